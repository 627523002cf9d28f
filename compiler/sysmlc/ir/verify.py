"""Invariants of every graph, before and after each pass."""

from collections.abc import Iterator

from sysmlc.ir.element import Element
from sysmlc.ir.graph import Graph
from sysmlc.ir.kinds import Edge, Kind

_AT_MOST_ONE: dict[Kind, tuple[Edge, ...]] = {
    Kind.CONTROL_FLOW: (Edge.FLOW_SOURCE, Edge.FLOW_TARGET),
    Kind.OBJECT_FLOW: (Edge.FLOW_SOURCE, Edge.FLOW_TARGET),
    Kind.TRANSITION: (Edge.FLOW_SOURCE, Edge.FLOW_TARGET),
}
OWNERS: dict[Kind, frozenset[Kind]] = {
    Kind.REGION: frozenset({Kind.STATE_MACHINE, Kind.STATE}),
    Kind.STATE: frozenset({Kind.REGION}),
    Kind.FINAL_STATE: frozenset({Kind.REGION}),
    Kind.CONNECTOR_END: frozenset({Kind.CONNECTOR}),
    Kind.ENUMERATION_LITERAL: frozenset({Kind.ENUMERATION}),
    Kind.SLOT: frozenset({Kind.INSTANCE}),
}
"""Owners that elements of a kind may have; elements of other kinds may have any owner."""


def verify(graph: Graph) -> list[str]:
    """Return the violations, one sentence each; an empty list for a valid graph.

    Ownership is a forest, flows have at most one source and one target, and the origin of a
    derived element exists. A violation is a fault of a front end or a pass, not of the model.
    """
    return [*_check_ownership(graph), *_check_flows(graph), *_check_origins(graph)]


def _check_ownership(graph: Graph) -> Iterator[str]:
    below_roots = {element.id for root in graph.roots() for element in graph.subtree(root)}
    owners = {owned: owner for _, owner, owned in graph.edges(Edge.OWNS)}
    for element in graph:
        if element.id not in below_roots:
            yield f"{element!r} ({element.id}) is not below a root"
        yield from _check_owner(graph, element, owners.get(element.id))


def _check_owner(graph: Graph, element: Element, owner_id: str | None) -> Iterator[str]:
    owner = graph.owner(element)
    if element.owner != owner_id:
        yield f"{element!r} ({element.id}) is not owned by its owner {owner!r}"
    allowed = OWNERS.get(element.kind)
    if owner is not None and allowed is not None and owner.kind not in allowed:
        yield f"{element!r} ({element.id}) must not be owned by {owner!r}"


def _check_flows(graph: Graph) -> Iterator[str]:
    for kind, edges in _AT_MOST_ONE.items():
        for element in graph.of_kind(kind):
            for edge in edges:
                if len(graph.targets(element, edge)) > 1:
                    yield f"{element!r} ({element.id}) has several {edge} edges"


def _check_origins(graph: Graph) -> Iterator[str]:
    for element in graph:
        origin = element.attrs.get("origin")
        if origin is not None and graph.get(str(origin)) is None:
            yield f"{element!r} ({element.id}) names an origin that does not exist"
