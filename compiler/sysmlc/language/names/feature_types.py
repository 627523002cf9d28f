"""Types of features: the most special of all types of their generals."""

from collections.abc import Callable

from sysmlc.language.metaclasses import FEATURES
from sysmlc.language.names.generals import GeneralLookup
from sysmlc.language.tree import Node

_MAX_DEPTH = 100
"""Length of chains of generals for which the recursion of ``_find_single`` is used."""


class FeatureTypes:
    """Memoised types of features.

    Most features have one type that specialises all others which they inherit. It is computed from
    the single types of the generals. Only features without such a type collect all types.
    ``supertypes`` returns a type with everything that it specialises.
    """

    def __init__(
        self, lookup: GeneralLookup, supertypes: Callable[[Node], dict[Node, None]]
    ) -> None:
        self._lookup = lookup
        self._supertypes = supertypes
        self._single_types: dict[Node, Node | None] = {}
        self._multiple_types: dict[tuple[Node, ...], list[Node]] = {}

    def find_types(self, node: Node) -> list[Node]:
        """Return the types of a feature: its own, else those of what it subsets and redefines."""
        single = self._find_single(node, 0)
        return [single] if single is not None else list(self._find_several(node))

    def _find_single(self, node: Node, depth: int) -> Node | None:
        """Return the type of a feature that specialises all its other types, if known."""
        if node in self._single_types:
            return self._single_types[node]
        if depth > _MAX_DEPTH:
            return None
        self._single_types[node] = None  # the value for recursive queries in a cycle
        result: Node | None = None
        for general in self._lookup.all_generals(node):
            type_ = (
                general if general.kind not in FEATURES else self._find_single(general, depth + 1)
            )
            result = (
                type_ if result is None or type_ is None else self._choose_special(result, type_)
            )
            if result is None:
                return None
        self._single_types[node] = result
        return result

    def _choose_special(self, left: Node, right: Node) -> Node | None:
        """Return the type that specialises the other one; None if neither or both do."""
        if left is right:
            return left
        is_special = right in self._supertypes(left)
        if is_special is (left in self._supertypes(right)):
            return None
        return left if is_special else right

    def _find_several(self, node: Node) -> list[Node]:
        """Return the most special types among the generals of a feature and theirs."""
        generals = self._lookup.all_generals(node)
        cached = self._multiple_types.get(generals)
        if cached is None:
            cached = self._multiple_types[generals] = self._drop_general(
                self._collect_types(generals)
            )
        return cached

    def _collect_types(self, generals: tuple[Node, ...]) -> list[Node]:
        """Return all types among generals of a feature and theirs, nearest first."""
        types: dict[Node, None] = {}
        seen: set[Node] = set()
        worklist = [generals]
        for generals_of_feature in worklist:
            for general in generals_of_feature:
                if general.kind not in FEATURES:
                    types[general] = None
                elif general not in seen:
                    seen.add(general)
                    worklist.append(self._lookup.all_generals(general))
        return list(types)

    def _drop_general(self, types: list[Node]) -> list[Node]:
        """Return the types that no other one of ``types`` specialises."""
        if len(types) < 2:
            return types
        return [
            type_
            for type_ in types
            if not any(
                type_ is not special and type_ in self._supertypes(special) for special in types
            )
        ]
