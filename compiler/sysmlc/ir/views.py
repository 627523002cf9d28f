"""Views of the graph for algorithms."""

from typing import TYPE_CHECKING

from sysmlc.ir.graph import Graph
from sysmlc.ir.kinds import Edge

if TYPE_CHECKING:
    from networkx import DiGraph


def networkx(graph: Graph, *kinds: Edge) -> "DiGraph[str]":
    """Ids as nodes and the edges of these kinds, for cycles, dominators, longest paths.

    Only elements that such an edge touches are nodes; the attribute ``kind`` of an edge is the
    last kind that connects the two. networkx is imported here because it is slow to import.
    """
    from networkx import DiGraph

    view: DiGraph[str] = DiGraph()
    for kind, source, target in graph.edges(*kinds):
        view.add_edge(source, target, kind=kind)
    return view
