"""Requirement diagrams: one for each package that owns requirements."""

from collections.abc import Iterable, Iterator

from sysmlc.backends.plantuml import block_definition, boxes, labels, partitioning
from sysmlc.backends.plantuml.aliases import Aliases
from sysmlc.backends.plantuml.layout import box_view
from sysmlc.backends.plantuml.relations import REQUIREMENT_ROLES, Relation
from sysmlc.backends.plantuml.views import Box, BoxView, Compartment, Diagram
from sysmlc.ir import Edge, Element, Graph, Kind
from sysmlc.ir.query import is_requirement
from sysmlc.support.plantuml_text import lines, plain

_WORDS = {"derive": "deriveReqt"}
_EDGES = {
    Edge.SATISFIES: "satisfy",
    Edge.DERIVES: "derive",
    Edge.VERIFIES: "verify",
    Edge.REFINES: "refine",
    Edge.TRACES: "trace",
}
_TEXT_WIDTH = 44


def diagrams(graph: Graph) -> Iterator[Diagram]:
    """All requirement diagrams, in the order of the packages."""
    if not any(map(is_requirement, graph)):
        return
    homes: dict[str | None, list[Element]] = {}
    for root in graph.roots():
        for element in graph.subtree(root):
            if is_requirement(element) and not element.attrs.get("external"):
                homes.setdefault(labels.home(graph, element), []).append(element)
    every = relations(graph)
    for package, requirements in homes.items():
        yield from _of_package(graph, graph.get(package), requirements, every)


def relations(graph: Graph) -> list[Relation]:
    """Lines between requirements, and to what satisfies, verifies or refines them."""
    return [*_containments(graph), *_relations(graph)]


def _containments(graph: Graph) -> Iterator[Relation]:
    for element in filter(is_requirement, graph):
        owner = graph.owner(element)
        if owner is not None and is_requirement(owner):
            yield Relation(owner.id, element.id, "+--")


def _relations(graph: Graph) -> Iterator[Relation]:
    """Dependencies between requirements and others; bare edges where there is no dependency."""
    seen: set[tuple[str, str, str]] = set()
    for item in graph.of_kind(Kind.DEPENDENCY):
        if item.role not in REQUIREMENT_ROLES:
            continue
        for client in graph.targets(item, Edge.CLIENT):
            for supplier in graph.targets(item, Edge.SUPPLIER):
                seen.add((item.role, client.id, supplier.id))
                yield _relation(item.role, client.id, supplier.id, item)
    for edge, source, target in graph.edges(*_EDGES):
        if (_EDGES[edge], source, target) not in seen:
            yield _relation(_EDGES[edge], source, target, None)


def _relation(role: str, client: str, supplier: str, item: Element | None) -> Relation:
    text = f"«{_WORDS.get(role, role)}»"
    if item is not None and item.name:
        text += f" {item.name}"
    shows = (item.id,) if item is not None else ()
    return Relation(client, supplier, "..>", text, shows=shows)


def _of_package(
    graph: Graph, package: Element | None, requirements: list[Element], every: Iterable[Relation]
) -> Iterator[Diagram]:
    own = {item.id for item in requirements}
    ours = [relation for relation in every if own & {relation.source, relation.target}]
    parts = partitioning.chunks(
        [item.id for item in requirements], block_definition.neighbours(own, ours)
    )
    whole = graph.qualified_name(package) if package is not None else "model"
    for index, part in enumerate(parts):
        inside = [r for r in ours if {r.source, r.target} & set(part)]
        yield Diagram(
            kind="req",
            name=partitioning.numbered(whole, index, len(parts)),
            frame=plain(f"req [package] {whole}"),
            heading=("Requirement diagram", whole),
            view=_view(graph, [graph[id] for id in part], inside),
            about=package.id if package is not None else "",
            footer=plain(partitioning.footer(index, len(parts), whole)),
        )


def _view(graph: Graph, shown: list[Element], inside: list[Relation]) -> BoxView:
    aliases = Aliases()
    boxes = [box(graph, item, aliases) for item in shown]
    outside = [id for r in inside for id in (r.source, r.target) if id not in aliases]
    boxes += [_other(graph, graph[id], aliases) for id in dict.fromkeys(outside)]
    return box_view(boxes, [block_definition.line(relation, aliases) for relation in inside])


def box(graph: Graph, item: Element, aliases: Aliases) -> Box:
    """The box of a requirement, with id and text."""
    rows = [f"id = {item.attrs['req_id']}"] if item.attrs.get("req_id") else []
    rows += [f"text = {item.attrs['text']}"] if item.attrs.get("text") else []
    shown = tuple(row for text in rows for row in lines(text, _TEXT_WIDTH))
    owned = [part for part in graph.owned(item) if part.kind in _INSIDE]
    conditions = tuple(row for part in owned for row in _row(graph, part))
    compartments = (Compartment("", shown), Compartment("constraints", conditions))
    alias = aliases.make(item.id, item.name, "requirement")
    return Box(
        alias,
        boxes.heading(graph, item),
        "requirement",
        tuple(part for part in compartments if part.rows),
        (item.id, *(part.id for part in owned)),
    )


_INSIDE = (Kind.CONSTRAINT, Kind.PROPERTY)


def _row(graph: Graph, part: Element) -> tuple[str, ...]:
    if part.kind is Kind.CONSTRAINT:
        return lines(labels.condition(part), _TEXT_WIDTH)
    return lines(labels.feature(graph, part), _TEXT_WIDTH)


def _other(graph: Graph, item: Element, aliases: Aliases) -> Box:
    """What satisfies, verifies or refines; a requirement of another package is grey."""
    if is_requirement(item) or item.attrs.get("external"):
        return boxes.stub(graph, item, aliases)
    owner = graph.owner(item)
    where = f"from {graph.qualified_name(owner)}" if owner is not None else ""
    alias = aliases.make(item.id, item.name, str(item.kind))
    return Box(alias, boxes.heading(graph, item, where), "block", shows=(item.id,))
