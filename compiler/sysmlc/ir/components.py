"""Strongly connected components of a directed graph of ids (R. E. Tarjan, 1972).

networkx has them, too, but takes longer to import than most models take to be compiled.
"""

from collections.abc import Iterable, Iterator, Mapping

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
        path = [(root, self._enter(root))]
        while path:
            node, left = path[-1]
            following = next((one for one in left if self._is_new(node, one)), None)
            if following is not None:
                path.append((following, self._enter(following)))
                continue
            path.pop()
            if path:
                above = path[-1][0]
                self._low[above] = min(self._low[above], self._low[node])
            if self._low[node] == self.found[node]:
                yield self._taken(node)

    def _enter(self, node: str) -> Iterator[str]:
        self.found[node] = self._low[node] = len(self.found)
        self._waiting[node] = None
        return iter(self._successors[node])

    def _is_new(self, node: str, other: str) -> bool:
        if other not in self.found:
            return True
        if other in self._waiting:
            self._low[node] = min(self._low[node], self.found[other])
        return False

    def _taken(self, head: str) -> list[str]:
        component: list[str] = []
        while not component or component[-1] != head:
            component.append(self._waiting.popitem()[0])
        return component
