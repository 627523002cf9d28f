"""Generals of elements: what they specialise and redefine, by the text and by position.

The types of a feature are the most special of all types of its generals.
"""

from abc import ABC, abstractmethod
from collections.abc import Callable

from sysmlc.language.metaclasses import FEATURES, kinds_of
from sysmlc.language.names import contexts
from sysmlc.language.names.expression_results import find_value_result
from sysmlc.language.names.implied import (
    find_own_features,
    find_redefined,
    gather_features,
    may_redefine_by_position,
)
from sysmlc.language.tree import Node, Reference, Relation

GENERALIZATION_KINDS = kinds_of("Specialization") | {"Conjugation", "FeatureChaining"}
"""Relations by which a node inherits the members of the target."""
_DEFINITIONS = kinds_of("Definition")


class GeneralLookup(ABC):
    """Memoised generals of elements.

    The queries call each other recursively and may ask for a value that is being computed. Such a
    query returns an incomplete value and increments ``cycle_hits``. A value is memoised only if no
    cycle was hit while it was computed, so a cycle ends and changes no other answer.
    ``abandoned_references`` could not be resolved within the recursion limit. ``cycles`` has
    elements that specialise themselves.
    """

    def __init__(
        self, implied: Callable[[Node], tuple[Node, ...]], by_role: Callable[[Node], list[Node]]
    ) -> None:
        self._implied = implied
        self._by_role = by_role
        self.cycle_hits = 0
        self.cycles: list[Node] = []
        self._active: set[Reference] = set()
        self.abandoned_references: set[Reference] = set()
        self._cyclic: set[Node] = set()
        self._general_targets: set[Node] = set()
        self._generals: dict[Node, list[Node]] = {}
        self._implied_generals: dict[Node, tuple[Node, ...]] = {}
        self._all_generals: dict[Node, tuple[Node, ...]] = {}
        self._positional_members: dict[Node, list[Node]] = {}
        self._active_positions: set[Node | tuple[Node, str]] = set()
        """Features, and roles of owners, whose positions are being computed."""
        self._positions: dict[Node, list[Node]] = {}
        self._own_of_role: dict[tuple[Node, str], list[Node]] = {}
        self._at_positions: dict[tuple[Node, str], list[Node]] = {}

    def abandon(self) -> None:
        """Reset the state of the queries that a RecursionError interrupted."""
        # The interrupted references count as unresolved: their lookup would only fail again.
        for reference in self._active:
            reference.set_targets([])
        self.abandoned_references |= self._active
        self._active.clear()
        self._active_positions.clear()

    @abstractmethod
    def target(self, node: Node, relation: Relation) -> Node | None:
        """Return the element that a relation of ``node`` leads to, or None if it is unresolved."""

    @abstractmethod
    def resolve_alias(self, hit: Node) -> Node | None:
        """Return the element that a member stands for: that of an alias, else the member itself."""

    def generals(self, node: Node) -> list[Node]:
        """Return the generals that the text states: types, subsetted, redefined features ..."""
        cached = self._generals.get(node)
        if cached is not None:
            return cached
        if not node.relations:
            return self._generals.setdefault(node, [])
        hits_before = self.cycle_hits
        generals: list[Node] = []
        links: list[Node] = []
        for relation in node.relations:
            if relation.kind in GENERALIZATION_KINDS or (
                relation.kind == "Membership" and node.kind in contexts.INSTANTIATIONS
            ):
                target = self.target(node, relation)
                if target is not None and target not in generals:
                    if relation.kind == "FeatureChaining":
                        generals = [general for general in generals if general not in links]
                        links.append(target)
                    generals.append(target)
        # A cycle was hit otherwise: the value is incomplete, and another query may complete it.
        if self.cycle_hits == hits_before:
            self._generals[node] = generals
            # A node in a cycle is the general of another one, so others need no search for cycles.
            self._general_targets.update(generals)
            if node in self._general_targets:
                self._record_cycle(node)
        return generals

    def _record_cycle(self, node: Node) -> None:
        """Record ``node`` if it specialises itself.

        Elements in a cycle inherit everything of each other.
        """
        ancestors = self.known_ancestors(node)
        if node not in ancestors or node in self._cyclic:
            return
        specials: dict[Node, list[Node]] = {}
        for ancestor in ancestors:
            for general in self._generals.get(ancestor, ()):
                specials.setdefault(general, []).append(ancestor)
        cycle = {node}
        worklist = [node]
        while worklist:
            specials_in_cycle = [
                special for special in specials.get(worklist.pop(), ()) if special not in cycle
            ]
            cycle.update(specials_in_cycle)
            worklist += specials_in_cycle
        self._cyclic |= cycle
        self.cycles.append(node)

    def find_cycle_path(self, node: Node) -> list[Node]:
        """Return the shortest path from ``node`` through its generals to itself, exclusive."""
        previous: dict[Node, Node] = {}
        worklist = [node]
        for current in worklist:
            for general in self._generals.get(current, ()):
                if general is node:
                    path = [current]
                    while path[-1] is not node:
                        path.append(previous[path[-1]])
                    return path[-2::-1]
                if general not in previous:
                    previous[general] = current
                    worklist.append(general)
        return []

    def known_ancestors(self, node: Node) -> list[Node]:
        """Return the memoised direct and indirect generals of ``node``, nearest first."""
        ancestors: dict[Node, None] = {}
        worklist = [node]
        while worklist:
            for general in self._generals.get(worklist.pop(0), ()):
                if general not in ancestors:
                    ancestors[general] = None
                    worklist.append(general)
        return list(ancestors)

    def conforms(self, node: Node, general: Node) -> bool:
        """Whether ``node`` is ``general`` or specialises it by relations that the text states."""
        seen, worklist = {node}, [node]
        while worklist:
            current = worklist.pop()
            if current is general:
                return True
            for ancestor in self.generals(current):
                if ancestor not in seen:
                    seen.add(ancestor)
                    worklist.append(ancestor)
        return False

    def redefined_features(self, feature: Node) -> set[Node]:
        """Return the features that ``feature`` redefines, directly or not."""
        redefined: set[Node] = set()
        worklist = [feature]
        while worklist:
            node = worklist.pop()
            for relation in node.relations:
                if relation.kind == "Redefinition":
                    target = self.target(node, relation)
                    if target is not None and target not in redefined:
                        redefined.add(target)
                        worklist.append(target)
            worklist += [
                general for general in self.redefined_by_position(node) if general not in redefined
            ]
            redefined.update(self.redefined_by_position(node))
        return redefined

    def _find_positional_members(self, scope: Node) -> list[Node]:
        """Return the members of ``scope`` that may redefine a feature by position."""
        cached = self._positional_members.get(scope)
        if cached is None:
            cached = self._positional_members[scope] = [
                member for member in scope.members if may_redefine_by_position(member)
            ]
        return cached

    def redefined_by_position(self, feature: Node) -> list[Node]:
        """Return the features that ``feature`` redefines by its position or its membership."""
        cached = self._positions.get(feature)
        if cached is None:
            if not may_redefine_by_position(feature):
                return self._positions.setdefault(feature, [])
            if feature in self._active_positions:
                self.cycle_hits += 1
                return []
            hits_before = self.cycle_hits
            self._active_positions.add(feature)
            cached = find_redefined(feature, self) or self._by_role(feature)
            self._active_positions.discard(feature)
            if self.cycle_hits == hits_before:
                self._positions[feature] = cached
        return cached

    def own_features_of_role(self, scope: Node, role: str) -> list[Node]:
        """Return the features of a type with this positional role, in the order of the text."""
        key = (scope, role)
        cached = self._own_of_role.get(key)
        if cached is None:
            cached = self._own_of_role[key] = find_own_features(scope, role)
        return cached

    def features_of_role(self, scope: Node, role: str) -> list[Node]:
        """Return the features of a type with this positional role, own before inherited ones."""
        key = (scope, role)
        cached = self._at_positions.get(key)
        if cached is None:
            if key in self._active_positions:
                self.cycle_hits += 1
                return []
            hits_before = self.cycle_hits
            self._active_positions.add(key)
            cached = gather_features(scope, role, self)
            self._active_positions.discard(key)
            if self.cycle_hits == hits_before:
                self._at_positions[key] = cached
        return cached

    def all_generals(self, node: Node) -> tuple[Node, ...]:
        """Return the generals that the text states, then those that may be implied."""
        cached = self._all_generals.get(node)
        if cached is None:
            hits_before = self.cycle_hits
            cached = (*self.generals(node), *self._find_implied_generals(node))
            if self.cycle_hits == hits_before:
                self._all_generals[node] = cached
        return cached

    def _find_implied_generals(self, node: Node) -> tuple[Node, ...]:
        cached = self._implied_generals.get(node)
        if cached is None:
            hits_before = self.cycle_hits
            value = find_value_result(node, self) if not self.generals(node) else None
            by_position = self.redefined_by_position(node)
            cached = self._implied(node)
            if by_position:
                cached = (*by_position, *cached)
            if value is not None and value is not node:
                cached = (value, *cached)
            # A variant such as an enumerated value has the type that it is a variant of.
            if node.membership == "VariantMembership" and not self.generals(node):
                owner = node.owner
                cached = (owner, *cached) if owner and owner.kind in _DEFINITIONS else cached
            if self.cycle_hits == hits_before:
                self._implied_generals[node] = cached
        return cached


# -- types of features -------------------------------------------------------------------------

_MAX_DEPTH = 100
"""Length of chains of generals for which the recursion of ``_find_single`` is used."""


class FeatureTypes:
    """Memoised types of features.

    Most features have one type that specialises all inherited types. This type is computed from
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
        """Return the most special types of the direct and indirect generals of a feature."""
        generals = self._lookup.all_generals(node)
        cached = self._multiple_types.get(generals)
        if cached is None:
            cached = self._multiple_types[generals] = self._drop_general(
                self._collect_types(generals)
            )
        return cached

    def _collect_types(self, generals: tuple[Node, ...]) -> list[Node]:
        """Return all types of the direct and indirect generals of a feature, nearest first."""
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
