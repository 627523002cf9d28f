"""Paths, cycles and times of a flow graph."""

from collections.abc import Callable, Iterable, Iterator, Mapping

from msgspec import Struct

from sysmlc.ir.algorithms import sort_topologically, strongly_connected_components
from sysmlc.recipe.model import FlowGraph, Node, Range

Cost = Callable[[Node], Range | None]

STEPS = frozenset({"service", "function", "call", "action", "assign", "wait", "delay"})
"""Kinds of nodes that do something."""


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
    following: dict[str, dict[str, None]] = {id: {} for id in nodes}
    for source, target in edges:
        following.setdefault(source, {})[target] = None
        following.setdefault(target, {})
    rank = {id: number for number, id in enumerate(following)}
    found = [
        sorted(component, key=rank.__getitem__)
        for component in strongly_connected_components(following)
        if len(component) > 1 or component[0] in following[component[0]]
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
    return list(sort_topologically((node.id for node in graph.nodes), forward_edges(graph)))


# -- times -------------------------------------------------------------------------------------


class _Span(Struct, frozen=True):
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
    known = {id: value for id, value in costs.items() if value is not None}
    if len(known) < len(costs):
        return None
    pairs = list(dict.fromkeys((e.source, e.target) for e in graph.edges))
    starts = [node.id for node in graph.nodes if node.kind == "initial"]
    done = _Clock(nodes, known).run(list(nodes), pairs, starts[:1])
    ends = [span for id, span in done.items() if nodes[id].kind == "final"]
    ends = ends or [span for id, span in done.items() if nodes[id].kind == "flowFinal"]
    if not ends:
        return None
    return _range(min(end.earliest for end in ends), _latest(end.latest for end in ends))


_Pairs = list[tuple[str, str]]


class _Clock(Struct, frozen=True):
    """Tells when nodes are done; ``costs`` has the time of every step."""

    nodes: Mapping[str, Node]
    costs: Mapping[str, Range]

    def run(self, ids: Iterable[str], pairs: _Pairs, starts: list[str]) -> dict[str, _Span]:
        """When each node is done after the starts began at 0; cycles count as one step."""
        done: dict[str, _Span] = {}
        for part, is_cycle in _parts(ids, pairs):
            inside = set(part)
            before = [(a, b) for a, b in pairs if b in inside and a not in inside and a in done]
            ways = [done[a] for a, _ in before] + [_Span(0, 0)] * (not inside.isdisjoint(starts))
            if not ways:
                continue
            heads = [b for _, b in before] + [id for id in starts if id in inside]
            start = _arrival(self.nodes[heads[0]], ways)
            if is_cycle:
                done.update(self._rounds(heads[0], part, pairs, start))
            else:
                done[part[0]] = start.then(self.costs.get(part[0], Range(0, 0)))
        return done

    def _rounds(self, head: str, part: list[str], pairs: _Pairs, start: _Span) -> dict[str, _Span]:
        """Times in a cycle entered at ``head``: full rounds, then a last one to the way out."""
        inside = set(part)
        inner = [(a, b) for a, b in pairs if a in inside and b in inside and b != head]
        once = self.run(part, inner, [head])
        back = [once[a].latest for a, b in pairs if b == head and a in inside and a in once]
        before = _plus(start.latest, _times(self._count(head, part, inner), _latest(back)))
        return {
            id: _Span(start.earliest + span.earliest, _plus(before, span.latest))
            for id, span in once.items()
        }

    def _count(self, head: str, part: list[str], inner: _Pairs) -> int | None:
        """How often the cycle is closed at most; the loop nodes outside inner cycles say it."""
        nested = {id for one in cycles(part, inner) for id in one}
        loops = [self.nodes[id] for id in part if id not in nested]
        loops = [node for node in loops if node.kind in ("loop", "forEach")]
        bounds = [node.max_iterations for node in loops if node.max_iterations is not None]
        if not loops or len(bounds) < len(loops):
            return None
        tested_first = not any(self._does_something(head, loop.id, inner) for loop in loops)
        return sum(bounds) - (0 if tested_first else len(loops))

    def _does_something(self, head: str, loop: str, inner: _Pairs) -> bool:
        """Whether there is a step between the head of a cycle and its loop node."""
        after = reachable([head], [(a, b) for a, b in inner if a != loop])
        before = reachable([loop], [(b, a) for a, b in inner])
        return any(self.nodes[id].kind in STEPS for id in after & before)


def _parts(ids: Iterable[str], pairs: _Pairs) -> Iterator[tuple[list[str], bool]]:
    """Cycles and single nodes, each after what leads to it, and whether it is a cycle."""
    ordered = list(ids)
    parts = {f"cycle {number}": part for number, part in enumerate(cycles(ordered, pairs))}
    home = {id: name for name, part in parts.items() for id in part}
    parts.update({f"node {id}": [id] for id in ordered if id not in home})
    home.update({id: f"node {id}" for id in ordered if id not in home})
    between = ((home[a], home[b]) for a, b in pairs if home[a] != home[b])
    for name in sort_topologically(parts, between):
        yield parts[name], name.startswith("cycle ")


def _arrival(node: Node, ways: list[_Span]) -> _Span:
    waits = node.kind == "join" or node.kind in STEPS
    choose = max if waits else min
    return _Span(choose(way.earliest for way in ways), _latest(way.latest for way in ways))


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
