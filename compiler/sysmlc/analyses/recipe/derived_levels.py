"""Recipe levels that follow from facts of the model: machines, OPC UA bindings and pauses.

A level is derived only if neither the model nor the options give it to any element, so that models
that state their levels do not change (docs/decisions/0029).
"""

import json
import re
from collections.abc import Iterator

from msgspec import Struct

from sysmlc.analyses.recipe.context import Context
from sysmlc.analyses.recipe.profile import LEVELS
from sysmlc.diagnostics import Severity, Sink, rule
from sysmlc.ir import Edge, Element, Kind, query
from sysmlc.ir.query.classifiers import quantity_kind_of

DERIVED = rule(
    "SM483",
    "recipe-level-derived",
    Severity.INFO,
    "'{element}' is treated as {level}: {because}",
    help="to choose another level, set it in [recipe.levels] or apply a stereotype",
)

MISSING = rule(
    "SM640",
    "recipe-levels-missing",
    Severity.WARNING,
    "no recipe is written: definitions are named like the levels of recipes, but have no level",
    help="add the lines of the notes to sysmlc.toml, or switch this rule off",
)

# The form of node ids in OPC 10000-6, clause 5.3.1.10: a namespace, then a typed identifier.
_NODE_ID = re.compile(
    r"(?:nsu?=[^;]+;)?"
    r"(?:i=\d+|s=.+|b=[A-Za-z0-9+/=]+|g=[0-9A-Fa-f]{8}(?:-[0-9A-Fa-f]{4}){3}-[0-9A-Fa-f]{12})",
    re.DOTALL,
)
_DURATION_QUANTITIES = ("duration", "time")
_CLASSES = (Kind.CLASS, Kind.COMPONENT)
_LEVEL_TEXTS = {
    "machine": "a machine",
    "opc ua call": "a stereotype of OPC UA calls",
    "opc ua variable": "a stereotype of OPC UA variables",
    "delay": "a pause",
}


_LEVELS_BY_WORD = {level.replace(" ", ""): level for level in LEVELS.values()}
_BELOW_TASKS = frozenset(["machine service", "infrastructure service", "machine function"])


class DerivedLevel(Struct, frozen=True):
    """An element, its derived level, and the reason as a clause for the report."""

    element: Element
    level: str
    because: str


def add_derived_levels(context: Context) -> tuple[Context, list[DerivedLevel]]:
    """Return the context with the derived levels, and the list of these levels."""
    derived = [*_derive_machines(context), *_derive_bindings(context), *_derive_pauses(context)]
    if not derived:
        return context, []
    levels = {entry.element.id: entry.level for entry in derived}
    return context.with_derived(levels), derived


def report_derived_levels(context: Context, derived: list[DerivedLevel], sink: Sink) -> None:
    """Report each derived level with the reason for it (SM483)."""
    for entry in derived:
        sink.report(
            DERIVED,
            context.graph.subject(entry.element),
            element=context.name(entry.element),
            level=_LEVEL_TEXTS[entry.level],
            because=entry.because,
        )


def report_missing_levels(context: Context, sink: Sink) -> None:
    """Report definitions named like levels if there is a task and a service or function (SM640).

    An equal name alone gives no level, because other profiles and models use the same words.
    """
    by_level: dict[str, Element] = {}
    for element in context.graph.of_kind(*query.CLASSIFIERS):
        level = _LEVELS_BY_WORD.get(re.sub(r"[\W_]", "", element.name).casefold())
        uses = (Edge.SPECIALIZES, Edge.TYPED_BY, Edge.CALLS)
        is_used = any(context.graph.sources(element, edge) for edge in uses)
        if level and is_used and not element.attrs.get("external"):
            by_level.setdefault(level, element)
    if "task" not in by_level or by_level.keys().isdisjoint(_BELOW_TASKS):
        return
    lines = (
        f"{level.replace(' ', '-')} = {json.dumps(context.name(by_level[level]))}"
        for level in LEVELS.values()
        if level in by_level
    )
    subject = context.graph.subject(by_level["task"])
    sink.report(MISSING, subject, notes=("[recipe.levels]", *lines))


def _derive_machines(context: Context) -> Iterator[DerivedLevel]:
    """Yield the blocks that own machine functions."""
    if context.elements_of_level("machine"):
        return
    seen: set[str] = set()
    for function in context.elements_of_level("machine function"):
        owner = context.graph.owner(function)
        is_block = owner is not None and owner.kind in _CLASSES and not context.level(owner)
        if owner is not None and is_block and owner.id not in seen:
            seen.add(owner.id)
            yield DerivedLevel(owner, "machine", f"it owns the machine function '{function.name}'")


def _derive_bindings(context: Context) -> Iterator[DerivedLevel]:
    """Yield the stereotypes with a tag ``nodeId`` whose value is a node id of OPC UA."""
    stated = set(context.levels.values())
    for stereotype in context.graph.of_kind(Kind.STEREOTYPE):
        applied = context.graph.sources(stereotype, Edge.INSTANCE_OF)
        ids = (str(application.attrs.get("tag.nodeId", "")) for application in applied)
        id = next((text for text in ids if _NODE_ID.fullmatch(text)), "")
        level = (
            "opc ua call" if id and _applies_to_behaviour(context, applied) else "opc ua variable"
        )
        if id and level not in stated and not context.level(stereotype):
            yield DerivedLevel(stereotype, level, f"its nodeId '{id}' is a node id of OPC UA")


def _applies_to_behaviour(context: Context, applied: list[Element]) -> bool:
    subjects = (
        subject
        for application in applied
        for subject in context.graph.targets(application, Edge.SUBJECT)
    )
    return any(subject.kind in (*query.BEHAVIORS, Kind.OPERATION) for subject in subjects)


def _derive_pauses(context: Context) -> Iterator[DerivedLevel]:
    """Yield the called activities whose only feature is an input parameter for a duration."""
    if "delay" in context.levels.values():
        return
    for activity in context.graph.of_kind(Kind.ACTIVITY):
        if _is_pause(context, activity) and context.graph.sources(activity, Edge.CALLS):
            yield DerivedLevel(activity, "delay", "all that it has is a duration")


def _is_pause(context: Context, activity: Element) -> bool:
    if activity.subkind or context.level(activity) or "body" in activity.attrs:
        return False
    parameters = query.parameters(context.graph, activity)
    if len(parameters) != 1 or query.direction_of(parameters[0]) != "in":
        return False
    is_alone = not context.has_nodes(activity) and not query.applications(context.graph, activity)
    return is_alone and _is_duration(context, parameters[0])


def _is_duration(context: Context, parameter: Element) -> bool:
    type_ = query.type_of(context.graph, parameter)
    if type_ is not None and type_.attrs.get("qualified_name") == "ISQBase::DurationValue":
        return True
    kind = quantity_kind_of(context.graph, parameter)
    return kind is not None and kind.name.lower() in _DURATION_QUANTITIES
