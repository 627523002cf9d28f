"""A model: documents, their library, and queries about names and generalization."""

from collections.abc import Sequence
from functools import cached_property
from typing import NamedTuple

from sysmlc.language.library import Library
from sysmlc.language.metaclasses import TYPES
from sysmlc.language.names import implied, metadata
from sysmlc.language.names.base_types import REDEFINING_MEMBERSHIPS
from sysmlc.language.names.generals import FeatureTypes
from sysmlc.language.names.lookup import Lookup
from sysmlc.language.names.members import Hits
from sysmlc.language.names.symbols import find_naming_reference, find_payload
from sysmlc.language.tree import Document, Node, Relation, find_root


class _ImpliedGenerals(NamedTuple):
    """What all nodes with the same candidate key may implicitly specialise."""

    pairs: list[tuple[str, Node]]
    targets: tuple[Node, ...]


class Model:
    """Documents and the library that they refer to, with memoised queries."""

    def __init__(self, documents: Sequence[Document], library: Library) -> None:
        self.library = library
        self.lookup = Lookup(
            self._find_roots, self.implied_generals, self._find_redefined_by_role, self._find_text
        )
        self._nodes: dict[Node, list[Node]] = {}
        self.documents = sorted(documents, key=lambda document: document.path)
        self._documents_by_root = {document.root: document for document in self.documents}
        self._roots_by_name: dict[str, list[Node]] = {}
        for document in self.documents:
            for member in document.root.members:
                for name in dict.fromkeys(filter(None, (member.name, member.short_name))):
                    self._roots_by_name.setdefault(name, []).append(member)
        self._elements_by_name: dict[str, Node | None] = {}
        self._candidates: dict[Node, list[tuple[str, Node]]] = {}
        self._alike: dict[tuple[object, ...], _ImpliedGenerals] = {}
        self._needed_generals: dict[tuple[tuple[Node, ...], tuple[Node, ...]], list[Node]] = {}
        self._feature_types = FeatureTypes(self.lookup, self.supertype_set)
        self._supertype_sets: dict[Node, dict[Node, None]] = {}
        self._supertypes_above: dict[tuple[Node, ...], dict[Node, None]] = {}
        self.typed_generals: dict[Node, tuple[Node, ...]] = {}
        """The bases of features by their types (see ``implied_relations``)."""
        self.typed_generals_above: dict[tuple[Node, ...], set[Node]] = {}
        """The bases of everything that a tuple of generals specialises."""
        self.annotated_kinds: dict[tuple[Node, ...], list[str]] = {}
        """Kinds of elements that metadata with these generals may annotate (see ``checks``)."""

    def _find_roots(self, name: str) -> Hits:
        return (*self._roots_by_name.get(name, ()), *self.library.roots(name))

    def nodes(self, document: Document) -> list[Node]:
        """Return all nodes of a document of the model, owners first, in the order of the text."""
        cached = self._nodes.get(document.root)
        if cached is None:
            cached = self._nodes[document.root] = list(document.root.walk())
        return cached

    def packages(self) -> list[str]:
        """Return the names of the root members of the documents and of the library."""
        own_names = [str(package.name) for package in self.own_packages() if package.name]
        return [*own_names, *self.library.names()]

    def own_packages(self) -> list[Node]:
        """Return the root members of the documents."""
        return [member for document in self.documents for member in document.root.members]

    def find_packages_owning(self, name: str) -> Sequence[Node]:
        """Return the root members of the documents that own a member of that name."""
        return self._packages_by_member.get(name, ())

    @cached_property
    def _packages_by_member(self) -> dict[str, list[Node]]:
        packages: dict[str, list[Node]] = {}
        for package in self.own_packages():
            for name in self.lookup.symbol_table(package):
                packages.setdefault(name, []).append(package)
        return packages

    def _find_text(self, root: Node) -> str:
        document = self.document(root)
        return document.text if document else ""

    def find(self, qualified_name: str) -> Node | None:
        """Return the element with a qualified name such as ``Parts::Part``, also of the library."""
        if qualified_name in self._elements_by_name:
            return self._elements_by_name[qualified_name]
        names = tuple(part.strip("'") for part in qualified_name.split("::"))
        hits_before = self.lookup.cycle_hits
        hits = self._find_roots(names[0])
        hit = self.lookup.find_among(hits, names, None)
        element = self.lookup.resolve_alias(hit) if hit else None
        # A name that was not found in a cycle may be found later.
        if self.lookup.cycle_hits == hits_before:
            self._elements_by_name[qualified_name] = element
        return element

    def target(self, node: Node, relation: Relation) -> Node | None:
        """Return the element that a relation of ``node`` leads to, or None if it is unresolved."""
        return self.lookup.target(node, relation)

    def generals(self, node: Node) -> list[Node]:
        """Return what ``node`` directly specialises, implied generals last."""
        stated = self.lookup.generals(node)
        return [
            *stated,
            *(general for general in self.needed_generals(node) if general not in stated),
        ]

    def all_supertypes(self, node: Node) -> list[Node]:
        """Return ``node`` and everything that it specialises, nearest first."""
        return list(self.supertype_set(node))

    def specializes(self, node: Node, general: Node | str) -> bool:
        """Whether ``node`` is ``general`` or specialises it, in any number of steps."""
        wanted = self.find(general) if isinstance(general, str) else general
        return wanted is not None and wanted in self.supertype_set(node)

    def types(self, node: Node) -> list[Node]:
        """Return the types of a feature: its own, else those of what it subsets and redefines."""
        return self._feature_types.find_types(node)

    def members(self, node: Node, *, inherited: bool = True, imported: bool = False) -> list[Node]:
        """Return owned members, inherited ones that nothing redefines, and imported ones."""
        generals = self.all_supertypes(node)[1:] if inherited and node.kind in TYPES else []
        return _list_members(self.lookup, node, generals, imported=imported)

    def name(self, node: Node) -> str | None:
        """Return the effective name of an element: its own or that of its naming feature.

        KerML 1.0, 8.3.2.1.2.
        """
        seen = {node}
        while node.name is None:
            reference = find_naming_reference(node)
            if reference is None:
                by_position = self.lookup.redefined_by_position(node)
                if node.short_name or not by_position or by_position[0] in seen:
                    return node.short_name
                node = by_position[0]
                seen.add(node)
                continue
            relation = next(
                relation for relation in node.relations if relation.reference is reference
            )
            target = self.lookup.target(node, relation)
            if target is None or target in seen:
                return None if target else reference.chain[-1][-1]
            seen.add(target)
            node = target
        return node.name

    def qualified_name(self, node: Node) -> str:
        """Return the names from the root to ``node`` with ``::``, without nameless elements."""
        names: list[str] = []
        current: Node | None = node
        while current is not None:
            name = self.name(current)
            if name is not None:
                names.append(name)
            current = current.owner
        return "::".join(reversed(names))

    def document(self, node: Node) -> Document | None:
        """Return the document, of the model or of the library, that contains ``node``."""
        root = find_root(node)
        # The library loads documents on demand, so new ones may have been added.
        if root not in self._documents_by_root:
            self._documents_by_root.update((d.root, d) for d in self.library.loaded_documents())
        return self._documents_by_root.get(root)

    # -- implied generals ------------------------------------------------------------------------

    def implied_generals(self, node: Node) -> tuple[Node, ...]:
        """Return everything that ``node`` may implicitly specialise, needed or not."""
        alike = self._find_alike(node)
        if node in alike.targets or self._has_own_candidates(node):
            return tuple(dict.fromkeys([target for _, target in self.candidates(node)]))
        return alike.targets

    def _has_own_candidates(self, node: Node) -> bool:
        """Whether ``node`` may have candidates that its candidate key does not determine."""
        is_parameter = node.membership == "ParameterMembership"
        if is_parameter and node.owner is not None and node.owner.kind == "TransitionUsage":
            return True
        return not metadata.METADATA.isdisjoint([member.kind for member in node.members])

    def _find_redefined_by_role(self, node: Node) -> list[Node]:
        name = implied.find_role_base(node) if node.membership in REDEFINING_MEMBERSHIPS else None
        target = self.find(name) if name else None
        return [target] if target is not None and target is not node else []

    def candidates(self, node: Node) -> list[tuple[str, Node]]:
        """Return relation and target of everything that ``node`` may implicitly specialise."""
        cached = self._candidates.get(node)
        if cached is not None:
            return cached
        if node.kind not in TYPES:
            return []
        hits_before = self.lookup.cycle_hits
        pairs = [pair for pair in self._find_alike(node).pairs if pair[1] is not node]
        cached = [
            *_find_accepted_payload(node),
            *metadata.find_semantic_bases(node, self.lookup),
            *pairs,
        ]
        if self.lookup.cycle_hits == hits_before:
            self._candidates[node] = cached
        return cached

    def _find_alike(self, node: Node) -> _ImpliedGenerals:
        """Return what all nodes with the candidate key of ``node`` may implicitly specialise."""
        key = implied.make_key(node)
        cached = self._alike.get(key)
        if cached is None:
            hits_before = self.lookup.cycle_hits
            candidates = [(kind, self.find(name)) for kind, name in implied.list_candidates(node)]
            pairs = [(kind, target) for kind, target in candidates if target is not None]
            cached = _ImpliedGenerals(pairs, tuple(dict.fromkeys([target for _, target in pairs])))
            if self.lookup.cycle_hits == hits_before:
                self._alike[key] = cached
        return cached

    def needed_generals(self, node: Node, extra: tuple[Node, ...] = ()) -> list[Node]:
        """Return implied generals of ``node`` that no other general of it specialises already.

        ``extra`` has candidates that name lookup does not consider.
        """
        possible = (*self.lookup.redefined_by_position(node), *extra, *self.implied_generals(node))
        key = possible, tuple(self.lookup.generals(node))
        cached = self._needed_generals.get(key)
        if cached is None:
            cached = self._needed_generals[key] = self._drop_redundant(*key)
        return cached

    def _drop_redundant(self, possible: tuple[Node, ...], stated: tuple[Node, ...]) -> list[Node]:
        """Return the generals of ``possible`` that no other general specialises."""
        stated_supertypes = [self.supertype_set(general) for general in stated]
        possible_supertypes = [(general, self.supertype_set(general)) for general in possible]

        def is_redundant(general: Node) -> bool:
            return any(general in supertypes for supertypes in stated_supertypes) or any(
                special is not general and general in supertypes
                for special, supertypes in possible_supertypes
            )

        return [general for general in possible if not is_redundant(general)]

    def supertype_set(self, node: Node) -> dict[Node, None]:
        """Return ``all_supertypes`` as a dictionary, for membership tests."""
        cached = self._supertype_sets.get(node)
        if cached is None:
            cached = {node: None, **self._collect_supertypes(self.lookup.all_generals(node))}
            self._supertype_sets[node] = cached
        return cached

    def _collect_supertypes(self, generals: tuple[Node, ...]) -> dict[Node, None]:
        """Return generals and everything that they specialise, nearest first."""
        supertypes = self._supertypes_above.get(generals)
        if supertypes is None:
            supertypes = self._supertypes_above[generals] = dict.fromkeys(generals)
            worklist = list(supertypes)
            for supertype in worklist:
                for general in self.lookup.all_generals(supertype):
                    if general not in supertypes:
                        supertypes[general] = None
                        worklist.append(general)
        return supertypes


def _find_accepted_payload(node: Node) -> list[tuple[str, Node]]:
    """Relate the payload parameter of a transition to what its trigger accepts (SysML 8.3.17.9)."""
    owner = node.owner
    if owner is None or owner.kind != "TransitionUsage" or node.membership != "ParameterMembership":
        return []
    payload, accepted = find_payload(owner)
    return [("Subsetting", accepted)] if node is payload and accepted is not None else []


def _list_members(
    lookup: Lookup, node: Node, generals: Sequence[Node], *, imported: bool
) -> list[Node]:
    """Return members in the order of the text, then inherited ones that are not redefined."""
    members = dict.fromkeys(node.members)
    if generals:
        redefined = _collect_redefined(lookup, node.members)
        for general in generals:
            for member in general.members:
                if member.visibility != "private" and member not in redefined:
                    members.setdefault(member)
            redefined |= _collect_redefined(lookup, general.members)
    if imported:
        for member in _list_imported(lookup, node):
            members.setdefault(member)
    return list(members)


def _collect_redefined(lookup: Lookup, members: list[Node]) -> set[Node]:
    return {general for member in members for general in lookup.redefined_features(member)}


def _list_imported(lookup: Lookup, node: Node) -> list[Node]:
    members: list[Node] = []
    for import_ in lookup.imports(node):
        for relation in import_.relations:
            target = lookup.target(import_, relation)
            if target is not None and relation.kind == "importedMembership":
                members.append(target)
            elif target is not None:
                members += [
                    member for member in target.members if member.visibility in ("", "public")
                ]
    return members
