"""Values of features as attributes: literals, enumeration values, quantities, expressions."""

from typing import TYPE_CHECKING

from sysmlc.frontends.sysml import expressions, nodes
from sysmlc.ir import AttrValue, Edge, Element
from sysmlc.language.tree import Node

if TYPE_CHECKING:
    from sysmlc.frontends.sysml.lowering import Lowering


def give(low: "Lowering", element: Element, key: str, node: Node) -> None:
    """Set the attribute ``key`` from an expression, with what is known of it beside.

    Enumeration values have the attribute ``<key>_instance``, other expressions
    ``<key>_language``.
    """
    literal = constant(node)
    if literal is not None:
        low.graph.set(element, **{key: literal})
        return
    low.last(lambda: _refer(low, element, key, node))


def _refer(low: "Lowering", element: Element, key: str, node: Node) -> None:
    target = _literal_of(node)
    known = low.element(target)
    if target is not None and target.kind == "EnumerationUsage" and known is not None:
        _literal(low, element, key, known)
        return
    written = _written(node, low)
    low.graph.set(element, **{key: written, f"{key}_language": ""})


def say(low: "Lowering", element: Element, key: str, node: Node) -> None:
    """Set the attribute ``key`` to a condition, or another expression, as text."""
    low.set(element, **{key: texts(node, low)})


def _written(node: Node, low: "Lowering") -> str:
    document = low.document(node)
    return expressions.text(node, "" if document is None else document.text)


def _literal(low: "Lowering", element: Element, key: str, known: Element) -> None:
    """A literal of an enumeration; for a feature of another type the value that it has."""
    types = low.graph.targets(element, Edge.TYPED_BY)
    is_other = low.is_scalar(element) or (types and low.graph.owner(known) not in types)
    value = known.attrs.get("value") if is_other else None
    given = known.name if value is None else value
    low.graph.set(element, **{key: given, f"{key}_instance": known.id})


def _literal_of(node: Node) -> Node | None:
    if node.kind != "FeatureReferenceExpression":
        return None
    return nodes.target(node, "Membership")


def constant(node: Node) -> AttrValue:
    """The literal that an expression is; None when it must be computed.

    The number of a quantity is its value: the unit is that of the type (``measure``).
    """
    if node.kind in _LITERALS:
        return node.attributes.get("value")
    if node.kind == "OperatorExpression":
        return _operation(node)
    return () if node.kind == "NullExpression" else None


def _operation(node: Node) -> AttrValue:
    operator, args = node.attributes.get("operator"), nodes.arguments(node)
    if operator == "-" and len(args) == 1:
        found = constant(args[0])
        is_number = isinstance(found, int | float) and not isinstance(found, bool)
        return -found if is_number and isinstance(found, int | float) else None
    if operator == "[" and len(args) == 2:
        return constant(args[0])
    if operator == "," and len(args) == 2:
        return _sequence(args)
    return None


def _sequence(args: list[Node]) -> AttrValue:
    """The values of ``(a, b, c)``, which nests to the right as deep as it is long."""
    found: list[AttrValue] = []
    while len(args) == 2:
        left, right = args
        if not _add(constant(left), found):
            return None
        args = nodes.arguments(right) if right.attributes.get("operator") == "," else [right]
    return tuple(found) if all(_add(constant(one), found) for one in args) else None


def _add(value: AttrValue, found: list[AttrValue]) -> bool:
    """Take a value, or the values of a sequence within; False when there is none."""
    if value is None:
        return False
    found += value if isinstance(value, tuple) else [value]
    return True


_LITERALS = frozenset({"LiteralBoolean", "LiteralString", "LiteralInteger", "LiteralRational"})


def measure(node: Node) -> str:
    """Name of the unit of a quantity (``5 [SI::mm]`` gives ``mm``), or the empty string."""
    if node.kind == "OperatorExpression" and node.attributes.get("operator") == "[":
        args = nodes.arguments(node)
        found = nodes.reference(args[1], "Membership") if len(args) == 2 else None
        return "" if found is None else nodes.last_name(found)
    return ""


def multiplicity(low: "Lowering", node: Node) -> str:
    """The multiplicity of a feature in UML notation; empty when it is exactly one."""
    if not node.members:
        return ""
    for one in node.members:
        if one.kind == "MultiplicityRange":
            return _bounds(low, one)
    cross = nodes.crossed(node)
    return "" if cross is None else multiplicity(low, cross)


def _bounds(low: "Lowering", range_: Node) -> str:
    document = low.document(range_)
    source = "" if document is None else document.text
    bounds = [_bound(one, source) for one in range_.members if one.kind in nodes.EXPRESSIONS]
    if not bounds:
        return ""
    if len(bounds) == 1 or bounds[0] == bounds[1]:
        return "" if bounds[0] == "1" else bounds[0]
    return "*" if bounds == ["0", "*"] else "..".join(bounds)


def _bound(node: Node, source: str) -> str:
    return "*" if node.kind == "LiteralInfinity" else expressions.text(node, source)


def texts(node: Node | None, low: "Lowering") -> str:
    """A condition as text in our grammar; the name of a text feature is that text."""
    if node is None:
        return ""
    target = _literal_of(node)
    if target is not None and target.name and not target.name.isidentifier():
        return target.name
    return _written(node, low)
