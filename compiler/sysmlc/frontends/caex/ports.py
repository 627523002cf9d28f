"""What the attributes of an interface say of a port: direction, cardinality, category, values."""

from sysmlc.frontends.caex import fitting
from sysmlc.frontends.caex.context import Context
from sysmlc.frontends.caex.document import Node
from sysmlc.frontends.caex.vocabulary import DIRECTIONS
from sysmlc.ir import AttrValue

_CARDINALITY = ("MinOccur", "MaxOccur")


def said_of(context: Context, node: Node) -> dict[str, AttrValue]:
    """What the attributes of an interface say."""
    said: dict[str, AttrValue] = {}
    for child in node.of("Attribute"):
        _tell(context, said, child)
    return said


def _tell(context: Context, said: dict[str, AttrValue], node: Node) -> None:
    value = node.text("Value") or node.text("DefaultValue") or ""
    if node.name == "Direction" and value.strip().lower() in DIRECTIONS:
        said["direction"] = DIRECTIONS[value.strip().lower()]
    elif node.name == "Cardinality":
        _cardinality(said, node)
    elif node.name == "Category" and value:
        said["category"] = value
    else:
        _values(context, said, node)


def _cardinality(said: dict[str, AttrValue], node: Node) -> None:
    found = {child.name: (child.text("Value") or "").strip() for child in node.of("Attribute")}
    lower, upper = (found.get(name) or "" for name in _CARDINALITY)
    if lower or upper:
        bounds = (lower or "0", upper or "*")
        said["multiplicity"] = bounds[0] if bounds[0] == bounds[1] else "..".join(bounds)


def _values(context: Context, said: dict[str, AttrValue], top: Node) -> None:
    waiting = [(top, f"value.{top.name}")]
    while waiting:
        node, key = waiting.pop()
        value = node.text("Value")
        value = node.text("DefaultValue") if value is None else value
        if value is not None:
            data_type = node.attributes.get("AttributeDataType", "")
            said[key] = fitting.value(context, node, value, data_type, None)
        waiting += [(child, f"{key}.{child.name}") for child in node.of("Attribute")]
