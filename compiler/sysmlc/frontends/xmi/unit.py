"""The files of one compile unit: element ids and references, the same for any order of files."""

from collections import Counter
from collections.abc import Callable
from enum import Enum, auto
from functools import cached_property
from typing import NamedTuple

from sysmlc.diagnostics import Place, Rule, Sink, Subject, Verdict
from sysmlc.frontends.xmi import hrefs
from sysmlc.frontends.xmi.document import Document, WrittenReference
from sysmlc.frontends.xmi.namespaces import Profiles
from sysmlc.ir import AttrValue, Edge, Element, Graph, Kind, Reference
from sysmlc.ir.element import is_globally_unique

_OMITTED = (Verdict.IGNORED_NOTATION, Verdict.UNSUPPORTED)


class Stage(Enum):
    """What the rows of all documents must have become before deferred work can run."""

    WALKS = auto()
    """The walks are over: elements that their owner contains in another file."""
    ELEMENTS = auto()
    """All elements exist: attributes that hold ids."""
    APPLICATIONS = auto()
    """Stereotypes are applied: paths of connector ends."""
    TRIGGERS = auto()
    """Triggers read the events that they refer to."""
    BEHAVIOURS = auto()
    """Triggers are complete: other parts of behaviours that read later rows or other files."""
    GUARDS = auto()
    """Transitions read the constraints that are their guards."""
    BODIES = auto()
    """Guards are complete: bodies in several languages, and directions of parameters."""


class UncheckedReference(NamedTuple):
    """References of a feature that lead to no element of the file and become no edge."""

    holder: str
    """Id of the element that has the feature, or of the nearest element around it."""
    ordinal: int
    feature: str
    targets: list[str]
    is_redundant: bool
    """Whether another feature, or ownership, states the same relation."""


class File:
    """One file of the unit: its document, what its rows become, and what later steps finish.

    ``elements[row]`` is the row's own element, or None; ``element_ids[row]`` is the id of that
    element, or of the nearest element above the row.
    """

    __slots__ = (
        "applications",
        "bounds",
        "deferred",
        "document",
        "element_ids",
        "elements",
        "losses",
        "triggers_by_event",
        "unchecked_references",
        "unit",
        "unknown_values",
        "verdicts",
    )

    def __init__(self, document: Document, unit: "Unit") -> None:
        self.document = document
        self.unit = unit
        self.element_ids: list[str] = [""] * len(document)
        self.elements: list[Element | None] = [None] * len(document)
        self.verdicts: list[Verdict | None] = [None] * len(document)
        self.losses: dict[int, tuple[Rule, str]] = {}
        """The rule that reports a row which is not or partly read, and the part that is lost."""
        self.applications: list[int] = []
        """Rows that apply stereotypes."""
        self.bounds: dict[str, list[AttrValue]] = {}
        """Lower bound, upper bound, whether one is an expression, by the id of the element."""
        self.triggers_by_event: dict[str, list[str]] = {}
        """Ids of the triggers that refer to an event, by the id of the event."""
        self.deferred: dict[Stage, list[Callable[[], None]]] = {stage: [] for stage in Stage}
        self.unknown_values: list[tuple[int, str, str]] = []
        """Rows with an attribute whose value UML does not list."""
        self.unchecked_references: list[UncheckedReference] = []

    def defer(self, stage: Stage, work: Callable[[], None]) -> None:
        """Run *work* once all documents of the unit have reached a stage."""
        self.deferred[stage].append(work)

    def run_deferred(self, stage: Stage) -> None:
        """Run the work that waits for a stage, in the order of the rows."""
        for work in self.deferred.pop(stage):
            work()

    # -- verdicts ----------------------------------------------------------------------------------

    def mark_mapped(self, row: int) -> None:
        """Mark a row as mapped that becomes no element, but belongs to the element above it."""
        parent = self.document.parents[row]
        self.element_ids[row] = self.element_ids[parent] if parent >= 0 else ""
        self.verdicts[row] = Verdict.MAPPED

    def mark_subtree(self, row: int, verdict: Verdict) -> int:
        """Give the row and all its content one verdict; return the row after."""
        end, parent = self.document.ends[row], self.document.parents[row]
        id = self.element_ids[row] or (self.element_ids[parent] if parent >= 0 else "")
        for inner in range(row, end):
            self.verdicts[inner], self.element_ids[inner] = verdict, id
        return end

    def next_row(self, row: int) -> int:
        """Return the next row of the walk, which skips content that has verdicts already."""
        following = row + 1
        end = self.document.ends[row]
        return end if following < end and self.verdicts[following] is not None else following

    def approximate(self, row: int, rule: Rule, loss: str) -> None:
        """Mark the row as approximated; *loss* is the part of its meaning that is lost."""
        self.verdicts[row] = Verdict.APPROXIMATED
        self.losses[row] = rule, loss

    # -- owners and names --------------------------------------------------------------------------

    def find_owner(self, row: int) -> Element | None:
        """Return the element of the nearest row above that has one."""
        parent = self.document.parents[row]
        if parent < 0:
            return None
        return self.elements[parent] or self.unit.graph.get(self.element_ids[parent])

    def qualified_name(self, row: int) -> str:
        """Return the qualified name of a row, also of a row without an element of its own."""
        graph = self.unit.graph
        if self.elements[row]:
            return graph.qualified_name(graph[self.element_ids[row]])
        owner = self.find_owner(row)
        name = self.document.attributes[row].get("name") or f"<{self.document.features[row]}>"
        return f"{graph.qualified_name(owner)}::{name}" if owner is not None else name

    def locate(self, row: int) -> Place:
        """Return the location of the row."""
        return Place(self.document.name, self.document.ordinals[row])

    def subject(self, row: int) -> Subject:
        """Return the element that the row is, or that contains it, as a subject of diagnostics."""
        return Subject(self.qualified_name(row), self.element_ids[row], self.locate(row))

    # -- references --------------------------------------------------------------------------------

    def find_target(self, reference: WrittenReference) -> "Target | None":
        """Return the row that a reference of this file means, or None if no file has it."""
        return self.unit.find_target(self, reference.target, reference.is_href)

    def find_first_target(self, row: int, feature: str) -> "Target | None":
        """Return the row that the first reference of a feature means, or None."""
        for reference in self.document.references(row, feature):
            return self.find_target(reference)
        return None

    def add_reference(
        self,
        edge: Edge,
        source: str,
        reference: WrittenReference,
        feature: str,
        *,
        is_reversed: bool = False,
    ) -> None:
        """Add an edge from *source* to the target of *reference*, which *feature* writes.

        The reference is resolved when all documents are lowered.
        """
        self.unit.references.append(
            UnresolvedReference(edge, source, self, *reference, feature, is_reversed)
        )

    def add_references(self, edge: Edge, source: str, row: int, feature: str) -> None:
        """Add an edge from *source* to each target of a feature of the row."""
        for reference in self.document.references(row, feature):
            self.add_reference(edge, source, reference, feature)

    def defer_check(self, row: int, feature: str, value: str, is_redundant: bool = True) -> None:
        """Note the ids of a reference that no edge follows, to check later that they exist."""
        ids = self.document.ids
        missing = [target for target in self.document.split_ids(value) if target not in ids]
        if missing and not self.document.is_in_extension(row):
            holder, ordinal = self.element_ids[row], self.document.ordinals[row]
            self.unchecked_references.append(
                UncheckedReference(holder, ordinal, feature, missing, is_redundant)
            )


RowHandler = Callable[[File, int], None]
"""Lowers a row and its content."""
ElementHandler = Callable[[File, Element, int], None]
"""Completes the element of a row."""


class Target(NamedTuple):
    """The row that a reference leads to."""

    file: File
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
    file: File
    target: str
    row: int
    is_href: bool
    feature: str
    is_reversed: bool
    """Whether the edge leads from the target to the source."""


class Unit:
    """The documents of a compile unit, and the references between their elements."""

    def __init__(self, documents: list[Document], graph: Graph, sink: Sink) -> None:
        self.graph = graph
        self.sink = sink
        self.files = [File(document, self) for document in documents]
        self.references: list[UnresolvedReference] = []
        self.profiles = Profiles()
        self.library_ids: dict[str, tuple[str, str]] = {}
        """Elements of used projects by their id: id in the graph, and file as hrefs name it."""
        self.nested_paths: dict[str, tuple[File, list[WrittenReference]]] = {}
        """Paths that ``NestedConnectorEnd`` gives connector ends, by the id of the end."""
        self.positions: Counter[tuple[str, str]] = Counter()
        """Number of derived ids by owner, or file, and feature."""
        self._holders: dict[str, list[File]] = {}
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

    def find_target(self, file: File, target: str, is_href: bool) -> Target | None:
        """Return the row that an id or href of *file* means, or None if no file has it."""
        if not is_href:
            return self._find_by_id(file, target)
        key = file.document.name, target
        if key not in self._href_targets:
            self._href_targets[key] = self._find_by_href(file, target)
        return self._href_targets[key]

    def find_target_id(self, file: File, target: str, is_href: bool) -> str | None:
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

    def _find_holders(self, id: str) -> list[File]:
        if len(self.files) == 1:
            return self.files if id in self.files[0].document.ids else []
        return self._holders.get(id, [])

    def _find_by_id(self, file: File, target: str) -> Target | None:
        row = file.document.ids.get(target)
        if row is None and hrefs.is_path(target):
            row = hrefs.find_row_at_path(file.document, target)
        if row is not None:
            return Target(file, row)
        holders = self._find_holders(target)
        return Target(holders[0], holders[0].document.ids[target]) if len(holders) == 1 else None

    def _find_by_href(self, file: File, href: str) -> Target | None:
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

    @cached_property
    def flow_targets(self) -> frozenset[str]:
        """Ids of the targets of all flows; all documents must have been lowered."""
        return frozenset(
            self.find_target_id(reference.file, reference.target, reference.is_href) or ""
            for reference in self.references
            if reference.edge is Edge.FLOW_TARGET
        )

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

    def _ordinal(self, source: str, file: File, row: int) -> int:
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
