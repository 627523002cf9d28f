"""Strongly connected components, compared with those of networkx."""

import networkx as nx
from hypothesis import given
from hypothesis import strategies as st

from sysmlc.ir.algorithms import strongly_connected_components

_NODES = st.sampled_from("abcdefgh")
_GRAPHS = st.dictionaries(_NODES, st.lists(_NODES, max_size=4), max_size=8)


def _whole(graph: dict[str, list[str]]) -> dict[str, list[str]]:
    return {node: [] for targets in graph.values() for node in targets} | graph


def test_nodes_that_reach_each_other_are_one_component() -> None:
    found = list(strongly_connected_components({"a": ["b"], "b": ["c"], "c": ["b"], "d": ["d"]}))
    assert [sorted(part) for part in found] == [["b", "c"], ["a"], ["d"]]


def test_a_long_path_needs_no_recursion() -> None:
    length = 5_000
    path = {str(n): [str(n + 1)] for n in range(length)} | {str(length): ["0"]}
    assert [len(part) for part in strongly_connected_components(path)] == [length + 1]


@given(_GRAPHS)
def test_components_are_those_of_networkx(graph: dict[str, list[str]]) -> None:
    whole = _whole(graph)
    view: nx.DiGraph[str] = nx.DiGraph(
        {node: list(dict.fromkeys(targets)) for node, targets in whole.items()}
    )
    expected = {frozenset(part) for part in nx.strongly_connected_components(view)}
    assert {frozenset(part) for part in strongly_connected_components(whole)} == expected


@given(_GRAPHS)
def test_a_component_comes_after_those_that_it_leads_to(graph: dict[str, list[str]]) -> None:
    whole = _whole(graph)
    seen: set[str] = set()
    for part in strongly_connected_components(whole):
        seen.update(part)
        assert all(seen.issuperset(whole[node]) for node in part)
