"""Pass ``views``: the diagrams of authors become elements that lead to what they show."""

from collections.abc import Iterable, Iterator
from typing import ClassVar

from msgspec import Struct

from sysmlc.diagnostics import Severity, Sink, rule
from sysmlc.ir import AttrValue, Edge, Element, Graph, Kind
from sysmlc.ir.drawing import Drawing
from sysmlc.ir.identity import derived_id

MISSING = rule(
    "SM162",
    "diagram-shows-unknown",
    Severity.INFO,
    "{missing} of the {all} elements that diagram '{name}' shows are in no file of the unit",
    help="give the other project as a further input",
)

SUBKIND = "diagram"
"""Subkind of the Views that this pass makes."""


class Views(Struct, frozen=True):
    """Turn the drawings that a front end kept into Views.

    Assumes resolved references. Guarantees a View ``subkind="diagram"`` for each drawing, owned
    by what owns the diagram, with ``references`` to everything of the unit that it shows.
    Nothing else of the graph changes; it runs last because passes ask who refers to what.
    """

    name: ClassVar[str] = "views"
    after: ClassVar[tuple[str, ...]] = ("resolve",)

    def run(self, graph: Graph, sink: Sink) -> None:
        """Add the Views in place; see the class."""
        drawings = graph.derived(Drawing)
        if not drawings:
            return
        known = _Known(graph)
        for drawing in drawings:
            id = _id(graph, drawing)
            if id not in graph:
                _add(graph, sink, drawing, id, known)
        graph.store(Drawing, ())


class _Known:
    """Elements by what diagrams call them: ids, or hrefs of which the id counts."""

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
        """The element that the id or href means in the file, or None."""
        id = target.rpartition("#")[2]
        exact = self._graph.get(f"{file}#{id}")
        return exact or self._graph.get(id) or self._by_id.get(id)

    def ids(self, file: str, targets: Iterable[str]) -> tuple[str, ...]:
        """Ids in the graph of those that are there, each once."""
        found = (self.find(file, target) for target in targets)
        return tuple(dict.fromkeys(one.id for one in found if one is not None))


def _id(graph: Graph, drawing: Drawing) -> str:
    if not drawing.id:
        return derived_id(drawing.source, f"diagram[{drawing.ordinal}]")
    taken = graph.get(drawing.id)
    is_other = taken is not None and taken.subkind != SUBKIND
    return f"{drawing.source}#{drawing.id}" if is_other else drawing.id


def _add(graph: Graph, sink: Sink, drawing: Drawing, id: str, known: _Known) -> None:
    owner = known.find(drawing.file, drawing.owner) if drawing.owner else None
    context = known.find(drawing.file, drawing.context) if drawing.context else None
    view = Element(
        id,
        Kind.VIEW,
        drawing.name,
        owner.id if owner else None,
        drawing.ordinal,
        drawing.source,
        dict(_attributes(drawing, known)),
    )
    graph.add(view)
    if context is not None:
        graph.connect(Edge.REPRESENTS, view, context)
    shown = [known.find(drawing.file, target) for target in drawing.shown]
    for element in shown:
        if element is not None:
            graph.connect(Edge.REFERENCES, view, element)
    _report(graph, sink, drawing, view, shown)


def _attributes(drawing: Drawing, known: _Known) -> Iterator[tuple[str, AttrValue]]:
    yield "subkind", SUBKIND
    if drawing.diagram:
        yield "diagram", drawing.diagram
    yield "diagram_type", drawing.type
    paths = [known.ids(drawing.file, path) for path in drawing.paths]
    nested = tuple(dict.fromkeys(path for path in paths if len(path) > 1))
    if nested:
        yield "nesting", nested
    listed = known.ids(drawing.file, drawing.listed)
    if listed:
        yield "listed", listed
    yield "relations", tuple(_relations(drawing, known))


def _relations(drawing: Drawing, known: _Known) -> Iterator[AttrValue]:
    for edge, source, target in drawing.relations:
        ends = [known.find(drawing.file, end) for end in (source, target)]
        if ends[0] is not None and ends[1] is not None:
            yield (str(edge.value), ends[0].id, ends[1].id)


def _report(
    graph: Graph, sink: Sink, drawing: Drawing, view: Element, shown: list[Element | None]
) -> None:
    lines = len(drawing.relations)
    missing = sum(element is None for element in shown) - lines
    if missing > 0:
        sink.report(
            MISSING,
            graph.subject(view),
            missing=missing,
            all=len(shown) - lines,
            name=view.name or drawing.type,
        )
