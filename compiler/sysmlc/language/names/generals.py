"""What elements specialise and redefine, as the text says and by position."""

from abc import ABC, abstractmethod
from collections.abc import Callable

from sysmlc.language.metaclasses import kinds_of
from sysmlc.language.names import contexts
from sysmlc.language.names import expression_results as results
from sysmlc.language.names import positional_redefinition as positions
from sysmlc.language.tree import Node, Reference, Relation

GENERAL = kinds_of("Specialization") | {"Conjugation", "FeatureChaining"}
"""Relations whose target gives its members to the node that has them."""


class Generals(ABC):
    """Generals of elements, each found once.

    ``cuts`` counts the questions that were not answered because their answer is being looked
    for already: what was found while one was cut is not remembered, so cycles end and change no
    other answer. ``abandoned`` has references that were too deep. ``cycles`` has elements that
    specialise themselves.
    """

    def __init__(
        self, implied: Callable[[Node], tuple[Node, ...]], by_role: Callable[[Node], list[Node]]
    ) -> None:
        self._implied = implied
        self._by_role = by_role
        self.cuts = 0
        self.cycles: list[Node] = []
        self._active: set[Reference] = set()
        self.abandoned: set[Reference] = set()
        self._cyclic: set[Node] = set()
        self._pointed: set[Node] = set()
        self._generals: dict[Node, list[Node]] = {}
        self._silently: dict[Node, tuple[Node, ...]] = {}
        self._all_generals: dict[Node, tuple[Node, ...]] = {}
        self._redefining: dict[Node, list[Node]] = {}
        self._placing: set[Node | tuple[Node, str]] = set()
        """Features, and roles of owners, whose positions are being looked at."""
        self._positions: dict[Node, list[Node]] = {}
        self._own_of_role: dict[tuple[Node, str], list[Node]] = {}
        self._at_positions: dict[tuple[Node, str], list[Node]] = {}

    def abandon(self) -> None:
        """Give up what is being looked for, after an error in the midst of it."""
        for reference in self._active:
            reference.set_targets([])
        self.abandoned |= self._active
        self._active.clear()
        self._placing.clear()

    @abstractmethod
    def target(self, node: Node, relation: Relation) -> Node | None:
        """The element that a relation of ``node`` leads to; None when a name leads nowhere."""

    @abstractmethod
    def element(self, hit: Node) -> Node | None:
        """What a member stands for: the element of an alias, else the member itself."""

    def generals(self, node: Node) -> list[Node]:
        """What ``node`` specialises as the text says: types, subsetted, redefined features ..."""
        known = self._generals.get(node)
        if known is not None:
            return known
        if not node.relations:
            return self._generals.setdefault(node, [])
        before = self.cuts
        found: list[Node] = []
        links: list[Node] = []
        for relation in node.relations:
            if relation.kind in GENERAL or (
                relation.kind == "Membership" and node.kind in contexts.INSTANTIATIONS
            ):
                target = self.target(node, relation)
                if target is not None and target not in found:
                    if relation.kind == "FeatureChaining":
                        found = [one for one in found if one not in links]
                        links.append(target)
                    found.append(target)
        if self.cuts == before:
            self._generals[node] = found
            self._pointed.update(found)
            if node in self._pointed:
                self._find_cycle(node)
        return found

    def _find_cycle(self, node: Node) -> None:
        """Note when ``node`` specialises itself: those in a circle inherit all of each other."""
        reached = self.reached(node)
        if node not in reached or node in self._cyclic:
            return
        specials: dict[Node, list[Node]] = {}
        for one in reached:
            for general in self._generals.get(one, ()):
                specials.setdefault(general, []).append(one)
        circle = {node}
        waiting = [node]
        while waiting:
            found = [one for one in specials.get(waiting.pop(), ()) if one not in circle]
            circle.update(found)
            waiting += found
        self._cyclic |= circle
        self.cycles.append(node)

    def circle(self, node: Node) -> list[Node]:
        """The shortest way from ``node`` through its generals to itself, without ``node``."""
        before: dict[Node, Node] = {}
        waiting = [node]
        for one in waiting:
            for general in self._generals.get(one, ()):
                if general is node:
                    way = [one]
                    while way[-1] is not node:
                        way.append(before[way[-1]])
                    return way[-2::-1]
                if general not in before:
                    before[general] = one
                    waiting.append(general)
        return []

    def reached(self, node: Node) -> list[Node]:
        """What ``node`` specialises, as far as it is known, the nearest first."""
        reached: dict[Node, None] = {}
        waiting = [node]
        while waiting:
            for general in self._generals.get(waiting.pop(0), ()):
                if general not in reached:
                    reached[general] = None
                    waiting.append(general)
        return list(reached)

    def conforms(self, node: Node, general: Node) -> bool:
        """Whether ``node`` specialises ``general`` as the text says, in any number of steps."""
        seen, waiting = {node}, [node]
        while waiting:
            one = waiting.pop()
            if one is general:
                return True
            for other in self.generals(one):
                if other not in seen:
                    seen.add(other)
                    waiting.append(other)
        return False

    def redefined(self, feature: Node) -> set[Node]:
        """What a feature redefines, directly or not."""
        found: set[Node] = set()
        waiting = [feature]
        while waiting:
            node = waiting.pop()
            for relation in node.relations:
                if relation.kind == "Redefinition":
                    target = self.target(node, relation)
                    if target is not None and target not in found:
                        found.add(target)
                        waiting.append(target)
            waiting += [other for other in self.by_position(node) if other not in found]
            found.update(self.by_position(node))
        return found

    def _silent(self, scope: Node) -> list[Node]:
        """The members of ``scope`` that redefine something though the text does not say so."""
        known = self._redefining.get(scope)
        if known is None:
            known = self._redefining[scope] = [m for m in scope.members if positions.counts(m)]
        return known

    def by_position(self, feature: Node) -> list[Node]:
        """What a feature redefines because of its position or its membership."""
        known = self._positions.get(feature)
        if known is None:
            if not positions.counts(feature):
                return self._positions.setdefault(feature, [])
            if feature in self._placing:
                self.cuts += 1
                return []
            before = self.cuts
            self._placing.add(feature)
            known = positions.redefined(feature, self) or self._by_role(feature)
            self._placing.discard(feature)
            if self.cuts == before:
                self._positions[feature] = known
        return known

    def own_of_role(self, scope: Node, role: str) -> list[Node]:
        """The features of a type with one role by position, in the order of the text."""
        key = (scope, role)
        known = self._own_of_role.get(key)
        if known is None:
            known = self._own_of_role[key] = positions.own(scope, role)
        return known

    def at_positions(self, scope: Node, role: str) -> list[Node]:
        """The features of a type with one role by position, own ones before inherited ones."""
        key = (scope, role)
        known = self._at_positions.get(key)
        if known is None:
            if key in self._placing:
                self.cuts += 1
                return []
            before = self.cuts
            self._placing.add(key)
            known = positions.gather(scope, role, self)
            self._placing.discard(key)
            if self.cuts == before:
                self._at_positions[key] = known
        return known

    def all_generals(self, node: Node) -> tuple[Node, ...]:
        """What ``node`` specialises as the text says and what it may implicitly."""
        known = self._all_generals.get(node)
        if known is None:
            before = self.cuts
            known = (*self.generals(node), *self._silent_generals(node))
            if self.cuts == before:
                self._all_generals[node] = known
        return known

    def _silent_generals(self, node: Node) -> tuple[Node, ...]:
        known = self._silently.get(node)
        if known is None:
            before = self.cuts
            value = results.of_value(node, self) if not self.generals(node) else None
            placed = self.by_position(node)
            known = self._implied(node)
            if placed:
                known = (*placed, *known)
            if value is not None and value is not node:
                known = (value, *known)
            if self.cuts == before:
                self._silently[node] = known
        return known
