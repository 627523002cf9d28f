"""Looking names up: where each reference of a model leads (KerML 8.2.3.5)."""

from collections.abc import Callable, Iterable

from sysmlc.language.names import contexts
from sysmlc.language.names import expression_results as results
from sysmlc.language.names.imports import Imports
from sysmlc.language.names.members import Hits
from sysmlc.language.names.symbols import NAMESPACES, TYPES
from sysmlc.language.tree import Node, Reference, Relation

_MOST = 2_000
"""Circles that a name may be looked for in; behind those it is known as lost. Namesakes that each
specialise what lies in all of them lead to one another in more ways than can be tried."""


class Lookup(Imports):
    """Finds what names lead to, each once; ``roots`` gives the members of the global scope.

    ``implied`` gives the elements that a type specialises though the text does not say so,
    ``by_role`` those that a member redefines because of its membership, ``text`` the text of
    the document with a root.
    """

    def __init__(
        self,
        roots: Callable[[str], Hits],
        implied: Callable[[Node], tuple[Node, ...]],
        by_role: Callable[[Node], list[Node]],
        text: Callable[[Node], str],
    ) -> None:
        super().__init__(implied, by_role)
        self._roots = roots
        self._text = text
        self.given_up: set[Reference] = set()
        """References that were looked for in more circles than may be followed."""

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
        is_whole, cuts = len(targets) == len(reference.chain), self.cuts - before
        if not is_whole and cuts > _MOST:
            self.given_up.add(reference)
        if is_whole or not self._active or not 0 < cuts <= _MOST:
            reference.set_targets(targets)
        return targets[-1] if is_whole else None

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

    def search(
        self, start: contexts.Start, names: tuple[str, ...], kinds: frozenset[str] | None
    ) -> Node | None:
        """The member that a qualified name leads to from a scope, outwards."""
        first, scope = names[0], start.scope
        if first == "$" and len(names) > 1 and not self._is_quoted(start):
            return self.among(self._roots(names[1]), names, 1, kinds)
        while scope is not None:
            for hits in self._stages_of(start, scope, first):
                if start.past_subjects:
                    hits = tuple(hit for hit in hits if hit.membership != "SubjectMembership")
                if hits:
                    found = self.among(hits, names, 0, kinds, start.everything)
                    if found is not None:
                        return found
                    if len(names) > 1 and any(map(self._is_namespace, hits)):
                        return None
            scope = contexts.outer(scope)
        found = self.among(self._roots(first), names, 0, kinds)
        for importing in start.importing if found is None else ():
            hits = self.imported(importing, first, inside=True)
            found = found or self.among(hits, names, 0, kinds, start.everything)
        return found

    def _stages_of(self, start: contexts.Start, scope: Node, name: str) -> Iterable[Hits]:
        """Members by one name in a scope, as far as a search looks at them there."""
        if scope in start.importing:
            return self._without_imports(scope, name)
        if scope is start.scope and scope.kind in TYPES:
            if start.inherited:
                return (self._general_hits(scope, name),)
            if start.is_metadata:
                return self._without_implied(scope, name)
        return self._stages(scope, name, start.without)

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
        element = hit if hit.kind != "Membership" else self.element(hit)
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
