"""Sets of things that are one: features that connectors join, ends between which messages pass."""

from collections.abc import Hashable, Iterable
from typing import Generic, TypeVar

T = TypeVar("T", bound=Hashable)


class Joints(Generic[T]):
    """A partition that grows coarser: what is united with the same stands for the same."""

    def __init__(self) -> None:
        self._above: dict[T, T] = {}

    def find(self, one: T) -> T:
        """What stands for all that it is united with."""
        while (up := self._above.get(one, one)) != one:
            self._above[one] = self._above.get(up, up)
            one = up
        return one

    def unite(self, one: T, other: T) -> None:
        """The two are one from now on."""
        self._above.setdefault(one, one)
        self._above.setdefault(other, other)
        self._above[self.find(other)] = self.find(one)

    def is_joined(self, one: T) -> bool:
        """Whether it was united with anything."""
        return one in self._above

    def groups(self, given: Iterable[T]) -> list[list[T]]:
        """The given ones, those that are one together, in the order of the first of each."""
        found: dict[T, list[T]] = {}
        for one in given:
            found.setdefault(self.find(one), []).append(one)
        return list(found.values())
