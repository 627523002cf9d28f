"""Diagrams of authors: their selection of elements and lines, our notation.

A behaviour is the derived drawing without the elements that the author omitted. Block definition,
class, package and requirement diagrams consist of boxes and lines.
"""

from collections.abc import Callable, Iterable, Iterator
from dataclasses import dataclass
from functools import cached_property

from msgspec.structs import replace

from sysmlc.backends.plantuml import (
    activity,
    block_definition,
    boxes,
    labels,
    parametric,
    requirement,
    sequence,
    state_machine,
    use_case,
)
from sysmlc.backends.plantuml.author import internal_block as author_parts
from sysmlc.backends.plantuml.author.selection import FEATURES, LINES, Selection
from sysmlc.backends.plantuml.layout import arrange_boxes
from sysmlc.backends.plantuml.parametric import Binding, find_bindings
from sysmlc.backends.plantuml.relations import Relation, iter_use_case_relations, list_relations
from sysmlc.backends.plantuml.views import (
    Aliases,
    Box,
    BoxView,
    Diagram,
    GraphView,
    InternalView,
    Line,
    Node,
    Note,
    UseCaseView,
    View,
)
from sysmlc.diagnostics import Severity, Sink, rule
from sysmlc.ir import Edge, Element, Graph, Kind
from sysmlc.ir.query import CLASSIFIERS, is_requirement
from sysmlc.support.plantuml_text import escape_line, wrap_lines

NOT_DRAWN = rule(
    "SM702",
    "author-diagram-not-drawn",
    Severity.INFO,
    "diagram '{name}' of the model's author is not drawn: {reason}",
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
        return list_all_relations(self.graph)

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
            return build_box_view(choice, self._relations)
        if kind == "uc":
            return self._build_use_case_view(choice)
        if kind in ("ibd", "par"):
            return self._build_parametric_view(choice) or author_parts.build_view(choice)
        if kind in ("act", "stm"):
            kind = Kind.ACTIVITY if kind == "act" else Kind.STATE_MACHINE
            return build_behaviour_view(choice, kind)
        return self._find_sequence_view(choice) if kind == "sd" else None

    def _build_use_case_view(self, choice: Selection) -> View:
        figures = [element for element in choice.shown if element.kind in use_case.FIGURES]
        ids = {element.id for element in figures}
        inside = [r for r in self._relations if is_inside(choice, r, ids)]
        cases = [element for element in figures if element.kind is Kind.USE_CASE]
        actors = [element for element in figures if element not in cases]
        view = use_case.build_view(self.graph, cases, actors, inside)
        notes = (note for note in view.notes if not choice.ids.isdisjoint(note.shows))
        return replace(view, notes=tuple(notes))

    def _find_sequence_view(self, choice: Selection) -> View | None:
        about = find_behaviour(choice, Kind.INTERACTION)
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
    reason = f"a {type_} is not drawn"
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


# -- behaviours --------------------------------------------------------------------------------

_WHOLE: dict[Kind, Callable[[Graph, Element], GraphView]] = {
    Kind.ACTIVITY: activity.draw_whole,
    Kind.STATE_MACHINE: state_machine.draw_whole,
}


def find_behaviour(choice: Selection, kind: Kind) -> Element | None:
    """Return the behaviour of the frame, else the behaviour that owns the shown elements."""
    graph, about = choice.graph, choice.about
    starts = [*([about] if about else []), *choice.shown]
    candidates = (element for start in starts for element in (start, *graph.ancestors(start)))
    return next((element for element in candidates if element.kind is kind), None)


def build_behaviour_view(choice: Selection, kind: Kind) -> GraphView:
    """Return the nodes that the author selected, with their content, and the lines between them."""
    about = find_behaviour(choice, kind)
    if about is None:
        return GraphView((), ())
    whole = _WHOLE[kind](choice.graph, about)
    nodes = tuple(_select_nodes(whole.nodes, choice.ids))
    aliases = set(_iter_aliases(nodes))
    return GraphView(
        nodes,
        tuple(line for line in whole.lines if _is_drawn(line, aliases, choice.ids)),
        tuple(_select_notes(whole.notes, aliases, choice.ids)),
    )


def _select_nodes(nodes: Iterable[Node], ids: frozenset[str]) -> Iterator[Node]:
    for node in nodes:
        children = tuple(_select_nodes(node.children, ids))
        if children or not ids.isdisjoint(node.shows):
            yield replace(node, children=children)


def _iter_aliases(nodes: Iterable[Node]) -> Iterator[str]:
    for node in nodes:
        yield node.alias
        yield from _iter_aliases(node.children)


def _is_drawn(line: Line, aliases: set[str], ids: frozenset[str]) -> bool:
    return {line.source, line.target} <= aliases and not ids.isdisjoint(line.shows)


def _select_notes(notes: Iterable[Note], aliases: set[str], ids: frozenset[str]) -> Iterator[Note]:
    for note in notes:
        if not ids.isdisjoint(note.shows):
            yield replace(
                note, targets=tuple(target for target in note.targets if target in aliases)
            )


# -- boxes and lines ---------------------------------------------------------------------------

_ARROWS = {"--|>": Edge.SPECIALIZES, "..|>": Edge.REALIZES}
_TEXT = 44


def list_all_relations(graph: Graph) -> list[Relation]:
    """Return all relations that a diagram of boxes may show as lines."""
    return [
        *list_relations(graph),
        *requirement.list_relations(graph),
        *iter_use_case_relations(graph),
        *_iter_comment_anchors(graph),
    ]


def build_box_view(choice: Selection, candidates: Iterable[Relation]) -> BoxView:
    """Return the boxes that the author selected, and the lines that the diagram shows between
    them.
    """
    boxed = [item for item in choice.shown if _is_boxed(choice, item)]
    ids = {item.id for item in boxed}
    inside = [relation for relation in candidates if is_inside(choice, relation, ids)]
    in_lines = {id for relation in inside for id in relation.shows}
    aliases = Aliases()
    boxes = [_make_box(choice, item, aliases, in_lines) for item in boxed]
    return arrange_boxes(
        boxes, [block_definition.make_line(relation, aliases) for relation in inside]
    )


def _is_boxed(choice: Selection, item: Element) -> bool:
    if item.kind in LINES or item.kind is Kind.VIEW:
        return False
    if item.kind in FEATURES or item.kind is Kind.CONSTRAINT:
        return item.owner is None
    return True


def is_inside(choice: Selection, relation: Relation, boxes: set[str]) -> bool:
    """Whether the author drew the relation, and both its ends have boxes with these ids."""
    if not {relation.source, relation.target} <= boxes:
        return False
    edge = _ARROWS.get(relation.arrow)
    if edge is not None and not relation.shows:
        return choice.shows_edge(edge, relation.source, relation.target)
    return not relation.shows or relation.shows[0] in choice.ids


def _iter_comment_anchors(graph: Graph) -> Iterator[Relation]:
    for comment in graph.of_kind(Kind.COMMENT):
        for about in graph.targets(comment, Edge.REFERENCES):
            yield Relation(comment.id, about.id, "..")


# -- boxes -------------------------------------------------------------------------------------


def _make_box(choice: Selection, item: Element, aliases: Aliases, in_lines: set[str]) -> Box:
    graph = choice.graph
    if item.kind is Kind.COMMENT:
        text = "\\n".join(wrap_lines(str(item.attrs.get("body", "")), _TEXT))
        alias = aliases.make(item.id, "", "note")
        return Box(alias, text or labels.name(item), "requirement", shows=(item.id,))
    if item.attrs.get("external"):
        return boxes.make_stub(graph, item, aliases)
    if is_requirement(item):
        return requirement.make_box(graph, item, aliases)
    features = _list_features(choice, item)
    return boxes.make_box(graph, item, aliases, in_lines, {}, features)


def _list_features(choice: Selection, item: Element) -> list[Element]:
    """Return the features in the compartments: own, nested in the drawing, or inherited ones."""
    graph = choice.graph
    owned = graph.owned(item)
    if choice.is_summary:
        return owned
    nested = [id for path in choice.nesting for id in _list_below(path, item.id)]
    inherited = graph.targets(item, Edge.FEATURE) if item.id in choice.ids else []
    foreign = [
        feature
        for feature in inherited
        if feature.id in choice.ids and feature.owner not in choice.ids
    ]
    drawn = [graph[id] for id in nested if graph[id].kind in FEATURES]
    selected = [feature for feature in owned if feature.id in choice.ids]
    return list(dict.fromkeys([*selected, *drawn, *foreign]))


def _list_below(path: tuple[str, ...], id: str) -> tuple[str, ...]:
    """Return the ids drawn inside or on the border of the element with *id*, nested ports
    included.
    """
    return path[path.index(id) + 1 :] if id in path else ()
