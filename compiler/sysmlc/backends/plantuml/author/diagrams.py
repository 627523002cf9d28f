"""Diagrams as their authors drew them: their choice of elements and lines, our notation."""

from collections.abc import Iterator
from dataclasses import dataclass
from functools import cached_property

from msgspec.structs import replace

from sysmlc.backends.plantuml import labels, parametric, sequence, use_case
from sysmlc.backends.plantuml.author import behaviours as author_behaviours
from sysmlc.backends.plantuml.author import boxes as author_boxes
from sysmlc.backends.plantuml.author import internal_block as author_parts
from sysmlc.backends.plantuml.author.selection import Choice
from sysmlc.backends.plantuml.parametric import Binding, bindings
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
from sysmlc.support.plantuml_text import plain

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


def diagrams(graph: Graph, sink: Sink) -> Iterator[Diagram]:
    """One diagram for each View of an author, in the order of the model."""
    drawer = _Drawer(graph)
    for view in graph.of_kind(Kind.VIEW):
        if is_author_view(view):
            made = drawer.diagram(Choice(graph, view), sink)
            if made is not None:
                yield made


def is_author_view(view: Element) -> bool:
    """Whether a View is a diagram, not a view of SysML."""
    return view.kind is Kind.VIEW and view.subkind == "diagram"


@dataclass
class _Drawer:
    """What all diagrams of a graph need, made once."""

    graph: Graph

    @cached_property
    def _relations(self) -> list[Relation]:
        return author_boxes.every_relation(self.graph)

    @cached_property
    def _bindings(self) -> dict[str, list[Binding]]:
        return bindings(self.graph)

    @cached_property
    def _sequences(self) -> dict[str, Diagram]:
        return {diagram.about: diagram for diagram in sequence.diagrams(self.graph)}

    def diagram(self, choice: Choice, sink: Sink) -> Diagram | None:
        word = str(choice.view.attrs.get("diagram", ""))
        made = self._view(choice, word) if choice.shown else None
        if made is None or _is_empty(made):
            _report_not_drawn(choice, word, sink)
            return None
        diagram = _diagram(choice, word, made)
        _report_left_out(choice, diagram, sink)
        return diagram

    def _view(self, choice: Choice, word: str) -> View | None:
        if word in ("bdd", "class", "pkg", "req"):
            return author_boxes.view(choice, self._relations)
        if word == "uc":
            return self._use_cases(choice)
        if word in ("ibd", "par"):
            return self._parametric(choice) or author_parts.view(choice)
        if word in ("act", "stm"):
            kind = Kind.ACTIVITY if word == "act" else Kind.STATE_MACHINE
            return author_behaviours.view(choice, kind)
        return self._sequence(choice) if word == "sd" else None

    def _use_cases(self, choice: Choice) -> View:
        figures = [one for one in choice.shown if one.kind in use_case.FIGURES]
        ids = {one.id for one in figures}
        inside = [r for r in self._relations if author_boxes.is_inside(choice, r, ids)]
        cases = [one for one in figures if one.kind is Kind.USE_CASE]
        actors = [one for one in figures if one not in cases]
        made = use_case.view(self.graph, cases, actors, inside)
        notes = (note for note in made.notes if not choice.ids.isdisjoint(note.shows))
        return replace(made, notes=tuple(notes))

    def _sequence(self, choice: Choice) -> View | None:
        about = author_behaviours.behaviour(choice, Kind.INTERACTION)
        made = self._sequences.get(about.id) if about is not None else None
        return made.view if made is not None else None

    def _parametric(self, choice: Choice) -> View | None:
        """Usages of constraint blocks; a diagram without bindings is drawn as parts and ports."""
        about = choice.about
        every = self._bindings.get(about.id, []) if about is not None else []
        found = [one for one in every if not choice.ids.isdisjoint(one.shows)]
        if about is None or not found:
            return None
        return parametric.chosen(self.graph, about, choice.shown, found)


def _is_empty(view: View) -> bool:
    if isinstance(view, BoxView):
        return not view.boxes
    if isinstance(view, GraphView):
        return not view.nodes
    if isinstance(view, UseCaseView):
        return not (view.actors or view.cases or view.subjects)
    return isinstance(view, InternalView) and not (view.frame.parts or view.frame.ports)


def _diagram(choice: Choice, word: str, view: View) -> Diagram:
    graph, about = choice.graph, choice.about
    whole = graph.qualified_name(choice.view)
    frame = [word]
    if about is not None:
        frame += [f"[{' '.join(labels.keywords(graph, about)) or about.kind}]", labels.name(about)]
    frame.append(f"[{choice.view.name or choice.view.attrs.get('diagram_type', '')}]")
    return Diagram(
        kind=word,
        name=whole,
        frame=plain(" ".join(frame)),
        heading=(_TITLES[word], whole),
        view=view,
        about=choice.view.id,
    )


# -- what is not there -------------------------------------------------------------------------


def _report_not_drawn(choice: Choice, word: str, sink: Sink) -> None:
    type_ = str(choice.view.attrs.get("diagram_type", "")) or word or "diagram"
    known = word in _TITLES
    reason = f"a {type_} is no drawing"
    if known:
        reason = "it shows nothing of the model that its notation has a place for"
    subject = choice.graph.subject(choice.view)
    sink.report(NOT_DRAWN, subject, name=choice.view.name, reason=reason)


def _report_left_out(choice: Choice, diagram: Diagram, sink: Sink) -> None:
    drawn = set(diagram.trace())
    missing = [one for one in choice.shown if one.id not in drawn and not _is_said(choice, one)]
    if missing:
        names = [one.name or str(one.kind) for one in missing[:_NAMES_SHOWN]]
        names += ["..."] if len(missing) > _NAMES_SHOWN else []
        sink.report(
            LEFT_OUT,
            choice.graph.subject(choice.view),
            count=len(missing),
            all=len(choice.shown),
            name=choice.view.name,
            names=", ".join(names),
        )


def _is_said(choice: Choice, one: Element) -> bool:
    """Whether the frame or another element says it.

    Papyrus draws the frame as a shape of its own, and regions in it; a classifier that is only
    named is the type of something that is drawn.
    """
    is_named = one.id in choice.listed and one.kind in CLASSIFIERS
    return is_named or one is choice.about or one.kind in (Kind.APPLICATION, Kind.REGION)
