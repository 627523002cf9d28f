"""Author diagrams: the elements and lines that an author selected, in the notation of the back end.

The diagram of a behaviour is the derived diagram without the elements that the author omitted.
Block definition, class, package and requirement diagrams consist of boxes and lines (decision 14).
"""

from collections.abc import Callable, Iterable, Iterator
from dataclasses import dataclass
from functools import cached_property

from msgspec.structs import replace

from sysmlc.backends.plantuml import (
    activity,
    author_internal_block,
    block_definition,
    boxes,
    labels,
    parametric,
    requirement,
    sequence,
    state_machine,
    use_case,
)
from sysmlc.backends.plantuml.author_selection import FEATURES, LINES, Selection
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
    Node,
    Note,
    UseCaseView,
    View,
)
from sysmlc.diagnostics import Severity, Sink, rule
from sysmlc.ir import Edge, Element, Graph, Kind
from sysmlc.ir.query import CLASSIFIERS, is_requirement
from sysmlc.support.counts import count
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
    "diagram '{name}' is drawn without {count} of {all}: {names}",
    help="the element is still in the graph (--emit graph) and in the other outputs",
)

FOLDER = "author/"
"""The folder of author diagrams, below the folder of derived diagrams."""
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
        # Views in the sense of SysML are no diagrams.
        if view.subkind == "diagram":
            diagram = drawer.draw(Selection(graph, view), sink)
            if diagram is not None:
                yield diagram


@dataclass
class _Drawer:
    """Draws the diagrams of one graph; relations and sequence diagrams are computed once."""

    graph: Graph

    @cached_property
    def _relations(self) -> list[Relation]:
        return _list_all_relations(self.graph)

    @cached_property
    def _bindings(self) -> dict[str, list[Binding]]:
        return find_bindings(self.graph)

    @cached_property
    def _sequences(self) -> dict[str, Diagram]:
        return {diagram.about: diagram for diagram in sequence.draw_sequences(self.graph)}

    def draw(self, selection: Selection, sink: Sink) -> Diagram | None:
        kind = str(selection.view.attrs.get("diagram", ""))
        view = self._build_view(selection, kind) if selection.shown else None
        if view is None or _is_empty(view):
            _report_not_drawn(selection, kind, sink)
            return None
        diagram = _make_diagram(selection, kind, view)
        _report_left_out(selection, diagram, sink)
        return diagram

    def _build_view(self, selection: Selection, kind: str) -> View | None:
        if kind in ("bdd", "class", "pkg", "req"):
            return _build_box_view(selection, self._relations)
        if kind == "uc":
            return self._build_use_case_view(selection)
        if kind in ("ibd", "par"):
            return self._build_parametric_view(selection) or author_internal_block.build_view(
                selection
            )
        if kind == "act":
            return _build_behaviour_view(selection, Kind.ACTIVITY)
        if kind == "stm":
            return _build_behaviour_view(selection, Kind.STATE_MACHINE)
        about = _find_behaviour(selection, Kind.INTERACTION) if kind == "sd" else None
        diagram = self._sequences.get(about.id) if about is not None else None
        return diagram.view if diagram is not None else None

    def _build_use_case_view(self, selection: Selection) -> View:
        figures = [element for element in selection.shown if element.kind in use_case.FIGURES]
        ids = {element.id for element in figures}
        inside = [r for r in self._relations if is_inside(selection, r, ids)]
        cases = [element for element in figures if element.kind is Kind.USE_CASE]
        actors = [element for element in figures if element not in cases]
        view = use_case.build_view(self.graph, cases, actors, inside)
        notes = (note for note in view.notes if not selection.ids.isdisjoint(note.shows))
        return replace(view, notes=tuple(notes))

    def _build_parametric_view(self, selection: Selection) -> View | None:
        """Return the parametric view of the selection, or None if it contains no binding.

        The caller then draws parts and ports: a diagram of type "par" may have no binding, and one
        of type "ibd" may have bindings.
        """
        about = selection.about
        candidates = self._bindings.get(about.id, []) if about is not None else []
        selected = [
            binding for binding in candidates if not selection.ids.isdisjoint(binding.shows)
        ]
        if about is None or not selected:
            return None
        return parametric.build_selected_view(self.graph, about, selection.shown, selected)


def _is_empty(view: View) -> bool:
    if isinstance(view, BoxView):
        return not view.boxes
    if isinstance(view, GraphView):
        return not view.nodes
    if isinstance(view, UseCaseView):
        return not (view.actors or view.cases or view.subjects)
    return isinstance(view, InternalView) and not (view.frame.parts or view.frame.ports)


def _make_diagram(selection: Selection, kind: str, view: View) -> Diagram:
    graph, about = selection.graph, selection.about
    name = graph.qualified_name(selection.view)
    frame = [kind]
    if about is not None:
        frame += [f"[{' '.join(labels.keywords(graph, about)) or about.kind}]", labels.name(about)]
    frame.append(f"[{selection.view.name or selection.view.attrs.get('diagram_type', '')}]")
    return Diagram(
        kind=kind,
        name=name,
        frame=escape_line(" ".join(frame)),
        heading=(_TITLES[kind], name),
        view=view,
        about=selection.view.id,
    )


# -- omissions ---------------------------------------------------------------------------------


def _report_not_drawn(selection: Selection, kind: str, sink: Sink) -> None:
    if kind in _TITLES:
        reason = "it shows nothing of the model that its notation has a place for"
    else:
        type_ = str(selection.view.attrs.get("diagram_type", "")) or kind or "diagram"
        reason = f"a {type_} is not drawn"
    subject = selection.graph.subject(selection.view)
    sink.report(NOT_DRAWN, subject, name=selection.view.name, reason=reason)


def _report_left_out(selection: Selection, diagram: Diagram, sink: Sink) -> None:
    drawn = set(diagram.list_trace())
    missing = [
        element
        for element in selection.shown
        if element.id not in drawn and not _is_shown_otherwise(selection, element)
    ]
    if missing:
        names = [element.name or str(element.kind) for element in missing[:_NAMES_SHOWN]]
        names += ["..."] if len(missing) > _NAMES_SHOWN else []
        sink.report(
            LEFT_OUT,
            selection.graph.subject(selection.view),
            count=len(missing),
            all=count(len(selection.shown), "element"),
            name=selection.view.name,
            names=", ".join(names),
        )


def _is_shown_otherwise(selection: Selection, element: Element) -> bool:
    """Whether the frame or another shape of the diagram shows the element.

    Papyrus stores the frame as a shape, and the regions of a state machine as shapes inside the
    frame. A classifier that is only listed is the type of a drawn element.
    """
    if element is selection.about or element.kind in (Kind.APPLICATION, Kind.REGION):
        return True
    return element.id in selection.listed and element.kind in CLASSIFIERS


# -- behaviours --------------------------------------------------------------------------------

_DRAW_WHOLE: dict[Kind, Callable[[Graph, Element], GraphView]] = {
    Kind.ACTIVITY: activity.draw_whole,
    Kind.STATE_MACHINE: state_machine.draw_whole,
}


def _find_behaviour(selection: Selection, kind: Kind) -> Element | None:
    """Return the behaviour that the frame represents, else the owner of the shown elements."""
    graph, about = selection.graph, selection.about
    starts = [*([about] if about else []), *selection.shown]
    candidates = (element for start in starts for element in (start, *graph.ancestors(start)))
    return next((element for element in candidates if element.kind is kind), None)


def _build_behaviour_view(selection: Selection, kind: Kind) -> GraphView:
    """Return the view of a behaviour, reduced to the nodes and lines that the author selected.

    A node that the author omitted stays if a selected node lies inside it.
    """
    about = _find_behaviour(selection, kind)
    if about is None:
        return GraphView((), ())
    whole = _DRAW_WHOLE[kind](selection.graph, about)
    nodes = tuple(_select_nodes(whole.nodes, selection.ids))
    aliases = set(_iter_aliases(nodes))
    return GraphView(
        nodes,
        tuple(
            line
            for line in whole.lines
            if {line.source, line.target} <= aliases and not selection.ids.isdisjoint(line.shows)
        ),
        tuple(_select_notes(whole.notes, aliases, selection.ids)),
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


def _select_notes(notes: Iterable[Note], aliases: set[str], ids: frozenset[str]) -> Iterator[Note]:
    for note in notes:
        if not ids.isdisjoint(note.shows):
            yield replace(
                note, targets=tuple(target for target in note.targets if target in aliases)
            )


# -- boxes and lines ---------------------------------------------------------------------------

_ARROWS = {"--|>": Edge.SPECIALIZES, "..|>": Edge.REALIZES}
_COMMENT_WIDTH = 44


def _list_all_relations(graph: Graph) -> list[Relation]:
    """Return all relations that a diagram of boxes may show as lines."""
    return [
        *list_relations(graph),
        *requirement.list_relations(graph),
        *iter_use_case_relations(graph),
        *(
            Relation(comment.id, about.id, "..")
            for comment in graph.of_kind(Kind.COMMENT)
            for about in graph.targets(comment, Edge.REFERENCES)
        ),
    ]


def _build_box_view(selection: Selection, candidates: Iterable[Relation]) -> BoxView:
    """Return the boxes that the author selected, and the lines between them."""
    boxed = [item for item in selection.shown if _is_boxed(selection, item)]
    ids = {item.id for item in boxed}
    inside = [relation for relation in candidates if is_inside(selection, relation, ids)]
    in_lines = {id for relation in inside for id in relation.shows}
    aliases = Aliases()
    boxes = [_make_box(selection, item, aliases, in_lines) for item in boxed]
    return arrange_boxes(
        boxes, [block_definition.make_line(relation, aliases) for relation in inside]
    )


def _is_boxed(selection: Selection, item: Element) -> bool:
    if item.kind in LINES or item.kind is Kind.VIEW:
        return False
    if item.kind in FEATURES or item.kind is Kind.CONSTRAINT:
        return item.owner is None
    return True


def is_inside(selection: Selection, relation: Relation, boxes: set[str]) -> bool:
    """Whether the author drew the relation and both its ends are among *boxes* (ids)."""
    if not {relation.source, relation.target} <= boxes:
        return False
    # A generalization or realization is an edge of the graph without id, so that the view lists it
    # by its two ends.
    edge = _ARROWS.get(relation.arrow)
    if edge is not None and not relation.shows:
        return selection.shows_edge(edge, relation.source, relation.target)
    return not relation.shows or relation.shows[0] in selection.ids


# -- boxes -------------------------------------------------------------------------------------


def _make_box(selection: Selection, item: Element, aliases: Aliases, in_lines: set[str]) -> Box:
    graph = selection.graph
    if item.kind is Kind.COMMENT:
        text = "\\n".join(wrap_lines(str(item.attrs.get("body", "")), _COMMENT_WIDTH))
        alias = aliases.make(item.id, "", "note")
        return Box(alias, text or labels.name(item), "requirement", shows=(item.id,))
    if item.attrs.get("external"):
        return boxes.make_stub(graph, item, aliases)
    if is_requirement(item):
        return requirement.make_box(graph, item, aliases)
    features = _list_features(selection, item)
    return boxes.make_box(graph, item, aliases, in_lines, {}, features)


def _list_features(selection: Selection, item: Element) -> list[Element]:
    """Return the features in the compartments of *item* that the author selected.

    These are owned features, features whose shapes lie inside the shape of *item*, and inherited
    features that no other box of the diagram owns.
    """
    graph = selection.graph
    owned = graph.owned(item)
    if selection.is_summary:
        return owned
    nested = [id for path in selection.nesting for id in _list_below(path, item.id)]
    inherited = graph.targets(item, Edge.FEATURE) if item.id in selection.ids else []
    foreign = [
        feature
        for feature in inherited
        if feature.id in selection.ids and feature.owner not in selection.ids
    ]
    drawn = [graph[id] for id in nested if graph[id].kind in FEATURES]
    selected = [feature for feature in owned if feature.id in selection.ids]
    return list(dict.fromkeys([*selected, *drawn, *foreign]))


def _list_below(path: tuple[str, ...], id: str) -> tuple[str, ...]:
    """Return the ids that a path has inside the element with *id*, or on its border."""
    return path[path.index(id) + 1 :] if id in path else ()
