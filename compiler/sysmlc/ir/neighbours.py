"""Neighbours of elements along edges of one kind, in order of addition.

Most elements have one neighbour and a few have thousands. A set for each element would need more
memory than the elements themselves.
"""

from sysmlc.ir.element import Element

Neighbours = Element | list[Element] | dict[Element, None]
"""A single neighbour itself, several as a list, many as a dict."""

Index = dict[str, Neighbours]
"""Neighbours by the id of an element. An element without neighbours has no entry."""

_LONGEST_LIST = 16
"""Longer lists become dicts, because search and removal in a list take linear time."""


def add_neighbour(index: Index, id: str, neighbour: Element) -> bool:
    """Add a neighbour of the element *id*. Return False when the index has it already."""
    neighbours = index.get(id)
    if neighbours is None:
        index[id] = neighbour
    elif isinstance(neighbours, Element):
        if neighbours is neighbour:
            return False
        index[id] = [neighbours, neighbour]
    elif neighbour in neighbours:
        return False
    elif isinstance(neighbours, dict):
        neighbours[neighbour] = None
    elif len(neighbours) < _LONGEST_LIST:
        neighbours.append(neighbour)
    else:
        index[id] = dict.fromkeys((*neighbours, neighbour))
    return True


def remove_neighbour(index: Index, id: str, neighbour: Element) -> bool:
    """Remove a neighbour of the element *id*. Return False when the index does not have it."""
    neighbours = index.get(id)
    if neighbours is None:
        return False
    if isinstance(neighbours, Element):
        if neighbours is not neighbour:
            return False
        del index[id]
        return True
    if neighbour not in neighbours:
        return False
    if isinstance(neighbours, dict):
        del neighbours[neighbour]
    else:
        neighbours.remove(neighbour)
    if not neighbours:
        del index[id]
    return True


def list_neighbours(index: Index, id: str) -> list[Element]:
    """Return all neighbours of the element *id*."""
    neighbours = index.get(id)
    if neighbours is None:
        return []
    return [neighbours] if isinstance(neighbours, Element) else list(neighbours)


def first_neighbour(index: Index, id: str) -> Element | None:
    """Return the neighbour of the element *id* that was added first, or None."""
    neighbours = index.get(id)
    if neighbours is None or isinstance(neighbours, Element):
        return neighbours
    return next(iter(neighbours))
