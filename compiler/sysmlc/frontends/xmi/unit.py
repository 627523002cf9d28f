"""All files of one compile unit: ids that are the same for every order of files, references."""

from typing import NamedTuple

from sysmlc.diagnostics import Verdict
from sysmlc.frontends.xmi import fragments, hrefs
from sysmlc.frontends.xmi.document import Document
from sysmlc.frontends.xmi.profiles import Profiles
from sysmlc.ir import Edge, Element, Graph, Kind, Reference
from sysmlc.ir.identity import is_unmistakable

_NOT_KEPT = (Verdict.IGNORED_NOTATION, Verdict.UNSUPPORTED)


class Lowered:
    """One document and what became of its rows.

    ``gids[row]`` is the id in the graph of the row's element, or of the nearest element above
    it; ``own[row]`` is the row's own element, or None.
    """

    __slots__ = ("document", "gids", "own", "verdicts")

    def __init__(self, document: Document) -> None:
        self.document = document
        self.gids: list[str] = [""] * len(document)
        self.own: list[Element | None] = [None] * len(document)
        self.verdicts: list[Verdict | None] = [None] * len(document)


class Link(NamedTuple):
    """A reference whose target is still an id or href as the file writes it."""

    edge: Edge
    source: str
    lowered: Lowered
    target: str
    row: int
    feature: str
    is_href: bool = False
    is_reversed: bool = False


class Unit:
    """The documents of a compile unit, and the references between their elements."""

    def __init__(self, documents: list[Document], graph: Graph) -> None:
        self.graph = graph
        self.files = [Lowered(document) for document in documents]
        self.links: list[Link] = []
        self.profiles = Profiles()
        self.library: dict[str, tuple[str, str]] = {}
        self.paths: dict[str, tuple[Lowered, list[tuple[str, int, bool]]]] = {}
        self._holders: dict[str, list[Lowered]] = {}
        self._hrefs: dict[tuple[str, str], tuple[Lowered, int] | None] = {}
        """What hrefs were found to mean, by the file that they are in."""
        for file in self.files if len(self.files) > 1 else ():
            for id in file.document.ids:
                self._holders.setdefault(id, []).append(file)
        self.clashes = {id for id, holders in self._holders.items() if len(holders) > 1}
        self.clashes.update(e.id for e in graph if any(e.id in d.ids for d in documents))

    def graph_id(self, file: str, id: str) -> str:
        """Id in the graph of an element with the id ``id`` in the file."""
        return f"{file}#{id}" if id in self.clashes else id

    def find(self, lowered: Lowered, target: str, is_href: bool) -> tuple[Lowered, int] | None:
        """File and row that an id or href means, if a file of the unit has it."""
        if not is_href:
            return self._local(lowered, target)
        name = lowered.document.name
        if (name, target) not in self._hrefs:
            self._hrefs[name, target] = self._elsewhere(lowered, target)
        return self._hrefs[name, target]

    def _elsewhere(self, lowered: Lowered, target: str) -> tuple[Lowered, int] | None:
        path, _, fragment = hrefs.normalised(target, lowered.document.name).partition("#")
        if fragments.is_path(fragment):
            return self._at_path(path, fragment)
        holders = self._having(fragment)
        exact = [h for h in holders if _archive(h.document.name) == path or h.document.name == path]
        if not exact and is_unmistakable(fragment):
            exact = holders
        if hrefs.is_in_project(target, fragment):
            here = _archive(lowered.document.name)
            exact = [h for h in holders if _archive(h.document.name) == here] or exact
        if not exact:
            name = hrefs.base_name(path)
            exact = [h for h in holders if hrefs.base_name(h.document.name) == name]
        return (exact[0], exact[0].document.ids[fragment]) if len(exact) == 1 else None

    def has(self, id: str) -> bool:
        """Whether a file of the unit has an element with this id."""
        return bool(self._having(id))

    def _at_path(self, path: str, fragment: str) -> tuple[Lowered, int] | None:
        """A path of EMF leads through the one file that it names."""
        named = [f for f in self.files if f.document.name == path]
        if not named:
            name = hrefs.base_name(path)
            named = [f for f in self.files if hrefs.base_name(f.document.name) == name]
        row = fragments.row_at(named[0].document, fragment) if len(named) == 1 else None
        return None if row is None else (named[0], row)

    def _having(self, id: str) -> list[Lowered]:
        if len(self.files) == 1:
            return self.files if id in self.files[0].document.ids else []
        return self._holders.get(id, [])

    def _local(self, lowered: Lowered, target: str) -> tuple[Lowered, int] | None:
        row = lowered.document.ids.get(target)
        if row is None and fragments.is_path(target):
            row = fragments.row_at(lowered.document, target)
        if row is not None:
            return lowered, row
        holders = self._having(target)
        return (holders[0], holders[0].document.ids[target]) if len(holders) == 1 else None

    def target_id(self, lowered: Lowered, target: str, is_href: bool) -> str | None:
        """Id in the graph of what an id or href means; None for what is read but not kept.

        What no file of the unit has is returned as written (an href normalised).
        """
        found = self.find(lowered, target, is_href)
        if found is None and is_href:
            return self._in_library(target) or hrefs.normalised(target, lowered.document.name)
        if found is None:
            return target
        holder, row = found
        if not holder.own[row] and holder.verdicts[row] in _NOT_KEPT:
            return None
        return holder.gids[row] or None

    def _in_library(self, target: str) -> str | None:
        path, _, id = target.rpartition("#")
        known, file = self.library.get(id, ("", ""))
        return known if hrefs.can_lead_into(file, path, id) else None

    def flush(self) -> None:
        """Add all references to ``graph.pending``, in the order in which they were found."""
        for link in self.links:
            reference = self._resolved(link)
            if reference is not None:
                self.graph.pending.append(reference)
        self.links.clear()

    def _resolved(self, link: Link) -> Reference | None:
        target = self.target_id(link.lowered, link.target, link.is_href)
        if target is None or self._is_loose(link, target):
            return None
        return self._reference(link, target)

    def _is_loose(self, link: Link, target: str) -> bool:
        """Whether it leads nowhere inside what a tool keeps beside the model."""
        if link.is_href or target in self.graph:
            return False
        return link.lowered.document.is_in_extension(link.row)

    def _reference(self, link: Link, target: str) -> Reference:
        edge, source, lowered, _, row, _, is_href, is_reversed = link
        if is_reversed and target in self.graph:
            return Reference(edge, target, source, ordinal=self._ordinal(target, lowered, row))
        if is_reversed:
            edge = Edge.REFERENCES
        ordinal = self._ordinal(source, lowered, row)
        if not is_href or target in self.graph:
            return Reference(edge, source, target, ordinal=ordinal)
        if lowered.verdicts[row] is Verdict.MAPPED:
            lowered.verdicts[row] = Verdict.EXTERNAL
        known = hrefs.hint(lowered.document, row, link.feature)
        kind = known[0] or self._likely(link)
        return Reference(edge, source, target, kind, known[1], ordinal)

    def _ordinal(self, source: str, lowered: Lowered, row: int) -> int:
        """Place of a reference in the file of the element that it leaves, -1 in other files."""
        document = lowered.document
        return document.ordinals[row] if self.graph[source].source == document.name else -1

    def _likely(self, link: Link) -> Kind:
        """What is general or redefined is most likely of the kind of what refers to it."""
        if link.edge in (Edge.SPECIALIZES, Edge.REDEFINES):
            return self.graph[link.source].kind
        return hrefs.likely(link.feature)


def _archive(name: str) -> str:
    return name.partition("!")[0]
