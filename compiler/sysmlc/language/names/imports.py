"""Import resolution: the members that namespaces import (KerML 8.2.3.5.3 and 7.2.5.4)."""

from collections.abc import Callable

from sysmlc.language.metaclasses import NAMESPACES, kinds_of
from sysmlc.language.names.members import NO_HITS, Hits, MemberLookup
from sysmlc.language.names.metadata import passes_filter
from sysmlc.language.tree import Node, Relation

_IMPORTS = kinds_of("Import")
_EXPOSES = kinds_of("Expose")


class ImportLookup(MemberLookup):
    """Memoised lookup of imported members by namespace and name."""

    def __init__(
        self, implied: Callable[[Node], tuple[Node, ...]], by_role: Callable[[Node], list[Node]]
    ) -> None:
        super().__init__(implied, by_role)
        self._imports: dict[Node, list[Node]] = {}
        self._imported: dict[tuple[Node, bool], dict[str, Hits]] = {}
        self._conditions: dict[Node, list[Node]] = {}
        self._below: dict[tuple[Node, bool], list[Node]] = {}
        self._seen: dict[tuple[Node, bool, str], Hits] = {}
        """Results of the lookup in progress: imports may form a cycle."""

    def abandon(self) -> None:
        """Reset the state of the queries that a RecursionError interrupted."""
        super().abandon()
        self._seen.clear()

    def imports(self, scope: Node) -> list[Node]:
        """Return the imports that a namespace owns."""
        cached = self._imports.get(scope)
        if cached is None:
            cached = self._imports[scope] = [
                member for member in scope.members if member.kind in _IMPORTS
            ]
        return cached

    def imported_members(self, scope: Node, name: str, *, inside: bool) -> Hits:
        """Return imported members by name; with ``inside`` false only those of public imports."""
        imports = self.imports(scope)
        if not imports:
            return NO_HITS
        key = (scope, inside)
        cached = self._imported.get(key)
        if cached is None:
            cached = self._imported[key] = {}
        hits = cached.get(name)
        if hits is not None:
            return hits
        in_progress = self._seen.get((scope, inside, name))
        if in_progress is not None:
            self.cycle_hits += 1
            return in_progress
        hits_before, is_outermost = self.cycle_hits, not self._seen
        self._seen[scope, inside, name] = NO_HITS
        hits = self._find_imported(scope, imports, name, inside)
        self._seen[scope, inside, name] = hits
        if self.cycle_hits == hits_before:
            cached[name] = hits
        # Results in progress are valid only within one outermost query.
        if is_outermost:
            self._seen.clear()
        return hits

    def _find_imported(self, scope: Node, imports: list[Node], name: str, inside: bool) -> Hits:
        hits: list[Node] = []
        for node in imports:
            if inside or node.visibility == "public":
                hits += [h for h in self._find_in_import(node, name) if h not in hits]
        if not hits:
            return NO_HITS
        conditions = self._conditions.get(scope)
        if conditions is None:
            conditions = [
                member for member in scope.members if member.membership == "ElementFilterMembership"
            ]
            self._conditions[scope] = conditions
        return tuple(hit for hit in hits if all(passes_filter(c, hit, self) for c in conditions))

    def _find_in_import(self, node: Node, name: str) -> Hits:
        """Return the members by name that one import brings."""
        for member in node.members:
            if member.kind == "Package":
                return self.visible_outside(member, name)
        for relation in node.relations:
            if relation.kind == "importedMembership":
                return self._find_in_membership_import(node, relation, name)
            if relation.kind == "importedNamespace":
                return self._find_in_namespace_import(node, self.target(node, relation), name)
        return NO_HITS

    def _find_in_membership_import(self, node: Node, relation: Relation, name: str) -> Hits:
        hit = self.target(node, relation)
        if hit is None:
            return NO_HITS
        names = (
            (hit.name, hit.short_name)
            if hit.name or hit.short_name
            else (relation.reference.chain[-1][-1],)
        )
        if name in names:
            return (hit,)
        if node.attributes.get("isRecursive"):
            return self._find_in_namespace_import(node, self.resolve_alias(hit), name)
        return NO_HITS

    def _find_in_namespace_import(self, node: Node, scope: Node | None, name: str) -> Hits:
        if scope is None:
            return NO_HITS
        everything = node.kind in _EXPOSES or bool(node.attributes.get("isImportAll"))
        hits = (
            tuple(self.iter_visible_inside(scope, name))
            if everything
            else self.visible_outside(scope, name)
        )
        # A recursive import searches nested namespaces only for names that the first one lacks.
        if hits or not node.attributes.get("isRecursive"):
            return hits
        for nested in self._list_nested_namespaces(scope, everything):
            hits = (
                self.own_members(nested, name) if everything else self.visible_outside(nested, name)
            )
            if hits:
                return hits
        return NO_HITS

    def _list_nested_namespaces(self, scope: Node, everything: bool) -> list[Node]:
        """Return the namespaces below ``scope`` that a recursive import searches, owners first."""
        nested = self._below.get((scope, everything))
        if nested is None:
            nested = self._below[scope, everything] = []
            worklist = [scope]
            while worklist:
                node = worklist.pop()
                if node is not scope:
                    nested.append(node)
                worklist += [
                    member
                    for member in reversed(node.members)
                    if member.kind in NAMESPACES
                    and (everything or member.visibility in ("", "public"))
                ]
        return nested
