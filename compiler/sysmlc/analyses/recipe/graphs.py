"""Graphs of tasks, whose nodes are services, and graphs of services, whose nodes are functions."""

from collections import Counter
from collections.abc import Iterator
from dataclasses import dataclass, field
from itertools import pairwise

from msgspec.structs import replace

from sysmlc.analyses.recipe.activity_graph import ActivityGraph, Flow, is_for_each
from sysmlc.analyses.recipe.context import Call, Context, Refinement
from sysmlc.analyses.recipe.data_flow import DataFlow
from sysmlc.analyses.recipe.nodes import build_nodes, is_by_position, step_kind
from sysmlc.analyses.recipe.profile import read_number
from sysmlc.ir import Element, Kind, algorithms, query
from sysmlc.ir.element import derived_id
from sysmlc.ir.expressions import Binary, Expression, Literal, Unary
from sysmlc.recipe.flow import add_loop_nodes, find_reachable, sort_nodes
from sysmlc.recipe.model import FlowEdge, FlowGraph, Node

_CALLED_LEVELS = {"service": "service", "function": "machine function"}
_ENDS = ("final", "flow-final")
_OUT = ("out", "inout", "return")


def refine(context: Context, activity: Element, activity_level: str) -> Refinement:
    """Return the content of an activity that refines a task or a service.

    *activity_level* states which of the two: ``task`` or ``service``.
    """
    refinement = context.refinements.get((activity_level, activity.id))
    if refinement is None:
        graph = _build_flow_graph(context, activity, activity_level)
        calls = tuple(_list_calls(context, activity, activity_level))
        refinement = Refinement(
            graph, calls, tuple(_list_decisions(context, activity, activity_level))
        )
        context.refinements[activity_level, activity.id] = refinement
    return refinement


def _list_calls(context: Context, activity: Element, activity_level: str) -> Iterator[Call]:
    for node in context.read_activity(activity).nodes:
        kind = step_kind(context, node, activity_level)
        if kind in ("call", "service", "function"):
            definition = context.definition(node) or node
            yield Call(kind, node.id, definition.id)


def _list_decisions(
    context: Context, activity: Element, activity_level: str
) -> Iterator[tuple[str, str]]:
    drawn = context.read_activity(activity)
    for node in drawn.nodes:
        kind = step_kind(context, node, activity_level)
        if node.kind is Kind.STRUCTURED and node.id not in drawn.inlined:
            yield node.id, ""
        elif is_by_position(context, node, kind):
            yield (context.definition(node) or node).id, _CALLED_LEVELS[kind]


@dataclass(slots=True)
class Draft:
    """A flow graph under construction.

    Several recipe nodes may stand for one activity node. By its id, ``first`` has the recipe node
    that its incoming edges reach, and ``last`` the recipe node that its outgoing edges leave.
    """

    nodes: list[Node] = field(default_factory=list)
    edges: list[FlowEdge] = field(default_factory=list)
    first: dict[str, str] = field(default_factory=dict)
    last: dict[str, str] = field(default_factory=dict)


def _build_flow_graph(context: Context, activity: Element, activity_level: str) -> FlowGraph:
    """Return the graph of an activity; *activity_level* is its level, ``task`` or ``service``."""
    data = DataFlow.build(context, activity)
    draft = Draft()
    drawn = context.read_activity(activity)
    for node in drawn.nodes:
        _add_nodes(context, node, step_kind(context, node, activity_level), data, draft)
    regions = [node for node in drawn.nodes if node.id in drawn.inlined]
    for region in regions:
        _remove_region_ends(drawn, region, draft)
    draft.edges.extend(_list_control_edges(context, drawn, data, draft))
    # After the control edges: only object flows that no control flow already orders count.
    draft.edges.extend(_list_object_edges(context, drawn, data, draft))
    _add_pin_merges(context, drawn, draft)
    for region in regions:
        _connect_region(context, drawn, region, draft)
    _add_ends(context, activity, draft)
    _add_results(context, activity, data, draft)
    _split_combined_nodes(context, activity, draft)
    graph = FlowGraph(
        context.name(activity),
        data.list_parameters("in", "inout"),
        data.list_parameters(*_OUT),
        data.list_variables(),
        tuple(sorted(draft.nodes, key=lambda node: node.id)),
        tuple(draft.edges),
        activity.id,
    )
    return _sort_graph(add_loop_nodes(graph, _read_loop_bounds(context, activity, draft)))


def _sort_graph(graph: FlowGraph) -> FlowGraph:
    """Return the graph with nodes in the order of execution and edges in the order of their ends.

    The order does not depend on the order of the model.
    """
    by_id = {node.id: node for node in sorted(graph.nodes, key=lambda node: node.id)}
    graph = replace(graph, nodes=tuple(by_id.values()))
    rank = {id: number for number, id in enumerate(sort_nodes(graph))}
    edges = sorted(graph.edges, key=lambda e: (rank[e.source], rank[e.target], e.text, e.item))
    nodes = sorted(graph.nodes, key=lambda node: rank[node.id])
    return replace(graph, nodes=tuple(nodes), edges=tuple(edges))


# -- regions -----------------------------------------------------------------------------------


def _remove_region_ends(drawn: ActivityGraph, region: Element, draft: Draft) -> None:
    """Remove the initial and final nodes of a region.

    Edges from an initial node then leave the first recipe node of the region, and edges to a final
    node reach its last one.
    """
    for node in drawn.list_steps(region):
        if node.kind is Kind.CONTROL and node.subkind in ("initial", *_ENDS):
            draft.nodes = [
                recipe_node for recipe_node in draft.nodes if recipe_node.id != draft.first[node.id]
            ]
            draft.last[node.id] = draft.first[region.id]
            draft.first[node.id] = draft.last[region.id]


def _connect_region(context: Context, drawn: ActivityGraph, region: Element, draft: Draft) -> None:
    """Connect the first and last node of a region with its content.

    Both are the same node if the region is a for-each loop.
    """
    begin, end = draft.first[region.id], draft.last[region.id]
    starts = [node for node in drawn.find_entries(region) if node.subkind != "initial"]
    draft.edges += (FlowEdge(begin, draft.first[node.id], element=region.id) for node in starts)
    ends = [node for node in drawn.find_exits(region) if node.subkind not in _ENDS]
    draft.edges += (FlowEdge(draft.last[node.id], end, element=region.id) for node in ends)
    if is_for_each(region):
        draft.edges = [_assign_role(context, region, edge, draft) for edge in draft.edges]


def _assign_role(context: Context, region: Element, edge: FlowEdge, draft: Draft) -> FlowEdge:
    if edge.source != draft.first[region.id]:
        return edge
    owner = context.graph[edge.element].owner
    is_body = region.id in (edge.element, owner)
    return replace(edge, role="body" if is_body else "exit")


# -- begin and end -----------------------------------------------------------------------------


def _add_ends(context: Context, activity: Element, draft: Draft) -> None:
    """Add an initial and a final node where the model draws none (UML 2.5.1 clause 15.2.3.2)."""
    id = context.name(activity)
    outermost = {node.id for node in context.read_activity(activity).list_nodes(activity)}
    top_nodes = [node for node in draft.nodes if node.element in outermost]
    kinds = {node.kind for node in top_nodes}
    targets = {edge.target for edge in draft.edges}
    sources = {edge.source for edge in draft.edges}
    if "initial" not in kinds:
        draft.nodes.append(Node(f"{id}::initial", "initial"))
        first = [node.id for node in top_nodes if node.id not in targets]
        draft.edges.extend(FlowEdge(f"{id}::initial", target) for target in first)
    if not kinds & {"final", "flowFinal"}:
        draft.nodes.append(Node(f"{id}::final", "final"))
        last = [node for node in top_nodes if node.id not in sources]
        draft.edges.extend(
            FlowEdge(node.id, f"{id}::final", role="exit" if node.kind == "forEach" else "")
            for node in last
        )


def _add_results(context: Context, activity: Element, data: DataFlow, draft: Draft) -> None:
    """Add assignments before the end, for outputs whose values are given by expressions."""
    computed = [
        element
        for element in query.parameters(context.graph, activity, *_OUT)
        if _is_computed(element)
    ]
    ends = [node for node in draft.nodes if node.kind == "final"]
    # A flow final node ends its own flow only, so that it counts only if nothing else is an end.
    ends = ends or [node for node in draft.nodes if node.kind == "flowFinal"]
    for number, end in enumerate(ends if computed else (), 1):
        mark = "" if number == 1 else f"#{number}"
        results = [_build_result(context, element, data, mark) for element in computed]
        _insert_before(results, end, draft)


def _is_computed(parameter: Element) -> bool:
    """Whether an expression determines the value of an output, not only its initial value."""
    is_text = isinstance(parameter.attrs.get("default"), str)
    is_expression = is_text and "default_language" in parameter.attrs
    return is_expression and parameter.attrs.get("default_kind") != "initial"


def _build_result(context: Context, parameter: Element, data: DataFlow, mark: str) -> Node:
    value = data.read(str(parameter.attrs["default"]))
    name = context.label(parameter)
    id = f"{context.name(parameter)}{mark}"
    return Node(id, "assign", variable=name, expression=value, element=parameter.id)


def _insert_before(inserted: list[Node], end: Node, draft: Draft) -> None:
    """Insert nodes before an end, after a merge node if several edges lead to the end."""
    incoming = [edge for edge in draft.edges if edge.target == end.id]
    if len(incoming) > 1:
        inserted = [
            Node(f"{inserted[0].id}::merge", "merge", element=inserted[0].element),
            *inserted,
        ]
    draft.edges = [replace(e, target=inserted[0].id) if e in incoming else e for e in draft.edges]
    following = [*inserted[1:], end]
    for node, next_node in zip(inserted, following, strict=True):
        draft.edges.append(FlowEdge(node.id, next_node.id, element=node.element))
    draft.nodes += inserted


def _add_nodes(context: Context, node: Element, kind: str, data: DataFlow, draft: Draft) -> None:
    if not kind:
        return
    new_nodes = build_nodes(context, node, kind, data)
    draft.nodes.extend(new_nodes)
    draft.first[node.id], draft.last[node.id] = new_nodes[0].id, new_nodes[-1].id
    if kind != "block":
        draft.edges.extend(FlowEdge(a.id, b.id, element=node.id) for a, b in pairwise(new_nodes))


# -- edges -------------------------------------------------------------------------------------


def _list_control_edges(
    context: Context, drawn: ActivityGraph, data: DataFlow, draft: Draft
) -> Iterator[FlowEdge]:
    for flow in drawn.flows:
        is_control = flow.element.kind is Kind.CONTROL_FLOW
        if is_control and flow.source.id in draft.last and flow.target.id in draft.first:
            yield _build_edge(context, flow, flow.target.id, data, draft)


def _list_object_edges(
    context: Context, drawn: ActivityGraph, data: DataFlow, draft: Draft
) -> Iterator[FlowEdge]:
    """Yield the edges of object flows between nodes that no control flow orders."""
    ordered = [(edge.source, edge.target) for edge in draft.edges]
    following: dict[str, list[str]] = {}
    for flow in drawn.flows:
        # Buffers of data are no nodes of a recipe: they pass on what they get.
        if flow.source.id not in draft.last and flow.source.kind is not Kind.ACTIVITY_PARAMETER:
            following.setdefault(flow.source.id, []).append(flow.target.id)
    for flow in drawn.flows:
        if flow.element.kind is Kind.OBJECT_FLOW and flow.source.id in draft.last:
            reached = algorithms.find_reachable([flow.target.id], lambda id: following.get(id, ()))
            for target in (id for id in draft.first if id in reached):
                edge = _build_edge(context, flow, target, data, draft)
                if edge.target not in find_reachable([edge.source], ordered):
                    yield edge


def _add_pin_merges(context: Context, drawn: ActivityGraph, draft: Draft) -> None:
    """Add the merge before a pin that several object flows reach, as in the token graph.

    The node takes the value of any of them, whereas it waits for all its control flows.
    """
    flows_by_pin: dict[str, list[Flow]] = {}
    for flow in drawn.flows:
        pin = query.flow_target(context.graph, flow.element)
        if pin is not None and flow.edge.target == derived_id(pin.id, "merge"):
            flows_by_pin.setdefault(pin.id, []).append(flow)
    for pin_id, flows in flows_by_pin.items():
        ids, target = {flow.element.id for flow in flows}, draft.first.get(flows[0].target.id)
        edges = [e for e in draft.edges if e.element in ids and e.target == target]
        if target is not None and len(edges) > 1:
            merge = Node(f"{context.name(context.graph[pin_id])}::merge", "merge", element=pin_id)
            draft.nodes.append(merge)
            draft.edges = [replace(e, target=merge.id) if e in edges else e for e in draft.edges]
            draft.edges.append(FlowEdge(merge.id, target, element=pin_id))


def _build_edge(
    context: Context, flow: Flow, target: str, data: DataFlow, draft: Draft
) -> FlowEdge:
    element, is_else = flow.element, flow.edge.is_else
    text = str(element.attrs.get("guard", ""))
    return FlowEdge(
        draft.last[flow.source.id],
        draft.first[target],
        guard=None if is_else else _read_guard(context, element, flow.source, text, data),
        text=text,
        is_else=is_else,
        item=_find_item(context, element) if element.kind is Kind.OBJECT_FLOW else "",
        element=element.id,
        probability=_read_probability(element),
    )


def _read_probability(flow: Element) -> float | None:
    """Return the probability of a flow («Probability», SysML 1.6, 11.3.2.6) from 0 to 1."""
    probability = read_number(str(flow.attrs.get("probability", "")))
    return probability if probability is not None and 0 <= probability <= 1 else None


def _read_guard(
    context: Context, flow: Element, source: Element, text: str, data: DataFlow
) -> Expression | None:
    """Return a guard. A literal is compared with the decision input as in fUML 1.5, 8.5.2.2."""
    is_literal = bool(flow.attrs.get("guard_literal"))
    # Tools write the literal `true` by default; it is a guard only after a decision.
    if not text or (is_literal and text == "true" and source.subkind != "decision"):
        return None
    expression = data.read(text)
    tested = _find_decision_input(context, source, data)
    if not is_literal or tested is None or not isinstance(expression, Literal):
        return expression
    if isinstance(expression.value, bool):
        return tested if expression.value else Unary("not", tested)
    return Binary("==", tested, expression)


def _find_decision_input(context: Context, decision: Element, data: DataFlow) -> Expression | None:
    if not query.has_decision_input(context.graph, decision):
        return None
    chosen = context.graph.get(str(decision.attrs.get("decision_input_flow", "")))
    incoming = query.incoming(context.graph, decision, Kind.OBJECT_FLOW)
    flows = [chosen] if chosen is not None else incoming
    return next((value for flow in flows if (value := data.source_of(flow)) is not None), None)


def _find_item(context: Context, flow: Element) -> str:
    ends = (query.flow_source(context.graph, flow), query.flow_target(context.graph, flow))
    types = (query.type_of(context.graph, end) for end in ends if end is not None)
    return next((context.name(type_) for type_ in types if type_ is not None), "")


# -- combined control nodes --------------------------------------------------------------------


def _split_combined_nodes(context: Context, activity: Element, draft: Draft) -> None:
    """Replace control nodes that stand for two, as in token graphs; the first keeps the id.

    A fork with several incoming edges and a join with several outgoing ones become a join and a
    fork. An initial node or a merge with several outgoing edges is followed by a decision, in
    SysML v2 by a fork, because there only ``decide`` chooses. A block waits for all its edges, and
    a token that leaves it takes all its edges, as those of other steps do.
    """
    targets = Counter(edge.target for edge in draft.edges)
    sources = Counter(edge.source for edge in draft.edges)
    follows_v2 = query.follows_v2(context.graph, activity)
    for number, node in enumerate(draft.nodes[:]):
        is_drawn = node.id == draft.first.get(node.element)
        is_block = is_drawn and node.id != draft.last[node.element] and node.kind == "merge"
        is_join = node.kind == "join" or (node.kind == "fork" and targets[node.id] > 1)
        if is_join or (is_block and targets[node.id] > 1):
            draft.nodes[number] = replace(node, kind="join")
        if sources[node.id] > 1 and (is_join or node.kind in ("initial", "merge")):
            # What is not drawn is the start of all first steps, or the end of a block.
            kind = "fork" if is_join or not is_drawn or follows_v2 else "decision"
            second = replace(node, id=f"{node.id}::{kind}", kind=kind)
            draft.nodes.append(second)
            draft.edges = [
                replace(edge, source=second.id) if edge.source == node.id else edge
                for edge in draft.edges
            ]
            draft.edges.append(FlowEdge(node.id, second.id, element=node.element))


# -- bounds ------------------------------------------------------------------------------------


def _read_loop_bounds(context: Context, activity: Element, draft: Draft) -> dict[str, int]:
    bounds: dict[str, int] = {}
    for element in context.contents(activity):
        bound = context.tags(element, "Loop").integer("maxIterations")
        if bound is not None and bound > 0:
            bounds[draft.first.get(element.id, element.id)] = bound
    return bounds
