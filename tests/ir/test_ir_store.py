"""The store of elements and edges in the graph."""

import pytest
from hypothesis import given
from hypothesis import strategies as st

from sysmlc.ir import Edge, Element, Graph, Kind
from sysmlc.ir.graph import add_neighbour, first_neighbour, list_neighbours, remove_neighbour

POOL = [Element(f"e{number}", Kind.CLASS) for number in range(40)]
CHANGES = st.lists(st.tuples(st.booleans(), st.integers(0, 39)), max_size=120)


def test_neighbours_behave_like_an_ordered_set():
    @given(CHANGES)
    def compare(changes):
        index, expected = {}, []
        for is_addition, number in changes:
            element = POOL[number]
            change = add_neighbour if is_addition else remove_neighbour
            assert change(index, "a", element) == (is_addition != (element in expected))
            if is_addition and element not in expected:
                expected.append(element)
            elif not is_addition and element in expected:
                expected.remove(element)
            assert list_neighbours(index, "a") == expected
            assert first_neighbour(index, "a") is (expected[0] if expected else None)
            assert ("a" in index) == bool(expected)

    compare()


def test_thousands_of_features_retain_their_order():
    graph = Graph()
    owner = graph.add(Element("c", Kind.CLASS))
    features = [graph.add(Element(f"p{n}", Kind.PROPERTY, owner="c")) for n in range(3000)]
    for feature in (*features, *features):
        graph.connect(Edge.FEATURE, owner, feature)
    assert graph.targets(owner, Edge.FEATURE) == features
    graph.disconnect(Edge.FEATURE, owner, features[0])
    assert graph.target(owner, Edge.FEATURE) is features[1]
    assert graph.sources(features[0], Edge.FEATURE) == []
    assert graph.owned(owner) == features


def build_three_classes():
    graph = Graph()
    for id in "abx":
        graph.add(Element(id, Kind.CLASS))
    for source, target in (("b", "a"), ("a", "x"), ("b", "x")):
        graph.connect(Edge.TYPED_BY, source, target)
    return graph


def test_sources_are_in_the_order_in_which_edges_were_added():
    graph = build_three_classes()
    assert [e.id for e in graph.sources(graph["x"], Edge.TYPED_BY)] == ["a", "b"]


def test_sources_follow_the_removal_of_an_element():
    graph = build_three_classes()
    graph.remove(graph["a"])
    assert [e.id for e in graph.sources(graph["x"], Edge.TYPED_BY)] == ["b"]


def test_elements_of_a_kind_follow_additions_and_removals():
    graph = build_three_classes()
    assert [e.id for e in graph.of_kind(Kind.CLASS)] == ["a", "b", "x"]
    graph.remove(graph["b"])
    graph.add(Element("b", Kind.PORT))
    graph.add(Element("c", Kind.CLASS))
    assert [e.id for e in graph.of_kind(Kind.PORT, Kind.CLASS)] == ["b", "a", "x", "c"]


def test_an_edge_between_the_same_elements_is_added_once():
    graph = build_three_classes()
    graph.connect(Edge.TYPED_BY, "a", "x")
    assert [e.id for e in graph.sources(graph["x"], Edge.TYPED_BY)] == ["a", "b"]


def test_ownership_cannot_be_connected_like_an_edge():
    graph = build_three_classes()
    with pytest.raises(ValueError, match="move"):
        graph.connect(Edge.OWNS, "a", "x")
