"""Cycles of decide and merge become loops: the decision that can leave a cycle is its loop node.

The loop node keeps the guards of its edges; ``body`` edges go round again, ``exit`` edges leave.
A for-each node has such edges as well: once round for each element of its list.
"""

from collections.abc import Mapping

from msgspec.structs import replace

from sysmlc.recipe.expression import Expr, either, negated
from sysmlc.recipe.flow import cycles, entries, reachable
from sysmlc.recipe.model import FlowEdge, FlowGraph, Node


def with_loops(graph: FlowGraph, bounds: Mapping[str, int]) -> FlowGraph:
    """The graph with loop nodes; ``bounds`` gives iterations for nodes and for edges' elements.

    A cycle that no decision can leave stays as it is; the validator reports it.
    """
    nodes = {node.id: node for node in graph.nodes}
    edges = list(graph.edges)
    active = set(nodes)
    closing = for_each_rounds(graph)
    once = replace(graph, edges=tuple(edge for edge in edges if edge not in closing))
    while (found := _next_loop(once, active)) is not None:
        loop, part = found
        edges = [_with_role(edge, loop, part) for edge in edges]
        nodes[loop] = _loop_node(nodes[loop], part, edges, bounds)
        active.discard(loop)
    return replace(graph, nodes=tuple(nodes.values()), edges=tuple(edges))


def for_each_rounds(graph: FlowGraph) -> frozenset[FlowEdge]:
    """The edges that lead back from the body of a for-each node: no decision repeats them."""
    found: set[FlowEdge] = set()
    for node in graph.nodes:
        if node.kind == "forEach":
            starts = [e.target for e in graph.edges if e.source == node.id and e.role == "body"]
            inner = [(e.source, e.target) for e in graph.edges if e.source != node.id]
            body = reachable(starts, inner)
            found |= {e for e in graph.edges if e.target == node.id and e.source in body}
    return frozenset(found)


def _next_loop(graph: FlowGraph, active: set[str]) -> tuple[str, set[str]] | None:
    pairs = [(e.source, e.target) for e in graph.edges if {e.source, e.target} <= active]
    ordered = [node.id for node in graph.nodes if node.id in active]
    for part in cycles(ordered, pairs):
        inside = set(part)
        decisions = [n.id for n in graph.nodes if n.id in inside and n.kind == "decision"]
        leaving = [id for id in decisions if _leaves(graph, id, inside)]
        if leaving:
            return _closing(graph, leaving, part), inside
    return None


def _leaves(graph: FlowGraph, decision: str, part: set[str]) -> bool:
    return any(e.target not in part for e in graph.edges if e.source == decision)


def _closing(graph: FlowGraph, leaving: list[str], part: list[str]) -> str:
    """The decision whose edge goes straight back to where the cycle begins, else the first."""
    heads = entries(graph, part)
    back = {e.source for e in graph.edges if e.target in heads}
    direct = [id for id in leaving if id in back]
    return (direct or leaving)[0]


def _with_role(edge: FlowEdge, loop: str, part: set[str]) -> FlowEdge:
    if edge.source != loop:
        return edge
    return replace(edge, role="body" if edge.target in part else "exit")


def _loop_node(
    node: Node, part: set[str], edges: list[FlowEdge], bounds: Mapping[str, int]
) -> Node:
    out = [edge for edge in edges if edge.source == node.id]
    return replace(
        node,
        kind="loop",
        expression=_condition(out),
        max_iterations=_bound(node, part, out, edges, bounds),
    )


def _condition(out: list[FlowEdge]) -> Expr:
    """When to go round again, from the guards of the body edges or of the exits."""
    body = [edge for edge in out if edge.role == "body"]
    if any(edge.is_else or edge.guard is None for edge in body):
        exits = [edge.guard for edge in out if edge.role == "exit" and edge.guard is not None]
        return negated(either(tuple(exits)))
    return either(tuple(edge.guard for edge in body if edge.guard is not None))


def _bound(
    node: Node,
    part: set[str],
    out: list[FlowEdge],
    edges: list[FlowEdge],
    bounds: Mapping[str, int],
) -> int | None:
    """Bound on the decision, on its way back, on the merge that begins the cycle, or before it."""
    body = [edge for edge in out if edge.role == "body"]
    heads = {e.target for e in edges if e.source not in part and e.target in part}
    back = [e.element for e in edges if e.source in part and e.target in heads]
    keys = [node.id, *(e.element for e in body), *sorted(heads), *back]
    return next((bounds[key] for key in keys if key in bounds), None)
