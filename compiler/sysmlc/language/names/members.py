"""The members of one namespace by name: what it owns, what it inherits (KerML 8.2.3.5.3)."""

from abc import abstractmethod
from collections.abc import Callable, Iterator

from sysmlc.language.names.generals import Generals
from sysmlc.language.names.symbols import TYPES, Owned, naming, owned
from sysmlc.language.tree import Node

Hits = tuple[Node, ...]
"""Members found by one name, the nearest first; an alias is its Membership node."""
NONE: Hits = ()


class Members(Generals):
    """Members of namespaces, each name looked up once."""

    def __init__(
        self, implied: Callable[[Node], tuple[Node, ...]], by_role: Callable[[Node], list[Node]]
    ) -> None:
        super().__init__(implied, by_role)
        self._owned: dict[Node, Owned] = {}
        self._inherited: dict[Node, dict[str, Hits]] = {}
        self._inheriting: set[Node] = set()
        self._inheritable: dict[Node, frozenset[str] | None] = {}
        self._names_of: dict[tuple[Node, ...], frozenset[str] | None] = {}
        self._names_above: dict[Node, frozenset[str]] = {}

    def abandon(self) -> None:
        """Give up what is being looked for, after an error in the midst of it."""
        super().abandon()
        self._inheriting.clear()

    @abstractmethod
    def imports(self, scope: Node) -> list[Node]:
        """The imports that a namespace owns."""

    @abstractmethod
    def imported(self, scope: Node, name: str, *, inside: bool) -> Hits:
        """Members by one name that a namespace imports; from outside the public ones."""

    def owned(self, scope: Node) -> Owned:
        """What ``scope`` owns, by name."""
        index = self._owned.get(scope)
        if index is None:
            index = self._owned[scope] = owned(scope)
        return index

    def own_members(self, scope: Node, name: str) -> Hits:
        """The members by one name that ``scope`` owns; a nameless one needs what names it."""
        hits = self.owned(scope).get(name)
        if hits is None:
            return NONE
        return tuple([hit for hit in hits if hit.name or hit.short_name or self._is_named(hit)])

    def _is_named(self, feature: Node) -> bool:
        reference = naming(feature)
        relation = next((r for r in feature.relations if r.reference is reference), None)
        return relation is None or self.target(feature, relation) is not None

    def _stages(self, scope: Node, name: str, without: Node | None) -> Iterator[Hits]:
        """Members by one name as seen from inside: all own ones, inherited, imported ones."""
        hits = self.owned(scope).get(name)
        if hits is not None:
            if (
                without in hits
                and without is not None
                and name not in (without.name, without.short_name)
            ):
                hits = [hit for hit in hits if hit is not without]
            yield tuple([hit for hit in hits if hit.name or hit.short_name or self._is_named(hit)])
        if scope.kind in TYPES:
            yield self.inherited(scope, name)
        if self.imports(scope):
            yield self.imported(scope, name, inside=True)

    def _without_imports(self, scope: Node, name: str) -> Iterator[Hits]:
        """All own members by one name, and inherited ones."""
        yield self.own_members(scope, name)
        if scope.kind in TYPES:
            yield self.inherited(scope, name)

    def _without_implied(self, scope: Node, name: str) -> Iterator[Hits]:
        """Members by one name, inherited ones only of what the text says that a type is."""
        yield self.own_members(scope, name)
        for general in self.generals(scope):
            yield self._heritable(general, name)
        yield self.imported(scope, name, inside=True)

    def inside(self, scope: Node, name: str) -> Iterator[Node]:
        """Members by one name as seen from inside: all own ones, inherited, imported."""
        for hits in self._stages(scope, name, None):
            yield from hits

    def visible(self, scope: Node, name: str) -> Hits:
        """Members by one name as seen from outside: public own ones, inherited, imported."""
        hits = [h for h in self.own_members(scope, name) if h.visibility in ("", "public")]
        if not hits and scope.kind in TYPES:
            hits += [h for h in self.inherited(scope, name) if h.visibility != "protected"]
        if not hits:
            hits += self.imported(scope, name, inside=False)
        return tuple(hits)

    def inherited(self, scope: Node, name: str) -> Hits:
        """Members by one name that a type inherits, without those that it redefines."""
        names = self._inheritable.get(scope)
        if names is not None and name not in names:
            return NONE
        memo = self._inherited.get(scope)
        if memo is None:
            memo = self._inherited[scope] = {}
        hits = memo.get(name)
        if hits is not None:
            return hits
        if scope in self._inheriting:
            self.cuts += 1
            return NONE
        before = self.cuts
        self._inheriting.add(scope)
        hits = self._general_hits(scope, name)
        if hits:
            left = (self._instead(scope, hit) for hit in hits)
            hits = tuple(dict.fromkeys(hit for hit in left if hit is not None))
        self._inheriting.discard(scope)
        if self.cuts == before:
            memo[name] = hits
            if not hits and scope not in self._inheritable:
                self._inheritable[scope] = self._learnt(scope)
        return hits

    def _learnt(self, scope: Node) -> frozenset[str] | None:
        """The names of all that ``scope`` may inherit, found when all was searched in vain.

        None where generals import some, are not known for good, or lead in a circle.
        """
        key = self.all_generals(scope)
        if key not in self._names_of:
            each = [self._names_from(general, {}) for general in key]
            known = [names for names in each if names is not None]
            whole = len(known) == len(each)
            self._names_of[key] = frozenset().union(*known) if whole else None
        return self._names_of[key]

    def _names_from(self, general: Node, below: dict[Node, None]) -> frozenset[str] | None:
        """The names that ``general`` owns or inherits; ``below`` are those that asked for it."""
        names = self._names_above.get(general)
        if names is not None:
            return names
        written, silent = self._generals.get(general), self._silently.get(general)
        if written is None or silent is None or general in below:
            return None
        if any(one.visibility == "public" for one in self.imports(general)):
            return None
        below[general] = None
        found = set(self.owned(general))
        for one in (*written, *silent):
            inherited = self._names_from(one, below)
            if inherited is None:
                return None
            found |= inherited
        del below[general]
        names = self._names_above[general] = frozenset(found)
        return names

    def _general_hits(self, scope: Node, name: str) -> Hits:
        hits: list[Node] = []
        if scope in self._cyclic:
            all_own = (h for g in self.reached(scope) for h in self.own_members(g, name))
            return tuple(dict.fromkeys(h for h in all_own if h.visibility != "private"))
        for general in self.generals(scope):
            found = self._heritable(general, name)
            if found:
                hits += [hit for hit in found if hit not in hits]
        if not hits and not self._may_inherit(scope, name):
            return NONE
        if not hits or any(map(is_of_library, hits)):
            for general in self._silent_generals(scope):
                found = self._heritable(general, name)
                if found:
                    hits += [hit for hit in found if hit not in hits]
        return tuple(hits) if len(hits) < 2 else self._most_special(hits)

    def _may_inherit(self, scope: Node, name: str) -> bool:
        """Whether some general of a type has a name, as far as is known from what has the same."""
        names = self._names_of.get(self.all_generals(scope))
        return names is None or name in names

    def _heritable(self, general: Node, name: str) -> Hits:
        """Members by one name that ``general`` gives to what specialises it."""
        index = self._owned.get(general)
        if index is None:
            index = self.owned(general)
        if name in index:
            hits = [h for h in self.own_members(general, name) if h.visibility != "private"]
            if hits:
                return tuple(hits)
        memo = self._inherited.get(general)
        found = memo.get(name) if memo is not None else None
        if found is None:
            found = self.inherited(general, name)
        return found or (
            self.imported(general, name, inside=False) if self.imports(general) else NONE
        )

    def _most_special(self, hits: list[Node]) -> Hits:
        """Without the members that others of them redefine."""
        redefined = {general for hit in hits for general in self.redefined(hit)}
        return tuple(hit for hit in hits if hit not in redefined)

    def _instead(self, scope: Node, hit: Node) -> Node | None:
        """What ``scope`` has instead of an inherited member: the member itself, what redefines it
        without a name of its own, or nothing."""
        for member in scope.members:
            for relation in member.relations:
                if relation.kind == "Redefinition":
                    name = relation.reference.chain[-1][-1]
                    if name in (hit.name, hit.short_name) or hit.name is None:
                        target = self.target(member, relation)
                        if target is hit or (target and hit in self.redefined(target)):
                            return None
        for member in self._silent(scope):
            if hit in self.by_position(member):
                return None if member.name else member
        return hit


def is_of_library(node: Node) -> bool:
    """Whether a member is of a library package: what is implied may give a more special one."""
    owner = node.owner
    while owner is not None and owner.owner is not None:
        node, owner = owner, owner.owner
    return node.kind == "LibraryPackage"
