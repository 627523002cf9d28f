"""Recipe levels that follow from others: machines, OPC UA bindings, pauses.

What is derived is looked at only where the model and its options say nothing of that level.
"""

import re
from collections.abc import Iterator

from msgspec import Struct

from sysmlc.diagnostics import Severity, Sink, rule
from sysmlc.ir import Edge, Element, Kind, query
from sysmlc.ir.query import units as measures
from sysmlc.passes.recipe.context import Context

DERIVED = rule(
    "SM483",
    "recipe-level-derived",
    Severity.INFO,
    "'{element}' is taken for {level}: {because}",
    help="say the level in [recipe.levels], or by a stereotype, when something else is meant",
)

_NODE_ID = re.compile(
    r"(?:nsu?=[^;]+;)?"
    r"(?:i=\d+|s=.+|b=[A-Za-z0-9+/=]+|g=[0-9A-Fa-f]{8}(?:-[0-9A-Fa-f]{4}){3}-[0-9A-Fa-f]{12})",
    re.DOTALL,
)
_DURATIONS = ("duration", "time")
_CLASSES = (Kind.CLASS, Kind.COMPONENT)


class Derived(Struct, frozen=True):
    """An element whose level follows from the rest of the model."""

    element: Element
    level: str
    because: str


def with_derived(context: Context) -> tuple[Context, list[Derived]]:
    """The context with the levels that follow from others, and these levels."""
    found = [*_machines(context), *_bindings(context), *_pauses(context)]
    if not found:
        return context, []
    levels = {one.element.id: one.level for one in found}
    return context.with_derived(levels), found


def tell(context: Context, found: list[Derived], sink: Sink) -> None:
    """Say of each derived level what it follows from."""
    for one in found:
        sink.report(
            DERIVED,
            context.graph.subject(one.element),
            element=context.name(one.element),
            level=_ARTICLES[one.level],
            because=one.because,
        )


_ARTICLES = {
    "machine": "a machine",
    "opc ua call": "a stereotype of OPC UA calls",
    "opc ua variable": "a stereotype of OPC UA variables",
    "delay": "a pause",
}


def _machines(context: Context) -> Iterator[Derived]:
    """Blocks that own machine functions."""
    if context.of_level("machine"):
        return
    seen: set[str] = set()
    for one in context.of_level("machine function"):
        owner = context.graph.owner(one)
        is_block = owner is not None and owner.kind in _CLASSES and not context.level(owner)
        if owner is not None and is_block and owner.id not in seen:
            seen.add(owner.id)
            yield Derived(owner, "machine", f"it owns the machine function '{one.name}'")


def _bindings(context: Context) -> Iterator[Derived]:
    """Stereotypes whose node ids are written as OPC UA writes them."""
    said = set(context.levels.values())
    for stereotype in context.graph.of_kind(Kind.STEREOTYPE):
        applied = context.graph.sources(stereotype, Edge.INSTANCE_OF)
        ids = (str(one.attrs.get("tag.nodeId", "")) for one in applied)
        id = next((text for text in ids if _NODE_ID.fullmatch(text)), "")
        level = "opc ua call" if id and _has_behaviour(context, applied) else "opc ua variable"
        if id and level not in said and not context.level(stereotype):
            yield Derived(stereotype, level, f"its nodeId '{id}' is a node id of OPC UA")


def _has_behaviour(context: Context, applied: list[Element]) -> bool:
    subjects = (one for each in applied for one in context.graph.targets(each, Edge.SUBJECT))
    return any(one.kind in (*query.BEHAVIORS, Kind.OPERATION) for one in subjects)


def _pauses(context: Context) -> Iterator[Derived]:
    """Behaviours that are called, are given a duration and nothing else, and do nothing."""
    if "delay" in context.levels.values():
        return
    for one in context.graph.of_kind(Kind.ACTIVITY):
        if _only_waits(context, one) and context.graph.sources(one, Edge.CALLS):
            yield Derived(one, "delay", "all that it has is a duration")


def _only_waits(context: Context, activity: Element) -> bool:
    if activity.subkind or context.level(activity) or "body" in activity.attrs:
        return False
    parameters = query.parameters(context.graph, activity)
    if len(parameters) != 1 or query.direction_of(parameters[0]) != "in":
        return False
    is_alone = not context.nodes(activity) and not query.applications(context.graph, activity)
    return is_alone and _is_duration(context, parameters[0])


def _is_duration(context: Context, parameter: Element) -> bool:
    type_ = query.type_of(context.graph, parameter)
    if type_ is not None and type_.attrs.get("qualified_name") == "ISQBase::DurationValue":
        return True
    kind = measures.quantity_kind_of(context.graph, parameter)
    return kind is not None and kind.name.lower() in _DURATIONS
