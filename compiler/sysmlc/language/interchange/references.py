"""References of interchange files: ids become elements, in one file and across files."""

from collections.abc import Callable, Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass
from posixpath import basename, dirname, join, normpath, splitext
from urllib.parse import unquote

from msgspec import field

from sysmlc.diagnostics import Place, Sink, Subject
from sysmlc.language.interchange import rules
from sysmlc.language.interchange.effective_names import QualifiedNames, describe_node
from sysmlc.language.interchange.element_ids import map_ids
from sysmlc.language.library import Library
from sysmlc.language.tree import Document, Node, Reference

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
        """Return the function that finds the links of the file ``path``."""
        return lambda link: self._load_ids(_file_of(path, link)).get(_id_of(link))

    def _load_ids(self, file: str) -> Mapping[str, Node]:
        if file not in self._ids and self._library is not None:
            # Hrefs name .kermlx files, the library has .kerml files of the same stem.
            stem = basename(splitext(file)[0])
            self._ids[file] = map_ids(self._library.document(self._stems[stem]))
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
