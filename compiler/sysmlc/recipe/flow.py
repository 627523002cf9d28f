"""Paths, cycles and loops of flow graphs.

The decision that can leave a cycle of decide and merge becomes a loop node. The loop node retains
the guards of its edges; ``body`` edges repeat the cycle, ``exit`` edges leave it. A for-each node
has such edges too: its body runs once for each element of a list.
"""

from collections.abc import Iterable, Mapping

from msgspec import Struct
from msgspec.structs import replace

from sysmlc.ir import algorithms
from sysmlc.ir.algorithms import sort_topologically, strongly_connected_components
from sysmlc.ir.expressions import Expression
from sysmlc.recipe.expression import disjunction, negation, variable_name
from sysmlc.recipe.model import FlowEdge, FlowGraph, Node

STEPS = frozenset({"service", "function", "call", "action", "assign", "wait", "delay"})
"""Kinds of nodes that do something."""


def find_reachable(starts: Iterable[str], edges: Iterable[tuple[str, str]]) -> set[str]:
    """Return *starts* and all nodes that are reachable from them."""
    successors: dict[str, list[str]] = {}
    for source, target in edges:
        successors.setdefault(source, []).append(target)
    return algorithms.find_reachable(starts, lambda node: successors.get(node, ()))


def find_entries(graph: FlowGraph, component: Iterable[str]) -> list[str]:
    """Return the nodes of a component that edges from outside reach, in the order of the graph."""
    inside = set(component)
    reached = {e.target for e in graph.edges if e.source not in inside and e.target in inside}
    return [node.id for node in graph.nodes if node.id in reached]


def find_cycles(nodes: Iterable[str], edges: Iterable[tuple[str, str]]) -> list[list[str]]:
    """Return the strongly connected components with a cycle, each in the order of *nodes*."""
    successors: dict[str, dict[str, None]] = {id: {} for id in nodes}
    for source, target in edges:
        successors.setdefault(source, {})[target] = None
        successors.setdefault(target, {})
    rank = {id: number for number, id in enumerate(successors)}
    cycles = [
        sorted(component, key=rank.__getitem__)
        for component in strongly_connected_components(successors)
        if len(component) > 1 or component[0] in successors[component[0]]
    ]
    return sorted(cycles, key=lambda cycle: rank[cycle[0]])


def list_forward_edges(graph: FlowGraph) -> list[tuple[str, str]]:
    """Return the edges except back edges, which lead from a cycle to its entry."""
    nodes = [node.id for node in graph.nodes]
    edges = list(dict.fromkeys((e.source, e.target) for e in graph.edges))
    # Without the back edges of a cycle the cycles inside it are components of their own.
    while cycles := find_cycles(nodes, edges):
        for cycle in cycles:
            inside = set(cycle)
            entries = {b for a, b in edges if a not in inside and b in inside} or {cycle[0]}
            edges = [(a, b) for a, b in edges if not (a in inside and b in entries)]
    return edges


def sort_nodes(graph: FlowGraph) -> list[str]:
    """Return the ids of the nodes in topological order of the forward edges."""
    return list(sort_topologically((node.id for node in graph.nodes), list_forward_edges(graph)))


# -- loops -------------------------------------------------------------------------------------


def add_loop_nodes(graph: FlowGraph, bounds: Mapping[str, int]) -> FlowGraph:
    """Return the graph in which a decision of each cycle is a loop node.

    *bounds* maps ids of nodes, and ids of the elements of edges, to the most iterations. A cycle
    that no decision can leave is unchanged; ``check_graphs`` reports it.
    """
    nodes = {node.id: node for node in graph.nodes}
    edges = list(graph.edges)
    active = set(nodes)
    # A for-each node repeats its body without a decision: its cycle is complete already.
    closing = _find_for_each_back_edges(graph)
    without_for_each = replace(graph, edges=tuple(edge for edge in edges if edge not in closing))
    while (next_loop := _find_next_loop(without_for_each, active)) is not None:
        loop, cycle = next_loop
        edges = [_assign_role(edge, loop, cycle) for edge in edges]
        nodes[loop] = _make_loop_node(nodes[loop], cycle, edges, bounds)
        # Without its loop node the cycle is gone, and the cycles inside it become visible.
        active.discard(loop)
    return replace(graph, nodes=tuple(nodes.values()), edges=tuple(edges))


def _find_for_each_back_edges(graph: FlowGraph) -> frozenset[FlowEdge]:
    """Return the edges that lead from the body of a for-each node back to it."""
    back_edges: set[FlowEdge] = set()
    for node in graph.nodes:
        if node.kind == "forEach":
            starts = [e.target for e in graph.edges if e.source == node.id and e.role == "body"]
            inner = [(e.source, e.target) for e in graph.edges if e.source != node.id]
            body = find_reachable(starts, inner)
            back_edges |= {e for e in graph.edges if e.target == node.id and e.source in body}
    return frozenset(back_edges)


def _find_next_loop(
    graph: FlowGraph, active: set[str], kind: str = "decision"
) -> tuple[str, set[str]] | None:
    """Return a node of *kind* with an edge out of a cycle of *active* nodes, and this cycle."""
    edges = [(e.source, e.target) for e in graph.edges if {e.source, e.target} <= active]
    nodes = [node.id for node in graph.nodes if node.id in active]
    for cycle in find_cycles(nodes, edges):
        inside = set(cycle)
        exits = {e.source for e in graph.edges if e.target not in inside}
        leaving = [n.id for n in graph.nodes if n.id in inside & exits and n.kind == kind]
        if leaving:
            return _select_loop(graph, leaving, cycle), inside
    return None


def _select_loop(graph: FlowGraph, leaving: list[str], cycle: list[str]) -> str:
    """Return the first decision with an edge to an entry of the cycle, else the first decision."""
    entries = find_entries(graph, cycle)
    sources = {e.source for e in graph.edges if e.target in entries}
    direct = [id for id in leaving if id in sources]
    return (direct or leaving)[0]


def _assign_role(edge: FlowEdge, loop: str, cycle: set[str]) -> FlowEdge:
    if edge.source != loop:
        return edge
    return replace(edge, role="body" if edge.target in cycle else "exit")


def _make_loop_node(
    node: Node, cycle: set[str], edges: list[FlowEdge], bounds: Mapping[str, int]
) -> Node:
    outgoing = [edge for edge in edges if edge.source == node.id]
    return replace(
        node,
        kind="loop",
        expression=_repeat_condition(outgoing),
        max_iterations=_find_bound(node, cycle, outgoing, edges, bounds),
    )


def _repeat_condition(outgoing: list[FlowEdge]) -> Expression:
    """Return the condition of another round.

    It is that a body guard holds; if a body edge has no guard or is else, that no exit guard holds.
    """
    body = [edge for edge in outgoing if edge.role == "body"]
    if any(edge.is_else or edge.guard is None for edge in body):
        exits = [edge.guard for edge in outgoing if edge.role == "exit" and edge.guard is not None]
        return negation(disjunction(tuple(exits)))
    return disjunction(tuple(edge.guard for edge in body if edge.guard is not None))


def _find_bound(
    node: Node,
    cycle: set[str],
    outgoing: list[FlowEdge],
    edges: list[FlowEdge],
    bounds: Mapping[str, int],
) -> int | None:
    """Return the first bound in this order, None if there is none.

    The order is: of the decision, of its body edges, of the entries of the cycle, of back edges.
    """
    body = [edge for edge in outgoing if edge.role == "body"]
    entries = {e.target for e in edges if e.source not in cycle and e.target in cycle}
    back = [e.element for e in edges if e.source in cycle and e.target in entries]
    keys = [node.id, *(e.element for e in body), *sorted(entries), *back]
    return next((bounds[key] for key in keys if key in bounds), None)


class LoopCycle(Struct, frozen=True):
    """The nodes that a loop or for-each node repeats, itself included.

    ``is_tested_first`` states that no step precedes the loop node in a round.
    """

    nodes: frozenset[str]
    is_tested_first: bool


def find_loop_cycles(graph: FlowGraph) -> dict[str, LoopCycle]:
    """Return the cycle of each loop and for-each node; inner cycles are part of outer ones."""
    back_edges = _find_for_each_back_edges(graph)
    cycles = {
        node.id: LoopCycle(frozenset(_find_body(graph, node.id, back_edges)), is_tested_first=True)
        for node in graph.nodes
        if node.kind == "forEach"
    }
    edges = tuple(edge for edge in graph.edges if edge not in back_edges)
    without_for_each = replace(graph, edges=edges)
    active = {node.id for node in graph.nodes}
    while (next_loop := _find_next_loop(without_for_each, active, "loop")) is not None:
        loop, cycle = next_loop
        entries = find_entries(without_for_each, cycle)
        is_tested_first = not _has_step_before(without_for_each, entries, loop, cycle)
        cycles[loop] = LoopCycle(frozenset(cycle), is_tested_first)
        active.discard(loop)
    return cycles


def fix_iterations(node: Node, graph: FlowGraph) -> Node:
    """Return a for-each node with the exact number of iterations if the list is a constant."""
    name = None if node.kind != "forEach" or not node.expression else variable_name(node.expression)
    assigned = {item for n in graph.nodes for item in (n.variable, *(v for _, v in n.assign))}
    if name in assigned:
        return node
    for variable in graph.variables:
        if variable.name == name and isinstance(variable.value, tuple):
            size = len(variable.value)
            return replace(node, min_iterations=size, max_iterations=size)
    return node


def _find_body(graph: FlowGraph, loop: str, back_edges: frozenset[FlowEdge]) -> set[str]:
    """Return a for-each node and the nodes between it and its back edges."""
    starts = [e.target for e in graph.edges if e.source == loop and e.role == "body"]
    inner = [(e.source, e.target) for e in graph.edges if e.source != loop]
    last = [e.source for e in back_edges if e.target == loop]
    returning = find_reachable(last, [(b, a) for a, b in inner])
    return {loop} | (find_reachable(starts, inner) & returning)


def _has_step_before(graph: FlowGraph, entries: list[str], loop: str, cycle: set[str]) -> bool:
    """Whether a step precedes the loop node in a round, which begins at an entry."""
    inner = [(e.source, e.target) for e in graph.edges if {e.source, e.target} <= cycle]
    after_entries = find_reachable(entries, [(a, b) for a, b in inner if a != loop])
    before_loop = find_reachable([loop], [(b, a) for a, b in inner if b not in entries])
    steps = {node.id for node in graph.nodes if node.kind in STEPS}
    return bool(steps & after_entries & before_loop)


def find_early_ends(graph: FlowGraph) -> frozenset[str]:
    """Return the final nodes that are reachable only if an inner loop gives up.

    An inner loop gives up by an exit that leaves an outer loop as well, while another exit of it
    continues the outer loop. All other ways out of a loop are regular: a search that succeeds, or
    attempts that are exhausted.
    """
    cycles = find_loop_cycles(graph)
    edges = [edge for edge in graph.edges if not _gives_up(edge, graph, cycles)]
    starts = [node.id for node in graph.nodes if node.kind == "initial"]
    regular = find_reachable(starts, [(e.source, e.target) for e in edges])
    ends = [node.id for node in graph.nodes if node.kind in ("final", "flowFinal")]
    early = frozenset(end for end in ends if end not in regular)
    return early if len(early) < len(ends) else frozenset()


def _gives_up(edge: FlowEdge, graph: FlowGraph, cycles: Mapping[str, LoopCycle]) -> bool:
    exits = [e for e in graph.edges if e.source == edge.source and e.role == "exit"]
    return edge.role == "exit" and any(
        loop != edge.source
        and edge.source in outer.nodes
        and edge.target not in outer.nodes
        and any(other_exit.target in outer.nodes for other_exit in exits)
        for loop, outer in cycles.items()
    )
