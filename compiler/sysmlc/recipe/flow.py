"""Paths and cycles of flow graphs."""

from collections.abc import Iterable

from sysmlc.ir import algorithms
from sysmlc.ir.algorithms import sort_topologically, strongly_connected_components
from sysmlc.recipe.model import FlowGraph

STEPS = frozenset({"service", "function", "call", "action", "assign", "wait", "delay"})
"""Kinds of nodes that do something."""


def find_reachable(starts: Iterable[str], edges: Iterable[tuple[str, str]]) -> set[str]:
    """Return *starts* and all nodes that are reachable from them."""
    successors: dict[str, list[str]] = {}
    for source, target in edges:
        successors.setdefault(source, []).append(target)
    return algorithms.find_reachable(starts, lambda node: successors.get(node, ()))


def find_entries(graph: FlowGraph, component: Iterable[str]) -> list[str]:
    """Return the nodes of a component that edges from outside reach, in the order of the graph."""
    inside = set(component)
    reached = {e.target for e in graph.edges if e.source not in inside and e.target in inside}
    return [node.id for node in graph.nodes if node.id in reached]


def find_cycles(nodes: Iterable[str], edges: Iterable[tuple[str, str]]) -> list[list[str]]:
    """Return the strongly connected components with a cycle, each in the order of *nodes*."""
    successors: dict[str, dict[str, None]] = {id: {} for id in nodes}
    for source, target in edges:
        successors.setdefault(source, {})[target] = None
        successors.setdefault(target, {})
    rank = {id: number for number, id in enumerate(successors)}
    cycles = [
        sorted(component, key=rank.__getitem__)
        for component in strongly_connected_components(successors)
        if len(component) > 1 or component[0] in successors[component[0]]
    ]
    return sorted(cycles, key=lambda cycle: rank[cycle[0]])


def list_forward_edges(graph: FlowGraph) -> list[tuple[str, str]]:
    """Return the edges except back edges, which lead from a cycle to its entry."""
    nodes = [node.id for node in graph.nodes]
    edges = list(dict.fromkeys((e.source, e.target) for e in graph.edges))
    # Without the back edges of a cycle the cycles inside it are components of their own.
    while cycles := find_cycles(nodes, edges):
        for cycle in cycles:
            inside = set(cycle)
            entries = {b for a, b in edges if a not in inside and b in inside} or {cycle[0]}
            edges = [(a, b) for a, b in edges if not (a in inside and b in entries)]
    return edges


def sort_nodes(graph: FlowGraph) -> list[str]:
    """Return the ids of the nodes in topological order of the forward edges."""
    return list(sort_topologically((node.id for node in graph.nodes), list_forward_edges(graph)))
