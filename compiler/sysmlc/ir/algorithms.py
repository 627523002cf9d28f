"""Strongly connected components of a directed graph of ids (R. E. Tarjan, 1972).

networkx has them, too, but takes longer to import than most models take to be compiled.
"""

from collections.abc import Iterable, Iterator, Mapping
from graphlib import TopologicalSorter
from heapq import heappop, heappush

Successors = Mapping[str, Iterable[str]]


def strong_components(successors: Successors) -> Iterator[list[str]]:
    """Nodes that reach each other, every component after those that it leads to.

    Every node is a key of ``successors``; one that reaches none back is a component of its own.
    """
    search = _Search(successors)
    for node in successors:
        if node not in search.found:
            yield from search.below(node)


class _Search:
    """Tarjan's search without recursion, for paths may be long."""

    def __init__(self, successors: Successors) -> None:
        self._successors = successors
        self.found: dict[str, int] = {}
        self._low: dict[str, int] = {}
        self._waiting: dict[str, None] = {}

    def below(self, root: str) -> Iterator[list[str]]:
        """The components that the root reaches and that are not found yet."""
        found, low, waiting = self.found, self._low, self._waiting
        path = [(root, self._enter(root))]
        while path:
            node, left = path[-1]
            for following in left:
                if following not in found:
                    path.append((following, self._enter(following)))
                    break
                if following in waiting:
                    low[node] = min(low[node], found[following])
            else:
                path.pop()
                if path:
                    above = path[-1][0]
                    low[above] = min(low[above], low[node])
                if low[node] == found[node]:
                    yield self._taken(node)

    def _enter(self, node: str) -> Iterator[str]:
        self.found[node] = self._low[node] = len(self.found)
        self._waiting[node] = None
        return iter(self._successors[node])

    def _taken(self, head: str) -> list[str]:
        component: list[str] = []
        while not component or component[-1] != head:
            component.append(self._waiting.popitem()[0])
        return component


def in_topological_order(nodes: Iterable[str], edges: Iterable[tuple[str, str]]) -> Iterator[str]:
    """Iterate over nodes so that sources precede targets; the least id first where several can be.

    Raise graphlib.CycleError, a ValueError, for a graph with a cycle.
    """
    sorter: TopologicalSorter[str] = TopologicalSorter(dict.fromkeys(nodes, ()))
    for source, target in edges:
        sorter.add(target, source)
    sorter.prepare()
    # get_ready() returns a batch in the order of addition: a heap makes the order depend on the
    # ids alone, so that it is the same when a model lists its elements in another order.
    ready: list[str] = []
    while sorter.is_active():
        for node in sorter.get_ready():
            heappush(ready, node)
        node = heappop(ready)
        yield node
        sorter.done(node)
