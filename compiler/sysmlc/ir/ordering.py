"""The topological order of a directed acyclic graph of ids (A. B. Kahn, 1962), always the same.

networkx has it, too, but takes longer to import than most models take to be compiled.
"""

from collections.abc import Iterable, Iterator
from heapq import heapify, heappop, heappush


def in_topological_order(nodes: Iterable[str], edges: Iterable[tuple[str, str]]) -> Iterator[str]:
    """Each node after those that lead to it; where that leaves a choice, the least id first.

    Raises ValueError for a graph with a cycle, after the nodes before it.
    """
    following: dict[str, set[str]] = {node: set() for node in nodes}
    for source, target in edges:
        following.setdefault(source, set()).add(target)
        following.setdefault(target, set())
    missing = dict.fromkeys(following, 0)
    for targets in following.values():
        for target in targets:
            missing[target] += 1
    yield from _by_least(following, missing)
    if any(missing.values()):
        raise ValueError("the graph has a cycle")


def _by_least(following: dict[str, set[str]], missing: dict[str, int]) -> Iterator[str]:
    ready = [node for node, number in missing.items() if not number]
    heapify(ready)
    while ready:
        node = heappop(ready)
        yield node
        for target in following[node]:
            missing[target] -= 1
            if not missing[target]:
                heappush(ready, target)
