"""Block definition diagrams: one for each package that owns classifiers."""

from collections.abc import Iterable, Iterator, Mapping

from msgspec.structs import replace

from sysmlc.backends.plantuml import labels, partitioning, use_case
from sysmlc.backends.plantuml.aliases import Aliases
from sysmlc.backends.plantuml.boxes import box, stub
from sysmlc.backends.plantuml.layout import box_view
from sysmlc.backends.plantuml.relations import Relation, relations
from sysmlc.backends.plantuml.views import Box, BoxView, Compartment, Diagram, Line
from sysmlc.ir import Edge, Element, Graph, Kind
from sysmlc.support.plantuml_text import keyword_label, lines, padded, plain

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
_WITH_BOX = frozenset([*BOXES, Kind.ACTIVITY])
_UPWARDS = {"--|>": "<|--", "..|>": "<|.."}
_DRAWN_AS_LINE = frozenset(["part", "reference"])


def diagrams(graph: Graph) -> Iterator[Diagram]:
    """All block definition diagrams, in the order of the packages."""
    every = [relation for relation in relations(graph) if _is_between_boxes(graph, relation)]
    homes = _homes(graph)
    relations_of = _group_by_package(every, homes)
    for package, classifiers in homes.items():
        own = tuple(item.id for item in classifiers)
        ours = tuple(relations_of.get(package, ()))
        yield from _of_package(graph, package, own, ours)


def _group_by_package(
    every: Iterable[Relation], homes: Mapping[str | None, list[Element]]
) -> dict[str | None, list[Relation]]:
    """Return the relations that the diagrams of each package show, in their order.

    A relation belongs to the package of its source; if no diagram shows the source, to the package
    of its target.
    """
    package_of = {item.id: package for package, items in homes.items() for item in items}
    groups: dict[str | None, list[Relation]] = {}
    for relation in every:
        end = relation.source if relation.source in package_of else relation.target
        if end in package_of:
            groups.setdefault(package_of[end], []).append(relation)
    return groups


def _homes(graph: Graph) -> dict[str | None, list[Element]]:
    """The classifiers that each package shows: its own and those inside its classifiers."""
    homes: dict[str | None, list[Element]] = {}
    of_use_cases = use_case.actors(graph)
    for root in graph.roots():
        for element in graph.subtree(root):
            is_shown = element.kind in _WITH_BOX and _is_shown(graph, element)
            if is_shown and element.id not in of_use_cases:
                homes.setdefault(labels.home(graph, element), []).append(element)
    return homes


def is_block(element: Element) -> bool:
    """Whether a block definition diagram has a box for it."""
    is_kind = element.kind in BOXES and element.role != "requirement"
    return is_kind and not element.attrs.get("external")


def _is_shown(graph: Graph, element: Element) -> bool:
    """A behaviour has a box when it stands in a package and has no diagram of its own."""
    if element.kind is not Kind.ACTIVITY and not is_block(element):
        return False
    owner = graph.owner(element)
    if owner is not None and owner.kind is Kind.TEMPLATE_PARAMETER:
        return False
    if element.kind is not Kind.ACTIVITY:
        return element.kind is not Kind.INSTANCE or not is_in_frame(graph, element)
    is_free = owner is None or owner.kind is Kind.PACKAGE
    is_drawn = any(item.kind in ACTIVITY_NODES for item in graph.owned(element))
    return is_free and not is_drawn and not element.attrs.get("external")


def is_in_frame(graph: Graph, instance: Element) -> bool:
    """Whether it, or an instance around it, frames an internal block diagram: it is drawn there."""
    around = (instance, *graph.ancestors(instance))
    frames = (one for one in around if one.kind is Kind.INSTANCE)
    return any(item.kind is Kind.CONNECTOR for one in frames for item in graph.owned(one))


def _of_package(
    graph: Graph, package: str | None, ids: tuple[str, ...], found: tuple[Relation, ...]
) -> Iterator[Diagram]:
    about, own = graph.get(package), set(ids)
    in_rows = {r.row: r.shows for r in found if r.row and r.target not in own}
    ours = [relation for relation in found if relation.row not in in_rows]
    ours += _containments(graph, [graph[id] for id in ids])
    ours, rows = fold_foreign_clients(ours, own)
    near = neighbours(own, ours)
    parts = partitioning.chunks(ids, near)
    whole = graph.qualified_name(about) if about is not None else "model"
    for index, part in enumerate(parts):
        shown = [graph[id] for id in part]
        inside = [r for r in ours if _belongs(r, set(part), own)]
        inside += _property_lines(graph, shown, inside)
        yield Diagram(
            kind="bdd",
            name=partitioning.numbered(whole, index, len(parts)),
            frame=plain(f"bdd [package] {whole}"),
            heading=("Block definition diagram", whole),
            view=_view(graph, shown, inside, in_rows, rows),
            about=package or "",
            footer=plain(partitioning.footer(index, len(parts), whole)),
        )


def _is_between_boxes(graph: Graph, relation: Relation) -> bool:
    ends = (graph[relation.source], graph[relation.target])
    return all(map(_is_boxable, ends)) and {end.kind for end in ends} != set(use_case.FIGURES)


def _is_boxable(element: Element) -> bool:
    return element.kind in _BOXABLE and element.role != "requirement"


_STUBS = (Kind.ACTIVITY, Kind.STATE_MACHINE, Kind.USE_CASE, Kind.UNIT, Kind.PACKAGE)
_BOXABLE = frozenset([*BOXES, *_STUBS])


def _containments(graph: Graph, classifiers: list[Element]) -> list[Relation]:
    pairs = ((graph.owner(item), item) for item in classifiers)
    return [
        Relation(owner.id, item.id, "+--")
        for owner, item in pairs
        if owner is not None and owner.kind in CLASSIFIERS
    ]


def neighbours(own: set[str], found: Iterable[Relation]) -> dict[str, list[str]]:
    """For each id in ``own`` what it is related to."""
    near: dict[str, list[str]] = {id: [] for id in sorted(own)}
    for relation in found:
        for one, other in (
            (relation.source, relation.target),
            (relation.target, relation.source),
        ):
            if one in near and one != other:
                near[one].append(other)
    return near


def _belongs(relation: Relation, part: set[str], own: set[str]) -> bool:
    """In a split package a line stands with its source, or with its target when that is ours."""
    return relation.source in part or (relation.source not in own and relation.target in part)


def _property_lines(
    graph: Graph, shown: list[Element], inside: Iterable[Relation]
) -> list[Relation]:
    """Parts and references without association whose type has a box: lines instead of rows."""
    boxes = {item.id for item in shown}
    taken = {id for relation in inside for id in relation.shows}
    found = []
    for owner in shown:
        for item in graph.owned(owner):
            type_ = graph.target(item, Edge.TYPED_BY)
            is_line = item.role in _DRAWN_AS_LINE and item.id not in taken
            if is_line and type_ is not None and type_.id in boxes:
                found.append(_property_line(owner, item, type_))
    return found


def _property_line(owner: Element, item: Element, type_: Element) -> Relation:
    arrow = {"composite": "*-->", "shared": "o-->"}.get(str(item.attrs.get("aggregation")), "-->")
    far = " ".join(part for part in (item.name, labels.multiplicity(item)) if part)
    return Relation(owner.id, type_.id, arrow, far=far, shows=(item.id,))


def _view(
    graph: Graph,
    shown: list[Element],
    inside: list[Relation],
    in_rows: Mapping[str, tuple[str, ...]],
    rows: Mapping[str, list[Relation]],
) -> BoxView:
    """``in_rows`` maps properties to what their row stands for, besides themselves."""
    aliases = Aliases()
    in_lines = {id for relation in inside for id in relation.shows}
    boxes = [box(graph, item, aliases, in_lines, in_rows) for item in shown]
    boxes = [
        add_client_rows(graph, made, rows.get(item.id, []))
        for item, made in zip(shown, boxes, strict=True)
    ]
    outside = [id for r in inside for id in (r.source, r.target) if id not in aliases]
    boxes += [stub(graph, graph[id], aliases) for id in dict.fromkeys(outside)]
    return box_view(boxes, [line(relation, aliases) for relation in inside])


def line(relation: Relation, aliases: Aliases | Mapping[str, str]) -> Line:
    """The relation between the aliases of its ends; the general classifier stands above."""
    if relation.arrow in _UPWARDS:
        upper, lower = aliases[relation.target], aliases[relation.source]
        text = keyword_label(relation.label)
        return Line(upper, _UPWARDS[relation.arrow], lower, text, shows=relation.shows)
    return Line(
        aliases[relation.source],
        relation.arrow,
        aliases[relation.target],
        keyword_label(relation.label),
        padded(relation.near),
        padded(relation.far),
        relation.shows,
    )


MAX_FOREIGN_CLIENTS = 3
"""Foreign clients in one diagram that still are boxes with lines."""

_CLIENTS_TITLE = "depended on by"
_CLIENT_WIDTH = 46


def fold_foreign_clients(
    found: Iterable[Relation], own: set[str]
) -> tuple[list[Relation], dict[str, list[Relation]]]:
    """The relations that stay lines, and those that become rows, by the box that has them."""
    every = list(found)
    inward = [one for one in every if _is_inward(one, own)]
    if len({one.source for one in inward}) <= MAX_FOREIGN_CLIENTS:
        return every, {}
    rows: dict[str, list[Relation]] = {}
    for one in inward:
        rows.setdefault(one.target, []).append(one)
    return [one for one in every if not _is_inward(one, own)], rows


def _is_inward(relation: Relation, own: set[str]) -> bool:
    is_plain = relation.arrow == "..>" and not relation.near and not relation.far
    return is_plain and relation.source not in own and relation.target in own


def add_client_rows(graph: Graph, box: Box, rows: list[Relation]) -> Box:
    """The box with a row for each relation."""
    if not rows:
        return box
    texts = (f"{labels.name(graph[one.source])} {one.label}".strip() for one in rows)
    shown = tuple(row for text in texts for row in lines(text, _CLIENT_WIDTH))
    return replace(
        box,
        compartments=(*box.compartments, Compartment(_CLIENTS_TITLE, shown)),
        shows=(*box.shows, *(id for one in rows for id in one.shows)),
    )
