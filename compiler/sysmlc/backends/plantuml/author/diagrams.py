"""Diagrams of authors: their selection of elements and lines, our notation."""

from collections.abc import Iterator
from dataclasses import dataclass
from functools import cached_property

from msgspec.structs import replace

from sysmlc.backends.plantuml import labels, parametric, sequence, use_case
from sysmlc.backends.plantuml.author import behaviours as author_behaviours
from sysmlc.backends.plantuml.author import boxes as author_boxes
from sysmlc.backends.plantuml.author import internal_block as author_parts
from sysmlc.backends.plantuml.author.selection import Selection
from sysmlc.backends.plantuml.parametric import Binding, find_bindings
from sysmlc.backends.plantuml.relations import Relation
from sysmlc.backends.plantuml.views import (
    BoxView,
    Diagram,
    GraphView,
    InternalView,
    UseCaseView,
    View,
)
from sysmlc.diagnostics import Severity, Sink, rule
from sysmlc.ir import Element, Graph, Kind
from sysmlc.ir.query import CLASSIFIERS
from sysmlc.support.plantuml_text import escape_line

NOT_DRAWN = rule(
    "SM702",
    "author-diagram-not-drawn",
    Severity.INFO,
    "diagram '{name}' of its author is not drawn: {reason}",
    help="requirements as tables: --emit +reqtable",
)
LEFT_OUT = rule(
    "SM703",
    "left-out-of-author-diagram",
    Severity.INFO,
    "{count} of the {all} elements that diagram '{name}' shows are not drawn: {names}",
    help="the element is still in the graph (--emit graph) and in the other outputs",
)

FOLDER = "author/"
"""Where these diagrams are, below those that are derived."""
_TITLES = {
    "bdd": "Block definition diagram",
    "class": "Class diagram",
    "pkg": "Package diagram",
    "req": "Requirement diagram",
    "uc": "Use case diagram",
    "ibd": "Internal block diagram",
    "par": "Parametric diagram",
    "act": "Activity diagram",
    "stm": "State machine diagram",
    "sd": "Sequence diagram",
}
_NAMES_SHOWN = 5


def draw_author_diagrams(graph: Graph, sink: Sink) -> Iterator[Diagram]:
    """Yield one diagram for each View of an author, in the order of the model."""
    drawer = _Drawer(graph)
    for view in graph.of_kind(Kind.VIEW):
        if is_author_view(view):
            diagram = drawer.draw(Selection(graph, view), sink)
            if diagram is not None:
                yield diagram


def is_author_view(view: Element) -> bool:
    """Whether a View is a diagram, not a view in the sense of SysML."""
    return view.kind is Kind.VIEW and view.subkind == "diagram"


@dataclass
class _Drawer:
    """Draws the diagrams of one graph; relations and sequence diagrams are computed once."""

    graph: Graph

    @cached_property
    def _relations(self) -> list[Relation]:
        return author_boxes.list_all_relations(self.graph)

    @cached_property
    def _bindings(self) -> dict[str, list[Binding]]:
        return find_bindings(self.graph)

    @cached_property
    def _sequences(self) -> dict[str, Diagram]:
        return {diagram.about: diagram for diagram in sequence.draw_sequences(self.graph)}

    def draw(self, choice: Selection, sink: Sink) -> Diagram | None:
        kind = str(choice.view.attrs.get("diagram", ""))
        view = self._build_view(choice, kind) if choice.shown else None
        if view is None or _is_empty(view):
            _report_not_drawn(choice, kind, sink)
            return None
        diagram = _make_diagram(choice, kind, view)
        _report_left_out(choice, diagram, sink)
        return diagram

    def _build_view(self, choice: Selection, kind: str) -> View | None:
        if kind in ("bdd", "class", "pkg", "req"):
            return author_boxes.build_view(choice, self._relations)
        if kind == "uc":
            return self._build_use_case_view(choice)
        if kind in ("ibd", "par"):
            return self._build_parametric_view(choice) or author_parts.build_view(choice)
        if kind in ("act", "stm"):
            kind = Kind.ACTIVITY if kind == "act" else Kind.STATE_MACHINE
            return author_behaviours.build_view(choice, kind)
        return self._find_sequence_view(choice) if kind == "sd" else None

    def _build_use_case_view(self, choice: Selection) -> View:
        figures = [element for element in choice.shown if element.kind in use_case.FIGURES]
        ids = {element.id for element in figures}
        inside = [r for r in self._relations if author_boxes.is_inside(choice, r, ids)]
        cases = [element for element in figures if element.kind is Kind.USE_CASE]
        actors = [element for element in figures if element not in cases]
        view = use_case.build_view(self.graph, cases, actors, inside)
        notes = (note for note in view.notes if not choice.ids.isdisjoint(note.shows))
        return replace(view, notes=tuple(notes))

    def _find_sequence_view(self, choice: Selection) -> View | None:
        about = author_behaviours.find_behaviour(choice, Kind.INTERACTION)
        diagram = self._sequences.get(about.id) if about is not None else None
        return diagram.view if diagram is not None else None

    def _build_parametric_view(self, choice: Selection) -> View | None:
        """Return the usages of constraint blocks; None for a diagram without bindings.

        A diagram without bindings is drawn as parts and ports.
        """
        about = choice.about
        candidates = self._bindings.get(about.id, []) if about is not None else []
        selected = [binding for binding in candidates if not choice.ids.isdisjoint(binding.shows)]
        if about is None or not selected:
            return None
        return parametric.build_selected_view(self.graph, about, choice.shown, selected)


def _is_empty(view: View) -> bool:
    if isinstance(view, BoxView):
        return not view.boxes
    if isinstance(view, GraphView):
        return not view.nodes
    if isinstance(view, UseCaseView):
        return not (view.actors or view.cases or view.subjects)
    return isinstance(view, InternalView) and not (view.frame.parts or view.frame.ports)


def _make_diagram(choice: Selection, kind: str, view: View) -> Diagram:
    graph, about = choice.graph, choice.about
    name = graph.qualified_name(choice.view)
    frame = [kind]
    if about is not None:
        frame += [f"[{' '.join(labels.keywords(graph, about)) or about.kind}]", labels.name(about)]
    frame.append(f"[{choice.view.name or choice.view.attrs.get('diagram_type', '')}]")
    return Diagram(
        kind=kind,
        name=name,
        frame=escape_line(" ".join(frame)),
        heading=(_TITLES[kind], name),
        view=view,
        about=choice.view.id,
    )


# -- what is not there -------------------------------------------------------------------------


def _report_not_drawn(choice: Selection, kind: str, sink: Sink) -> None:
    type_ = str(choice.view.attrs.get("diagram_type", "")) or kind or "diagram"
    is_drawable = kind in _TITLES
    reason = f"a {type_} is no drawing"
    if is_drawable:
        reason = "it shows nothing of the model that its notation has a place for"
    subject = choice.graph.subject(choice.view)
    sink.report(NOT_DRAWN, subject, name=choice.view.name, reason=reason)


def _report_left_out(choice: Selection, diagram: Diagram, sink: Sink) -> None:
    drawn = set(diagram.list_trace())
    missing = [
        element
        for element in choice.shown
        if element.id not in drawn and not _is_shown_otherwise(choice, element)
    ]
    if missing:
        names = [element.name or str(element.kind) for element in missing[:_NAMES_SHOWN]]
        names += ["..."] if len(missing) > _NAMES_SHOWN else []
        sink.report(
            LEFT_OUT,
            choice.graph.subject(choice.view),
            count=len(missing),
            all=len(choice.shown),
            name=choice.view.name,
            names=", ".join(names),
        )


def _is_shown_otherwise(choice: Selection, element: Element) -> bool:
    """Whether the frame or another element of the diagram shows an element.

    Papyrus draws the frame as a shape of its own, and regions in it. A classifier that is only
    listed is the type of an element that is drawn.
    """
    is_named = element.id in choice.listed and element.kind in CLASSIFIERS
    return is_named or element is choice.about or element.kind in (Kind.APPLICATION, Kind.REGION)
