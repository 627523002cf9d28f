"""From an activity to the graph of a task (services) or of a service (machine functions)."""

from collections.abc import Iterator, Sequence
from dataclasses import dataclass, field
from itertools import pairwise

from msgspec.structs import replace

from sysmlc.ir import Element, Kind, query
from sysmlc.passes.recipe.context import Called, Context, Refined
from sysmlc.passes.recipe.data import Data
from sysmlc.passes.recipe.nodes import (
    activity_flows,
    by_position,
    flow_ends,
    nodes_of,
    step_kind,
)
from sysmlc.passes.recipe.regions import entries, exits, is_for_each, is_inlined, steps_in
from sysmlc.recipe.expression import Apply, Expr, Lit
from sysmlc.recipe.flow import find_reachable, sort_nodes
from sysmlc.recipe.loops import with_loops
from sysmlc.recipe.model import FlowEdge, FlowGraph, Node

_CALLED_LEVELS = {"service": "service", "function": "machine function"}


def refined(context: Context, activity: Element, inside: str) -> Refined:
    """Return what an activity that refines a task or a service (*inside*) consists of."""
    refinement = context.refinements.get((inside, activity.id))
    if refinement is None:
        graph = flow_graph(context, activity, inside)
        calls = tuple(_list_calls(context, activity, inside))
        refinement = Refined(graph, calls, tuple(_remarks(context, activity, inside)))
        context.refinements[inside, activity.id] = refinement
    return refinement


def _list_calls(context: Context, activity: Element, inside: str) -> Iterator[Called]:
    for node in context.nodes(activity):
        kind = step_kind(context, node, inside)
        if kind in ("call", "service", "function"):
            called = context.definition(node) or node
            yield Called(kind, node.id, called.id)


def _remarks(context: Context, activity: Element, inside: str) -> Iterator[tuple[str, str]]:
    for node in context.nodes(activity):
        kind = step_kind(context, node, inside)
        if node.kind is Kind.STRUCTURED and not is_inlined(context.graph, node):
            yield node.id, ""
        elif by_position(context, node, kind):
            yield (context.definition(node) or node).id, _CALLED_LEVELS[kind]


_ENDS = ("final", "flow-final")


@dataclass(slots=True)
class Draft:
    """Nodes so far: for each activity node the first and last of the nodes made from it."""

    nodes: list[Node] = field(default_factory=list)
    edges: list[FlowEdge] = field(default_factory=list)
    first: dict[str, str] = field(default_factory=dict)
    last: dict[str, str] = field(default_factory=dict)


# -- regions -----------------------------------------------------------------------------------


def open_region(context: Context, region: Element, draft: Draft) -> None:
    """The initial node of a region's content is the region's own, its final nodes its end."""
    for node in steps_in(context.graph, region):
        if node.kind is Kind.CONTROL and node.subkind in ("initial", *_ENDS):
            draft.nodes = [one for one in draft.nodes if one.id != draft.first[node.id]]
            draft.last[node.id] = draft.first[region.id]
            draft.first[node.id] = draft.last[region.id]


def close_region(context: Context, region: Element, draft: Draft) -> None:
    """Edges into the content of a region and out of it; a for-each node is its begin and end."""
    begin, end = draft.first[region.id], draft.last[region.id]
    starts = [one for one in entries(context.graph, region) if one.subkind != "initial"]
    draft.edges += (FlowEdge(begin, draft.first[one.id], element=region.id) for one in starts)
    ends = [one for one in exits(context.graph, region) if one.subkind not in _ENDS]
    draft.edges += (FlowEdge(draft.last[one.id], end, element=region.id) for one in ends)
    if is_for_each(region):
        draft.edges = [_with_role(context, region, edge, draft) for edge in draft.edges]


def _with_role(context: Context, region: Element, edge: FlowEdge, draft: Draft) -> FlowEdge:
    if edge.source != draft.first[region.id]:
        return edge
    owner = context.graph[edge.element].owner
    is_body = region.id in (edge.element, owner)
    return replace(edge, role="body" if is_body else "exit")


# -- begin and end -----------------------------------------------------------------------------


def add_ends(context: Context, activity: Element, draft: Draft) -> None:
    """Begin and end as UML does where the model draws neither (UML 2.5.1 clause 15.2.3.2)."""
    id = context.name(activity)
    own = [one for one in draft.nodes if context.graph[one.element].owner == activity.id]
    between = [one for one in draft.edges if context.graph[one.element].owner == activity.id]
    kinds = {node.kind for node in own}
    targets = {edge.target for edge in between}
    sources = {edge.source for edge in between}
    if "initial" not in kinds:
        draft.nodes.append(Node(f"{id}::initial", "initial"))
        first = [node.id for node in own if node.id not in targets]
        draft.edges.extend(FlowEdge(f"{id}::initial", one) for one in first)
    if not kinds & {"final", "flowFinal"}:
        draft.nodes.append(Node(f"{id}::final", "final"))
        last = [node for node in own if node.id not in sources]
        draft.edges.extend(_ending(node, f"{id}::final") for node in last)


def _ending(node: Node, final: str) -> FlowEdge:
    return FlowEdge(node.id, final, role="exit" if node.kind == "forEach" else "")


def add_results(context: Context, activity: Element, data: Data, draft: Draft) -> None:
    """Before the end, what outputs are said to be by expressions over the activity."""
    found = [one for one in query.parameters(context.graph, activity, *_OUT) if is_computed(one)]
    ends = [one for one in draft.nodes if one.kind == "final"]
    ends = ends or [one for one in draft.nodes if one.kind == "flowFinal"]
    for number, end in enumerate(ends if found else (), 1):
        mark = "" if number == 1 else f"#{number}"
        made = [_result(context, one, data, mark) for one in found]
        _insert(made, end, draft)


_OUT = ("out", "inout", "return")


def is_computed(parameter: Element) -> bool:
    """Whether an expression gives the value of an output, and not only its first value."""
    is_text = isinstance(parameter.attrs.get("default"), str)
    is_expression = is_text and "default_language" in parameter.attrs
    return is_expression and not parameter.attrs.get("initial")


def _result(context: Context, parameter: Element, data: Data, mark: str) -> Node:
    value = data.read(str(parameter.attrs["default"]))
    name = context.label(parameter)
    id = f"{context.name(parameter)}{mark}"
    return Node(id, "assign", variable=name, expression=value, element=parameter.id)


def _insert(made: list[Node], end: Node, draft: Draft) -> None:
    """Nodes before an end; several ways to it meet first."""
    ways = [edge for edge in draft.edges if edge.target == end.id]
    if len(ways) > 1:
        made = [Node(f"{made[0].id}::merge", "merge", element=made[0].element), *made]
    draft.edges = [replace(e, target=made[0].id) if e in ways else e for e in draft.edges]
    following = [*made[1:], end]
    for one, after in zip(made, following, strict=True):
        draft.edges.append(FlowEdge(one.id, after.id, element=one.element))
    draft.nodes += made


def flow_graph(context: Context, activity: Element, inside: str) -> FlowGraph:
    """The graph of an activity; ``inside`` is its level, ``task`` or ``service``."""
    data = Data.of(context, activity)
    draft = Draft()
    nodes = context.nodes(activity)
    for node in nodes:
        _add_nodes(context, node, step_kind(context, node, inside), data, draft)
    regions = [node for node in nodes if is_inlined(context.graph, node)]
    for region in regions:
        open_region(context, region, draft)
    draft.edges.extend(_control_edges(context, activity, data, draft))
    draft.edges.extend(_object_edges(context, activity, data, draft))
    for region in regions:
        close_region(context, region, draft)
    add_ends(context, activity, draft)
    add_results(context, activity, data, draft)
    graph = FlowGraph(
        context.name(activity),
        data.parameters("in", "inout"),
        data.parameters("out", "inout", "return"),
        data.variables(),
        tuple(sorted(draft.nodes, key=lambda node: node.id)),
        tuple(draft.edges),
        activity.id,
    )
    return _sorted(with_loops(graph, _bounds(context, activity, draft)))


def _sorted(graph: FlowGraph) -> FlowGraph:
    """Nodes in the order of execution, edges in that of their ends, whatever the model's order."""
    by_id = {node.id: node for node in sorted(graph.nodes, key=lambda node: node.id)}
    graph = replace(graph, nodes=tuple(by_id.values()))
    rank = {id: number for number, id in enumerate(sort_nodes(graph))}
    edges = sorted(graph.edges, key=lambda e: (rank[e.source], rank[e.target], e.text, e.item))
    nodes = sorted(graph.nodes, key=lambda node: rank[node.id])
    return replace(graph, nodes=tuple(nodes), edges=tuple(edges))


def _add_nodes(context: Context, node: Element, kind: str, data: Data, draft: Draft) -> None:
    if not kind:
        return
    made = nodes_of(context, node, kind, data)
    draft.nodes.extend(made)
    draft.first[node.id], draft.last[node.id] = made[0].id, made[-1].id
    if not is_inlined(context.graph, node):
        draft.edges.extend(_row(made, node.id))


def _row(made: Sequence[Node], element: str) -> list[FlowEdge]:
    return [FlowEdge(a.id, b.id, element=element) for a, b in pairwise(made)]


# -- edges -------------------------------------------------------------------------------------


def _control_edges(
    context: Context, activity: Element, data: Data, draft: Draft
) -> Iterator[FlowEdge]:
    for flow in activity_flows(context, activity):
        source, target = flow_ends(context, flow)
        if flow.kind is not Kind.CONTROL_FLOW or source is None or target is None:
            continue
        if source.id in draft.last and target.id in draft.first:
            yield _edge(context, flow, source, target, data, draft)


def _object_edges(
    context: Context, activity: Element, data: Data, draft: Draft
) -> Iterator[FlowEdge]:
    """Object flows that order nodes which no control flow orders."""
    ordered = [(edge.source, edge.target) for edge in draft.edges]
    for flow in activity_flows(context, activity):
        source, _ = flow_ends(context, flow)
        if flow.kind is not Kind.OBJECT_FLOW or source is None or source.id not in draft.last:
            continue
        for target in _behind(context, flow, draft):
            edge = _edge(context, flow, source, target, data, draft)
            if edge.target not in find_reachable([edge.source], ordered):
                yield edge


def _behind(context: Context, flow: Element, draft: Draft) -> list[Element]:
    """Nodes that an object flow reaches, through buffers of data."""
    found: dict[str, Element] = {}
    seen: set[str] = set()
    stack = [flow]
    while stack:
        one = stack.pop(0)
        _, target = flow_ends(context, one)
        if target is None or one.id in seen:
            continue
        seen.add(one.id)
        if target.id in draft.first:
            found[target.id] = target
        elif target.kind is not Kind.ACTIVITY_PARAMETER:
            stack.extend(query.outgoing(context.graph, target))
    return list(found.values())


def _edge(
    context: Context, flow: Element, source: Element, target: Element, data: Data, draft: Draft
) -> FlowEdge:
    text = str(flow.attrs.get("guard", ""))
    is_else = text.strip() == "else"
    return FlowEdge(
        draft.last[source.id],
        draft.first[target.id],
        guard=None if is_else else _guard(context, flow, source, text, data),
        text=text,
        is_else=is_else,
        item=_item(context, flow) if flow.kind is Kind.OBJECT_FLOW else "",
        element=flow.id,
    )


def _guard(context: Context, flow: Element, source: Element, text: str, data: Data) -> Expr | None:
    """A guard; a literal is compared with the decision's input as fUML does (1.5, 8.5.2.2)."""
    is_literal = bool(flow.attrs.get("guard_literal"))
    if not text or (is_literal and source.subkind != "decision"):
        return None
    expression = data.read(text)
    tested = _decision_input(context, source, data)
    if not is_literal or tested is None or not isinstance(expression, Lit):
        return expression
    if isinstance(expression.value, bool):
        return tested if expression.value else Apply("not", (tested,))
    return Apply("==", (tested, expression))


def _decision_input(context: Context, decision: Element, data: Data) -> Expr | None:
    chosen = context.graph.get(str(decision.attrs.get("decision_input_flow", "")))
    incoming = query.incoming(context.graph, decision, Kind.OBJECT_FLOW)
    flows = [chosen] if chosen is not None else incoming
    return next((found for one in flows if (found := data.source_of(one)) is not None), None)


def _item(context: Context, flow: Element) -> str:
    ends = (query.flow_source(context.graph, flow), query.flow_target(context.graph, flow))
    types = (query.type_of(context.graph, end) for end in ends if end is not None)
    return next((context.name(one) for one in types if one is not None), "")


# -- bounds ------------------------------------------------------------------------------------


def _bounds(context: Context, activity: Element, draft: Draft) -> dict[str, int]:
    found: dict[str, int] = {}
    for element in context.contents(activity):
        if not context.may_have_stereotype(element):
            continue
        bound = context.tags(element, "Loop").integer("maxIterations")
        if bound is not None and bound > 0:
            found[draft.first.get(element.id, element.id)] = bound
    return found
