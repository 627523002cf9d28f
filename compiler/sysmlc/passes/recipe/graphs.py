"""From an activity to the graph of a task (services) or of a service (machine functions)."""

from collections.abc import Iterator, Sequence
from itertools import pairwise

from msgspec.structs import replace

from sysmlc.ir import Element, Kind, query
from sysmlc.passes.recipe.context import Context
from sysmlc.passes.recipe.data import Data
from sysmlc.passes.recipe.draft import Draft, add_ends, add_results, close_region, open_region
from sysmlc.passes.recipe.nodes import (
    activity_flows,
    flow_ends,
    nodes_of,
    step_kind,
)
from sysmlc.passes.recipe.regions import is_inlined
from sysmlc.recipe.expression import Apply, Expr, Lit
from sysmlc.recipe.flow import in_order, reachable
from sysmlc.recipe.loops import with_loops
from sysmlc.recipe.model import FlowEdge, FlowGraph, Node


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
    rank = {id: number for number, id in enumerate(in_order(graph))}
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
            if edge.target not in reachable([edge.source], ordered):
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
