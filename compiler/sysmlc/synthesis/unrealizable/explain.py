"""Smallest conflicts: what of many things cannot be had together, while all but any one can.

The search is Junker's QuickXplain (2004): halves are tried before single things, so that a small
conflict among many takes few questions.
"""

from collections.abc import Callable, Sequence
from typing import Generic, TypeVar

T = TypeVar("T")
MOST_ASKED = 200
"""Questions that are asked at most; what is left then may still be too many."""


def conflict(
    items: Sequence[T], is_conflict: Callable[[Sequence[T]], bool], most: int = MOST_ASKED
) -> tuple[T, ...]:
    """Items that conflict, of ``items`` that do, in their order.

    None of them can be left out, unless ``most`` questions were not enough to find that out.
    """
    return _Search(items, is_conflict, most).run()


class _Search(Generic[T]):
    def __init__(
        self, items: Sequence[T], is_conflict: Callable[[Sequence[T]], bool], most: int
    ) -> None:
        self._items = items
        self._is_conflict = is_conflict
        self._left = most

    def run(self) -> tuple[T, ...]:
        """The conflict."""
        found = set(self._needed((), range(len(self._items)), is_new=True))
        return tuple(one for at, one in enumerate(self._items) if at in found)

    def _needed(self, given: Sequence[int], among: Sequence[int], is_new: bool) -> tuple[int, ...]:
        """What of ``among`` is needed for a conflict, when all of ``given`` is there."""
        if is_new and self._ask(given):
            return ()
        if len(among) == 1 or not self._left:
            return tuple(among)
        first, second = among[: len(among) // 2], among[len(among) // 2 :]
        later = self._needed((*given, *first), second, is_new=bool(first))
        return (*self._needed((*given, *later), first, is_new=bool(later)), *later)

    def _ask(self, places: Sequence[int]) -> bool:
        if not self._left:
            return False
        self._left -= 1
        return self._is_conflict([self._items[at] for at in places])
