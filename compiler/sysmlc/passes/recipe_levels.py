"""Which elements may have a recipe level: what the options name, and who has that of another."""

from collections.abc import Callable, Iterable, Iterator, Mapping

from sysmlc.ir import Edge, Element, Graph

_FOLLOWED = (Edge.SPECIALIZES, Edge.TYPED_BY, Edge.REDEFINES, Edge.CALLS, Edge.METHOD)
"""Edges along which an element has the level of another one."""


def by_name(
    graph: Graph, levels: Mapping[str, str], segment: Callable[[Element], str]
) -> Iterator[tuple[str, str]]:
    """The ids of what qualified names stand for, with their levels.

    ``segment`` is the part of an element in such a name. The empty id is there, too, so that the
    answer is never nothing.
    """
    yield "", ""
    roots = graph.roots() if levels else []
    for name, level in levels.items():
        yield from ((one.id, level) for one in _named(graph, name, roots, segment))


def _named(
    graph: Graph, name: str, siblings: list[Element], segment: Callable[[Element], str]
) -> Iterator[Element]:
    """From the top down: only what the name begins with is looked into."""
    for one in siblings:
        part = segment(one)
        if name == part:
            yield one
        elif name.startswith(f"{part}::"):
            yield from _named(graph, name[len(part) + 2 :], graph.owned(one), segment)


def followers(graph: Graph, first: Iterable[Element]) -> set[str]:
    """Ids of these elements, and of all that may have a level because one of them has it."""
    waiting = list(first)
    found = {one.id for one in waiting}
    while waiting:
        one = waiting.pop()
        users = (user for edge in _FOLLOWED for user in graph.sources(one, edge))
        new = [user for user in users if user.id not in found]
        found.update(user.id for user in new)
        waiting += new
    return found
