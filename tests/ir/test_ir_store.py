"""The store behind the graph: it is compact, and nobody sees how."""

import pytest
from hypothesis import given
from hypothesis import strategies as st

from sysmlc.ir import Edge, Element, Graph, Kind, Reference
from sysmlc.ir.neighbours import drop, every, first, put

POOL = [Element(f"e{number}", Kind.CLASS) for number in range(40)]
CHANGES = st.lists(st.tuples(st.booleans(), st.integers(0, 39)), max_size=120)


def test_neighbours_behave_like_an_ordered_list_without_repetition():
    @given(CHANGES)
    def same(changes):
        index, expected = {}, []
        for is_put, number in changes:
            one = POOL[number]
            assert (put if is_put else drop)(index, "a", one) == (is_put != (one in expected))
            if is_put and one not in expected:
                expected.append(one)
            elif not is_put and one in expected:
                expected.remove(one)
            assert every(index, "a") == expected
            assert first(index, "a") is (expected[0] if expected else None)
            assert ("a" in index) == bool(expected)

    same()


def test_a_classifier_with_thousands_of_features_keeps_their_order():
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


def three(*, asked_early):
    graph = Graph()
    for id in "abx":
        graph.add(Element(id, Kind.CLASS))
    if asked_early:
        assert graph.sources(graph["x"], Edge.TYPED_BY) == []
    for source, target in (("b", "a"), ("a", "x"), ("b", "x")):
        graph.connect(Edge.TYPED_BY, source, target)
    return graph


def test_the_way_back_is_in_the_order_of_addition_whenever_it_is_asked_for():
    for asked_early in (False, True):
        graph = three(asked_early=asked_early)
        assert [e.id for e in graph.sources(graph["x"], Edge.TYPED_BY)] == ["a", "b"]


def test_the_way_back_knows_what_was_removed_before_it_was_asked_for():
    graph = three(asked_early=False)
    graph.remove(graph["a"])
    assert [e.id for e in graph.sources(graph["x"], Edge.TYPED_BY)] == ["b"]


def test_elements_of_a_kind_are_found_after_additions_and_removals_in_any_order():
    graph = three(asked_early=False)
    assert [e.id for e in graph.of_kind(Kind.CLASS)] == ["a", "b", "x"]
    graph.remove(graph["b"])
    graph.add(Element("b", Kind.PORT))
    graph.add(Element("c", Kind.CLASS))
    assert [e.id for e in graph.of_kind(Kind.PORT, Kind.CLASS)] == ["b", "a", "x", "c"]


def test_many_edges_at_once_are_the_same_as_one_by_one():
    one, all_ = three(asked_early=False), three(asked_early=False)
    wanted = [("x", "a"), ("x", "b"), ("x", "a"), ("gone", "a"), ("a", None)]
    for source, target in wanted[:2]:
        one.connect(Edge.SUBSETS, source, target)
    targets = all_.find_all(target or "nowhere" for _, target in wanted)
    all_.connect_all([Edge.SUBSETS] * 5, [source for source, _ in wanted], targets)
    assert list(all_.edges()) == list(one.edges())


@pytest.mark.parametrize("asked_early", [True, False])
@pytest.mark.parametrize("wanted", ["xa ab", "xa ax", "xa xb xa", "ax bx", "xa x?", "bx ax bx"])
def test_many_edges_of_one_kind_at_once_are_the_same_as_one_by_one(wanted, asked_early):
    one, all_ = three(asked_early=asked_early), three(asked_early=asked_early)
    pairs = [(source, target) for source, target in wanted.split()]
    for source, target in pairs:
        if target != "?":
            one.connect(Edge.TYPED_BY, source, target)
    sources, targets = (all_.find_all(ends) for ends in zip(*pairs, strict=True))
    all_.connect_each(Edge.TYPED_BY, sources, targets)
    assert both_ways(all_) == both_ways(one)


@pytest.mark.parametrize("asked_early", [True, False])
@pytest.mark.parametrize("number", [0, 1, 2, 16, 17, 40])
def test_all_edges_of_an_element_at_once_are_the_same_as_one_by_one(number, asked_early):
    one, all_ = three(asked_early=asked_early), three(asked_early=asked_early)
    for graph in (one, all_):
        made = [graph.add(Element(f"n{place}", Kind.CLASS)) for place in range(number)]
        if graph is all_:
            graph.connect_fan(Edge.TYPED_BY, graph["x"], made)
        for target in made:
            graph.connect(Edge.TYPED_BY, "x", target)
    assert both_ways(all_) == both_ways(one)


def both_ways(graph):
    ways = (graph.targets, graph.sources)
    return [[[e.id for e in way(one, Edge.TYPED_BY)] for way in ways] for one in graph]


def test_references_come_back_as_they_went_in():
    said = [
        Reference(Edge.TYPED_BY, "a", "b"),
        Reference(Edge.CALLS, "a", "x.uml#c", Kind.OPERATION, "run", 7),
    ]
    graph = Graph()
    for reference in said:
        graph.refer(reference)
    assert list(graph.pending) == said
    graph.pending.clear()
    assert not graph.pending
