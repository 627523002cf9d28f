"""Requirement diagrams: one for each package that owns requirements."""

from collections.abc import Iterable, Iterator

from sysmlc.backends.plantuml import block_definition, boxes, labels, partitioning
from sysmlc.backends.plantuml.layout import arrange_boxes
from sysmlc.backends.plantuml.relations import REQUIREMENT_ROLES, Relation, find_neighbours
from sysmlc.backends.plantuml.views import Aliases, Box, BoxView, Compartment, Diagram
from sysmlc.ir import Edge, Element, Graph, Kind
from sysmlc.ir.query import is_requirement, requirement_id, requirement_text
from sysmlc.support.plantuml_text import escape_line, wrap_lines

_KEYWORDS = {"derive": "deriveReqt"}
"""Keywords of relations that differ from the role."""
_ROLES = {
    Edge.SATISFIES: "satisfy",
    Edge.DERIVES: "derive",
    Edge.VERIFIES: "verify",
    Edge.REFINES: "refine",
    Edge.TRACES: "trace",
}
_TEXT_WIDTH = 44
_ROW_KINDS = (Kind.CONSTRAINT, Kind.PROPERTY)


def draw_requirements(graph: Graph) -> Iterator[Diagram]:
    """Yield all requirement diagrams, in the order of the packages."""
    if not any(map(is_requirement, graph)):
        return
    requirements_by_package: dict[str | None, list[Element]] = {}
    for root in graph.roots():
        for element in graph.subtree(root):
            if is_requirement(element) and not element.attrs.get("external"):
                requirements_by_package.setdefault(labels.find_package(graph, element), []).append(
                    element
                )
    candidates = list_relations(graph)
    for package, requirements in requirements_by_package.items():
        yield from _draw_package(graph, graph.get(package), requirements, candidates)


def list_relations(graph: Graph) -> list[Relation]:
    """Return the lines between requirements, and to elements that satisfy, verify or refine one."""
    return [*_iter_structure(graph), *_iter_relations(graph)]


def _iter_structure(graph: Graph) -> Iterator[Relation]:
    """Yield the containments of requirements, and the lines from usages to their definitions."""
    for element in filter(is_requirement, graph):
        owner = graph.owner(element)
        if owner is not None and is_requirement(owner):
            yield Relation(owner.id, element.id, "+--")
        for general in filter(is_requirement, graph.targets(element, Edge.SPECIALIZES)):
            yield Relation(element.id, general.id, "--|>")


def _iter_relations(graph: Graph) -> Iterator[Relation]:
    """Yield the dependencies of requirements, and edges that no dependency represents."""
    drawn: set[tuple[str, str, str]] = set()
    for item in graph.of_kind(Kind.DEPENDENCY):
        if item.role not in REQUIREMENT_ROLES:
            continue
        for client in graph.targets(item, Edge.CLIENT):
            for supplier in graph.targets(item, Edge.SUPPLIER):
                drawn.add((item.role, client.id, supplier.id))
                yield _make_relation(item.role, client.id, supplier.id, item)
    for edge, source, target in graph.edges(*_ROLES):
        if (_ROLES[edge], source, target) not in drawn:
            yield _make_relation(_ROLES[edge], source, target, None)


def _make_relation(role: str, client: str, supplier: str, item: Element | None) -> Relation:
    text = f"«{_KEYWORDS.get(role, role)}»"
    if item is not None and item.name:
        text += f" {item.name}"
    shows = (item.id,) if item is not None else ()
    return Relation(client, supplier, "..>", text, shows=shows)


def _draw_package(
    graph: Graph,
    package: Element | None,
    requirements: list[Element],
    candidates: Iterable[Relation],
) -> Iterator[Diagram]:
    ids = [requirement.id for requirement in requirements]
    package_relations = [
        relation
        for relation in candidates
        if not {relation.source, relation.target}.isdisjoint(ids)
    ]
    parts = partitioning.partition(ids, find_neighbours(ids, package_relations))
    title = graph.qualified_name(package) if package is not None else "model"
    for index, part in enumerate(parts):
        relations = [r for r in package_relations if {r.source, r.target} & set(part)]
        diagram = Diagram(
            kind="req",
            name=title,
            frame=escape_line(f"req [package] {title}"),
            heading=("Requirement diagram", title),
            view=_build_view(graph, [graph[id] for id in part], relations),
            about=package.id if package is not None else "",
        )
        yield partitioning.name_part(diagram, index, len(parts))


def _build_view(graph: Graph, shown: list[Element], relations: list[Relation]) -> BoxView:
    aliases = Aliases()
    boxes = [make_box(graph, item, aliases) for item in shown]
    outside = [id for r in relations for id in (r.source, r.target) if id not in aliases]
    boxes += [_make_outer_box(graph, graph[id], aliases) for id in dict.fromkeys(outside)]
    lines = [block_definition.make_line(relation, aliases) for relation in relations]
    return arrange_boxes(boxes, lines)


def make_box(graph: Graph, item: Element, aliases: Aliases) -> Box:
    """Return the box of a requirement, with id and text."""
    id, text = requirement_id(graph, item), requirement_text(graph, item)
    rows = [f"id = {id}"] if id else []
    rows += [f"text = {text}"] if text else []
    text_rows = tuple(row for text in rows for row in wrap_lines(text, _TEXT_WIDTH))
    members = [part for part in graph.owned(item) if part.kind in _ROW_KINDS]
    conditions = tuple(row for part in members for row in _format_row(graph, part))
    compartments = (Compartment("", text_rows), Compartment("constraints", conditions))
    alias = aliases.make(item.id, item.name, "requirement")
    return Box(
        alias,
        boxes.make_heading(graph, item),
        "requirement",
        tuple(part for part in compartments if part.rows),
        (item.id, *(part.id for part in members)),
    )


def _format_row(graph: Graph, part: Element) -> tuple[str, ...]:
    if part.kind is Kind.CONSTRAINT:
        return wrap_lines(labels.condition(part), _TEXT_WIDTH)
    return wrap_lines(labels.feature(graph, part), _TEXT_WIDTH)


def _make_outer_box(graph: Graph, item: Element, aliases: Aliases) -> Box:
    """Return the box of an element at the other end of a line.

    A requirement of another package is a grey stub.
    """
    if is_requirement(item) or item.attrs.get("external"):
        return boxes.make_stub(graph, item, aliases)
    owner = graph.owner(item)
    where = f"from {graph.qualified_name(owner)}" if owner is not None else ""
    alias = aliases.make(item.id, item.name, str(item.kind))
    return Box(alias, boxes.make_heading(graph, item, where), "block", shows=(item.id,))
