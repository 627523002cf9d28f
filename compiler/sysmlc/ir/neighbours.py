"""Neighbours of elements by edges of one kind, compact: most elements have one, some thousands."""

from collections.abc import Iterable, Sequence
from operator import attrgetter
from typing import cast

from sysmlc.ir.element import Element

Neighbours = Element | list[Element] | dict[Element, None]
"""One neighbour stands for itself; several are a list, many a dict, each in order of addition."""

Index = dict[str, Neighbours]
"""Neighbours by the id of the element that they belong to; no entry where there is none."""

_ID = attrgetter("id")

MANY = 16
"""From here on a dict, so that neither a search nor a removal looks at all neighbours."""


def put(index: Index, id: str, neighbour: Element) -> bool:
    """Add a neighbour; False when it is there already."""
    known = index.get(id)
    if known is None:
        index[id] = neighbour
    elif isinstance(known, Element):
        if known is neighbour:
            return False
        index[id] = [known, neighbour]
    elif neighbour in known:
        return False
    elif isinstance(known, dict):
        known[neighbour] = None
    elif len(known) < MANY:
        known.append(neighbour)
    else:
        index[id] = dict.fromkeys((*known, neighbour))
    return True


def put_new(index: Index, id: str, neighbour: Element) -> None:
    """Add a neighbour that cannot be there: it was made just now."""
    known = index.get(id)
    if known is None:
        index[id] = neighbour
    elif isinstance(known, list):
        known.append(neighbour)
        if len(known) > MANY:
            index[id] = dict.fromkeys(known)
    elif isinstance(known, dict):
        known[neighbour] = None
    else:
        index[id] = [known, neighbour]


def together(neighbours: list[Element]) -> Neighbours:
    """All neighbours of an element, which differ; the list is taken over."""
    if len(neighbours) == 1:
        return neighbours[0]
    return neighbours if len(neighbours) <= MANY else dict.fromkeys(neighbours)


def put_each_new(
    index: Index, ones: Sequence[Element | None], neighbours: Sequence[Element | None]
) -> bool:
    """Add a neighbour of each of many that have none; False, and none is added, when one has."""
    if not (all(ones) and all(neighbours)):
        return False
    ids, before = list(map(_ID, ones)), len(index)
    if index and not index.keys().isdisjoint(ids):
        return False
    index.update(cast("Iterable[tuple[str, Element]]", zip(ids, neighbours, strict=True)))
    if len(index) == before + len(ids):
        return True
    for id in set(ids):
        del index[id]
    return False


def drop(index: Index, id: str, neighbour: Element) -> bool:
    """Remove a neighbour; False when it is not there."""
    known = index.get(id)
    if known is None:
        return False
    if isinstance(known, Element):
        if known is not neighbour:
            return False
        del index[id]
        return True
    if neighbour not in known:
        return False
    if isinstance(known, dict):
        del known[neighbour]
    else:
        known.remove(neighbour)
    if not known:
        del index[id]
    return True


def every(index: Index, id: str) -> list[Element]:
    """All neighbours, in order of addition."""
    known = index.get(id)
    if known is None:
        return []
    return [known] if isinstance(known, Element) else list(known)


def first(index: Index, id: str) -> Element | None:
    """The neighbour that was added first, or None."""
    known = index.get(id)
    if known is None or isinstance(known, Element):
        return known
    return next(iter(known))
