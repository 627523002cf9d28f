"""Paths, cycles and durations of a flow graph, and its loop nodes.

The decision that can leave a cycle of decide and merge becomes a loop node. The loop node retains
the guards of its edges; ``body`` edges repeat the cycle, ``exit`` edges leave it. A for-each node
has such edges too: its body runs once for each element of a list.
"""

from collections.abc import Callable, Iterable, Iterator, Mapping

from msgspec import Struct
from msgspec.structs import replace

from sysmlc.ir.algorithms import sort_topologically, strongly_connected_components
from sysmlc.logic.expressions.expression import Expression
from sysmlc.recipe.expression import disjunction, negation
from sysmlc.recipe.model import FlowEdge, FlowGraph, Node, Range

Cost = Callable[[Node], Range | None]
"""The duration of a node; None if it is unknown."""
_Edges = list[tuple[str, str]]

STEPS = frozenset({"service", "function", "call", "action", "assign", "wait", "delay"})
"""Kinds of nodes that do something."""


# -- paths and cycles --------------------------------------------------------------------------


def find_reachable(starts: Iterable[str], edges: Iterable[tuple[str, str]]) -> set[str]:
    """Return *starts* and all nodes that are reachable from them."""
    successors: dict[str, list[str]] = {}
    for source, target in edges:
        successors.setdefault(source, []).append(target)
    reached = set(starts)
    worklist = list(reached)
    while worklist:
        for target in successors.get(worklist.pop(), ()):
            if target not in reached:
                reached.add(target)
                worklist.append(target)
    return reached


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


def forward_edges(graph: FlowGraph) -> list[tuple[str, str]]:
    """Return the edges without back edges. A back edge leads to the entry of its cycle."""
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
    return list(sort_topologically((node.id for node in graph.nodes), forward_edges(graph)))


# -- durations ---------------------------------------------------------------------------------


class _Span(Struct, frozen=True):
    """Earliest and latest time at which a node is done; ``latest`` None is unbounded."""

    earliest: float
    latest: float | None

    def extend(self, cost: Range) -> "_Span":
        return _Span(self.earliest + cost.min, _add(self.latest, cost.max))


def compute_duration(graph: FlowGraph, cost: Cost) -> Range | None:
    """Return the shortest and longest time from the initial node to a final one.

    Decisions choose one branch, joins and steps wait for all incoming edges, and a cycle runs at
    most ``max_iterations`` times. Return None for an unknown duration of a step, or if no final
    node is reachable.
    """
    nodes = {node.id: node for node in graph.nodes}
    costs: dict[str, Range] = {}
    for id, node in nodes.items():
        if node.kind in STEPS:
            node_cost = cost(node)
            if node_cost is None:
                return None
            costs[id] = node_cost
    edges = list(dict.fromkeys((e.source, e.target) for e in graph.edges))
    starts = [node.id for node in graph.nodes if node.kind == "initial"]
    spans = _Clock(nodes, costs).run(list(nodes), edges, starts[:1])
    ends = [span for id, span in spans.items() if nodes[id].kind == "final"]
    # A flow final node ends one branch only (UML 2.5.1, 15.3.3.2): it counts without a final node.
    ends = ends or [span for id, span in spans.items() if nodes[id].kind == "flowFinal"]
    if not ends:
        return None
    return _to_range(min(end.earliest for end in ends), _maximum(end.latest for end in ends))


class _Clock(Struct, frozen=True):
    """Computes when nodes are done; ``costs`` has the duration of every step."""

    nodes: Mapping[str, Node]
    costs: Mapping[str, Range]

    def run(self, ids: Iterable[str], edges: _Edges, starts: list[str]) -> dict[str, _Span]:
        """Return the span of each node if *starts* begin at 0; a cycle counts as one step."""
        spans: dict[str, _Span] = {}
        # A node that no start reaches has no span: it does not delay the nodes behind it.
        for component, is_cycle in _iter_components(ids, edges):
            inside = set(component)
            incoming = [(a, b) for a, b in edges if b in inside and a not in inside and a in spans]
            arrivals = [spans[a] for a, _ in incoming]
            arrivals += [_Span(0, 0)] * (not inside.isdisjoint(starts))
            if not arrivals:
                continue
            heads = [b for _, b in incoming] + [id for id in starts if id in inside]
            start = _combine(self.nodes[heads[0]], arrivals)
            if is_cycle:
                spans.update(self._run_cycle(heads[0], component, edges, start))
            else:
                spans[component[0]] = start.extend(self.costs.get(component[0], Range(0, 0)))
        return spans

    def _run_cycle(
        self, head: str, cycle: list[str], edges: _Edges, start: _Span
    ) -> dict[str, _Span]:
        """Return the spans of the nodes of a cycle entered at *head*, with all its rounds."""
        inside = set(cycle)
        inner = [(a, b) for a, b in edges if a in inside and b in inside and b != head]
        one_round = self.run(cycle, inner, [head])
        rounds = [
            one_round[a].latest for a, b in edges if b == head and a in inside and a in one_round
        ]
        count = self._count_rounds(head, cycle, inner)
        latest = _add(start.latest, _multiply(count, _maximum(rounds)))
        return {
            id: _Span(start.earliest + span.earliest, _add(latest, span.latest))
            for id, span in one_round.items()
        }

    def _count_rounds(self, head: str, cycle: list[str], inner: _Edges) -> int | None:
        """Return how often the cycle is closed at most, by its loop nodes outside inner cycles."""
        nested = {id for inner_cycle in find_cycles(cycle, inner) for id in inner_cycle}
        loops = [self.nodes[id] for id in cycle if id not in nested]
        loops = [node for node in loops if node.kind in ("loop", "forEach")]
        bounds = [node.max_iterations for node in loops if node.max_iterations is not None]
        if not loops or len(bounds) < len(loops):
            return None
        # A loop that is tested first runs its body as often as the bound says, and is closed as
        # often; a loop that is tested last is closed once less, because the last round leaves it.
        is_tested_first = not any(self._has_step(head, loop.id, inner) for loop in loops)
        return sum(bounds) - (0 if is_tested_first else len(loops))

    def _has_step(self, head: str, loop: str, inner: _Edges) -> bool:
        """Return whether there is a step between the head of a cycle and its loop node."""
        after_head = find_reachable([head], [(a, b) for a, b in inner if a != loop])
        before_loop = find_reachable([loop], [(b, a) for a, b in inner])
        return any(self.nodes[id].kind in STEPS for id in after_head & before_loop)


def _iter_components(ids: Iterable[str], edges: _Edges) -> Iterator[tuple[list[str], bool]]:
    """Iterate over cycles and single nodes in topological order; the flag marks cycles."""
    nodes = list(ids)
    components = {f"cycle {n}": cycle for n, cycle in enumerate(find_cycles(nodes, edges))}
    component_of = {id: name for name, cycle in components.items() for id in cycle}
    components.update({f"node {id}": [id] for id in nodes if id not in component_of})
    component_of.update({id: f"node {id}" for id in nodes if id not in component_of})
    pairs = ((component_of[a], component_of[b]) for a, b in edges)
    for name in sort_topologically(components, ((a, b) for a, b in pairs if a != b)):
        yield components[name], name.startswith("cycle ")


def _combine(node: Node, arrivals: list[_Span]) -> _Span:
    """Return the span in which a node begins: after all incoming edges, or after the first."""
    is_waiting = node.kind == "join" or node.kind in STEPS
    choose = max if is_waiting else min
    return _Span(choose(a.earliest for a in arrivals), _maximum(a.latest for a in arrivals))


def _add(left: float | None, right: float | None) -> float | None:
    return None if left is None or right is None else left + right


def _multiply(count: int | None, value: float | None) -> float | None:
    if count == 0:
        return 0
    return None if count is None or value is None else count * value


def _maximum(values: Iterable[float | None]) -> float | None:
    """Return the largest value, 0 for no values; None is unbounded."""
    largest: float = 0
    for value in values:
        if value is None:
            return None
        largest = max(largest, value)
    return largest


def _to_range(low: float, high: float | None) -> Range:
    return Range(int(low), None if high is None else int(high))


# -- loop nodes --------------------------------------------------------------------------------


def with_loops(graph: FlowGraph, bounds: Mapping[str, int]) -> FlowGraph:
    """Return the graph with loop nodes; *bounds* has iterations of nodes and of edges' elements.

    A cycle that no decision can leave stays as it is; the validator reports it.
    """
    nodes = {node.id: node for node in graph.nodes}
    edges = list(graph.edges)
    active = set(nodes)
    # A for-each node repeats its body without a decision: its cycle is complete already.
    closing = _find_for_each_back_edges(graph)
    without_for_each = replace(graph, edges=tuple(edge for edge in edges if edge not in closing))
    while (found := _find_next_loop(without_for_each, active)) is not None:
        loop, cycle = found
        edges = [_assign_role(edge, loop, cycle) for edge in edges]
        nodes[loop] = _make_loop_node(nodes[loop], cycle, edges, bounds)
        # Without its loop node the cycle is gone, and the cycles inside it become visible.
        active.discard(loop)
    return replace(graph, nodes=tuple(nodes.values()), edges=tuple(edges))


def _find_for_each_back_edges(graph: FlowGraph) -> frozenset[FlowEdge]:
    """Return the edges from the body of a for-each node back to it; no decision repeats them."""
    back_edges: set[FlowEdge] = set()
    for node in graph.nodes:
        if node.kind == "forEach":
            starts = [e.target for e in graph.edges if e.source == node.id and e.role == "body"]
            inner = [(e.source, e.target) for e in graph.edges if e.source != node.id]
            body = find_reachable(starts, inner)
            back_edges |= {e for e in graph.edges if e.target == node.id and e.source in body}
    return frozenset(back_edges)


def _find_next_loop(graph: FlowGraph, active: set[str]) -> tuple[str, set[str]] | None:
    """Return a decision that can leave a cycle of active nodes, and the nodes of the cycle."""
    edges = [(e.source, e.target) for e in graph.edges if {e.source, e.target} <= active]
    nodes = [node.id for node in graph.nodes if node.id in active]
    for cycle in find_cycles(nodes, edges):
        inside = set(cycle)
        decisions = [n.id for n in graph.nodes if n.id in inside and n.kind == "decision"]
        leaving = [id for id in decisions if _can_leave(graph, id, inside)]
        if leaving:
            return _select_loop(graph, leaving, cycle), inside
    return None


def _can_leave(graph: FlowGraph, decision: str, cycle: set[str]) -> bool:
    return any(e.target not in cycle for e in graph.edges if e.source == decision)


def _select_loop(graph: FlowGraph, leaving: list[str], cycle: list[str]) -> str:
    """Return the decision with an edge to the entry of the cycle, else the first decision."""
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
    """Return the condition of another round: a body guard holds, or else no exit guard does."""
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
    """Return the bound of the decision, its body edges, the entry of the cycle or a back edge."""
    body = [edge for edge in outgoing if edge.role == "body"]
    entries = {e.target for e in edges if e.source not in cycle and e.target in cycle}
    back = [e.element for e in edges if e.source in cycle and e.target in entries]
    keys = [node.id, *(e.element for e in body), *sorted(entries), *back]
    return next((bounds[key] for key in keys if key in bounds), None)
