"""The files of one compile unit: element ids and references, the same for any order of files."""

from typing import NamedTuple

from sysmlc.diagnostics import Verdict
from sysmlc.frontends.xmi import hrefs
from sysmlc.frontends.xmi.document import Document, WrittenReference
from sysmlc.frontends.xmi.namespaces import Profiles
from sysmlc.ir import Edge, Element, Graph, Kind, Reference
from sysmlc.ir.element import is_globally_unique

_OMITTED = (Verdict.IGNORED_NOTATION, Verdict.UNSUPPORTED)


class LoweredDocument:
    """One document and the elements that its rows become.

    ``elements[row]`` is the row's own element, or None; ``element_ids[row]`` is the id of that
    element, or of the nearest element above the row.
    """

    __slots__ = ("document", "element_ids", "elements", "verdicts")

    def __init__(self, document: Document) -> None:
        self.document = document
        self.element_ids: list[str] = [""] * len(document)
        self.elements: list[Element | None] = [None] * len(document)
        self.verdicts: list[Verdict | None] = [None] * len(document)


class Target(NamedTuple):
    """The row that a reference leads to."""

    file: LoweredDocument
    row: int

    @property
    def document(self) -> Document:
        """The document of the row."""
        return self.file.document

    @property
    def type(self) -> str:
        """The metaclass of the row."""
        return self.file.document.types[self.row]

    @property
    def name(self) -> str:
        """The name that the row writes, or the empty string."""
        return self.file.document.attributes[self.row].get("name", "")

    @property
    def element(self) -> Element | None:
        """The row's own element, or None."""
        return self.file.elements[self.row]

    @property
    def element_id(self) -> str:
        """Id of the row's element, or of the nearest element above it."""
        return self.file.element_ids[self.row]

    @property
    def verdict(self) -> Verdict | None:
        """The verdict of the row."""
        return self.file.verdicts[self.row]


class UnresolvedReference(NamedTuple):
    """A reference of an element whose target is still an id or href as *file* writes it."""

    edge: Edge
    source: str
    file: LoweredDocument
    target: str
    row: int
    is_href: bool
    feature: str
    is_reversed: bool
    """Whether the edge leads from the target to the source."""


class Unit:
    """The documents of a compile unit, and the references between their elements."""

    def __init__(self, documents: list[Document], graph: Graph) -> None:
        self.graph = graph
        self.files = [LoweredDocument(document) for document in documents]
        self.references: list[UnresolvedReference] = []
        self.profiles = Profiles()
        self.library_ids: dict[str, tuple[str, str]] = {}
        """Elements of used projects by their id: id in the graph, and file as hrefs name it."""
        self.nested_paths: dict[str, tuple[LoweredDocument, list[WrittenReference]]] = {}
        """Paths that ``NestedConnectorEnd`` gives connector ends, by the id of the end."""
        self._holders: dict[str, list[LoweredDocument]] = {}
        self._href_targets: dict[tuple[str, str], Target | None] = {}
        """Targets of hrefs, by the file that contains the href."""
        if len(self.files) > 1:
            for file in self.files:
                for id in file.document.ids:
                    self._holders.setdefault(id, []).append(file)
        self.clashes = {id for id, holders in self._holders.items() if len(holders) > 1}
        self.clashes.update(e.id for e in graph if any(e.id in d.ids for d in documents))

    # -- ids ---------------------------------------------------------------------------------------

    def graph_id(self, file: str, id: str) -> str:
        """Return the id in the graph for the element *id* of *file*."""
        return f"{file}#{id}" if id in self.clashes else id

    def has_id(self, id: str) -> bool:
        """Whether a file of the unit has an element with this id."""
        return bool(self._find_holders(id))

    def find_target(self, file: LoweredDocument, target: str, is_href: bool) -> Target | None:
        """Return the row that an id or href of *file* means, or None if no file has it."""
        if not is_href:
            return self._find_by_id(file, target)
        key = file.document.name, target
        if key not in self._href_targets:
            self._href_targets[key] = self._find_by_href(file, target)
        return self._href_targets[key]

    def find_target_id(self, file: LoweredDocument, target: str, is_href: bool) -> str | None:
        """Return the id in the graph that an id or href of *file* means.

        None if the target is read but not part of the graph. A target that no file of the unit has
        is returned as written (an href normalised).
        """
        definition = self.find_target(file, target, is_href)
        if definition is None and is_href:
            normalised = hrefs.normalise_href(target, file.document.name)
            return self._find_in_library(target) or normalised
        if definition is None:
            return target
        holder, row = definition
        if not holder.elements[row] and holder.verdicts[row] in _OMITTED:
            return None
        return holder.element_ids[row] or None

    def _find_holders(self, id: str) -> list[LoweredDocument]:
        if len(self.files) == 1:
            return self.files if id in self.files[0].document.ids else []
        return self._holders.get(id, [])

    def _find_by_id(self, file: LoweredDocument, target: str) -> Target | None:
        row = file.document.ids.get(target)
        if row is None and hrefs.is_path(target):
            row = hrefs.find_row_at_path(file.document, target)
        if row is not None:
            return Target(file, row)
        holders = self._find_holders(target)
        return Target(holders[0], holders[0].document.ids[target]) if len(holders) == 1 else None

    def _find_by_href(self, file: LoweredDocument, href: str) -> Target | None:
        path, _, fragment = hrefs.normalise_href(href, file.document.name).partition("#")
        if hrefs.is_path(fragment):
            return self._find_by_path(path, fragment)
        holders = self._find_holders(fragment)
        candidates = [
            holder
            for holder in holders
            if _archive(holder.document.name) == path or holder.document.name == path
        ]
        if not candidates and is_globally_unique(fragment):
            candidates = holders
        if hrefs.is_in_project(href, fragment):
            archive = _archive(file.document.name)
            same_archive = [h for h in holders if _archive(h.document.name) == archive]
            candidates = same_archive or candidates
        if not candidates:
            name = hrefs.base_name(path)
            candidates = [h for h in holders if hrefs.base_name(h.document.name) == name]
        if len(candidates) != 1:
            return None
        return Target(candidates[0], candidates[0].document.ids[fragment])

    def _find_by_path(self, path: str, fragment: str) -> Target | None:
        """Return the target of a path of EMF; the file must be named unambiguously."""
        files = [file for file in self.files if file.document.name == path]
        if not files:
            name = hrefs.base_name(path)
            files = [file for file in self.files if hrefs.base_name(file.document.name) == name]
        row = hrefs.find_row_at_path(files[0].document, fragment) if len(files) == 1 else None
        return None if row is None else Target(files[0], row)

    def _find_in_library(self, href: str) -> str | None:
        path, _, id = href.rpartition("#")
        graph_id, file = self.library_ids.get(id, ("", ""))
        return graph_id if hrefs.can_lead_into(file, path, id) else None

    # -- references --------------------------------------------------------------------------------

    def resolve_references(self) -> None:
        """Add all references to ``graph.pending``, in the order in which they were added."""
        for reference in self.references:
            target = self.find_target_id(reference.file, reference.target, reference.is_href)
            if target is not None and not self._is_tool_artefact(reference, target):
                self.graph.pending.append(self._resolve(reference, target))
        self.references.clear()

    def _is_tool_artefact(self, reference: UnresolvedReference, target: str) -> bool:
        """Whether the reference is in an extension of a tool and its target does not exist."""
        if reference.is_href or target in self.graph:
            return False
        return reference.file.document.is_in_extension(reference.row)

    def _resolve(self, unresolved: UnresolvedReference, target: str) -> Reference:
        edge, source, file, _, row, is_href, feature, is_reversed = unresolved
        if is_reversed and target in self.graph:
            return Reference(edge, target, source, ordinal=self._ordinal(target, file, row))
        if is_reversed:
            edge = Edge.REFERENCES
        ordinal = self._ordinal(source, file, row)
        if not is_href or target in self.graph:
            return Reference(edge, source, target, ordinal=ordinal)
        if file.verdicts[row] is Verdict.MAPPED:
            file.verdicts[row] = Verdict.EXTERNAL
        kind, name = hrefs.read_stub(file.document, row, feature)
        return Reference(edge, source, target, kind or self._guess_kind(unresolved), name, ordinal)

    def _ordinal(self, source: str, file: LoweredDocument, row: int) -> int:
        """Position of a reference in the file of the element that it leaves; -1 in other files."""
        document = file.document
        return document.ordinals[row] if self.graph[source].source == document.name else -1

    def _guess_kind(self, reference: UnresolvedReference) -> Kind:
        """Return the likely kind of an external target.

        A general or redefined element is most likely of the kind of the element that refers to it.
        """
        if reference.edge in (Edge.SPECIALIZES, Edge.REDEFINES):
            return self.graph[reference.source].kind
        return hrefs.guess_kind(reference.feature)


def _archive(name: str) -> str:
    return name.partition("!")[0]
