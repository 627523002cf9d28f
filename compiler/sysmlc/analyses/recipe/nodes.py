"""Nodes of recipe graphs: services, functions, control nodes and other steps of an activity."""

from collections.abc import Callable

from msgspec.structs import replace

from sysmlc.analyses.recipe.activity_graph import is_for_each
from sysmlc.analyses.recipe.context import SERVICES, Context
from sysmlc.analyses.recipe.data_flow import DataFlow
from sysmlc.analyses.recipe.expressions import read_assignments, read_delay, read_optional
from sysmlc.ir import Edge, Element, Kind, query
from sysmlc.recipe.model import Node
from sysmlc.support.units import read_time

_CONTROL_KINDS = frozenset(["initial", "final", "flowFinal", "decision", "merge", "fork", "join"])
_HELPERS = ("opaque", "function")


def step_kind(  # noqa: PLR0911 - a table
    context: Context, node: Element, activity_level: str
) -> str:
    """Return the kind of the recipe node for an activity node, or "" for a buffer of data.

    *activity_level* is ``task`` or ``service``. In a task, a called element without a level is a
    service, and in a service it is a machine function or a helper.
    """
    if node.kind is Kind.CONTROL:
        kind = "flowFinal" if node.subkind == "flow-final" else node.subkind
        return kind if kind in _CONTROL_KINDS else "action"
    if node.kind is Kind.STRUCTURED:
        inlined_kind = "forEach" if is_for_each(node) else "block"
        return inlined_kind if context.is_inlined(node) else "action"
    level = context.level(node)
    if level in SERVICES:
        return "service"
    if level == "machine function":
        return "function"
    if level == "delay":
        return "delay"
    if node.kind in (Kind.OBJECT_NODE, Kind.DATA_STORE, Kind.ACTIVITY_PARAMETER, Kind.PIN):
        return ""
    definition = context.definition(node) if node.kind is Kind.ACTION else None
    if definition is None or node.subkind not in ("call-behavior", "call-operation"):
        return _plain_kind(context, node)
    if definition.subkind in _HELPERS or (
        activity_level == "service" and _is_helper(context, definition)
    ):
        return "call"
    return "service" if activity_level == "task" else "function"


def _is_helper(context: Context, behavior: Element) -> bool:
    """Whether a behaviour without a level that a service calls is a helper, not a machine function.

    A helper has steps of its own. If the model marks any behaviour as a machine function, all
    unmarked behaviours are helpers.
    """
    return find_refinement(context, behavior) is not None or bool(
        context.elements_of_level("machine function")
    )


def find_refinement(context: Context, definition: Element | None) -> Element | None:
    """Return the activity with nodes that describes a definition, or None.

    Candidates are the definition, its method, its classifier behaviour, activities that it owns,
    and elements that refine it, in this order.
    """
    if definition is None:
        return None
    if definition.id not in context.refined:
        context.refined[definition.id] = _search_refinement(context, definition)
    return context.refined[definition.id]


def _search_refinement(context: Context, definition: Element) -> Element | None:
    graph = context.graph
    candidates = [definition, graph.target(definition, Edge.METHOD)]
    candidates.append(query.classifier_behavior(graph, definition))
    candidates += [
        candidate for candidate in graph.owned(definition) if candidate.kind is Kind.ACTIVITY
    ]
    candidates += graph.sources(definition, Edge.REFINES)
    for candidate in candidates:
        if (
            candidate is not None
            and candidate.kind is Kind.ACTIVITY
            and context.has_nodes(candidate)
        ):
            return candidate
    return None


def is_by_position(context: Context, node: Element, kind: str) -> bool:
    """Whether the node is a service or function only because of the activity that calls it."""
    return kind in ("service", "function") and not context.level(node)


def _plain_kind(context: Context, node: Element) -> str:
    if node.subkind == "opaque" and read_assignments(str(node.attrs.get("body", ""))):
        return "assign"
    trigger = _find_trigger(context, node) if node.subkind == "accept" else None
    if trigger is None:
        return "wait" if node.subkind == "accept" else "action"
    return "delay" if trigger.subkind == "time" else "wait"


def _find_trigger(context: Context, node: Element) -> Element | None:
    owned = (element for element in context.graph.owned(node) if element.kind is Kind.TRIGGER)
    return next(iter((*context.graph.targets(node, Edge.TRIGGER), *owned)), None)


def build_nodes(context: Context, node: Element, kind: str, data: DataFlow) -> list[Node]:
    """Return the recipe nodes for one activity node: several for a block or several assignments."""
    recipe_node = Node(context.name(node), kind, element=node.id)
    build = _MAKERS.get(kind)
    return [recipe_node] if build is None else build(context, node, recipe_node, data)


def _build_call(context: Context, node: Element, base: Node, data: DataFlow) -> list[Node]:
    definition = context.definition(node)
    # The graph of a helper is named after the activity that describes it.
    if base.kind == "call":
        definition = find_refinement(context, definition) or definition
    ref = context.name(node if definition is None else definition)
    return [replace(base, ref=ref, bind=data.bind_inputs(node), assign=data.assign_outputs(node))]


def _build_assignments(context: Context, node: Element, base: Node, data: DataFlow) -> list[Node]:
    body = str(node.attrs.get("body", ""))
    return [
        replace(
            base,
            id=f"{base.id}#{number}" if number > 1 else base.id,
            variable=variable,
            expression=data.rename_variables(value),
        )
        for number, (variable, value) in enumerate(read_assignments(body) or (), 1)
    ]


def _build_action(context: Context, node: Element, base: Node, data: DataFlow) -> list[Node]:
    text = str(node.attrs.get("body", "") or node.name or node.subkind)
    return [replace(base, text=text, bind=data.bind_inputs(node), assign=data.assign_outputs(node))]


def _build_wait(context: Context, node: Element, base: Node, data: DataFlow) -> list[Node]:
    trigger = _find_trigger(context, node)
    event = None if trigger is None else context.graph.target(trigger, Edge.TYPED_BY)
    condition = "" if trigger is None else str(trigger.attrs.get("condition", ""))
    text = condition or (node.name if event is None else context.name(event))
    return [
        replace(
            base, expression=read_optional(condition), text=text, assign=data.assign_outputs(node)
        )
    ]


def _build_block(context: Context, node: Element, base: Node, data: DataFlow) -> list[Node]:
    """Return the merge nodes at the start and at the end of a block."""
    return [replace(base, kind="merge"), replace(base, kind="merge", id=f"{base.id}::end")]


def _build_for_each(context: Context, node: Element, base: Node, data: DataFlow) -> list[Node]:
    variable = next(
        (element for element in context.graph.owned(node) if element.subkind == "variable"), None
    )
    name = "" if variable is None else context.label(variable)
    collection = data.read(str(node.attrs.get("collection", "")))
    least, most = data.find_sizes(collection)
    return [
        replace(
            base,
            variable=name,
            expression=collection,
            max_iterations=most,
            min_iterations=least,
        )
    ]


def _build_delay(context: Context, node: Element, base: Node, data: DataFlow) -> list[Node]:
    duration = next((value for _, value in data.bind_inputs(node)), None)
    if duration is not None:
        return [replace(base, expression=duration)]
    trigger = _find_trigger(context, node)
    time = read_time("after ") if trigger is None else query.time_of(trigger)
    return [replace(base, expression=read_delay(time), text=time.text)]


_Maker = Callable[[Context, Element, Node, DataFlow], list[Node]]
_MAKERS: dict[str, _Maker] = {
    "service": _build_call,
    "function": _build_call,
    "call": _build_call,
    "assign": _build_assignments,
    "action": _build_action,
    "wait": _build_wait,
    "delay": _build_delay,
    "block": _build_block,
    "forEach": _build_for_each,
}
