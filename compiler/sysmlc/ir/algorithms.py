"""Algorithms on directed graphs: reachability, strongly connected components, topological order.

networkx offers all of them, but its import takes longer than compiling most models.
"""

from collections.abc import Callable, Hashable, Iterable, Iterator, Mapping
from graphlib import TopologicalSorter
from heapq import heappop, heappush
from typing import Generic, TypeVar

_Node = TypeVar("_Node", bound=Hashable)


def find_reachable(
    starts: Iterable[_Node], successors_of: Callable[[_Node], Iterable[_Node]]
) -> set[_Node]:
    """Return *starts* and all nodes that are reachable from them."""
    reached = set(starts)
    worklist = list(reached)
    while worklist:
        for successor in successors_of(worklist.pop()):
            if successor not in reached:
                reached.add(successor)
                worklist.append(successor)
    return reached


def strongly_connected_components(
    successors: Mapping[_Node, Iterable[_Node]],
) -> Iterator[list[_Node]]:
    """Iterate over the strongly connected components, each after those that it leads to.

    Every node is a key of *successors*. A node that is on no cycle is a component of its own.
    """
    search = _TarjanSearch(successors)
    for node in successors:
        if node not in search.index:
            yield from search.run(node)


class _TarjanSearch(Generic[_Node]):
    """The algorithm of R. E. Tarjan (1972), without recursion because paths may be long."""

    def __init__(self, successors: Mapping[_Node, Iterable[_Node]]) -> None:
        self._successors = successors
        self.index: dict[_Node, int] = {}
        self._low_link: dict[_Node, int] = {}
        self._stack: dict[_Node, None] = {}

    def run(self, root: _Node) -> Iterator[list[_Node]]:
        """Iterate over the components reachable from *root* that no earlier run has visited."""
        index, low_link, stack = self.index, self._low_link, self._stack
        path = [(root, self._visit(root))]
        while path:
            node, successors = path[-1]
            for successor in successors:
                if successor not in index:
                    path.append((successor, self._visit(successor)))
                    break
                if successor in stack:
                    low_link[node] = min(low_link[node], index[successor])
            else:
                path.pop()
                if path:
                    parent = path[-1][0]
                    low_link[parent] = min(low_link[parent], low_link[node])
                if low_link[node] == index[node]:
                    yield self._pop_component(node)

    def _visit(self, node: _Node) -> Iterator[_Node]:
        self.index[node] = self._low_link[node] = len(self.index)
        self._stack[node] = None
        return iter(self._successors[node])

    def _pop_component(self, root: _Node) -> list[_Node]:
        component: list[_Node] = []
        while not component or component[-1] != root:
            component.append(self._stack.popitem()[0])
        return component


def sort_topologically(nodes: Iterable[str], edges: Iterable[tuple[str, str]]) -> Iterator[str]:
    """Iterate over nodes so that sources precede targets, the least id first where several can be.

    Ends of *edges* are nodes too. Raise graphlib.CycleError, a ValueError, for a cycle.
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
