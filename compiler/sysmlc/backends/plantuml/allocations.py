"""Allocations as rows, where no line can show them (SysML 1.6 clause 15.3.1)."""

from collections.abc import Iterator

from sysmlc.backends.plantuml import labels
from sysmlc.ir import Edge, Element, Graph, Kind
from sysmlc.support.plantuml_text import lines

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
    """Rows of an activity node, and the ids of the allocations that they stand for."""
    rows: list[str] = []
    ids: list[str] = []
    for dependency, target in _opposite(graph, node, Edge.CLIENT):
        rows += lines(f"allocated to {_title(graph, target)}", _WIDTH)
        ids.append(dependency.id)
    return rows, ids


def list_block_allocations(graph: Graph, block: Element) -> tuple[list[str], list[str]]:
    """Rows of a block for itself and its features, and the ids of the allocations."""
    rows: list[str] = []
    ids: list[str] = []
    for own in (block, *_features(graph, block)):
        for dependency, other in _opposite(graph, own, Edge.CLIENT):
            if not _has_line(own, other):
                rows += lines(f"{_short(block, own)}→ {_title(graph, other)}", _WIDTH)
                ids.append(dependency.id)
        for dependency, other in _opposite(graph, own, Edge.SUPPLIER):
            if not _has_line(own, other) and not _has_home(graph, other):
                rows += lines(f"{_short(block, own)}← {_title(graph, other)}", _WIDTH)
                ids.append(dependency.id)
    return rows, ids


def iter_feature_allocations(
    graph: Graph, block: Element
) -> Iterator[tuple[Element, Element, Element]]:
    """Allocations from one feature of the block to another: dependency, client, supplier."""
    for own in _features(graph, block):
        for dependency, other in _opposite(graph, own, Edge.CLIENT):
            if own.kind in _PLACES and other.kind in _PLACES and other.owner == block.id:
                yield dependency, own, other


def _opposite(graph: Graph, element: Element, edge: Edge) -> Iterator[tuple[Element, Element]]:
    other = Edge.SUPPLIER if edge is Edge.CLIENT else Edge.CLIENT
    for dependency in graph.sources(element, edge):
        if dependency.kind is Kind.DEPENDENCY and dependency.role == "allocate":
            for opposite in graph.targets(dependency, other):
                yield dependency, opposite


def _features(graph: Graph, block: Element) -> list[Element]:
    return [one for one in graph.owned(block) if one.kind in _FEATURES]


def _has_line(one: Element, other: Element) -> bool:
    """Whether a block definition or an internal block diagram draws it."""
    if one.kind in _PLACES and other.kind in _PLACES:
        return one.owner == other.owner
    return one.kind in _BOXED and other.kind in _BOXED


def _has_home(graph: Graph, client: Element) -> bool:
    """Whether the client's own block has the row."""
    home = graph.owner(client) if client.kind in _FEATURES else client
    if home is None or home.attrs.get("external"):
        return False
    return home.kind in _BOXED and home.kind is not Kind.ACTIVITY


def _short(block: Element, own: Element) -> str:
    return "" if own is block else f"{labels.name(own)} "


def _title(graph: Graph, element: Element) -> str:
    """The element by its name; a feature or an action with what it belongs to."""
    owner = graph.owner(element)
    if element.kind in (*_FEATURES, Kind.ACTION) and owner is not None:
        return f"{labels.name(owner)}.{labels.name(element)}"
    return labels.name(element)
