"""Authors' diagrams of boxes and lines: block definition, class, package and requirement
diagrams.
"""

from collections.abc import Iterable, Iterator

from sysmlc.backends.plantuml import block_definition, boxes, labels, requirement
from sysmlc.backends.plantuml.aliases import Aliases
from sysmlc.backends.plantuml.author.selection import FEATURES, LINES, Selection
from sysmlc.backends.plantuml.layout import arrange_boxes
from sysmlc.backends.plantuml.relations import Relation, iter_use_case_relations, list_relations
from sysmlc.backends.plantuml.views import Box, BoxView
from sysmlc.ir import Edge, Element, Graph, Kind
from sysmlc.ir.query import is_requirement
from sysmlc.support.plantuml_text import wrap_lines

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


def build_view(choice: Selection, candidates: Iterable[Relation]) -> BoxView:
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
