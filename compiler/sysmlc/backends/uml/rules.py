"""Rules for what UML cannot express, the counter of such losses, and facts for the way back.

A model from AutomationML loses nothing: what UML cannot express is stored in a comment, and the
pass ``kept`` restores it when the saved model is read.
"""

from dataclasses import dataclass, field

from sysmlc.backends.base import LossCounter
from sysmlc.backends.uml.hrefs import make_href
from sysmlc.diagnostics import Rule, Severity, Sink, rule
from sysmlc.ir import AttrValue, Edge, Element, Graph, Kind
from sysmlc.ir.query.names import CAEX_ID, find_caex_id
from sysmlc.ir.round_trip import Record, StoredElement, encode_record
from sysmlc.support.counts import count

UNSUPPORTED_KIND = rule(
    "SM720",
    "uml-without-kind",
    Severity.WARNING,
    "UML cannot express {kind} ({count} omitted from the saved model)",
    help="--emit +ir or +ecore saves the whole graph",
)
UNSUPPORTED_EDGE = rule(
    "SM721",
    "uml-without-relation",
    Severity.WARNING,
    "UML cannot express '{edge}' from {kind} to {target} ({count} omitted from the saved model)",
    help="--emit +ir or +ecore saves the whole graph",
)
UNSUPPORTED_ATTRIBUTE = rule(
    "SM722",
    "uml-without-attribute",
    Severity.WARNING,
    "UML cannot express '{attribute}' of {kind} ({count} omitted from the saved model)",
    help="--emit +ir or +ecore saves the whole graph",
)
MOVED = rule(
    "SM723",
    "uml-moved",
    Severity.INFO,
    "UML lets no {owner} own {kind}: saved with the nearest possible owner ({count})",
)
APPROXIMATED = rule(
    "SM724",
    "uml-approximated",
    Severity.INFO,
    "{construct} is saved as {replacement} ({count})",
)
ILLEGAL_CHARACTERS = rule(
    "SM725",
    "uml-illegal-character",
    Severity.WARNING,
    "{count} not allowed in XML, replaced in the saved model",
)
STORED_FACTS = rule(
    "SM726",
    "uml-kept",
    Severity.INFO,
    "UML cannot express {count} of the plant: a comment preserves this for the conversion back",
)
RESPELT_ID = rule(
    "SM747",
    "uml-value-names-respelt-id",
    Severity.WARNING,
    "an ID is not a valid XML name, so that its element has another id in the saved model; values "
    "that name the ID ({count}) lead nowhere there",
    help=(
        "let the plant's tool assign IDs that start with a letter, or follow these "
        "values in the plant and not in the saved model"
    ),
)
IMMEDIATE = rule(
    "SM490",
    "uml-when-waits-for-change",
    Severity.INFO,
    "'accept when' of SysML v2 also fires if its condition is already true; it is saved as a "
    "change event, which waits until the condition becomes true ({count})",
    help="let the behaviour ensure that the condition is false when the wait begins",
)
_UNSUPPORTED = frozenset({UNSUPPORTED_KIND, UNSUPPORTED_EDGE, UNSUPPORTED_ATTRIBUTE})


# -- facts for the way back --------------------------------------------------------------------

_IMPLIED_EDGES = frozenset({Edge.OWNS, Edge.FEATURE})
"""Edges that containment expresses, or that passes add again."""


def is_plant(graph: Graph) -> bool:
    """Whether the graph comes from AutomationML."""
    documents = graph.of_kind(Kind.DOCUMENT)
    return any(document.subkind == "caex" and document.owner is None for document in documents)


@dataclass(slots=True)
class RoundTripFacts:
    """Facts of a plant that UML cannot express; keys are the ids of elements in the file."""

    graph: Graph
    ids: dict[str, str]
    """The id in the file, by the id in the graph."""
    added: list[str] = field(default_factory=list)
    """Ids of elements that are written only because UML or SysML requires them."""
    profiled: list[str] = field(default_factory=list)
    """Ids of packages that apply SysML only because the saved model does."""
    _elements: dict[str, Element] = field(default_factory=dict)
    _attributes: dict[str, dict[str, AttrValue]] = field(default_factory=dict)
    _names: dict[str, str] = field(default_factory=dict)
    _owners: dict[str, str | None] = field(default_factory=dict)
    _edges: dict[tuple[Edge, str, str], None] = field(default_factory=dict)

    def store_attribute(self, element: Element, name: str) -> None:
        """Store an attribute; ``name`` is the name of an element that has none in UML."""
        if name == "name":
            self._names[self.ids[element.id]] = element.name
        elif name in element.attrs:
            attributes = self._attributes.setdefault(self.ids[element.id], {})
            value = element.attrs[name]
            # A value of an interface is the text of the author, even if it equals an id.
            attributes[name] = value if name.startswith("value.") else self._replace_ids(value)

    def store_owner(self, element: Element) -> None:
        """Store the owner of an element that is saved with another owner."""
        owner = element.owner
        self._owners[self.ids[element.id]] = None if owner is None else self.ids[owner]

    def store_edge(self, edge: Edge, source: Element, target: Element) -> None:
        """Store an edge."""
        self._edges[edge, self.ids[source.id], self.ids[target.id]] = None

    def store_element(self, element: Element) -> None:
        """Store an element with all its attributes and edges."""
        if element.id in self._elements:
            return
        self._elements[element.id] = element
        for name in element.attrs:
            self.store_attribute(element, name)
        for edge in Edge:
            if edge not in _IMPLIED_EDGES:
                for target in self.graph.targets(element, edge):
                    self.store_edge(edge, element, target)
                    if "href" in target.attrs:
                        self.store_element(target)

    def store_libraries(self) -> None:
        """Store the library elements that no file holds: units, standard libraries."""
        for element in self.graph:
            if element.attrs.get("library") and not element.attrs.get("href"):
                for member in self.graph.subtree(element):
                    self.store_element(member)

    def store_caex_ids(self) -> None:
        """Store the IDs of AutomationML, of which ``xmi:id`` allows only some."""
        documents = self.graph.of_kind(Kind.DOCUMENT)
        files = {document.source for document in documents if document.subkind == "caex"} - {""}
        for element in self.graph:
            id = find_caex_id(element, files)
            if id:
                self._attributes.setdefault(self.ids[element.id], {})[CAEX_ID] = id

    def encode(self) -> str:
        """Return the body of the comment."""
        # Owners come before the elements that they own, as the reader needs them.
        members = (item for root in self.graph.roots() for item in self.graph.subtree(root))
        elements = [item for item in members if item.id in self._elements]
        record = Record(
            elements=[self._describe_element(element) for element in elements],
            attributes=self._attributes,
            names=self._names,
            owners=self._owners,
            edges=list(self._edges),
            made=self.added,
            applied=self.profiled,
        )
        return encode_record(record)

    def _describe_element(self, element: Element) -> StoredElement:
        """Return the element as the comment stores it; only an external stub has an href."""
        owner = None if element.owner is None else self.ids[element.owner]
        href = None
        if element.attrs.get("external"):
            href = str(element.attrs.get("href") or make_href(self.graph, element))
        return StoredElement(self.ids[element.id], element.kind, element.name, owner, href)

    def _replace_ids(self, value: AttrValue) -> AttrValue:
        """Return a value in which ids of the graph are replaced by those of the file."""
        if isinstance(value, tuple):
            return tuple(self._replace_ids(item) for item in value)
        return self.ids.get(value, value) if isinstance(value, str) else value


# -- losses ------------------------------------------------------------------------------------


@dataclass
class Losses(LossCounter):
    """Counts what UML does not express."""

    round_trip: RoundTripFacts | None = None
    """The facts that a plant stores for the way back; None for other models."""

    def record(self, loss: Rule, element: Element, /, **facts: str) -> None:
        """Count a loss of *element*, and store what a plant needs to restore it."""
        if self.round_trip is not None:
            self._store(self.round_trip, loss, element, facts)
        super().record(loss, element, **facts)

    def record_approximation(self, element: Element, original: str, replacement: str) -> None:
        """Count an element that is saved in another form."""
        self.record(APPROXIMATED, element, construct=original, replacement=replacement)

    def record_attribute(self, element: Element, name: str) -> None:
        """Count an attribute that UML cannot express."""
        self.record(UNSUPPORTED_ATTRIBUTE, element, attribute=name, kind=str(element.kind))

    def _store(
        self, round_trip: RoundTripFacts, loss: Rule, element: Element, facts: dict[str, str]
    ) -> None:
        if loss is UNSUPPORTED_ATTRIBUTE:
            round_trip.store_attribute(element, facts["attribute"])
        elif loss is UNSUPPORTED_KIND:
            round_trip.store_element(element)
        elif loss is MOVED:
            round_trip.store_owner(element)
        elif loss is APPROXIMATED:
            round_trip.store_attribute(element, "subkind")

    def list_losses(self) -> list[tuple[Rule, Element, dict[str, object]]]:
        """Return the losses, without facts that are stored for restoring a plant."""
        losses = super().list_losses()
        if self.round_trip is None:
            return losses
        return [loss for loss in losses if loss[0] not in _UNSUPPORTED]

    def report(self, sink: Sink) -> None:
        """Report the facts stored for the way back by one diagnostic, then the losses."""
        stored = super().list_losses() if self.round_trip is not None else []
        stored = [loss for loss in stored if loss[0] in _UNSUPPORTED]
        if stored:
            phrases = [loss.phrase.format(**facts) for loss, _, facts in stored]
            notes = tuple(text.replace(" omitted from the saved model", "") for text in phrases)
            total = sum(int(str(facts["count"])) for _, _, facts in stored)
            sink.report(
                STORED_FACTS,
                self.graph.subject(stored[0][1]),
                notes=notes,
                count=count(total, "fact"),
            )
        super().report(sink)
