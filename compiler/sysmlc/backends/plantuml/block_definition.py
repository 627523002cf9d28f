"""Block definition diagrams: one for each package that owns classifiers."""

from collections.abc import Iterable, Iterator, Mapping, Sequence

from msgspec.structs import replace

from sysmlc.backends.plantuml import labels, partitioning, use_case
from sysmlc.backends.plantuml.boxes import make_box, make_stub
from sysmlc.backends.plantuml.layout import arrange_boxes
from sysmlc.backends.plantuml.relations import Relation, find_neighbours, list_relations
from sysmlc.backends.plantuml.views import Aliases, Box, BoxView, Compartment, Diagram, Line
from sysmlc.ir import Edge, Element, Graph, Kind
from sysmlc.support.plantuml_text import escape_line, format_keyword_label, pad_label, wrap_lines

CLASSIFIERS = (
    Kind.CLASS,
    Kind.COMPONENT,
    Kind.INTERFACE,
    Kind.DATA_TYPE,
    Kind.ENUMERATION,
    Kind.SIGNAL,
    Kind.ACTOR,
    Kind.ITEM,
)
BOXES = frozenset([*CLASSIFIERS, Kind.INSTANCE])
ACTIVITY_NODES = frozenset(
    [
        Kind.ACTION,
        Kind.STRUCTURED,
        Kind.CONTROL,
        Kind.OBJECT_NODE,
        Kind.DATA_STORE,
        Kind.ACTIVITY_PARAMETER,
    ]
)
_BOX_KINDS = frozenset([*BOXES, Kind.ACTIVITY])
_REVERSED_ARROWS = {"--|>": "<|--", "..|>": "<|.."}
_DRAWN_AS_LINE = frozenset(["part", "reference"])
_STUB_KINDS = (Kind.ACTIVITY, Kind.STATE_MACHINE, Kind.USE_CASE, Kind.UNIT, Kind.PACKAGE)
_BOXABLE = frozenset([*BOXES, *_STUB_KINDS])


def draw_block_definitions(graph: Graph) -> Iterator[Diagram]:
    """Yield all block definition diagrams, in the order of the packages."""
    candidates = [
        relation for relation in list_relations(graph) if _is_between_boxes(graph, relation)
    ]
    classifiers_by_package = _group_classifiers(graph)
    relations_of = _group_by_package(candidates, classifiers_by_package)
    for package, classifiers in classifiers_by_package.items():
        ids = tuple(item.id for item in classifiers)
        package_relations = tuple(relations_of.get(package, ()))
        yield from _draw_package(graph, package, ids, package_relations)


def _group_by_package(
    candidates: Iterable[Relation], classifiers_by_package: Mapping[str | None, list[Element]]
) -> dict[str | None, list[Relation]]:
    """Return the relations that the diagrams of each package show, in their order.

    A relation belongs to the package of its source; if no diagram shows the source, to the package
    of its target.
    """
    package_of = {
        item.id: package for package, items in classifiers_by_package.items() for item in items
    }
    groups: dict[str | None, list[Relation]] = {}
    for relation in candidates:
        end = relation.source if relation.source in package_of else relation.target
        if end in package_of:
            groups.setdefault(package_of[end], []).append(relation)
    return groups


def _group_classifiers(graph: Graph) -> dict[str | None, list[Element]]:
    """Return the classifiers that each package shows, those nested in its classifiers included."""
    classifiers_by_package: dict[str | None, list[Element]] = {}
    of_use_cases = use_case.find_use_case_actors(graph)
    for root in graph.roots():
        for element in graph.subtree(root):
            is_shown = element.kind in _BOX_KINDS and _is_shown(graph, element)
            if is_shown and element.id not in of_use_cases:
                classifiers_by_package.setdefault(labels.find_package(graph, element), []).append(
                    element
                )
    return classifiers_by_package


def is_block(element: Element) -> bool:
    """Whether a block definition diagram has a box for the element."""
    is_kind = element.kind in BOXES and element.role != "requirement"
    return is_kind and not element.attrs.get("external")


def _is_shown(graph: Graph, element: Element) -> bool:
    """Whether a block definition diagram shows the element.

    An activity has a box if it has no activity diagram and no classifier owns it.
    """
    if element.kind is not Kind.ACTIVITY and not is_block(element):
        return False
    owner = graph.owner(element)
    if owner is not None and owner.kind is Kind.TEMPLATE_PARAMETER:
        return False
    if element.kind is not Kind.ACTIVITY:
        return element.kind is not Kind.INSTANCE or not _is_in_frame(graph, element)
    is_free = owner is None or owner.kind is Kind.PACKAGE
    is_drawn = any(item.kind in ACTIVITY_NODES for item in graph.owned(element))
    return is_free and not is_drawn and not element.attrs.get("external")


def _is_in_frame(graph: Graph, instance: Element) -> bool:
    """Whether an internal block diagram shows the instance.

    It does if the instance, or an instance that contains it, owns a connector.
    """
    around = (instance, *graph.ancestors(instance))
    frames = (outer for outer in around if outer.kind is Kind.INSTANCE)
    return any(item.kind is Kind.CONNECTOR for outer in frames for item in graph.owned(outer))


def _draw_package(
    graph: Graph, package: str | None, ids: tuple[str, ...], candidates: tuple[Relation, ...]
) -> Iterator[Diagram]:
    about, own_ids = graph.get(package), set(ids)
    # A part whose type another package shows is a row: a grey box would carry a name only.
    in_rows = {r.row: r.shows for r in candidates if r.row and r.target not in own_ids}
    lines = [relation for relation in candidates if relation.row not in in_rows]
    lines += _list_containments(graph, [graph[id] for id in ids])
    lines, rows = _fold_foreign_clients(lines, own_ids)
    parts = partitioning.partition(ids, find_neighbours(ids, lines))
    title = graph.qualified_name(about) if about is not None else "model"
    lines_of_part = _group_by_part(lines, parts)
    for index, part in enumerate(parts):
        shown = [graph[id] for id in part]
        inside = lines_of_part[index]
        inside += _list_property_lines(graph, shown, inside)
        diagram = Diagram(
            kind="bdd",
            name=title,
            frame=escape_line(f"bdd [package] {title}"),
            heading=("Block definition diagram", title),
            view=_build_view(graph, shown, inside, in_rows, rows),
            about=package or "",
        )
        yield partitioning.name_part(diagram, index, len(parts))


def _is_between_boxes(graph: Graph, relation: Relation) -> bool:
    ends = (graph[relation.source], graph[relation.target])
    are_boxable = all(end.kind in _BOXABLE and end.role != "requirement" for end in ends)
    return are_boxable and {end.kind for end in ends} != set(use_case.FIGURES)


def _list_containments(graph: Graph, classifiers: list[Element]) -> list[Relation]:
    pairs = ((graph.owner(item), item) for item in classifiers)
    return [
        Relation(owner.id, item.id, "+--")
        for owner, item in pairs
        if owner is not None and owner.kind in CLASSIFIERS
    ]


def _group_by_part(
    lines: Iterable[Relation], parts: Sequence[Sequence[str]]
) -> list[list[Relation]]:
    """Return the relations that each part of a package that was split shows.

    The part with the source shows a relation; if the source belongs to another package, the part
    with the target.
    """
    index_of = {id: index for index, part in enumerate(parts) for id in part}
    groups: list[list[Relation]] = [[] for _ in parts]
    for relation in lines:
        index = index_of.get(relation.source, index_of.get(relation.target))
        if index is not None:
            groups[index].append(relation)
    return groups


def _list_property_lines(
    graph: Graph, shown: list[Element], inside: Iterable[Relation]
) -> list[Relation]:
    """Return lines for the parts and references whose types have boxes in the diagram.

    Only properties without an association are considered: the association has a line already.
    """
    boxes = {item.id for item in shown}
    shown_ids = {id for relation in inside for id in relation.shows}
    property_relations = []
    for owner in shown:
        for item in graph.owned(owner):
            type_ = graph.target(item, Edge.TYPED_BY)
            is_line = item.role in _DRAWN_AS_LINE and item.id not in shown_ids
            if is_line and type_ is not None and type_.id in boxes:
                property_relations.append(_make_property_line(owner, item, type_))
    return property_relations


def _make_property_line(owner: Element, item: Element, type_: Element) -> Relation:
    arrow = {"composite": "*-->", "shared": "o-->"}.get(str(item.attrs.get("aggregation")), "-->")
    far = " ".join(part for part in (item.name, labels.multiplicity(item)) if part)
    return Relation(owner.id, type_.id, arrow, far=far, shows=(item.id,))


def _build_view(
    graph: Graph,
    shown: list[Element],
    inside: list[Relation],
    in_rows: Mapping[str, tuple[str, ...]],
    rows: Mapping[str, list[Relation]],
) -> BoxView:
    """Build the view of *shown* and of the relations *inside* the diagram.

    *in_rows* maps a property to the further ids that its row shows; *rows* has the relations that
    became rows of a box.
    """
    aliases = Aliases()
    in_lines = {id for relation in inside for id in relation.shows}
    boxes = [make_box(graph, item, aliases, in_lines, in_rows) for item in shown]
    boxes = [
        _add_client_rows(graph, classifier_box, rows.get(item.id, []))
        for item, classifier_box in zip(shown, boxes, strict=True)
    ]
    outside = [id for r in inside for id in (r.source, r.target) if id not in aliases]
    boxes += [make_stub(graph, graph[id], aliases) for id in dict.fromkeys(outside)]
    return arrange_boxes(boxes, [make_line(relation, aliases) for relation in inside])


def make_line(relation: Relation, aliases: Aliases | Mapping[str, str]) -> Line:
    """Return the line between the aliases of both ends of the relation.

    A generalization starts at the general classifier, which PlantUML then draws above.
    """
    if relation.arrow in _REVERSED_ARROWS:
        upper, lower = aliases[relation.target], aliases[relation.source]
        text = format_keyword_label(relation.label)
        return Line(upper, _REVERSED_ARROWS[relation.arrow], lower, text, shows=relation.shows)
    return Line(
        aliases[relation.source],
        relation.arrow,
        aliases[relation.target],
        format_keyword_label(relation.label),
        pad_label(relation.near),
        pad_label(relation.far),
        relation.shows,
    )


MAX_FOREIGN_CLIENTS = 3
"""The largest number of clients of other packages that are drawn as boxes with lines."""

_CLIENTS_TITLE = "depended on by"
_CLIENT_WIDTH = 46


def _fold_foreign_clients(
    candidates: Iterable[Relation], own: set[str]
) -> tuple[list[Relation], dict[str, list[Relation]]]:
    """Return the relations to draw as lines, and by box the relations to show as rows.

    If more than three classifiers of other packages depend on the package, their dependencies
    become rows of the supplier's box: a package of machines on which twenty services depend would
    otherwise be as wide as twenty grey boxes.
    """
    all_relations = list(candidates)
    inward_relations = [relation for relation in all_relations if _is_inward(relation, own)]
    if len({relation.source for relation in inward_relations}) <= MAX_FOREIGN_CLIENTS:
        return all_relations, {}
    rows: dict[str, list[Relation]] = {}
    for relation in inward_relations:
        rows.setdefault(relation.target, []).append(relation)
    return [relation for relation in all_relations if not _is_inward(relation, own)], rows


def _is_inward(relation: Relation, own: set[str]) -> bool:
    is_plain = relation.arrow == "..>" and not relation.near and not relation.far
    return is_plain and relation.source not in own and relation.target in own


def _add_client_rows(graph: Graph, box: Box, rows: list[Relation]) -> Box:
    """Return the box with a row for each relation."""
    if not rows:
        return box
    texts = (f"{labels.name(graph[relation.source])} {relation.label}".strip() for relation in rows)
    client_rows = tuple(row for text in texts for row in wrap_lines(text, _CLIENT_WIDTH))
    return replace(
        box,
        compartments=(*box.compartments, Compartment(_CLIENTS_TITLE, client_rows)),
        shows=(*box.shows, *(id for relation in rows for id in relation.shows)),
    )
