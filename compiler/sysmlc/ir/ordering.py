"""The topological order of a directed acyclic graph of ids, the same in every run."""

from collections.abc import Iterable, Iterator
from graphlib import TopologicalSorter
from heapq import heappop, heappush


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
