"""A graph as plain rows, and the same graph of them again: what a cache can keep."""

from collections.abc import Iterable

from sysmlc.ir.element import AttrValue, Element
from sysmlc.ir.graph import Graph
from sysmlc.ir.kinds import Edge, Kind
from sysmlc.ir.neighbours import Index, put_new
from sysmlc.ir.reads import Watched

Row = tuple[str, str, str, str | None, int, str, dict[str, AttrValue]]
"""Id, kind, name, owner, ordinal, source and attributes of an element."""
Ends = list[tuple[str, list[str]]]
"""Elements with their neighbours, by id."""
Rows = tuple[list[Row], dict[str, tuple[Ends, Ends]]]
"""Elements in order, and for each kind of edge the neighbours forwards and backwards."""

_NAMES = {kind: kind.value for kind in Kind}
"""To ask a member for its value takes a call."""


def rows(graph: Graph) -> Rows:
    """All of a graph but derived values and references that are not resolved."""
    edges = {
        edge.value: (_ends(graph.index(edge)), _ends(graph.index(edge, backwards=True)))
        for edge in Edge
        if graph.index(edge)
    }
    return list(map(_row, graph)), edges


def _row(one: Element) -> Row:
    attrs = one.attrs.plain() if isinstance(one.attrs, Watched) else one.attrs.copy()
    return one.id, _NAMES[one.kind], one.name, one.owner, one.ordinal, one.source, attrs


def _ends(index: Index) -> Ends:
    return [
        (id, [known.id] if isinstance(known, Element) else [one.id for one in known])
        for id, known in index.items()
    ]


def graph_of(kept: Rows, graph: Graph) -> Graph:
    """Fill an empty graph with what ``rows`` gave."""
    elements, edges = kept
    kinds = {kind.value: kind for kind in Kind}
    for id, kind, name, owner, ordinal, source, attrs in elements:
        graph.add_loose(Element(id, kinds[kind], name, owner, ordinal, source, attrs))
    for edge, (forwards, backwards) in edges.items():
        graph.fill(Edge(edge), _index(graph, forwards), _index(graph, backwards))
    return graph


def _index(graph: Graph, ends: Iterable[tuple[str, list[str]]]) -> Index:
    index: Index = {}
    for id, neighbours in ends:
        if len(neighbours) == 1:
            index[id] = graph[neighbours[0]]
        else:
            for one in neighbours:
                put_new(index, id, graph[one])
    return index
