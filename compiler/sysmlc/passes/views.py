"""Pass ``views``: turns the diagrams of authors into View elements."""

from collections.abc import Iterable, Iterator
from typing import ClassVar

from msgspec import Struct

from sysmlc.diagnostics import Severity, Sink, rule
from sysmlc.ir import AttrValue, Edge, Element, Graph, Kind
from sysmlc.ir.element import derived_id
from sysmlc.ir.pending import Drawing
from sysmlc.support.counts import count

MISSING = rule(
    "SM162",
    "diagram-shows-unknown",
    Severity.INFO,
    "diagram '{name}' shows {all}, {missing} of them from no file of the unit",
    help="give the other project as a further input",
)

SUBKIND = "diagram"
"""Subkind of the Views that this pass adds."""


class Views(Struct, frozen=True):
    """Turn the drawings that a front end stored into Views.

    Assumes resolved references. Guarantees a View ``subkind="diagram"`` for each drawing. Its owner
    is the owner of the diagram, and it has ``references`` to every element of the unit that the
    diagram shows. Nothing else in the graph changes. The pass runs last, because other passes query
    the references to an element.
    """

    name: ClassVar[str] = "views"
    after: ClassVar[tuple[str, ...]] = ("resolve",)

    def run(self, graph: Graph, sink: Sink) -> None:
        """Add the Views in place; see the class."""
        drawings = graph.derived(Drawing)
        if not drawings:
            return
        index = _DiagramIndex(graph)
        for drawing in drawings:
            id = _choose_id(graph, drawing)
            if id not in graph:
                _add_view(graph, sink, drawing, id, index)
        graph.store(Drawing, ())


class _DiagramIndex:
    """Index of elements by the ids that diagrams use: ids without file, and fragments of hrefs."""

    def __init__(self, graph: Graph) -> None:
        self._graph = graph
        self._by_id: dict[str, Element] = {}
        for element in graph:
            self._by_id.setdefault(element.id.rpartition("#")[2], element)
        for element in graph:
            href = element.attrs.get("href")
            if isinstance(href, str):
                self._by_id.setdefault(href.rpartition("#")[2], element)

    def find(self, file: str, target: str) -> Element | None:
        """Return the element to which an id or href in the file leads, or None."""
        id = target.rpartition("#")[2]
        exact = self._graph.get(f"{file}#{id}")
        return exact or self._graph.get(id) or self._by_id.get(id)

    def ids(self, file: str, targets: Iterable[str]) -> tuple[str, ...]:
        """Return the ids of the elements to which *targets* lead, each once."""
        elements = (self.find(file, target) for target in targets)
        return tuple(dict.fromkeys(element.id for element in elements if element is not None))


def _choose_id(graph: Graph, drawing: Drawing) -> str:
    if not drawing.id:
        return derived_id(drawing.source, f"diagram[{drawing.ordinal}]")
    existing = graph.get(drawing.id)
    is_occupied = existing is not None and existing.subkind != SUBKIND
    return f"{drawing.source}#{drawing.id}" if is_occupied else drawing.id


def _add_view(graph: Graph, sink: Sink, drawing: Drawing, id: str, index: _DiagramIndex) -> None:
    owner = index.find(drawing.file, drawing.owner) if drawing.owner else None
    context = index.find(drawing.file, drawing.context) if drawing.context else None
    view = Element(
        id,
        Kind.VIEW,
        drawing.name,
        owner.id if owner else None,
        drawing.ordinal,
        drawing.source,
        dict(_list_attributes(drawing, index)),
    )
    graph.add(view)
    if context is not None:
        graph.connect(Edge.REPRESENTS, view, context)
    shown = [index.find(drawing.file, target) for target in drawing.shown]
    for element in shown:
        if element is not None:
            graph.connect(Edge.REFERENCES, view, element)
    _report_missing(graph, sink, drawing, view, shown)


def _list_attributes(drawing: Drawing, index: _DiagramIndex) -> Iterator[tuple[str, AttrValue]]:
    yield "subkind", SUBKIND
    if drawing.diagram:
        yield "diagram", drawing.diagram
    yield "diagram_type", drawing.type
    paths = [index.ids(drawing.file, path) for path in drawing.paths]
    nested = tuple(dict.fromkeys(path for path in paths if len(path) > 1))
    if nested:
        yield "nesting", nested
    listed = index.ids(drawing.file, drawing.listed)
    if listed:
        yield "listed", listed
    yield "relations", tuple(_list_relations(drawing, index))


def _list_relations(drawing: Drawing, index: _DiagramIndex) -> Iterator[AttrValue]:
    for edge, source, target in drawing.relations:
        ends = [index.find(drawing.file, end) for end in (source, target)]
        if ends[0] is not None and ends[1] is not None:
            yield (str(edge.value), ends[0].id, ends[1].id)


def _report_missing(
    graph: Graph, sink: Sink, drawing: Drawing, view: Element, shown: list[Element | None]
) -> None:
    # `shown` also lists the lines for edges of the graph, for which no element exists.
    relation_count = len(drawing.relations)
    missing = sum(element is None for element in shown) - relation_count
    if missing > 0:
        sink.report(
            MISSING,
            graph.subject(view),
            missing=missing,
            all=count(len(shown) - relation_count, "element"),
            name=view.name or drawing.type,
        )
