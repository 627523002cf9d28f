"""Definitions for applied stereotypes: those of the model, and stand-ins for unknown ones."""

from collections.abc import Iterator

from sysmlc.backends.sysml.entry import Entry, Plan
from sysmlc.backends.sysml.shapes import Shape
from sysmlc.backends.sysml.stereotypes import is_standard
from sysmlc.ir import AttrValue, Edge, Element, Kind
from sysmlc.ir.query import generals

_UNKNOWN = "Stereotypes"


def define(plan: Plan) -> dict[str, Entry]:
    """The metadata definition for each application (by its id); adds those that are missing."""
    found: dict[str, Entry] = {}
    made: dict[tuple[str, str], Entry] = {}
    for one in plan.graph.of_kind(Kind.APPLICATION):
        if one.attrs.get("external") or is_standard(one):
            continue
        definition = plan.entry(plan.graph.target(one, Edge.INSTANCE_OF))
        found[one.id] = definition or _stand_in(plan, made, one)
    for id, definition in found.items():
        _add_tags(plan, definition, plan.graph[id])
    return found


def _stand_in(plan: Plan, made: dict[tuple[str, str], Entry], one: Element) -> Entry:
    name = str(one.attrs.get("stereotype", "")) or one.name or "Stereotype"
    key = (str(one.attrs.get("namespace", "")), name)
    if key not in made:
        above = made.get(("", ""))
        if above is None:
            above = made["", ""] = plan.new(Shape("package"), None, _UNKNOWN, None)
        made[key] = plan.new(Shape("metadata def"), above, name, None)
        plan.profiles[id(made[key])] = key[0]
    return made[key]


def _add_tags(plan: Plan, definition: Entry, one: Element) -> None:
    known = set(_names(plan, definition))
    for key, value in one.attrs.items():
        tag = key.removeprefix("tag.")
        if not key.startswith("tag."):
            continue
        if tag not in known:
            plan.new(Shape("attribute"), definition, tag, None)
        added = next((m for m in definition.members if m.name == tag and m.element is None), None)
        if added is not None:
            plan.added[id(added)] = _wider(plan.added.get(id(added)), value)


def _names(plan: Plan, definition: Entry) -> Iterator[str]:
    yield from (one.name for one in definition.members)
    if definition.element is not None:
        for general in generals(plan.graph, definition.element):
            other = plan.entry(general)
            yield from () if other is None else (one.name for one in other.members)


def _wider(known: str | None, value: AttrValue) -> str:
    """Type and multiplicity of an attribute that has all values seen."""
    several = isinstance(value, tuple) or (known is not None and "[0..*]" in known)
    first = value[0] if isinstance(value, tuple) and value else value
    type_ = "String"
    if isinstance(first, bool):
        type_ = "Boolean"
    elif isinstance(first, int):
        type_ = "Integer"
    elif isinstance(first, float):
        type_ = "Real"
    if known is not None and not known.startswith(f"ScalarValues::{type_}"):
        type_ = "ScalarValue"
    return f"ScalarValues::{type_}[0..{'*' if several else '1'}]"
