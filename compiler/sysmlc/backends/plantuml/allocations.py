"""Allocations as rows, where no line can show them (SysML 1.6 clause 15.3.1)."""

from collections.abc import Iterator

from sysmlc.backends.plantuml import labels
from sysmlc.ir import Edge, Element, Graph, Kind
from sysmlc.support.plantuml_text import wrap_lines

_WIDTH = 44
_PLACES = (Kind.PROPERTY, Kind.PORT)
_FEATURES = (*_PLACES, Kind.OPERATION)
_BOXED = (
    Kind.CLASS,
    Kind.COMPONENT,
    Kind.INTERFACE,
    Kind.DATA_TYPE,
    Kind.SIGNAL,
    Kind.ACTOR,
    Kind.ACTIVITY,
    Kind.STATE_MACHINE,
    Kind.USE_CASE,
    Kind.PACKAGE,
)
"""Kinds between which block definition diagrams draw allocations as lines."""


def list_node_allocations(graph: Graph, node: Element) -> tuple[list[str], list[str]]:
    """Return the rows of an activity node, and the ids of the allocations that they show."""
    rows: list[str] = []
    ids: list[str] = []
    for dependency, target in _iter_opposite_ends(graph, node, Edge.CLIENT):
        rows += wrap_lines(f"allocated to {_format_opposite_end(graph, target)}", _WIDTH)
        ids.append(dependency.id)
    return rows, ids


def list_block_allocations(graph: Graph, block: Element) -> tuple[list[str], list[str]]:
    """Return the rows of a block and its features, and the ids of the allocations that they
    show.
    """
    rows: list[str] = []
    ids: list[str] = []
    for element in (block, *_list_features(graph, block)):
        for dependency, other in _iter_opposite_ends(graph, element, Edge.CLIENT):
            if not _has_line(element, other):
                rows += wrap_lines(
                    f"{_format_own_end(block, element)}→ {_format_opposite_end(graph, other)}",
                    _WIDTH,
                )
                ids.append(dependency.id)
        for dependency, other in _iter_opposite_ends(graph, element, Edge.SUPPLIER):
            if not _has_line(element, other) and not _has_row_at_client(graph, other):
                rows += wrap_lines(
                    f"{_format_own_end(block, element)}← {_format_opposite_end(graph, other)}",
                    _WIDTH,
                )
                ids.append(dependency.id)
    return rows, ids


def iter_feature_allocations(
    graph: Graph, block: Element
) -> Iterator[tuple[Element, Element, Element]]:
    """Yield allocations between two features of the block: dependency, client, supplier."""
    for client in _list_features(graph, block):
        for dependency, other in _iter_opposite_ends(graph, client, Edge.CLIENT):
            if client.kind in _PLACES and other.kind in _PLACES and other.owner == block.id:
                yield dependency, client, other


def _iter_opposite_ends(
    graph: Graph, element: Element, edge: Edge
) -> Iterator[tuple[Element, Element]]:
    other = Edge.SUPPLIER if edge is Edge.CLIENT else Edge.CLIENT
    for dependency in graph.sources(element, edge):
        if dependency.kind is Kind.DEPENDENCY and dependency.role == "allocate":
            for opposite in graph.targets(dependency, other):
                yield dependency, opposite


def _list_features(graph: Graph, block: Element) -> list[Element]:
    return [member for member in graph.owned(block) if member.kind in _FEATURES]


def _has_line(left: Element, right: Element) -> bool:
    """Whether a block definition or an internal block diagram draws the allocation as a line."""
    if left.kind in _PLACES and right.kind in _PLACES:
        return left.owner == right.owner
    return left.kind in _BOXED and right.kind in _BOXED


def _has_row_at_client(graph: Graph, client: Element) -> bool:
    """Whether the box of the client's own block has a row for the allocation."""
    block = graph.owner(client) if client.kind in _FEATURES else client
    if block is None or block.attrs.get("external"):
        return False
    return block.kind in _BOXED and block.kind is not Kind.ACTIVITY


def _format_own_end(block: Element, element: Element) -> str:
    return "" if element is block else f"{labels.name(element)} "


def _format_opposite_end(graph: Graph, element: Element) -> str:
    """Return the name of an element; a feature or an action with its owner."""
    owner = graph.owner(element)
    if element.kind in (*_FEATURES, Kind.ACTION) and owner is not None:
        return f"{labels.name(owner)}.{labels.name(element)}"
    return labels.name(element)
