"""Members of one namespace by name: owned and inherited ones (KerML 8.2.3.5.3).

The lookup of a name in a namespace has stages: owned, then inherited, then imported members. A
later stage counts only if no member of an earlier one fits.
"""

from abc import abstractmethod
from collections.abc import Callable, Iterator

from sysmlc.language.metaclasses import TYPES
from sysmlc.language.names.generals import GeneralLookup
from sysmlc.language.names.symbols import SymbolTable, build_symbol_table, find_naming_reference
from sysmlc.language.tree import Node

Hits = tuple[Node, ...]
"""Members found by one name, nearest first. An alias is represented by its Membership node."""
NO_HITS: Hits = ()


class MemberLookup(GeneralLookup):
    """Memoised lookup of the members of namespaces by name."""

    def __init__(
        self, implied: Callable[[Node], tuple[Node, ...]], by_role: Callable[[Node], list[Node]]
    ) -> None:
        super().__init__(implied, by_role)
        self._owned: dict[Node, SymbolTable] = {}
        self._inherited: dict[Node, dict[str, Hits]] = {}
        """Inherited members by type and name."""
        self._inheriting: set[Node] = set()
        """Types whose inherited members are being looked up, to end the recursion in cycles."""
        self._inheritable: dict[Node, frozenset[str] | None] = {}
        """Names that a type may inherit; None if they are unknown. Set by the first failure."""
        self._inheritable_by_generals: dict[tuple[Node, ...], frozenset[str] | None] = {}
        """The same sets of names by the generals of the type."""
        self._names_of: dict[Node, frozenset[str]] = {}
        """Names that a general owns or inherits."""

    def abandon(self) -> None:
        """Reset the state of the queries that a RecursionError interrupted."""
        super().abandon()
        self._inheriting.clear()

    @abstractmethod
    def imports(self, scope: Node) -> list[Node]:
        """Return the imports that a namespace owns."""

    @abstractmethod
    def imported_members(self, scope: Node, name: str, *, inside: bool) -> Hits:
        """Return imported members by name; with ``inside`` false only those of public imports."""

    def symbol_table(self, scope: Node) -> SymbolTable:
        """Return the owned members of ``scope`` by name."""
        table = self._owned.get(scope)
        if table is None:
            table = self._owned[scope] = build_symbol_table(scope)
        return table

    def own_members(self, scope: Node, name: str) -> Hits:
        """Return the owned members with that name.

        A feature without a declared name is included only if its naming reference resolves.
        """
        hits = self.symbol_table(scope).get(name)
        return NO_HITS if hits is None else self._select_named(hits)

    def _select_named(self, hits: list[Node]) -> Hits:
        """Return the members with a declared name or a naming reference that resolves."""
        return tuple(
            [hit for hit in hits if hit.name or hit.short_name or self._has_resolved_name(hit)]
        )

    def _has_resolved_name(self, feature: Node) -> bool:
        reference = find_naming_reference(feature)
        relation = next(
            (relation for relation in feature.relations if relation.reference is reference), None
        )
        return relation is None or self.target(feature, relation) is not None

    def _iter_stages(self, scope: Node, name: str, without: Node | None) -> Iterator[Hits]:
        """Yield the members visible inside ``scope`` by name: owned, inherited, imported ones.

        The effective name of ``without`` is being computed, so that it counts only if ``name`` is
        one of its declared names.
        """
        hits = self.symbol_table(scope).get(name)
        if hits is not None:
            if without is not None and without in hits:
                is_declared = name in (without.name, without.short_name)
                hits = hits if is_declared else [hit for hit in hits if hit is not without]
            yield self._select_named(hits)
        if scope.kind in TYPES:
            yield self.inherited(scope, name)
        if self.imports(scope):
            yield self.imported_members(scope, name, inside=True)

    def _iter_stages_without_imports(self, scope: Node, name: str) -> Iterator[Hits]:
        """Yield the owned members with that name, then the inherited ones."""
        yield self.own_members(scope, name)
        if scope.kind in TYPES:
            yield self.inherited(scope, name)

    def _iter_stages_without_implied(self, scope: Node, name: str) -> Iterator[Hits]:
        """Yield the members with that name, without those that only implied generals have."""
        yield self.own_members(scope, name)
        for general in self.generals(scope):
            yield self._find_heritable(general, name)
        yield self.imported_members(scope, name, inside=True)

    def iter_visible_inside(self, scope: Node, name: str) -> Iterator[Node]:
        """Yield the members with that name as seen from inside: owned, inherited, imported ones."""
        for hits in self._iter_stages(scope, name, None):
            yield from hits

    def visible_outside(self, scope: Node, name: str) -> Hits:
        """Return the public members with that name: owned, inherited, imported ones."""
        hits = [
            member
            for member in self.own_members(scope, name)
            if member.visibility in ("", "public")
        ]
        if not hits and scope.kind in TYPES:
            hits += [h for h in self.inherited(scope, name) if h.visibility != "protected"]
        if not hits:
            hits += self.imported_members(scope, name, inside=False)
        return tuple(hits)

    def inherited(self, scope: Node, name: str) -> Hits:
        """Return the inherited members with that name that the type does not redefine."""
        names = self._inheritable.get(scope)
        if names is not None and name not in names:
            return NO_HITS
        cached = self._inherited.get(scope)
        if cached is None:
            cached = self._inherited[scope] = {}
        hits = cached.get(name)
        if hits is not None:
            return hits
        if scope in self._inheriting:
            self.cycle_hits += 1
            return NO_HITS
        hits_before = self.cycle_hits
        self._inheriting.add(scope)
        hits = self._find_in_generals(scope, name)
        if hits:
            replacements = (self._find_replacement(scope, hit) for hit in hits)
            hits = tuple(dict.fromkeys(hit for hit in replacements if hit is not None))
        self._inheriting.discard(scope)
        if self.cycle_hits == hits_before:
            cached[name] = hits
            # Most lookups fail in most scopes; from the second failure on a set of names decides.
            if not hits and scope not in self._inheritable:
                self._inheritable[scope] = self._collect_inheritable_names(scope)
        return hits

    def _collect_inheritable_names(self, scope: Node) -> frozenset[str] | None:
        """Return the names of all members that ``scope`` may inherit.

        Called when a lookup failed, so that later failures are cheap. None where a general imports
        names, has unknown generals, or is in a cycle.
        """
        generals = self.all_generals(scope)
        if generals not in self._inheritable_by_generals:
            names_of_generals = [self._collect_names(general, {}) for general in generals]
            complete = [names for names in names_of_generals if names is not None]
            is_complete = len(complete) == len(generals)
            self._inheritable_by_generals[generals] = (
                frozenset().union(*complete) if is_complete else None
            )
        return self._inheritable_by_generals[generals]

    def _collect_names(self, general: Node, pending: dict[Node, None]) -> frozenset[str] | None:
        """Return the names that ``general`` owns or inherits; None if they are unknown.

        ``pending`` has the generals whose names are being collected.
        """
        names = self._names_of.get(general)
        if names is not None:
            return names
        stated, implied = self._generals.get(general), self._implied_generals.get(general)
        if stated is None or implied is None or general in pending:
            return None
        if any(imported.visibility in ("", "public") for imported in self.imports(general)):
            return None
        pending[general] = None
        collected = set(self.symbol_table(general))
        for inherited_from in (*stated, *implied):
            inherited = self._collect_names(inherited_from, pending)
            if inherited is None:
                return None
            collected |= inherited
        del pending[general]
        names = self._names_of[general] = frozenset(collected)
        return names

    def _find_in_generals(self, scope: Node, name: str) -> Hits:
        hits: list[Node] = []
        # In a cycle every element inherits from all others, in no order of generality.
        if scope in self._cyclic:
            members = (
                member
                for ancestor in self.known_ancestors(scope)
                for member in self.own_members(ancestor, name)
            )
            return tuple(
                dict.fromkeys(member for member in members if member.visibility != "private")
            )
        for general in self.generals(scope):
            inherited = self._find_heritable(general, name)
            if inherited:
                hits += [hit for hit in inherited if hit not in hits]
        inheritable = self._inheritable_by_generals.get(self.all_generals(scope))
        if not hits and inheritable is not None and name not in inheritable:
            return NO_HITS
        # An implied general can redefine a member of the library, but not a member of the model.
        if not hits or any(map(is_in_library, hits)):
            for general in self._find_implied_generals(scope):
                inherited = self._find_heritable(general, name)
                if inherited:
                    hits += [hit for hit in inherited if hit not in hits]
        if len(hits) < 2:
            return tuple(hits)
        redefined = {general for hit in hits for general in self.redefined_features(hit)}
        return tuple(hit for hit in hits if hit not in redefined)

    def _find_heritable(self, general: Node, name: str) -> Hits:
        """Return the members named ``name`` that ``general`` passes on to its specialisations."""
        if name in self.symbol_table(general):
            hits = [
                member
                for member in self.own_members(general, name)
                if member.visibility != "private"
            ]
            if hits:
                return tuple(hits)
        return self.inherited(general, name) or self.imported_members(general, name, inside=False)

    def _find_replacement(self, scope: Node, hit: Node) -> Node | None:
        """Return the member of ``scope`` in place of an inherited one.

        That is the inherited member itself, a member without a name that redefines it, or None if a
        member with a name does.
        """
        for member in scope.members:
            for relation in member.relations:
                if relation.kind == "Redefinition":
                    name = relation.reference.chain[-1][-1]
                    # Comparing the last name first avoids resolving all other redefinitions.
                    if name in (hit.name, hit.short_name) or hit.name is None:
                        target = self.target(member, relation)
                        if target is hit or (target and hit in self.redefined_features(target)):
                            return None
        for member in self._find_positional_members(scope):
            if hit in self.redefined_by_position(member):
                return None if member.name else member
        return hit


def is_in_library(node: Node) -> bool:
    """Whether a library package contains ``node``."""
    owner = node.owner
    while owner is not None and owner.owner is not None:
        node, owner = owner, owner.owner
    return node.kind == "LibraryPackage"
