"""Paths, cycles and times of a flow graph."""

from collections.abc import Callable, Iterable, Mapping
from dataclasses import dataclass
from typing import TYPE_CHECKING

from sysmlc.recipe.model import FlowEdge, FlowGraph, Node, Range

if TYPE_CHECKING:
    from networkx import DiGraph

Cost = Callable[[Node], Range | None]

STEPS = frozenset({"service", "function", "call", "action", "assign", "wait", "delay"})
"""Kinds of nodes that do something."""


def digraph(graph: FlowGraph) -> "DiGraph[str]":
    """The graph for networkx: ids as nodes; parallel edges become one."""
    import networkx

    result: DiGraph[str] = networkx.DiGraph()
    result.add_nodes_from(node.id for node in graph.nodes)
    result.add_edges_from((edge.source, edge.target) for edge in graph.edges)
    return result


def reachable(starts: Iterable[str], edges: Iterable[tuple[str, str]]) -> set[str]:
    """The starts and everything that the edges lead to from them."""
    following: dict[str, list[str]] = {}
    for source, target in edges:
        following.setdefault(source, []).append(target)
    found = set(starts)
    stack = list(found)
    while stack:
        for target in following.get(stack.pop(), ()):
            if target not in found:
                found.add(target)
                stack.append(target)
    return found


def entries(graph: FlowGraph, component: Iterable[str]) -> list[str]:
    """Nodes of the component that edges from outside reach, in the order of the graph."""
    inside = set(component)
    reached = {e.target for e in graph.edges if e.source not in inside and e.target in inside}
    return [node.id for node in graph.nodes if node.id in reached]


def cycles(nodes: Iterable[str], edges: Iterable[tuple[str, str]]) -> list[list[str]]:
    """Strongly connected parts that hold a cycle, each in the order of ``nodes``."""
    import networkx

    ordered = list(nodes)
    part: DiGraph[str] = networkx.DiGraph()
    part.add_nodes_from(ordered)
    part.add_edges_from(edges)
    rank = {id: number for number, id in enumerate(ordered)}
    found = [
        sorted(component, key=rank.__getitem__)
        for component in networkx.strongly_connected_components(part)
        if len(component) > 1 or part.has_edge(*[next(iter(component))] * 2)
    ]
    return sorted(found, key=lambda component: rank[component[0]])


def forward_edges(graph: FlowGraph) -> list[tuple[str, str]]:
    """The edges without those that close a cycle: what is left is acyclic."""
    ordered = [node.id for node in graph.nodes]
    pairs = list(dict.fromkeys((e.source, e.target) for e in graph.edges))
    while parts := cycles(ordered, pairs):
        for part in parts:
            inside = set(part)
            reached = {b for a, b in pairs if a not in inside and b in inside}
            heads = reached or {part[0]}
            pairs = [(a, b) for a, b in pairs if not (a in inside and b in heads)]
    return pairs


def in_order(graph: FlowGraph) -> list[str]:
    """Ids of the nodes, each after those that lead to it; where that leaves a choice, sorted."""
    import networkx

    order: DiGraph[str] = networkx.DiGraph()
    order.add_nodes_from(sorted(node.id for node in graph.nodes))
    order.add_edges_from(forward_edges(graph))
    return list(networkx.lexicographical_topological_sort(order))


# -- times -------------------------------------------------------------------------------------


@dataclass(frozen=True, slots=True)
class _Span:
    """Earliest and latest time at which something is done; ``latest`` None is unbounded."""

    earliest: float
    latest: float | None

    def then(self, cost: Range) -> "_Span":
        return _Span(self.earliest + cost.min, _plus(self.latest, cost.max))


def duration(graph: FlowGraph, cost: Cost) -> Range | None:
    """Shortest and longest time from the initial node to a final one.

    Decisions choose, joins and steps with several ways in wait for all of them, a cycle runs at
    most ``max_iterations`` times. None when the time of a step is not known or there is no way.
    """
    nodes = {node.id: node for node in graph.nodes}
    costs = {id: cost(node) for id, node in nodes.items() if node.kind in STEPS}
    if any(value is None for value in costs.values()):
        return None
    known = {id: value for id, value in costs.items() if value is not None}
    starts = [node.id for node in graph.nodes if node.kind == "initial"]
    done = _spans(nodes, graph.edges, starts[:1], known)
    ends = [span for id, span in done.items() if nodes[id].kind == "final"]
    ends = ends or [span for id, span in done.items() if nodes[id].kind == "flowFinal"]
    if not ends:
        return None
    return _range(min(end.earliest for end in ends), _latest(end.latest for end in ends))


def _spans(
    nodes: Mapping[str, Node],
    edges: Iterable[FlowEdge],
    starts: list[str],
    costs: Mapping[str, Range],
) -> dict[str, _Span]:
    """When each node is done after the starts began at 0; cycles count as one step."""
    import networkx

    pairs = list(dict.fromkeys((e.source, e.target) for e in edges))
    pairs = [(a, b) for a, b in pairs if a in nodes and b in nodes]
    home = {id: index for index, part in enumerate(cycles(nodes, pairs)) for id in part}
    block = {id: f"cycle {home[id]}" if id in home else f"node {id}" for id in nodes}
    order: DiGraph[str] = networkx.DiGraph()
    order.add_nodes_from(block.values())
    order.add_edges_from((block[a], block[b]) for a, b in pairs if block[a] != block[b])
    members: dict[str, list[str]] = {}
    for id, name in block.items():
        members.setdefault(name, []).append(id)
    done: dict[str, _Span] = {}
    for name in networkx.lexicographical_topological_sort(order):
        inside = members[name]
        _finish(inside, inside[0] in home, nodes, pairs, starts, costs, done)
    return done


def _finish(
    inside: list[str],
    is_cycle: bool,
    nodes: Mapping[str, Node],
    pairs: list[tuple[str, str]],
    starts: list[str],
    costs: Mapping[str, Range],
    done: dict[str, _Span],
) -> None:
    members = set(inside)
    before = [(a, b) for a, b in pairs if b in members and a not in members and a in done]
    ways = [done[a] for a, _ in before] + [_Span(0, 0)] * any(id in starts for id in inside)
    if not ways:
        return
    if not is_cycle:
        start = _arrival(nodes[inside[0]], ways)
        done[inside[0]] = start.then(costs.get(inside[0], Range(0, 0)))
        return
    head = next(b for _, b in before) if before else next(id for id in inside if id in starts)
    done.update(_cycle(head, members, nodes, pairs, costs, _arrival(nodes[head], ways)))


def _arrival(node: Node, ways: list[_Span]) -> _Span:
    waits = node.kind == "join" or node.kind in STEPS
    choose = max if waits else min
    return _Span(choose(way.earliest for way in ways), _latest(way.latest for way in ways))


def _cycle(
    head: str,
    members: set[str],
    nodes: Mapping[str, Node],
    pairs: list[tuple[str, str]],
    costs: Mapping[str, Range],
    start: _Span,
) -> dict[str, _Span]:
    """Times in a cycle entered at ``head``: full rounds, then a last one to the way out."""
    inner = [(a, b) for a, b in pairs if a in members and b in members and b != head]
    once = _spans(
        {id: node for id, node in nodes.items() if id in members},
        [FlowEdge(a, b) for a, b in inner],
        [head],
        costs,
    )
    back = [once[a].latest for a, b in pairs if b == head and a in members and a in once]
    rounds = _rounds(head, members, nodes, pairs, once)
    whole = _times(rounds, _latest(back))
    return {
        id: _Span(start.earliest + span.earliest, _plus(_plus(start.latest, whole), span.latest))
        for id, span in once.items()
    }


def _rounds(
    head: str,
    members: set[str],
    nodes: Mapping[str, Node],
    pairs: list[tuple[str, str]],
    once: Mapping[str, _Span],
) -> int | None:
    """How often the cycle is closed at most; the loop nodes in reach of the head say it."""
    inner = [(a, b) for a, b in pairs if a in members and b in members and b != head]
    nested = {id for part in cycles(members, inner) for id in part}
    loops = [nodes[id] for id in sorted(members - nested) if nodes[id].kind == "loop"]
    if not loops or any(loop.max_iterations is None for loop in loops):
        return None
    total = sum(loop.max_iterations or 0 for loop in loops)
    tested_first = all(not _does_something(head, loop.id, inner, nodes) for loop in loops)
    return total if tested_first else total - len(loops)


def _does_something(
    head: str, loop: str, inner: list[tuple[str, str]], nodes: Mapping[str, Node]
) -> bool:
    after = reachable([head], [(a, b) for a, b in inner if a != loop])
    before = reachable([loop], [(b, a) for a, b in inner])
    return any(nodes[id].kind in STEPS for id in after & before)


def _plus(left: float | None, right: float | None) -> float | None:
    return None if left is None or right is None else left + right


def _times(count: int | None, value: float | None) -> float | None:
    return 0 if count == 0 else None if count is None or value is None else count * value


def _latest(values: Iterable[float | None]) -> float | None:
    found = list(values)
    return (
        None
        if any(v is None for v in found)
        else max((v for v in found if v is not None), default=0)
    )


def _range(low: float, high: float | None) -> Range:
    return Range(int(low), None if high is None else int(high))
