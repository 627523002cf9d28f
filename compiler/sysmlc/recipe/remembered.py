"""What was found of a part of a recipe: a process that stays has the same parts again."""

from collections.abc import Callable, Iterable
from functools import wraps
from typing import TypeVar

_T = TypeVar("_T")
_V = TypeVar("_V")
_MOST = 1024
"""Values of which something is remembered; the first of more is forgotten."""


def remembered(find: Callable[[_V], Iterable[_T]]) -> Callable[[_V], tuple[_T, ...]]:
    """A search in a graph, service ... that is done once while it is the very same value.

    An equal one is not enough: 1, 1.0 and True are equal, too.
    """
    known: dict[int, tuple[_V, tuple[_T, ...]]] = {}

    @wraps(find)
    def found(value: _V) -> tuple[_T, ...]:
        # What is remembered is alive, so that nothing else has its id.
        before = known.pop(id(value), None) or (value, tuple(find(value)))
        known[id(value)] = before
        if len(known) > _MOST:
            del known[next(iter(known))]
        return before[1]

    return found
