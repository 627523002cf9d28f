"""Edges that passes add because something else in the model says so: they are not written."""

from collections.abc import Iterator

from sysmlc.ir import Edge, Element, Graph, Kind

_TAGGED = {
    Edge.REFERENCES: (
        "principal",
        "original",
        "connector",
        "end",
        "structuralFeature",
        "member",
        "orderedMember",
        "unit",
        "quantityKind",
        "dimension",
    ),
    Edge.ALLOCATED_TO: ("allocatedTo",),
    Edge.PATH: ("propertyPath", "onNestedPort"),
    Edge.REALIZES: ("viewpoint",),
    Edge.BINDS: ("bindingPath", "boundEnd"),
}
"""Tags of SysML's stereotypes that become edges of their elements (docs/ir.md)."""
_RELATIONS = {
    Edge.SATISFIES: ("satisfy",),
    Edge.DERIVES: ("derive",),
    Edge.VERIFIES: ("verify",),
    Edge.REFINES: ("refine",),
    Edge.TRACES: ("trace", "copy"),
    Edge.ALLOCATED_TO: ("allocate",),
    Edge.REALIZES: ("conform", ""),
    Edge.DEPENDS: ("expose", ""),
    Edge.BINDS: ("",),
}
"""Edges that dependencies mean, and the roles of these."""


def is_meant(graph: Graph, source: Element, edge: Edge, target: Element) -> bool:
    """Whether an edge follows from a dependency, a tag or a binding that is written."""
    if edge in _RELATIONS and any(
        target in graph.targets(one, Edge.SUPPLIER)
        for one in graph.sources(source, Edge.CLIENT)
        if one.role in _RELATIONS[edge] or edge in (Edge.DEPENDS, Edge.REALIZES, Edge.BINDS)
    ):
        return True
    if edge is Edge.REFERENCES and _is_of_unit(source, target):
        return True
    if edge is Edge.ALLOCATED_TO and _is_allocated(graph, source, target):
        return True
    if edge is Edge.BINDS and source.kind is not Kind.TEMPLATE_BINDING:
        return _is_bound(graph, source, target) or _is_tagged(graph, source, edge)
    if edge is Edge.REALIZES and _conforms(graph, source, target):
        return True
    return edge in _TAGGED and _is_tagged(graph, source, edge, target)


def applications(graph: Graph, element: Element) -> Iterator[Element]:
    """Stereotype applications that speak of the element, on a part of it or as a whole."""
    for one in graph.sources(element, Edge.SUBJECT):
        if one.kind is Kind.APPLICATION:
            yield one
    for one in graph.sources(element, Edge.REFERENCES):
        if one.kind is Kind.APPLICATION and "on" in one.attrs:
            yield one


def _is_tagged(graph: Graph, source: Element, edge: Edge, target: Element | None = None) -> bool:
    for one in applications(graph, source):
        for tag in _TAGGED[edge]:
            given = one.attrs.get(f"tag.{tag}")
            if given is None:
                continue
            if target is None or target.id in _named(graph, given) or _is_href(given, target):
                return True
    return False


def _named(graph: Graph, given: object) -> Iterator[str]:
    for one in given if isinstance(given, tuple) else (given,):
        found = graph.get(str(one))
        if found is not None and found.kind is Kind.APPLICATION:
            yield from (base.id for base in graph.targets(found, Edge.SUBJECT))
        yield str(one)


def _is_href(given: object, target: Element) -> bool:
    return bool(target.attrs.get("external")) and "#" in str(given)


def _is_of_unit(source: Element, target: Element) -> bool:
    """Slots say the quantity kinds of units, names those of library types."""
    is_measure = source.role in ("unit", "quantity kind") or source.kind is Kind.UNIT
    return is_measure or target.kind in (Kind.UNIT, Kind.QUANTITY_KIND)


def _is_allocated(graph: Graph, source: Element, target: Element) -> bool:
    froms = (one.attrs.get("tag.allocatedFrom") for one in applications(graph, target))
    if any(source.id in _named(graph, given) for given in froms if given is not None):
        return True
    for partition in graph.targets(source, Edge.IN_PARTITION):
        for one in (partition, *graph.ancestors(partition)):
            if one.role == "allocate partition" and target in graph.targets(one, Edge.REPRESENTS):
                return True
    return False


def _is_bound(graph: Graph, source: Element, target: Element) -> bool:
    for end in graph.sources(source, Edge.ROLE):
        connector = graph.owner(end)
        if connector is not None and connector.role == "binding connector":
            ends = graph.targets(connector, Edge.END)
            if any(target in graph.targets(one, Edge.ROLE) for one in ends):
                return True
    return False


def _conforms(graph: Graph, source: Element, target: Element) -> bool:
    if target not in graph.targets(source, Edge.SPECIALIZES):
        return False
    return any(one.attrs.get("on") == "generalization" for one in applications(graph, source))
