"""What the nodes of an activity are in a recipe graph: services, functions, control, the rest."""

from collections.abc import Callable, Iterator

from msgspec.structs import replace

from sysmlc.ir import Edge, Element, Kind, query
from sysmlc.passes.recipe.context import SERVICES, Context
from sysmlc.passes.recipe.data import Data
from sysmlc.passes.recipe.expressions import assignments, optional, read_time
from sysmlc.passes.recipe.regions import is_block, is_for_each
from sysmlc.recipe.model import Node

CONTROL_KINDS = {
    "initial": "initial",
    "final": "final",
    "flow-final": "flowFinal",
    "decision": "decision",
    "merge": "merge",
    "fork": "fork",
    "join": "join",
}
_HELPERS = ("opaque", "function")


def step_kind(context: Context, node: Element, inside: str) -> str:
    """Kind of the recipe node that an activity node becomes; empty for a buffer of data.

    ``inside`` is the level of the activity: what a task calls is a service, what a service
    calls is a function, unless a level says otherwise.
    """
    found = context.kinds.get((node.id, inside))
    if found is None:
        found = context.kinds[node.id, inside] = _step_kind(context, node, inside)
    return found


def _step_kind(context: Context, node: Element, inside: str) -> str:  # noqa: PLR0911 - a table
    if node.kind is Kind.CONTROL:
        return CONTROL_KINDS.get(node.subkind, "action")
    if node.kind is Kind.STRUCTURED:
        return _region_kind(context, node)
    level = context.level(node)
    if level in SERVICES:
        return "service"
    if level == "machine function":
        return "function"
    if level == "delay":
        return "delay"
    if node.kind in (Kind.OBJECT_NODE, Kind.DATA_STORE, Kind.ACTIVITY_PARAMETER, Kind.PIN):
        return ""
    called = context.definition(node) if node.kind is Kind.ACTION else None
    if called is None or node.subkind not in ("call-behavior", "call-operation"):
        return _plain_kind(context, node)
    if called.subkind in _HELPERS or (inside == "service" and is_helper(context, called)):
        return "call"
    return "service" if inside == "task" else "function"


def is_helper(context: Context, called: Element) -> bool:
    """Whether a behaviour without a level that a service calls only orders other steps.

    In a model that says which behaviours are machine functions, no other is one.
    """
    return refinement(context, called) is not None or bool(context.of_level("machine function"))


def refinement(context: Context, definition: Element | None) -> Element | None:
    """The activity that a definition is, that implements it, or that it runs; with content."""
    if definition is None:
        return None
    if definition.id not in context.refined:
        context.refined[definition.id] = _refinement(context, definition)
    return context.refined[definition.id]


def _refinement(context: Context, definition: Element) -> Element | None:
    graph = context.graph
    candidates = [definition, graph.target(definition, Edge.METHOD)]
    candidates.append(query.classifier_behavior(graph, definition))
    candidates += [one for one in graph.owned(definition) if one.kind is Kind.ACTIVITY]
    candidates += graph.sources(definition, Edge.REFINES)
    for one in candidates:
        if one is not None and one.kind is Kind.ACTIVITY and context.nodes(one):
            return one
    return None


def _region_kind(context: Context, node: Element) -> str:
    if is_for_each(node):
        return "forEach"
    return "block" if is_block(context.graph, node) else "action"


def by_position(context: Context, node: Element, kind: str) -> bool:
    """Whether only its position made the node a service or a function."""
    return kind in ("service", "function") and not context.level(node)


def _plain_kind(context: Context, node: Element) -> str:
    if node.subkind == "opaque" and assignments(str(node.attrs.get("body", ""))):
        return "assign"
    trigger = next(_triggers(context, node), None) if node.subkind == "accept" else None
    if trigger is None:
        return "wait" if node.subkind == "accept" else "action"
    return "delay" if trigger.subkind == "time" else "wait"


def _triggers(context: Context, node: Element) -> Iterator[Element]:
    for one in context.graph.targets(node, Edge.TRIGGER):
        yield one
    for one in context.graph.owned(node):
        if one.kind is Kind.TRIGGER:
            yield one


def nodes_of(context: Context, node: Element, kind: str, data: Data) -> list[Node]:
    """Nodes of the recipe graph for one node; an effect of several assignments is a chain."""
    made = Node(context.name(node), kind, element=node.id)
    return _MAKERS.get(kind, _bare)(context, node, made, data)


def _bare(context: Context, node: Element, made: Node, data: Data) -> list[Node]:
    return [made]


def _called(context: Context, node: Element, made: Node, data: Data) -> list[Node]:
    definition = context.definition(node)
    if made.kind == "call":
        definition = refinement(context, definition) or definition
    ref = context.name(node if definition is None else definition)
    return [_with(made, ref=ref, bind=data.bind(node), assign=data.assign(node))]


def _assigned(context: Context, node: Element, made: Node, data: Data) -> list[Node]:
    body = str(node.attrs.get("body", ""))
    return [
        _with(made, id=f"{made.id}#{number}" if number > 1 else made.id, variable=v, expression=e)
        for number, (v, e) in enumerate(assignments(body) or (), 1)
    ]


def _action(context: Context, node: Element, made: Node, data: Data) -> list[Node]:
    text = str(node.attrs.get("body", "") or node.name or node.subkind)
    return [_with(made, text=text, bind=data.bind(node), assign=data.assign(node))]


def _wait(context: Context, node: Element, made: Node, data: Data) -> list[Node]:
    trigger = next(_triggers(context, node), None)
    event = None if trigger is None else context.graph.target(trigger, Edge.TYPED_BY)
    condition = "" if trigger is None else str(trigger.attrs.get("condition", ""))
    text = condition or (node.name if event is None else context.name(event))
    return [_with(made, expression=optional(condition), text=text, assign=data.assign(node))]


def _block(context: Context, node: Element, made: Node, data: Data) -> list[Node]:
    """Where a block is entered and where it is left."""
    return [_with(made, kind="merge"), _with(made, kind="merge", id=f"{made.id}::end")]


def _for_each(context: Context, node: Element, made: Node, data: Data) -> list[Node]:
    variable = next((one for one in context.graph.owned(node) if one.subkind == "variable"), None)
    name = "" if variable is None else context.label(variable)
    collection = data.read(str(node.attrs.get("collection", "")))
    limit = data.size(collection)
    return [_with(made, variable=name, expression=collection, max_iterations=limit)]


def _delay(context: Context, node: Element, made: Node, data: Data) -> list[Node]:
    given = next((value for _, value in data.bind(node)), None)
    if given is not None:
        return [_with(made, expression=given)]
    trigger = next(_triggers(context, node), None)
    when = "" if trigger is None else str(trigger.attrs.get("when", ""))
    return [_with(made, expression=read_time(when), text=when)]


def _with(node: Node, **changes: object) -> Node:
    return replace(node, **changes)


_Maker = Callable[[Context, Element, Node, Data], list[Node]]
_MAKERS: dict[str, _Maker] = {
    "service": _called,
    "function": _called,
    "call": _called,
    "assign": _assigned,
    "action": _action,
    "wait": _wait,
    "delay": _delay,
    "block": _block,
    "forEach": _for_each,
}


def activity_flows(context: Context, activity: Element) -> list[Element]:
    """Control flows and object flows of the activity, inlined regions included."""
    kinds = (Kind.CONTROL_FLOW, Kind.OBJECT_FLOW)
    return [one for one in context.contents(activity) if one.kind in kinds]


def end_node(context: Context, end: Element | None) -> Element | None:
    """The node that an end of a flow belongs to: a pin stands for its action."""
    if end is None or end.kind is not Kind.PIN:
        return end
    return context.graph.owner(end)


def flow_ends(context: Context, flow: Element) -> tuple[Element | None, Element | None]:
    """Source and target nodes of a flow."""
    graph = context.graph
    ends = query.flow_source(graph, flow), query.flow_target(graph, flow)
    return end_node(context, ends[0]), end_node(context, ends[1])
