"""The topological order that is always the same."""

import pytest

from sysmlc.ir.algorithms import sort_topologically


def order(nodes, *edges):
    return " ".join(sort_topologically(nodes.split(), [tuple(edge) for edge in edges]))


def test_each_node_comes_after_those_that_lead_to_it_the_least_first():
    assert order("d c b a", "ca", "db") == "c a d b"
    assert order("a b c", "cb", "cb", "ba") == "c b a"


def test_ends_of_edges_are_nodes_too():
    assert order("b", "za") == "b z a"


def test_a_cycle_has_no_order():
    with pytest.raises(ValueError, match="cycle"):
        order("a b c", "ab", "bc", "cb")
