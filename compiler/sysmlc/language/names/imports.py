"""What namespaces import (KerML 8.2.3.5.3 and 7.2.5.4)."""

from collections.abc import Callable

from sysmlc.language.metaclasses import kinds_of
from sysmlc.language.names.members import NONE, Hits, Members
from sysmlc.language.names.metadata import passes
from sysmlc.language.names.symbols import NAMESPACES
from sysmlc.language.tree import Node, Relation

_IMPORTS = kinds_of("Import")
_EXPOSES = kinds_of("Expose")


class Imports(Members):
    """Imported members, each name looked up once for each namespace."""

    def __init__(
        self, implied: Callable[[Node], tuple[Node, ...]], by_role: Callable[[Node], list[Node]]
    ) -> None:
        super().__init__(implied, by_role)
        self._imports: dict[Node, list[Node]] = {}
        self._imported: dict[tuple[Node, bool], dict[str, Hits]] = {}
        self._conditions: dict[Node, list[Node]] = {}
        self._below: dict[tuple[Node, bool], list[Node]] = {}
        self._seen: dict[tuple[Node, bool, str], Hits] = {}
        """What one question has passed through already: imports may go in circles."""

    def abandon(self) -> None:
        """Give up what is being looked for, after an error in the midst of it."""
        super().abandon()
        self._seen.clear()

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
            return NONE
        key = (scope, inside)
        memo = self._imported.get(key)
        if memo is None:
            memo = self._imported[key] = {}
        hits = memo.get(name)
        if hits is not None:
            return hits
        seen = self._seen.get((scope, inside, name))
        if seen is not None:
            self.cuts += 1
            return seen
        before, outermost = self.cuts, not self._seen
        self._seen[scope, inside, name] = NONE
        hits = self._gather(scope, imports, name, inside)
        self._seen[scope, inside, name] = hits
        if self.cuts == before:
            memo[name] = hits
        if outermost:
            self._seen.clear()
        return hits

    def _gather(self, scope: Node, imports: list[Node], name: str, inside: bool) -> Hits:
        found: list[Node] = []
        for node in imports:
            if inside or node.visibility == "public":
                found += [h for h in self._brought(node, name) if h not in found]
        if not found:
            return NONE
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
        return NONE

    def _one(self, node: Node, relation: Relation, name: str) -> Hits:
        hit = self.target(node, relation)
        if hit is None:
            return NONE
        names = (
            (hit.name, hit.short_name)
            if hit.name or hit.short_name
            else (relation.reference.chain[-1][-1],)
        )
        if name in names:
            return (hit,)
        if node.attributes.get("isRecursive"):
            return self._many(node, self.element(hit), name)
        return NONE

    def _many(self, node: Node, scope: Node | None, name: str) -> Hits:
        if scope is None:
            return NONE
        everything = node.kind in _EXPOSES or bool(node.attributes.get("isImportAll"))
        hits = tuple(self.inside(scope, name)) if everything else self.visible(scope, name)
        if hits or not node.attributes.get("isRecursive"):
            return hits
        for nested in self._nested(scope, everything):
            hits = self.own_members(nested, name) if everything else self.visible(nested, name)
            if hits:
                return hits
        return NONE

    def _nested(self, scope: Node, everything: bool) -> list[Node]:
        """The namespaces below ``scope`` that a recursive import searches, owners first."""
        known = self._below.get((scope, everything))
        if known is None:
            known = self._below[scope, everything] = []
            waiting = [scope]
            while waiting:
                node = waiting.pop()
                if node is not scope:
                    known.append(node)
                waiting += [
                    member
                    for member in reversed(node.members)
                    if member.kind in NAMESPACES
                    and (everything or member.visibility in ("", "public"))
                ]
        return known
