"""References of interchange files: ids become elements, in one file and across files."""

from collections.abc import Callable, Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass
from posixpath import basename, dirname, join, normpath, splitext
from urllib.parse import unquote

from msgspec import field

from sysmlc.diagnostics import Place, Sink, Subject
from sysmlc.language.interchange import rules
from sysmlc.language.interchange.effective_names import Naming, shown
from sysmlc.language.library import Library
from sysmlc.language.tree import Document, Node, Reference

_Finder = Callable[[str], Node | None]
"""What leads from an id or an href to an element."""


@dataclass(slots=True)
class Pending:
    """A reference, the ids or hrefs of its links, the feature that has it, and of what."""

    reference: Reference
    links: list[str]
    feature: str
    node: Node


class ExchangeDocument(Document, frozen=True, eq=False):
    """A document that was read from an interchange file, with what links it to others.

    ``ids`` leads from ids to elements; the id of a membership leads to its member. ``pending``
    are the references that lead into other files.
    """

    ids: Mapping[str, Node] = field(default_factory=dict)
    pending: Sequence[Pending] = ()


class References:
    """The ids and the references of one file while it is read."""

    def __init__(self) -> None:
        self.ids: dict[str, Node] = {}
        self._found: dict[Reference, Pending] = {}

    def stand_for(self, id: str, node: Node) -> None:
        """Let the id lead to the element."""
        if id:
            self.ids[id] = node

    def add(self, links: list[str], feature: str, node: Node) -> Reference:
        """A reference whose links are ids or hrefs."""
        reference = Reference(tuple((link,) for link in links), node.start, node.start)
        self._found[reference] = Pending(reference, links, feature, node)
        return reference

    def joined(self, chain: Node) -> Reference:
        """One reference for a feature that is a chain of others."""
        parts = [self._found.pop(relation.reference) for relation in chain.relations]
        links = [link for part in parts for link in part.links]
        return self.add(links, "chainingFeature", chain)

    def all(self) -> Iterator[Pending]:
        """All references, in the order of the file."""
        return iter(self._found.values())


def resolve(references: References, path: str, sink: Sink) -> list[Pending]:
    """Resolve what stays in the file; the references that lead out of it are returned."""
    outward = []
    for pending in references.all():
        if any(_is_outward(link) for link in pending.links):
            outward.append(pending)
        else:
            _resolve(pending, lambda link: references.ids.get(_local(link)), path, sink)
    return outward


def link(documents: Iterable[Document], sink: Sink, library: Library | None = None) -> None:
    """Resolve references between documents that were read from interchange files.

    Hrefs into files that are not among the documents lead into the library, where it has a file
    of that name and an element that the standard gives that id; others stay as they are, with
    ``targets`` None.
    """
    read = [document for document in documents if isinstance(document, ExchangeDocument)]
    finder = _Finding(read, library)
    naming = Naming()
    for document in read:
        for pending in document.pending:
            if all(finder.has(_file(document.path, link)) for link in pending.links):
                _resolve(pending, finder.of(document.path), document.path, sink)
    for document in read:
        name(document.root, naming)


class _Finding:
    """Elements by their ids, in documents that were read and in files of the library."""

    def __init__(self, read: Iterable[ExchangeDocument], library: Library | None) -> None:
        self._ids = {normpath(document.path): document.ids for document in read}
        self._library = library
        paths = library.paths() if library else ()
        self._stems = {basename(splitext(path)[0]): path for path in paths}

    def has(self, file: str) -> bool:
        return file in self._ids or basename(splitext(file)[0]) in self._stems

    def of(self, path: str) -> _Finder:
        """What finds the links of the file ``path``."""
        return lambda link: self._known(_file(path, link)).get(_local(link))

    def _known(self, file: str) -> Mapping[str, Node]:
        if file not in self._ids and self._library is not None:
            from sysmlc.language.interchange.element_ids import ids

            stem = basename(splitext(file)[0])
            self._ids[file] = ids(self._library.document(self._stems[stem]))
        return self._ids[file]


def name(root: Node, naming: Naming) -> None:
    """Give resolved references the qualified names of their targets."""
    for node in root.walk():
        for relation in node.relations:
            targets = relation.reference.targets
            if targets is not None and len(targets) == len(relation.reference.chain):
                relation.reference.chain = tuple(map(naming.qualified, targets))


def _resolve(pending: Pending, find: _Finder, path: str, sink: Sink) -> None:
    targets: list[Node] = []
    for link in pending.links:
        target = find(link)
        if target is None:
            _report(pending, link, path, sink)
            break
        targets.append(target)
    pending.reference.set_targets(targets)


def _report(pending: Pending, link: str, path: str, sink: Sink) -> None:
    place = Place(path, ordinal=pending.node.start)
    file = _file(path, link) if _is_outward(link) else path
    sink.report(
        rules.DANGLING,
        Subject(shown(pending.node), place=place),
        feature=pending.feature,
        element=shown(pending.node),
        id=_local(link),
        file=f"'{file}'",
    )


def _is_outward(link: str) -> bool:
    return "#" in link and not link.startswith("#")


def _local(link: str) -> str:
    return link.rpartition("#")[2]


def _file(path: str, link: str) -> str:
    """The path, in the unit, of the file that a link leads to."""
    file = unquote(link.rpartition("#")[0])
    return normpath(join(dirname(path), file)) if file else normpath(path)
