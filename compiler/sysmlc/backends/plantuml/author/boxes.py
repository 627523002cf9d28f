"""Authors' diagrams of boxes and lines: block definition, class, package and requirement."""

from collections.abc import Iterable, Iterator

from sysmlc.backends.plantuml import block_definition, boxes, labels, requirement
from sysmlc.backends.plantuml.aliases import Aliases
from sysmlc.backends.plantuml.author.selection import FEATURES, LINES, Choice
from sysmlc.backends.plantuml.layout import box_view
from sysmlc.backends.plantuml.relations import Relation, relations, use_case_relations
from sysmlc.backends.plantuml.views import Box, BoxView
from sysmlc.ir import Edge, Element, Graph, Kind
from sysmlc.ir.query import is_requirement
from sysmlc.support.plantuml_text import lines

_ARROWS = {"--|>": Edge.SPECIALIZES, "..|>": Edge.REALIZES}
_TEXT = 44


def every_relation(graph: Graph) -> list[Relation]:
    """All lines that diagrams of boxes may show."""
    return [
        *relations(graph),
        *requirement.relations(graph),
        *use_case_relations(graph),
        *_anchors(graph),
    ]


def view(choice: Choice, every: Iterable[Relation]) -> BoxView:
    """The boxes that the author chose, and those of the lines that the diagram shows."""
    boxed = [item for item in choice.shown if _is_boxed(choice, item)]
    ids = {item.id for item in boxed}
    inside = [one for one in every if is_inside(choice, one, ids)]
    in_lines = {id for one in inside for id in one.shows}
    aliases = Aliases()
    boxes = [_box(choice, item, aliases, in_lines) for item in boxed]
    return box_view(boxes, [block_definition.line(one, aliases) for one in inside])


def _is_boxed(choice: Choice, item: Element) -> bool:
    if item.kind in LINES or item.kind is Kind.VIEW:
        return False
    if item.kind in FEATURES or item.kind is Kind.CONSTRAINT:
        return item.owner is None
    return True


def is_inside(choice: Choice, relation: Relation, boxes: set[str]) -> bool:
    """Whether the author drew the line between two boxes with these ids."""
    if not {relation.source, relation.target} <= boxes:
        return False
    edge = _ARROWS.get(relation.arrow)
    if edge is not None and not relation.shows:
        return choice.shows_edge(edge, relation.source, relation.target)
    return not relation.shows or relation.shows[0] in choice.ids


def _anchors(graph: Graph) -> Iterator[Relation]:
    for comment in graph.of_kind(Kind.COMMENT):
        for about in graph.targets(comment, Edge.REFERENCES):
            yield Relation(comment.id, about.id, "..")


# -- boxes -------------------------------------------------------------------------------------


def _box(choice: Choice, item: Element, aliases: Aliases, in_lines: set[str]) -> Box:
    graph = choice.graph
    if item.kind is Kind.COMMENT:
        text = "\\n".join(lines(str(item.attrs.get("body", "")), _TEXT))
        alias = aliases.make(item.id, "", "note")
        return Box(alias, text or labels.name(item), "requirement", shows=(item.id,))
    if item.attrs.get("external"):
        return boxes.stub(graph, item, aliases)
    if is_requirement(item):
        return requirement.box(graph, item, aliases)
    features = _features(choice, item)
    return boxes.box(graph, item, aliases, in_lines, {}, features)


def _features(choice: Choice, item: Element) -> list[Element]:
    """What its compartments show: own, nested in the drawing, or inherited features."""
    graph = choice.graph
    own = graph.owned(item)
    if choice.is_summary:
        return own
    nested = [id for path in choice.nesting for id in _inside(path, item.id)]
    inherited = graph.targets(item, Edge.FEATURE) if item.id in choice.ids else []
    foreign = [one for one in inherited if one.id in choice.ids and one.owner not in choice.ids]
    drawn = [graph[id] for id in nested if graph[id].kind in FEATURES]
    mine = [one for one in own if one.id in choice.ids]
    return list(dict.fromkeys([*mine, *drawn, *foreign]))


def _inside(path: tuple[str, ...], id: str) -> tuple[str, ...]:
    """What is drawn inside or on the border of the element with this id, ports of ports too."""
    return path[path.index(id) + 1 :] if id in path else ()
