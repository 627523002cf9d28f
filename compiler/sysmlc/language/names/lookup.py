"""Looking names up: what a namespace owns, inherits and imports (KerML 8.2.3.5)."""

from collections.abc import Callable, Iterable, Iterator

from sysmlc.language.metaclasses import kinds_of
from sysmlc.language.names import contexts, positions, results
from sysmlc.language.names.contents import NAMESPACES, TYPES, Owned, naming, owned
from sysmlc.language.names.filters import passes
from sysmlc.language.tree import Node, Reference, Relation

Hits = tuple[Node, ...]
"""Members found by one name, the nearest first; an alias is its Membership node."""
_NONE: Hits = ()
_IMPORTS = kinds_of("Import")
_EXPOSES = kinds_of("Expose")
GENERAL = kinds_of("Specialization") | {"Conjugation", "FeatureChaining"}
"""Relations whose target gives its members to the node that has them."""


class Lookup:
    """Finds what names lead to, each once; ``roots`` gives the members of the global scope.

    ``implied`` gives the elements that a type specialises though the text does not say so,
    ``by_role`` those that a member redefines because of its membership, ``text`` the text of
    the document with a root.
    References that are being looked up already lead nowhere meanwhile: what was found while one
    was cut is not remembered, so cycles end and change no other answer.
    """

    def __init__(
        self,
        roots: Callable[[str], Hits],
        implied: Callable[[Node], list[Node]],
        by_role: Callable[[Node], list[Node]],
        text: Callable[[Node], str],
    ) -> None:
        self._roots = roots
        self._implied = implied
        self._by_role = by_role
        self._text = text
        self.cycles: list[Node] = []
        """Elements that specialise themselves, one of each circle."""
        self._cyclic: set[Node] = set()
        self._pointed: set[Node] = set()
        self._owned: dict[Node, Owned] = {}
        self._generals: dict[Node, list[Node]] = {}
        self._inherited: dict[Node, dict[str, Hits]] = {}
        self._imports: dict[Node, list[Node]] = {}
        self._imported: dict[tuple[Node, bool], dict[str, Hits]] = {}
        self._conditions: dict[Node, list[Node]] = {}
        self._active: set[Reference] = set()
        self._inheriting: set[Node] = set()
        self._importing: set[tuple[Node, bool]] = set()
        self._silently: dict[Node, list[Node]] = {}
        self._redefining: dict[Node, list[Node]] = {}
        self._positions: dict[Node, list[Node]] = {}
        self._at_positions: dict[tuple[Node, str], list[Node]] = {}
        self.cuts = 0

    # References

    def target(self, node: Node, relation: Relation) -> Node | None:
        """The element that a relation of ``node`` leads to; None when a name leads nowhere.

        The target of ``importedMembership`` may be the Membership node of an alias.
        """
        reference = relation.reference
        if reference.targets is not None:
            return reference.target
        if reference in self._active:
            self.cuts += 1
            return None
        before = self.cuts
        self._active.add(reference)
        targets = self._follow(node, relation)
        self._active.discard(reference)
        if len(targets) == len(reference.chain) or self.cuts == before or not self._active:
            reference.targets = targets
        return targets[-1] if len(targets) == len(reference.chain) else None

    def _follow(self, node: Node, relation: Relation) -> list[Node]:
        """The element of each link of the chain, as far as they are found."""
        reference = relation.reference
        wanted = contexts.WANTED.get(relation.kind)
        last = len(reference.chain) - 1
        start = contexts.start(node, relation)
        found: list[Node] = []
        for index, names in enumerate(reference.chain):
            kinds = wanted if index == last else contexts.WANTED["Subsetting"]
            if index or start.before is not None:
                scope = found[-1] if index else self._link(node, start.before)
                hit = self.descend(scope, names, 0, kinds) if scope else None
            elif start.operand is not None:
                scope = results.result(start.operand, self)
                hit = self.descend(scope, names, 0, kinds) if scope else None
            else:
                hit = self.search(start, names, kinds)
            if hit is None:
                break
            imported = relation.kind == "importedMembership"
            element = hit if imported and index == last else self.element(hit)
            if element is None:
                break
            found.append(element)
        return found

    def _link(self, node: Node, relation: Relation | None) -> Node | None:
        return self.target(node, relation) if relation is not None else None

    def element(self, hit: Node) -> Node | None:
        """What a member stands for: the element of an alias, else the member itself."""
        if hit.kind != "Membership":
            return hit
        return next((self.target(hit, r) for r in hit.relations if r.kind == "Membership"), None)

    # Names

    def search(
        self, start: contexts.Start, names: tuple[str, ...], kinds: frozenset[str] | None
    ) -> Node | None:
        """The member that a qualified name leads to from a scope, outwards."""
        first, scope, inherited = names[0], start.scope, start.inherited
        if first == "$" and len(names) > 1 and not self._is_quoted(start):
            return self.among(self._roots(names[1]), names, 1, kinds)
        while scope is not None:
            stages: Iterable[Hits]
            if inherited and scope.kind in TYPES:
                stages = (self._general_hits(scope, first),)
            else:
                stages = self._stages(scope, first, start.without)
            inherited = False
            for hits in stages:
                found = self.among(hits, names, 0, kinds, start.everything)
                if found is not None:
                    return found
                if len(names) > 1 and any(map(self._is_namespace, hits)):
                    return None
            scope = contexts.outer(scope)
        return self.among(self._roots(first), names, 0, kinds)

    def descend(
        self,
        scope: Node,
        names: tuple[str, ...],
        index: int,
        kinds: frozenset[str] | None,
        everything: bool = False,
    ) -> Node | None:
        """The member that the names from ``index`` on lead to, from outside of ``scope``.

        ``everything``: private and protected members too, as ``import all`` sees them.
        """
        name = names[index]
        hits = tuple(self.inside(scope, name)) if everything else self.visible(scope, name)
        return self.among(hits, names, index, kinds, everything)

    def among(
        self,
        hits: Hits,
        names: tuple[str, ...],
        index: int,
        kinds: frozenset[str] | None,
        everything: bool = False,
    ) -> Node | None:
        """The member that the names after ``index`` lead to from the first hit where they do."""
        for hit in hits:
            found = self._take(hit, names, index, kinds, everything)
            if found is not None:
                return found
        return None

    def _take(
        self,
        hit: Node,
        names: tuple[str, ...],
        index: int,
        kinds: frozenset[str] | None,
        everything: bool,
    ) -> Node | None:
        """``hit`` when it ends the name and is of a wanted kind, else what lies further in it."""
        element = self.element(hit)
        if element is None:
            return None
        if index + 1 == len(names):
            return hit if kinds is None or element.kind in kinds else None
        return self.descend(element, names, index + 1, kinds, everything)

    def _is_quoted(self, start: contexts.Start) -> bool:
        """Whether ``$`` is a name in quotes: the reference is longer than its names."""
        reference = start.reference
        if reference is None or reference.start < 0 or start.scope is None:
            return False
        root = start.scope
        while root.owner is not None:
            root = root.owner
        return self._text(root)[reference.start : reference.start + 1] == "'"

    def _is_namespace(self, hit: Node) -> bool:
        element = self.element(hit)
        return element is not None and element.kind in NAMESPACES

    # Members of one namespace

    def owned(self, scope: Node) -> Owned:
        """What ``scope`` owns, by name."""
        index = self._owned.get(scope)
        if index is None:
            index = self._owned[scope] = owned(scope)
        return index

    def own(self, scope: Node, name: str) -> Hits:
        """The members by one name that ``scope`` owns; a nameless one needs what names it."""
        hits = self.owned(scope).get(name)
        if hits is None:
            return _NONE
        return tuple([hit for hit in hits if hit.name or hit.short or self._is_named(hit)])

    def _is_named(self, feature: Node) -> bool:
        reference = naming(feature)
        relation = next((r for r in feature.relations if r.reference is reference), None)
        return relation is None or self.target(feature, relation) is not None

    def _stages(self, scope: Node, name: str, without: Node | None) -> Iterator[Hits]:
        """Members by one name as seen from inside: all own ones, inherited, imported ones."""
        hits = self.owned(scope).get(name)
        if hits is not None:
            if without in hits and without is not None and name not in (without.name, without.short):
                hits = [hit for hit in hits if hit is not without]
            yield tuple([hit for hit in hits if hit.name or hit.short or self._is_named(hit)])
        if scope.kind in TYPES:
            yield self.inherited(scope, name)
        yield self.imported(scope, name, inside=True)

    def inside(self, scope: Node, name: str) -> Iterator[Node]:
        """Members by one name as seen from inside: all own ones, inherited, imported."""
        for hits in self._stages(scope, name, None):
            yield from hits

    def visible(self, scope: Node, name: str) -> Hits:
        """Members by one name as seen from outside: public own ones, inherited, imported."""
        hits = [h for h in self.own(scope, name) if h.visibility in ("", "public")]
        if not hits and scope.kind in TYPES:
            hits += [h for h in self.inherited(scope, name) if h.visibility != "protected"]
        if not hits:
            hits += self.imported(scope, name, inside=False)
        return tuple(hits)

    def inherited(self, scope: Node, name: str) -> Hits:
        """Members by one name that a type inherits, without those that it redefines."""
        memo = self._inherited.get(scope)
        if memo is None:
            memo = self._inherited[scope] = {}
        hits = memo.get(name)
        if hits is not None:
            return hits
        if scope in self._inheriting:
            self.cuts += 1
            return _NONE
        before = self.cuts
        self._inheriting.add(scope)
        hits = self._general_hits(scope, name)
        if hits:
            left = (self._instead(scope, hit) for hit in hits)
            hits = tuple(dict.fromkeys(hit for hit in left if hit is not None))
        self._inheriting.discard(scope)
        if self.cuts == before:
            memo[name] = hits
        return hits

    def _general_hits(self, scope: Node, name: str) -> Hits:
        hits: list[Node] = []
        if scope in self._cyclic:
            all_own = (h for g in self._reached(scope) for h in self.own(g, name))
            return tuple(dict.fromkeys(h for h in all_own if h.visibility != "private"))
        for general in self.generals(scope):
            found = self._heritable(general, name)
            if found:
                hits += [hit for hit in found if hit not in hits]
        if not hits or any(map(_is_of_library, hits)):
            for general in self._silent_generals(scope):
                found = self._heritable(general, name)
                if found:
                    hits += [hit for hit in found if hit not in hits]
        return tuple(hits) if len(hits) < 2 else self._most_special(hits)

    def _heritable(self, general: Node, name: str) -> Hits:
        """Members by one name that ``general`` gives to what specialises it."""
        index = self._owned.get(general)
        if index is None:
            index = self.owned(general)
        if name in index:
            hits = [h for h in self.own(general, name) if h.visibility != "private"]
            if hits:
                return tuple(hits)
        memo = self._inherited.get(general)
        found = memo.get(name) if memo is not None else None
        if found is None:
            found = self.inherited(general, name)
        return found or (
            self.imported(general, name, inside=False) if self.imports(general) else _NONE
        )

    def _most_special(self, hits: list[Node]) -> Hits:
        """Without the members that others of them redefine."""
        redefined = {general for hit in hits for general in self.redefined(hit)}
        return tuple(hit for hit in hits if hit not in redefined)

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

    def _instead(self, scope: Node, hit: Node) -> Node | None:
        """What ``scope`` has instead of an inherited member: the member itself, what redefines it
        without a name of its own, or nothing."""
        for member in scope.members:
            for relation in member.relations:
                if relation.kind == "Redefinition" and not relation.implied:
                    name = relation.reference.chain[-1][-1]
                    if name in (hit.name, hit.short) or hit.name is None:
                        target = self.target(member, relation)
                        if target is hit or (target and hit in self.redefined(target)):
                            return None
        for member in self._silent(scope):
            if hit in self.by_position(member):
                return None if member.name else member
        return hit

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
                return []
            before = self.cuts
            self._positions[feature] = []
            known = positions.redefined(feature, self) or self._by_role(feature)
            if self.cuts == before:
                self._positions[feature] = known
            else:
                del self._positions[feature]
        return known

    def at_positions(self, scope: Node, role: str) -> list[Node]:
        """The features of a type with one role by position, own ones before inherited ones."""
        key = (scope, role)
        known = self._at_positions.get(key)
        if known is None:
            before = self.cuts
            self._at_positions[key] = []
            known = positions.gather(scope, role, self)
            if self.cuts == before:
                self._at_positions[key] = known
            else:
                del self._at_positions[key]
        return known

    def all_generals(self, node: Node) -> list[Node]:
        """What ``node`` specialises as the text says and what it may implicitly."""
        return [*self.generals(node), *self._silent_generals(node)]

    def _silent_generals(self, node: Node) -> list[Node]:
        known = self._silently.get(node)
        if known is None:
            before = self.cuts
            value = results.of_value(node, self) if not self.generals(node) else None
            known = [*self.by_position(node), *self._implied(node)]
            known = [value, *known] if value is not None and value is not node else known
            if self.cuts == before:
                self._silently[node] = known
        return known

    def generals(self, node: Node) -> list[Node]:
        """What ``node`` specialises as the text says: types, subsetted, redefined features ..."""
        known = self._generals.get(node)
        if known is not None:
            return known
        before = self.cuts
        found: list[Node] = []
        links: list[Node] = []
        for relation in node.relations:
            if not relation.implied and (
                relation.kind in GENERAL
                or (relation.kind == "Membership" and node.kind in contexts.INSTANTIATIONS)
            ):
                target = self.target(node, relation)
                if target is not None and target not in found:
                    if relation.kind == "FeatureChaining":
                        found = [one for one in found if one not in links]
                        links.append(target)
                    found.append(target)
        if self.cuts == before:
            self._generals[node] = found
            if node in self._pointed:
                self._find_cycle(node)
            self._pointed.update(found)
        return found

    def _find_cycle(self, node: Node) -> None:
        """Note when ``node`` specialises itself: those in a circle inherit all of each other."""
        back = {one for one in self._reached(node) if node in self._reached(one)}
        if back:
            self.cycles.append(node)
            self._cyclic |= back | {node}

    def _reached(self, node: Node) -> list[Node]:
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

    # Imports

    def imports(self, scope: Node) -> list[Node]:
        """The imports that a namespace owns."""
        known = self._imports.get(scope)
        if known is None:
            known = self._imports[scope] = [m for m in scope.members if m.kind in _IMPORTS]
        return known

    def imported(self, scope: Node, name: str, *, inside: bool) -> Hits:
        """Members by one name that a namespace imports; from outside the public ones."""
        imports = self.imports(scope)
        if not imports:
            return _NONE
        key = (scope, inside)
        memo = self._imported.get(key)
        if memo is None:
            memo = self._imported[key] = {}
        hits = memo.get(name)
        if hits is not None:
            return hits
        if key in self._importing:
            self.cuts += 1
            return _NONE
        before, first = self.cuts, not self._importing
        self._importing.add(key)
        hits = self._gather(scope, imports, name, inside)
        self._importing.discard(key)
        if self.cuts == before or (first and not self._active):
            memo[name] = hits
        return hits

    def _gather(self, scope: Node, imports: list[Node], name: str, inside: bool) -> Hits:
        found: list[Node] = []
        for node in imports:
            if inside or node.visibility == "public":
                found += [h for h in self._brought(node, name) if h not in found]
        if not found:
            return _NONE
        conditions = self._conditions.get(scope)
        if conditions is None:
            conditions = [m for m in scope.members if m.membership == "ElementFilterMembership"]
            self._conditions[scope] = conditions
        return tuple(h for h in found if all(passes(c, h, self) for c in conditions))

    def _brought(self, node: Node, name: str) -> Hits:
        """Members by one name that one import brings."""
        for member in node.members:
            if member.kind == "Package":
                return self.visible(member, name)
        for relation in node.relations:
            if relation.kind == "importedMembership":
                return self._one(node, relation, name)
            if relation.kind == "importedNamespace":
                return self._many(node, self.target(node, relation), name)
        return _NONE

    def _one(self, node: Node, relation: Relation, name: str) -> Hits:
        hit = self.target(node, relation)
        if hit is None:
            return _NONE
        names = (hit.name, hit.short) if hit.name or hit.short else (relation.reference.chain[-1][-1],)
        if name in names:
            return (hit,)
        if node.facts.get("isRecursive"):
            return self._many(node, self.element(hit), name)
        return _NONE

    def _many(self, node: Node, scope: Node | None, name: str) -> Hits:
        if scope is None:
            return _NONE
        everything = node.kind in _EXPOSES or bool(node.facts.get("isImportAll"))
        hits = tuple(self.inside(scope, name)) if everything else self.visible(scope, name)
        if hits or not node.facts.get("isRecursive"):
            return hits
        for nested in self._nested(scope, everything):
            hits = self.own(nested, name) if everything else self.visible(nested, name)
            if hits:
                return hits
        return _NONE

    def _nested(self, scope: Node, everything: bool) -> Iterator[Node]:
        """The namespaces below ``scope`` that a recursive import searches."""
        for member in scope.members:
            if member.kind in NAMESPACES and (everything or member.visibility in ("", "public")):
                yield member
                yield from self._nested(member, everything)


def _is_of_library(node: Node) -> bool:
    """Whether a member is of a library package: what is implied may give a more special one."""
    owner = node.owner
    while owner is not None and owner.owner is not None:
        node, owner = owner, owner.owner
    return node.kind == "LibraryPackage"
