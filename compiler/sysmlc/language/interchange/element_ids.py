"""Ids of elements, and the references by id in one interchange file and across files.

KerML 1.0, 9.1: an element of a standard library has a version 5 UUID (RFC 9562) of its path in the
namespace of its package, whose UUID is that of its IRI. Other elements get ids by the same scheme.
"""

from collections.abc import Callable, Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass
from posixpath import basename, dirname, join, normpath, splitext
from urllib.parse import unquote
from uuid import NAMESPACE_URL, UUID, uuid5

from msgspec import field

from sysmlc.diagnostics import Place, Sink, Subject
from sysmlc.language.interchange import rules
from sysmlc.language.interchange.effective_names import (
    QualifiedNames,
    RedefinitionQuery,
    describe_node,
    find_effective_name,
    redefine_nothing,
)
from sysmlc.language.interchange.unfolding import Element, unfold, walk_elements
from sysmlc.language.library import Library
from sysmlc.language.metaclasses import is_a
from sysmlc.language.text.lexer import quote_name
from sysmlc.language.tree import Document, Node, Reference

_STANDARD = {"kerml": "https://www.omg.org/spec/KerML/", "sysml": "https://www.omg.org/spec/SysML/"}
_OPERATOR_PARAMETERS = {
    **dict.fromkeys(("and", "or", "implies"), ("firstValue", "secondValue")),
    **dict.fromkeys(("<", ">", "<=", ">=", "==", "!=", "===", "!==", "xor", "not"), ("x", "y")),
    **dict.fromkeys(("+", "-", "*", "/", "%", "^", "**", "|", "&"), ("x", "y")),
}
"""Parameters of the functions of operators; operands redefine them (KerML 9.4)."""


def _map_ids(document: Document) -> dict[str, Node]:
    """Return the nodes of a document by the ids that they and their memberships have."""
    root = unfold(document.root)
    assign_ids(root, document)
    nodes: dict[str, Node] = {}
    for element, owner in walk_elements(root):
        node = element.node
        if element.kind == "ConjugatedPortDefinition" and owner is not None:
            node = find_conjugated(element)
        if node is not None:
            nodes[element.id] = node
    return nodes


def assign_ids(
    root: Element, document: Document, redefined: RedefinitionQuery = redefine_nothing
) -> None:
    """Assign ids to the element and all below it."""
    package = next(
        (member for member in document.root.members if member.kind == "LibraryPackage"), None
    )
    is_standard = package is not None and package.attributes.get("isStandard") is True
    if package is not None and is_standard:
        name = package.name or ""
        base, path = uuid5(NAMESPACE_URL, _STANDARD[document.language] + name), f"{name}/owner"
    else:
        # Not the content: ids must survive edits of the model.
        stem = document.path.rpartition(".")[0] or document.path
        base, path = uuid5(NAMESPACE_URL, f"urn:sysmlc:{stem}"), ""
    _IdAssigner(base, document.root, redefined).assign(root, path)
    if package is not None and is_standard:
        _set_package_id(root, str(base))


def _set_package_id(root: Element, id: str) -> None:
    """Set the id of a standard package, which is the UUID of its IRI."""
    for membership in root.owned:
        for element in membership.owned:
            if element.kind == "LibraryPackage":
                element.id = id


_RESULTS = frozenset({"ReturnParameterMembership"})


class _IdAssigner:
    def __init__(self, base: UUID, root: Node, redefined: RedefinitionQuery) -> None:
        self._redefined = redefined
        self._base = base
        self._root = root
        self._worklist: list[tuple[Element, str, str]] = []

    def assign(self, root: Element, path: str) -> None:
        """Assign ids to the root namespace and all below it."""
        self._worklist.append((root, path, ""))
        # No recursion: expressions nest deeper than Python recurses.
        while self._worklist:
            self._assign_to_element(*self._worklist.pop())

    def _make_id(self, path: str) -> str:
        return str(uuid5(self._base, path))

    def _assign_to_element(self, element: Element, path: str, qualified: str) -> None:
        """Assign ids to an element that is not an owned relationship, and to its relationships.

        ``qualified`` is its qualified name, empty if it has none.
        """
        element.id = self._make_id(path)
        is_root = element.node is self._root
        used_names: set[str] = set()
        operands = iter(_OPERATOR_PARAMETERS.get(str(element.attributes.get("operator")), ()))
        for index, owned in enumerate(element.owned, 1):
            name = _find_member_name(owned, self._redefined) if is_root or qualified else ""
            if element.kind == "OperatorExpression" and qualified:
                name = "result" if owned.kind in _RESULTS else next(operands, "")
            unique_name = name if name not in used_names else ""
            used_names.add(name)
            qualified_member = _join_names("" if is_root else qualified, unique_name)
            self._assign_to_relationship(owned, path, index, qualified_member)

    def _assign_to_relationship(
        self, element: Element, owner_path: str, index: int, qualified: str
    ) -> None:
        """Assign ids to an owned relationship and all below it; ``qualified`` names its member."""
        path = f"{qualified}/owningMembership" if qualified else f"{owner_path}/{index}"
        element.id = self._make_id(path)
        for position, owned in enumerate(element.owned, 1):
            if owned.kind == "Annotation":
                self._assign_to_relationship(owned, path, position, "")
            else:
                qualified_member = qualified if position == 1 else ""
                self._worklist.append(
                    (owned, qualified_member or f"{path}/{position}", qualified_member)
                )


def _join_names(owner: str, name: str) -> str:
    if not name:
        return ""
    return f"{owner}::{quote_name(name)}" if owner else quote_name(name)


def _find_member_name(owned: Element, redefined: RedefinitionQuery) -> str:
    """Return the name of the member of a membership; empty for other relationships."""
    if not is_a(owned.kind, "OwningMembership") or not owned.owned:
        return ""
    member = owned.owned[0]
    if member.kind == "ConjugatedPortDefinition":
        original = find_conjugated(member)
        return f"~{find_effective_name(original, redefined)}" if original else ""
    return find_effective_name(member.node, redefined) if member.node is not None else ""


def find_conjugated(definition: Element) -> Node | None:
    """Return the port definition that a ConjugatedPortDefinition conjugates."""
    targets = (target for _, target in definition.owned[0].targets)
    return next(
        (target.node for target in targets if isinstance(target, Element) and target.node), None
    )


# -- references --------------------------------------------------------------------------------

_Find = Callable[[str], Node | None]
"""Returns the element that an id or an href leads to."""


@dataclass(slots=True)
class PendingReference:
    """A reference, the ids or hrefs of its links, the feature that has it, and its node."""

    reference: Reference
    links: list[str]
    feature: str
    node: Node


class ExchangeDocument(Document, frozen=True, eq=False):
    """A document that was read from an interchange file, with the data to link it to others.

    ``ids`` maps ids to nodes; the id of a membership leads to its member. ``pending`` are the
    references into other files.
    """

    ids: Mapping[str, Node] = field(default_factory=dict)
    pending: Sequence[PendingReference] = ()


class References:
    """The ids and the references of one file while it is read."""

    def __init__(self) -> None:
        self.ids: dict[str, Node] = {}
        self._pending: dict[Reference, PendingReference] = {}

    def bind_id(self, id: str, node: Node) -> None:
        """Let the id lead to the node."""
        if id:
            self.ids[id] = node

    def add(self, links: list[str], feature: str, node: Node) -> Reference:
        """Return a new reference whose links are ids or hrefs."""
        reference = Reference(tuple((link,) for link in links), node.start, node.start)
        self._pending[reference] = PendingReference(reference, links, feature, node)
        return reference

    def join_chain(self, chain: Node) -> Reference:
        """Return one reference for a feature that is a feature chain."""
        parts = [self._pending.pop(relation.reference) for relation in chain.relations]
        links = [link for part in parts for link in part.links]
        return self.add(links, "chainingFeature", chain)

    def all(self) -> Iterator[PendingReference]:
        """Return all references, in the order of the file."""
        return iter(self._pending.values())


def resolve_local(references: References, path: str, sink: Sink) -> list[PendingReference]:
    """Resolve references within the file; return those into other files."""
    outward = []
    for pending in references.all():
        if any(_is_outward(link) for link in pending.links):
            outward.append(pending)
        else:
            _resolve(pending, lambda link: references.ids.get(_id_of(link)), path, sink)
    return outward


def link(documents: Iterable[Document], sink: Sink, library: Library | None = None) -> None:
    """Resolve references between documents that were read from interchange files.

    Hrefs into other files lead into the library if it has a file of that name and an element with
    that standard id. Others remain unresolved.
    """
    read_documents = [document for document in documents if isinstance(document, ExchangeDocument)]
    index = _IdIndex(read_documents, library)
    naming = QualifiedNames()
    for document in read_documents:
        for pending in document.pending:
            if all(index.has_file(_file_of(document.path, link)) for link in pending.links):
                _resolve(pending, index.make_find(document.path), document.path, sink)
    for document in read_documents:
        set_names(document.root, naming)


class _IdIndex:
    """Elements by their ids, in documents that were read and in files of the library."""

    def __init__(self, documents: Iterable[ExchangeDocument], library: Library | None) -> None:
        self._ids = {normpath(document.path): document.ids for document in documents}
        self._library = library
        paths = library.paths() if library else ()
        self._stems = {basename(splitext(path)[0]): path for path in paths}

    def has_file(self, file: str) -> bool:
        return file in self._ids or basename(splitext(file)[0]) in self._stems

    def make_find(self, path: str) -> _Find:
        """Return a function that finds the elements to which links of the file ``path`` lead."""
        return lambda link: self._load_ids(_file_of(path, link)).get(_id_of(link))

    def _load_ids(self, file: str) -> Mapping[str, Node]:
        if file not in self._ids and self._library is not None:
            # Hrefs name .kermlx files, the library has .kerml files of the same stem.
            stem = basename(splitext(file)[0])
            self._ids[file] = _map_ids(self._library.document(self._stems[stem]))
        return self._ids[file]


def set_names(root: Node, naming: QualifiedNames) -> None:
    """Replace the ids of resolved references by the qualified names of their targets."""
    for node in root.walk():
        for relation in node.relations:
            targets = relation.reference.targets
            if targets is not None and len(targets) == len(relation.reference.chain):
                relation.reference.chain = tuple(map(naming.find_qualified_name, targets))


def _resolve(pending: PendingReference, find: _Find, path: str, sink: Sink) -> None:
    targets: list[Node] = []
    for link in pending.links:
        target = find(link)
        if target is None:
            _report_dangling(pending, link, path, sink)
            break
        targets.append(target)
    pending.reference.set_targets(targets)


def _report_dangling(pending: PendingReference, link: str, path: str, sink: Sink) -> None:
    place = Place(path, ordinal=pending.node.start)
    file = _file_of(path, link) if _is_outward(link) else path
    sink.report(
        rules.DANGLING,
        Subject(describe_node(pending.node), place=place),
        feature=pending.feature,
        element=describe_node(pending.node),
        id=_id_of(link),
        file=f"'{file}'",
    )


def _is_outward(link: str) -> bool:
    return "#" in link and not link.startswith("#")


def _id_of(link: str) -> str:
    return link.rpartition("#")[2]


def _file_of(path: str, link: str) -> str:
    """Return the path, in the unit, of the file that a link leads to."""
    # Tools write spaces in hrefs as %20.
    file = unquote(link.rpartition("#")[0])
    return normpath(join(dirname(path), file)) if file else normpath(path)
