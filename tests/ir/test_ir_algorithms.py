"""Strongly connected components, compared with those of networkx, and the topological order."""

import networkx as nx
import pytest
from hypothesis import given
from hypothesis import strategies as st

from sysmlc.ir.algorithms import sort_topologically, strongly_connected_components

NODES = st.sampled_from("abcdefgh")
SUCCESSORS = st.dictionaries(NODES, st.lists(NODES, max_size=4), max_size=8)


# -- strongly connected components ---------------------------------------------------------------


def add_sinks(successors: dict[str, list[str]]) -> dict[str, list[str]]:
    """Add the nodes without successors as keys."""
    return {node: [] for targets in successors.values() for node in targets} | successors


def test_nodes_that_reach_each_other_are_one_component() -> None:
    successors = {"a": ["b"], "b": ["c"], "c": ["b"], "d": ["d"]}
    components = strongly_connected_components(successors)
    assert [sorted(component) for component in components] == [["b", "c"], ["a"], ["d"]]


def test_a_long_path_needs_no_recursion() -> None:
    length = 5_000
    path = {str(n): [str(n + 1)] for n in range(length)} | {str(length): ["0"]}
    components = strongly_connected_components(path)
    assert [len(component) for component in components] == [length + 1]


@given(SUCCESSORS)
def test_components_are_those_of_networkx(successors: dict[str, list[str]]) -> None:
    graph = add_sinks(successors)
    view: nx.DiGraph[str] = nx.DiGraph(
        {node: list(dict.fromkeys(targets)) for node, targets in graph.items()}
    )
    expected = {frozenset(component) for component in nx.strongly_connected_components(view)}
    components = strongly_connected_components(graph)
    assert {frozenset(component) for component in components} == expected


@given(SUCCESSORS)
def test_a_component_comes_after_those_that_it_leads_to(successors: dict[str, list[str]]) -> None:
    graph = add_sinks(successors)
    visited: set[str] = set()
    for component in strongly_connected_components(graph):
        visited.update(component)
        assert all(visited.issuperset(graph[node]) for node in component)


# -- topological order ---------------------------------------------------------------------------


def sort_nodes(nodes, *edges):
    return " ".join(sort_topologically(nodes.split(), [tuple(edge) for edge in edges]))


def test_each_node_comes_after_its_predecessors_and_the_least_node_first():
    assert sort_nodes("d c b a", "ca", "db") == "c a d b"
    assert sort_nodes("a b c", "cb", "cb", "ba") == "c b a"


def test_ends_of_edges_are_nodes_too():
    assert sort_nodes("b", "za") == "b z a"


def test_a_cycle_has_no_order():
    with pytest.raises(ValueError, match="cycle"):
        sort_nodes("a b c", "ab", "bc", "cb")
