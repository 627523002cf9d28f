"""The types of features: the most special of all that their generals are typed by."""

from collections.abc import Callable

from sysmlc.language.names.generals import Generals
from sysmlc.language.names.symbols import FEATURES
from sysmlc.language.tree import Node

_DEEP = 100
"""Features that are typed by what they specialise in so many steps are looked at one by one."""


class Types:
    """Types of features, each found once; ``supers`` gives all that a type specialises.

    Most features have one type that specialises all others which they have from their generals:
    it follows from such types of the generals.
    """

    def __init__(self, lookup: Generals, supers: Callable[[Node], dict[Node, None]]) -> None:
        self._lookup = lookup
        self._supers = supers
        self._single: dict[Node, Node | None] = {}
        self._several: dict[tuple[Node, ...], list[Node]] = {}

    def of(self, node: Node) -> list[Node]:
        """The types of a feature: its own, else those of what it subsets and redefines."""
        single = self._one(node, 0)
        return [single] if single is not None else list(self._among(node))

    def _one(self, node: Node, depth: int) -> Node | None:
        """The type of a feature that specialises its others; None where that is not known."""
        if node in self._single:
            return self._single[node]
        if depth > _DEEP:
            return None
        self._single[node] = None  # for who asks while it is being found
        found: Node | None = None
        for general in self._lookup.all_generals(node):
            one = general if general.kind not in FEATURES else self._one(general, depth + 1)
            found = one if found is None or one is None else self._special(found, one)
            if found is None:
                return None
        self._single[node] = found
        return found

    def _special(self, one: Node, other: Node) -> Node | None:
        """Which of two types specialises the other; None for neither and for both."""
        if one is other:
            return one
        is_special = other in self._supers(one)
        if is_special is (one in self._supers(other)):
            return None
        return one if is_special else other

    def _among(self, node: Node) -> list[Node]:
        """The most special of what is no feature among generals of a feature, and theirs."""
        generals = self._lookup.all_generals(node)
        known = self._several.get(generals)
        if known is None:
            known = self._several[generals] = self._most_special(self._above(generals))
        return known

    def _above(self, generals: tuple[Node, ...]) -> list[Node]:
        """What is no feature among generals of a feature and theirs, the nearest first."""
        found: dict[Node, None] = {}
        seen: set[Node] = set()
        waiting = [generals]
        for some in waiting:
            for one in some:
                if one.kind not in FEATURES:
                    found[one] = None
                elif one not in seen:
                    seen.add(one)
                    waiting.append(self._lookup.all_generals(one))
        return list(found)

    def _most_special(self, found: list[Node]) -> list[Node]:
        if len(found) < 2:
            return found
        return [t for t in found if not any(t is not o and t in self._supers(o) for o in found)]
