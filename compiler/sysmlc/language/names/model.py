"""Documents and their library, and the questions that others ask about their names."""

from collections.abc import Sequence
from typing import NamedTuple

from sysmlc.language.library import Library
from sysmlc.language.names import implied, metadata
from sysmlc.language.names.base_types import REDEFINED_BY_MEMBERSHIP
from sysmlc.language.names.feature_types import Types
from sysmlc.language.names.lookup import Lookup
from sysmlc.language.names.members import Hits
from sysmlc.language.names.symbols import TYPES, naming, payload_of
from sysmlc.language.tree import Document, Node, Relation


class _Alike(NamedTuple):
    """What elements that are alike may implicitly specialise: with kinds of relations, alone."""

    pairs: list[tuple[str, Node]]
    targets: tuple[Node, ...]


class Model:
    """Documents and the library that they refer to; everything is found out when it is asked."""

    def __init__(self, documents: Sequence[Document], library: Library) -> None:
        self.library = library
        self.lookup = Lookup(self._roots, self.implied_generals, self._by_role, self._text)
        self._nodes: dict[Node, list[Node]] = {}
        self.documents = sorted(documents, key=lambda document: document.path)
        self._by_root = {document.root: document for document in self.documents}
        self._named: dict[str, list[Node]] = {}
        for document in self.documents:
            for member in document.root.members:
                for name in {member.name, member.short_name} - {None}:
                    self._named.setdefault(str(name), []).append(member)
        self._found: dict[str, Node | None] = {}
        self._implied: dict[Node, list[tuple[str, Node]]] = {}
        self._likes: dict[tuple[object, ...], _Alike] = {}
        self._needed: dict[tuple[tuple[Node, ...], tuple[Node, ...]], list[Node]] = {}
        self._types = Types(self.lookup, self.supers_of)
        self._supers: dict[Node, dict[Node, None]] = {}
        self._aboves: dict[tuple[Node, ...], dict[Node, None]] = {}
        self.by_type: dict[Node, tuple[Node, ...]] = {}
        """What ``typed`` found out about features, once all names are resolved."""
        self.by_types_above: dict[tuple[Node, ...], set[Node]] = {}
        """The same about all that is above several generals."""
        self.annotating: dict[tuple[Node, ...], list[str]] = {}
        """What metadata of several definitions is for, as the checks found out."""

    def _roots(self, name: str) -> Hits:
        return (*self._named.get(name, ()), *self.library.roots(name))

    def nodes(self, document: Document) -> list[Node]:
        """All nodes of a document of the model, owners first, in the order of the text."""
        known = self._nodes.get(document.root)
        if known is None:
            known = self._nodes[document.root] = list(document.root.walk())
        return known

    def packages(self) -> list[str]:
        """The names of the root members of the documents and of the library."""
        own = [str(one.name) for one in self.own_packages() if one.name]
        return [*own, *self.library.names()]

    def own_packages(self) -> list[Node]:
        """The root members of the documents."""
        return _members(self.documents)

    def _text(self, root: Node) -> str:
        document = self.document(root)
        return document.text if document else ""

    # What others ask

    def find(self, qualified_name: str) -> Node | None:
        """The element with a qualified name such as ``Parts::Part``, here or in the library."""
        if qualified_name in self._found:
            return self._found[qualified_name]
        names, before = (
            tuple(part.strip("'") for part in qualified_name.split("::")),
            self.lookup.cuts,
        )
        hits = self._roots(names[0])
        hit = self.lookup.among(hits, names, 0, None)
        found = self.lookup.element(hit) if hit else None
        if self.lookup.cuts == before:
            self._found[qualified_name] = found
        return found

    def target(self, node: Node, relation: Relation) -> Node | None:
        """The element that a relation of ``node`` leads to; None when it was not found."""
        return self.lookup.target(node, relation)

    def generals(self, node: Node) -> list[Node]:
        """What ``node`` directly specialises, the implied ones last."""
        written = self.lookup.generals(node)
        return [*written, *(n for n in self.needed_generals(node) if n not in written)]

    def supers(self, node: Node) -> list[Node]:
        """``node`` and all that it specialises, directly or not, the nearest first."""
        return list(self.supers_of(node))

    def specializes(self, node: Node, general: Node | str) -> bool:
        """Whether ``node`` is ``general`` or specialises it, in any number of steps."""
        wanted = self.find(general) if isinstance(general, str) else general
        return wanted is not None and wanted in self.supers_of(node)

    def types(self, node: Node) -> list[Node]:
        """The types of a feature: its own, else those of what it subsets and redefines."""
        return self._types.of(node)

    def members(self, node: Node, *, inherited: bool = True, imported: bool = False) -> list[Node]:
        """Members of a namespace: own, inherited that nothing redefines, imported ones."""
        generals = self.supers(node)[1:] if inherited and node.kind in TYPES else []
        return members(self.lookup, node, generals, imported=imported)

    def name(self, node: Node) -> str | None:
        """The effective name of an element (KerML 8.3.2.1.2): its own, else what gives it one."""
        seen = {node}
        while node.name is None:
            reference = naming(node)
            if reference is None:
                by_position = self.lookup.by_position(node)
                if node.short_name or not by_position or by_position[0] in seen:
                    return node.short_name
                node = by_position[0]
                seen.add(node)
                continue
            relation = next(r for r in node.relations if r.reference is reference)
            target = self.lookup.target(node, relation)
            if target is None or target in seen:
                return None if target else reference.chain[-1][-1]
            seen.add(target)
            node = target
        return node.name

    def qualified_name(self, node: Node) -> str:
        """The names from the root to ``node`` with ``::``; a nameless one counts as nothing."""
        names: list[str] = []
        at: Node | None = node
        while at is not None:
            name = self.name(at)
            if name is not None:
                names.append(name)
            at = at.owner
        return "::".join(reversed(names))

    def document(self, node: Node) -> Document | None:
        """The document, of the model or of the library, that ``node`` is in."""
        top = root(node)
        if top not in self._by_root:
            self._by_root.update((d.root, d) for d in self.library.loaded())
        return self._by_root.get(top)

    # What the text does not say

    def implied_generals(self, node: Node) -> tuple[Node, ...]:
        """All that ``node`` may implicitly specialise, needed or not."""
        alike = self._alike(node)
        if node in alike.targets or self._is_special(node):
            return tuple(dict.fromkeys([one for _, one in self._candidates(node)]))
        return alike.targets

    def _is_special(self, node: Node) -> bool:
        """Whether something beside what it is like may say what ``node`` implicitly specialises."""
        is_parameter = node.membership == "ParameterMembership"
        if is_parameter and node.owner is not None and node.owner.kind == "TransitionUsage":
            return True
        return not metadata.METADATA.isdisjoint([member.kind for member in node.members])

    def _by_role(self, node: Node) -> list[Node]:
        name = implied.by_role(node) if node.membership in REDEFINED_BY_MEMBERSHIP else None
        target = self.find(name) if name else None
        return [target] if target is not None and target is not node else []

    def _candidates(self, node: Node) -> list[tuple[str, Node]]:
        """Kind of relation and target of all that ``node`` may implicitly specialise."""
        known = self._implied.get(node)
        if known is not None:
            return known
        if node.kind not in TYPES:
            return []
        before = self.lookup.cuts
        found = [pair for pair in self._alike(node).pairs if pair[1] is not node]
        known = [*_accepted(node), *metadata.bases(node, self.lookup), *found]
        if self.lookup.cuts == before:
            self._implied[node] = known
        return known

    def _alike(self, node: Node) -> _Alike:
        """What ``node`` and all that is like it may implicitly specialise."""
        like = implied.like(node)
        known = self._likes.get(like)
        if known is None:
            before = self.lookup.cuts
            named = [(kind, self.find(name)) for kind, name in implied.candidates(node)]
            pairs = [(kind, one) for kind, one in named if one is not None]
            known = _Alike(pairs, tuple(dict.fromkeys([one for _, one in pairs])))
            if self.lookup.cuts == before:
                self._likes[like] = known
        return known

    def candidates(self, node: Node) -> list[tuple[str, Node]]:
        """Kind of relation and target of all that ``node`` may implicitly specialise."""
        return self._candidates(node)

    def needed_generals(self, node: Node, also: tuple[Node, ...] = ()) -> list[Node]:
        """What ``node`` implicitly specialises and no other general of it does already.

        ``also`` are candidates beside those that names are looked up in.
        """
        possible = (*self.lookup.by_position(node), *also, *self.implied_generals(node))
        key = possible, tuple(self.lookup.generals(node))
        known = self._needed.get(key)
        if known is None:
            known = self._needed[key] = self._not_given(*key)
        return known

    def _not_given(self, possible: tuple[Node, ...], written: tuple[Node, ...]) -> list[Node]:
        given = [self.supers_of(one) for one in written]
        supers = [(one, self.supers_of(one)) for one in possible]
        return [
            one
            for one in possible
            if not any(one in those for those in given)
            and not any(other is not one and one in those for other, those in supers)
        ]

    def supers_of(self, node: Node) -> dict[Node, None]:
        """Like ``supers``, to look one up in."""
        known = self._supers.get(node)
        if known is None:
            known = {node: None, **self._above(self.lookup.all_generals(node))}
            self._supers[node] = known
        return known

    def _above(self, generals: tuple[Node, ...]) -> dict[Node, None]:
        """Some generals and all that they specialise, the nearest first."""
        known = self._aboves.get(generals)
        if known is None:
            known = self._aboves[generals] = dict.fromkeys(generals)
            waiting = list(known)
            for one in waiting:
                for general in self.lookup.all_generals(one):
                    if general not in known:
                        known[general] = None
                        waiting.append(general)
        return known


def _accepted(node: Node) -> list[tuple[str, Node]]:
    """The payload of a transition is what its trigger accepts (SysML 8.3.17.9)."""
    owner = node.owner
    if owner is None or owner.kind != "TransitionUsage" or node.membership != "ParameterMembership":
        return []
    payload, accepted = payload_of(owner)
    return [("Subsetting", accepted)] if node is payload and accepted is not None else []


def _members(documents: Sequence[Document]) -> list[Node]:
    return [member for document in documents for member in document.root.members]


def root(node: Node) -> Node:
    """The root namespace of the document that ``node`` is in."""
    while node.owner is not None:
        node = node.owner
    return node


def members(lookup: Lookup, node: Node, generals: Sequence[Node], *, imported: bool) -> list[Node]:
    """Members in the order of the text, then those of generals that nothing nearer redefines."""
    found = dict.fromkeys(node.members)
    if generals:
        redefined = _redefined(lookup, node.members)
        for general in generals:
            for member in general.members:
                if member.visibility != "private" and member not in redefined:
                    found.setdefault(member)
            redefined |= _redefined(lookup, general.members)
    if imported:
        for member in _imported(lookup, node):
            found.setdefault(member)
    return list(found)


def _redefined(lookup: Lookup, owned: list[Node]) -> set[Node]:
    return {general for member in owned for general in lookup.redefined(member)}


def _imported(lookup: Lookup, node: Node) -> list[Node]:
    found: list[Node] = []
    for declaration in lookup.imports(node):
        for relation in declaration.relations:
            target = lookup.target(declaration, relation)
            if target is not None and relation.kind == "importedMembership":
                found.append(target)
            elif target is not None:
                found += [m for m in target.members if m.visibility in ("", "public")]
    return found
