"""Disjoint sets (union-find) over hashable items."""

from collections.abc import Collection, Hashable, Iterable
from typing import Generic, TypeVar

T = TypeVar("T", bound=Hashable)


class DisjointSets(Generic[T]):
    """A partition whose sets are merged but never split, with path halving.

    Items need not be added first: an item that was never merged is alone in its set.
    """

    def __init__(self) -> None:
        self._parents: dict[T, T] = {}

    def find(self, item: T) -> T:
        """Return the representative of the set that contains *item*."""
        while (parent := self._parents.get(item, item)) != item:
            self._parents[item] = self._parents.get(parent, parent)
            item = parent
        return item

    def union(self, left: T, right: T) -> None:
        """Merge the sets of both items; the representative of *left* represents the result."""
        self._parents.setdefault(left, left)
        self._parents.setdefault(right, right)
        self._parents[self.find(right)] = self.find(left)

    def has_merged(self, item: T) -> bool:
        """Whether *item* was ever an argument of ``union``."""
        return item in self._parents

    def group_items(self, items: Iterable[T]) -> list[list[T]]:
        """Group *items* by set, in the order of the first item of each set."""
        groups: dict[T, list[T]] = {}
        for item in items:
            groups.setdefault(self.find(item), []).append(item)
        return list(groups.values())


def group_related(items: Iterable[T], relations: Iterable[Collection[T]]) -> list[frozenset[T]]:
    """Group *items* that a relation connects, in the order of the first item of each group.

    Each relation connects those of its members that are among the items.
    """
    members = dict.fromkeys(items)
    sets: DisjointSets[T] = DisjointSets()
    for relation in relations:
        related = [item for item in relation if item in members]
        for item in related[1:]:
            sets.union(related[0], item)
    return [frozenset(group) for group in sets.group_items(members)]
