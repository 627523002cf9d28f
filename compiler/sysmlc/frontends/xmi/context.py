"""The lowering of one document: its elements, verdicts, and the work that later steps finish.

Handlers note references that no edge follows and whose target is not in their own file. Most of
them repeat the reference of the other end, or ownership (``incoming``, ``association``), but their
targets must exist nevertheless: targets that no file of the unit defines are reported once for each
element and feature.
"""

from collections.abc import Callable, Collection
from typing import NamedTuple

from sysmlc.diagnostics import Place, Rule, Sink, Subject, Verdict
from sysmlc.frontends.xmi import rules, uml_features
from sysmlc.frontends.xmi import vocabulary as v
from sysmlc.frontends.xmi.document import WrittenReference
from sysmlc.frontends.xmi.unit import LoweredDocument, Unit, UnresolvedReference
from sysmlc.frontends.xmi.vocabulary import to_snake_case
from sysmlc.ir import AttrValue, Edge, Element
from sysmlc.ir.element import derived_id

RowHandler = Callable[["Context", int], None]
"""Lowers a row and its content."""
ElementHandler = Callable[["Context", Element, int], None]
"""Completes the element of a row."""


class UncheckedReference(NamedTuple):
    """References of a feature that lead to no element of the file and become no edge."""

    holder: str
    """Id of the element that has the feature, or of the nearest element around it."""
    ordinal: int
    feature: str
    targets: list[str]
    is_redundant: bool
    """Whether another feature, or ownership, states the same relation."""


class Context:
    """The lowering of one document.

    The walk over the rows fills the lists; the steps of ``reading.read`` that need all documents
    of the unit consume them.
    """

    def __init__(self, unit: Unit, file: LoweredDocument, sink: Sink) -> None:
        self.unit = unit
        self.graph = unit.graph
        self.sink = sink
        self.file = file
        self.document = file.document
        self.elements = file.elements
        self.element_ids = file.element_ids
        self.verdicts = file.verdicts
        self.losses: dict[int, str] = {}
        """What approximated rows are read without; SM114 reports it."""
        self.loss_rules: dict[int, tuple[Rule, str]] = {}
        """Rules that report the other approximated rows, and the reason."""
        self._positions: dict[tuple[str, str], int] = {}
        # Rows and elements that later steps lower.
        self.applications: list[int] = []
        self.baseless_applications: list[int] = []
        self.extensions: list[int] = []
        """Rows of the extensions of Enterprise Architect."""
        self.contained_hrefs: list[int] = []
        """Rows that stand for elements which their owner contains in another file."""
        self.connector_ends: list[tuple[Element, int]] = []
        self.parameter_nodes: list[tuple[Element, int]] = []
        self.triggers: list[tuple[Element, int]] = []
        self.event_rows: list[int] = []
        self.used_events: set[tuple[str, int]] = set()
        """File and row of the events that triggers of this document read."""
        self.guards: list[tuple[Element, Element | WrittenReference, int]] = []
        """Transitions, the constraint that is their guard or a reference to it, and the row."""
        self.opaque_elements: dict[str, tuple[Element, int]] = {}
        """Elements with several bodies or languages, by their id."""
        self.record_rows: dict[str, list[tuple[Element, int]]] = {}
        """Rows that become records of their owner (clauses, handlers, link ends), by attribute."""
        self.completions: list[tuple[ElementHandler, Element, int]] = []
        # Attributes that need the ids of all documents.
        self.bounds: dict[str, list[AttrValue]] = {}
        """Lower and upper bound of elements, by their id."""
        self.computed_bounds: set[str] = set()
        """Ids of elements that have an expression as a bound."""
        self.deferred_ids: list[tuple[Element, str, list[str], bool]] = []
        """Attributes that hold ids: element, attribute, ids or hrefs, whether they are hrefs."""
        self.deferred_conditions: list[tuple[str, str]] = []
        """Ids of constraints that are pre- or postconditions, with their subkind."""
        # Findings that the last step reports.
        self.unknown_values: list[tuple[int, str, str]] = []
        """Rows with an attribute whose value UML does not list."""
        self.unchecked_references: list[UncheckedReference] = []

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

    def approximate(self, row: int, loss: str) -> None:
        """Mark the row as approximated; *loss* is the part of its meaning that is lost."""
        self.verdicts[row] = Verdict.APPROXIMATED
        self.losses[row] = loss

    # -- owners, ids and names ---------------------------------------------------------------------

    def find_owner(self, row: int) -> Element | None:
        """Return the element of the nearest row above that has one."""
        parent = self.document.parents[row]
        if parent < 0:
            return None
        return self.elements[parent] or self.graph.get(self.element_ids[parent])

    def new_id(self, row: int, owner: str, feature: str) -> str:
        """Return the id for the row's element: its own, else one derived from its position."""
        id = self.document.attributes[row].get(self.document.id_key)
        if not id:
            return derived_id(owner or self.document.name, self._next_position(owner, feature))
        graph_id = self.unit.graph_id(self.document.name, id)
        if id in self.document.repeated_ids and graph_id in self.graph:
            self._report_repeated(row, id)
            return derived_id(graph_id, str(self.document.ordinals[row]))
        return graph_id

    def _next_position(self, owner: str, feature: str) -> str:
        number = self._positions.get((owner, feature), 0)
        self._positions[owner, feature] = number + 1
        return f"{feature}[{number}]"

    def _report_repeated(self, row: int, id: str) -> None:
        if self.document.is_in_extension(row):
            return
        subject = Subject(self.qualified_name(row), id, self.locate(row))
        self.sink.report(rules.REPEATED_ID, subject, id=id, file=self.document.name)

    def qualified_name(self, row: int) -> str:
        """Return the qualified name of a row, also of a row without an element of its own."""
        if self.elements[row]:
            return self.graph.qualified_name(self.graph[self.element_ids[row]])
        owner = self.find_owner(row)
        name = self.document.attributes[row].get("name") or f"<{self.document.features[row]}>"
        return f"{self.graph.qualified_name(owner)}::{name}" if owner is not None else name

    def locate(self, row: int) -> Place:
        """Return the location of the row."""
        return Place(self.document.name, self.document.ordinals[row])

    # -- references --------------------------------------------------------------------------------

    def add_reference(
        self,
        edge: Edge,
        source: str,
        reference: WrittenReference,
        feature: str,
        *,
        is_reversed: bool = False,
        file: LoweredDocument | None = None,
    ) -> None:
        """Add an edge from *source* to the target of *reference*, which *feature* writes.

        The reference is resolved when all documents are lowered. *file* is the file that writes it
        if it is not this document.
        """
        unresolved = UnresolvedReference(
            edge, source, file or self.file, *reference, feature, is_reversed
        )
        self.unit.references.append(unresolved)

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

    def defer_ids(self, element: Element, key: str, ids: list[str], is_href: bool = False) -> None:
        """Set an attribute to ids of the graph once all elements exist; *ids* are as written."""
        if ids:
            self.deferred_ids.append((element, key, ids, is_href))

    def defer_conditions(self, targets: list[str], feature: str) -> None:
        """Mark the constraints with these ids as conditions once all elements exist."""
        subkind = v.CONDITIONS[feature]
        self.deferred_conditions.extend((target, subkind) for target in targets)

    def set_bound(self, row: int, index: int, value: AttrValue) -> None:
        """Set the lower (0) or upper (1) bound of the element of the row."""
        id = self.element_ids[row]
        if id:
            self.bounds.setdefault(id, [1, 1])[index] = value


# -- dangling references -----------------------------------------------------------------------

_REDUNDANT_KEYS = frozenset(map(to_snake_case, uml_features.REDUNDANT_REFERENCES))


def check_references_inside(context: Context, row: int, followed: Collection[str] = ()) -> None:
    """Defer a check of the references in a row and its content that become no elements.

    Targets that are missing are reported. References of the features *followed* are not redundant:
    no other feature states them, so a missing target is an error. Notation has no references: the
    ``source`` of an annotation of Eclipse is the URI of a tool.
    """
    document = context.document
    notation_end = row
    for inner in range(row, document.ends[row]):
        if inner < notation_end:
            continue
        if document.features[inner] in v.NOTATION_FEATURES:
            notation_end = document.ends[inner]
            continue
        for name, value in document.attributes[inner].items():
            if name in uml_features.NAMING or name in followed:
                context.defer_check(inner, name, value, name not in followed)
        idref = document.idref(inner)
        if idref and inner != row:
            feature = document.features[inner]
            context.defer_check(document.parents[inner], feature, idref, feature not in followed)


def select_existing(context: Context, element: Element, key: str, targets: list[str]) -> list[str]:
    """Return the ids of the attribute *key* that exist, and note the others to report them."""
    ids = context.document.ids
    if key in uml_features.CHECKED_BY_RESOLVE or all(target in ids for target in targets):
        return targets
    missing = [target for target in targets if _is_missing(context, target)]
    if missing:
        reference = UncheckedReference(
            element.id, element.ordinal, key, missing, key in _REDUNDANT_KEYS
        )
        context.unchecked_references.append(reference)
    return [target for target in targets if target not in missing]


def report_dangling(context: Context) -> None:
    """Report targets that no file of the unit has; all documents must have been lowered."""
    groups: dict[tuple[int, str, bool], list[UncheckedReference]] = {}
    for reference in context.unchecked_references:
        missing = [target for target in reference.targets if _is_missing(context, target)]
        if missing:
            key = reference.ordinal, reference.feature, reference.is_redundant
            groups.setdefault(key, []).append(reference._replace(targets=missing))
    for references in groups.values():
        targets = [target for reference in references for target in reference.targets]
        _report(context, references[0], targets)


def _is_missing(context: Context, target: str) -> bool:
    return context.unit.find_target(context.file, target, False) is None


def _report(context: Context, first: UncheckedReference, targets: list[str]) -> None:
    holder = context.graph.get(first.holder)
    place = Place(context.document.name, first.ordinal)
    name = context.graph.qualified_name(holder) if holder is not None else context.document.name
    rule = rules.DANGLING_OPPOSITE if first.is_redundant else rules.DANGLING_FEATURE
    others = len(dict.fromkeys(targets)) - 1
    context.sink.report(
        rule,
        Subject(name, first.holder, place),
        cause=f"missing {targets[0]}" if others == 0 else "",
        feature=first.feature,
        element=name,
        target=targets[0],
        others=f" and {others} more that do" if others else ", which does",
    )
