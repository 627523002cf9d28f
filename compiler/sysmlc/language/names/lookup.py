"""Name lookup: the elements that the references of a model lead to (KerML 8.2.3.5).

The lookup includes members that namespaces import (KerML 8.2.3.5.3 and 7.2.5.4).
"""

from collections.abc import Callable, Iterable

from sysmlc.language.metaclasses import NAMESPACES, TYPES, kinds_of
from sysmlc.language.names import contexts
from sysmlc.language.names.expression_results import find_result
from sysmlc.language.names.members import NO_HITS, Hits, MemberLookup
from sysmlc.language.names.metadata import passes_filter
from sysmlc.language.tree import Node, Reference, Relation, find_root

_IMPORTS = kinds_of("Import")
_EXPOSES = kinds_of("Expose")
Kinds = frozenset[str] | None
"""Metaclasses that the element may have; None for any."""


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

    def list_imported_namespaces(self, scopes: list[Node]) -> list[Node]:
        """Return the namespaces that the scopes import, and those that these import publicly."""
        namespaces: dict[Node, None] = {}
        worklist = [import_ for scope in scopes for import_ in self.imports(scope)]
        while worklist:
            import_ = worklist.pop(0)
            for relation in import_.relations:
                target = self.target(import_, relation)
                if relation.kind == "importedNamespace" and target and target not in namespaces:
                    namespaces[target] = None
                    worklist += [
                        nested for nested in self.imports(target) if nested.visibility != "private"
                    ]
        return list(namespaces)

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
            if inside or node.visibility in ("", "public"):
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
        hits = (hit,) if name in names else NO_HITS
        if node.attributes.get("isRecursive"):
            hits += self._find_in_namespace_import(node, self.resolve_alias(hit), name)
        return hits

    def _find_in_namespace_import(self, node: Node, scope: Node | None, name: str) -> Hits:
        if scope is None:
            return NO_HITS
        everything = node.kind in _EXPOSES or bool(node.attributes.get("isImportAll"))
        hits = (
            tuple(self.iter_visible_inside(scope, name))
            if everything
            else self.visible_outside(scope, name)
        )
        if node.attributes.get("isRecursive"):
            # The package 'Motor' does not hide the type 'Motor' in it, so that all count.
            for nested in self._list_nested_namespaces(scope, everything):
                hits += (
                    self.own_members(nested, name)
                    if everything
                    else self.visible_outside(nested, name)
                )
        return hits

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


_MAX_CYCLES = 2_000
"""Cycles hit by the lookup of one name before it is given up. Namesakes that each specialise what
lies in all of them lead to one another in exponentially many ways."""


class Lookup(ImportLookup):
    """Memoised lookup of references; the result is stored in the reference.

    ``find_roots`` returns the members of the global scope by name, ``implied`` the elements that a
    type may implicitly specialise, ``by_role`` those that a member redefines because of its
    membership, and ``text`` the text of the document with a root.
    """

    def __init__(
        self,
        find_roots: Callable[[str], Hits],
        implied: Callable[[Node], tuple[Node, ...]],
        by_role: Callable[[Node], list[Node]],
        text: Callable[[Node], str],
    ) -> None:
        super().__init__(implied, by_role)
        self._find_roots = find_roots
        self._text = text
        self.circular_references: set[Reference] = set()
        """References whose lookup hit too many cycles."""
        self.hidden_references: dict[Reference, Node] = {}
        """Users of references whose first name has a nearer meaning that lacks the next name."""

    def target(self, node: Node, relation: Relation) -> Node | None:
        """Return the element that a relation of ``node`` leads to, or None if it is unresolved.

        The target of ``importedMembership`` may be the Membership node of an alias.
        """
        reference = relation.reference
        if reference.targets is not None:
            return reference.target
        if reference in self._active:
            self.cycle_hits += 1
            return None
        hits_before = self.cycle_hits
        self._active.add(reference)
        targets = self._resolve_chain(node, relation)
        self._active.discard(reference)
        is_resolved, new_hits = len(targets) == len(reference.chain), self.cycle_hits - hits_before
        if not is_resolved and new_hits > _MAX_CYCLES:
            # Memoise the failure, because each further try would take as long.
            self.circular_references.add(reference)
        # A lookup that failed because of a cycle may succeed later, unless it is the outermost one.
        if is_resolved or not self._active or not 0 < new_hits <= _MAX_CYCLES:
            reference.set_targets(targets)
        return targets[-1] if is_resolved else None

    def _resolve_chain(self, node: Node, relation: Relation) -> list[Node]:
        """Return the element of each link of the chain, up to the first that is not found."""
        reference = relation.reference
        target_kinds = contexts.TARGET_KINDS.get(relation.kind)
        last_index = len(reference.chain) - 1
        context = contexts.find_context(node, relation)
        targets: list[Node] = []
        for index, names in enumerate(reference.chain):
            kinds = target_kinds if index == last_index else contexts.TARGET_KINDS["Subsetting"]
            if index or context.before is not None:
                before = context.before
                scope = targets[-1] if index or before is None else self.target(node, before)
                hit = self.descend(scope, names, kinds) if scope else None
            elif context.operand is not None:
                scope = find_result(context.operand, self)
                hit = self.descend(scope, names, kinds) if scope else None
            else:
                hits_before = self.cycle_hits
                hit = self.search(context, names, kinds)
                # A search that a cycle impeded may find the nearest meaning later.
                is_impeded = self.cycle_hits != hits_before and len(self._active) > 1
                if hit is None and len(names) > 1 and not is_impeded:
                    hit = self._search_hidden(node, relation, context, kinds)
            if hit is None:
                break
            is_import = relation.kind == "importedMembership"
            element = hit if is_import and index == last_index else self.resolve_alias(hit)
            if element is None:
                break
            targets.append(element)
        return targets

    def resolve_alias(self, hit: Node) -> Node | None:
        """Return the element that a member stands for: that of an alias, else the member itself."""
        if hit.kind != "Membership":
            return hit
        relation = hit.find_relation("Membership")
        return self.target(hit, relation) if relation else None

    def _search_hidden(
        self,
        node: Node,
        relation: Relation,
        context: contexts.LookupContext,
        kinds: Kinds,
    ) -> Node | None:
        """Return the member that a qualified name leads to if its nearest meaning lacks it."""
        # An import that is found by another import could depend on itself.
        if relation.kind in contexts.IMPORTED:
            context = context._replace(importing=tuple(contexts.list_scopes(context)))
        hits_before = self.cycle_hits
        hit = self.search(context, relation.reference.chain[0], kinds, past_imported=True)
        if hit is None or (self.cycle_hits != hits_before and len(self._active) > 1):
            return None
        self.hidden_references[relation.reference] = node
        return hit

    def search(
        self,
        context: contexts.LookupContext,
        names: tuple[str, ...],
        kinds: Kinds,
        *,
        past_imported: bool = False,
    ) -> Node | None:
        """Return the member that a qualified name leads to from a scope outwards.

        By the letter of KerML 8.2.3.5 the nearest namespace with the first name decides, even if it
        lacks the next name. Published models rely on tools that resolve the name as a whole: with
        ``past_imported`` the search goes on if the nearest namespace is an imported one.
        """
        first, scope = names[0], context.scope
        if first == "$" and len(names) > 1 and not self._is_first_name_quoted(context):
            return self.find_among(self._find_roots(names[1]), names[1:], kinds)
        while scope is not None:
            for hits in self._choose_stages(context, scope, first):
                if context.past_subjects and scope is context.scope:
                    hits = tuple(hit for hit in hits if hit.membership != "SubjectMembership")
                if hits:
                    member = self.find_among(hits, names, kinds, context.everything)
                    if member is not None:
                        return member
                    is_passed = past_imported and hits == self.imported_members(
                        scope, first, inside=True
                    )
                    if not is_passed and len(names) > 1 and any(map(self._is_namespace, hits)):
                        return None
            scope = contexts.find_outer_scope(scope)
        member = self.find_among(self._find_roots(first), names, kinds)
        if member is None and not past_imported:
            for importing in context.importing:
                hits = self.imported_members(importing, first, inside=True)
                member = member or self.find_among(hits, names, kinds, context.everything)
        return member

    def _choose_stages(
        self, context: contexts.LookupContext, scope: Node, name: str
    ) -> Iterable[Hits]:
        """Return the stages of the lookup of a name in one scope, nearest members first."""
        if scope in context.importing:
            return self._iter_stages_without_imports(scope, name)
        if scope is context.scope and scope.kind in TYPES:
            if context.inherited:
                return (self._find_in_generals(scope, name),)
            if context.is_metadata:
                return self._iter_stages_without_implied(scope, name)
        return self._iter_stages(scope, name, context.without)

    def descend(
        self, scope: Node, names: tuple[str, ...], kinds: Kinds, everything: bool = False
    ) -> Node | None:
        """Return the member that the names lead to from outside of ``scope``.

        With ``everything``, private and protected members are visible, as for ``import all``.
        """
        hits = (
            tuple(self.iter_visible_inside(scope, names[0]))
            if everything
            else self.visible_outside(scope, names[0])
        )
        return self.find_among(hits, names, kinds, everything)

    def find_among(
        self, hits: Hits, names: tuple[str, ...], kinds: Kinds, everything: bool = False
    ) -> Node | None:
        """Return the member that the names lead to from the first suitable hit.

        ``hits`` are the members for the first name. If that is the only one, the result is the
        first hit whose element is of one of ``kinds``. Otherwise the other names are looked up
        inside the element of each hit.
        """
        for hit in hits:
            element = hit if hit.kind != "Membership" else self.resolve_alias(hit)
            if element is None:
                continue
            if len(names) > 1:
                member = self.descend(element, names[1:], kinds, everything)
                if member is not None:
                    return member
            elif kinds is None or element.kind in kinds:
                return hit
        return None

    def _is_first_name_quoted(self, context: contexts.LookupContext) -> bool:
        """Whether ``$`` is a name in quotes, not the global scope."""
        reference = context.reference
        if reference is None or reference.start < 0 or context.scope is None:
            return False
        return self._text(find_root(context.scope))[reference.start : reference.start + 1] == "'"

    def _is_namespace(self, hit: Node) -> bool:
        element = self.resolve_alias(hit)
        return element is not None and element.kind in NAMESPACES
