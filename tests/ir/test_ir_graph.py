"""The graph keeps both directions of every edge, ownership and kinds consistent when it changes."""

import pytest
from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st
from random_graphs import EDGES, graphs

from sysmlc.ir import Edge, Element, Graph, Kind, parse_text, verify

LINE = """
Package line
  Class gate "Gate"
    Port in "in"
      -> typed-by pallet
    Port out "out"
      -> typed-by pallet
  Class pallet "MiniPallet"
"""


def is_consistent(graph: Graph) -> bool:
    """Whether every edge is found from both of its ends, and of_kind finds each element once."""
    for edge in Edge:
        for element in graph:
            for target in graph.targets(element, edge):
                if element not in graph.sources(target, edge):
                    return False
            for source in graph.sources(element, edge):
                if element not in graph.targets(source, edge):
                    return False
    by_kind = [element.id for kind in Kind for element in graph.of_kind(kind)]
    return sorted(by_kind) == sorted(element.id for element in graph)


def test_edges_can_be_followed_in_both_directions():
    graph = parse_text(LINE)
    assert [p.name for p in graph.sources(graph["pallet"], Edge.TYPED_BY)] == ["in", "out"]
    assert graph.target(graph["in"], Edge.TYPED_BY) is graph["pallet"]


def test_removing_an_element_removes_its_contents_and_all_edges():
    graph = parse_text(LINE)
    graph.remove(graph["gate"])
    assert [element.id for element in graph] == ["line", "pallet"]
    assert graph.sources(graph["pallet"], Edge.TYPED_BY) == []


def test_an_element_cannot_be_moved_into_itself():
    graph = parse_text(LINE)
    with pytest.raises(ValueError, match="cannot own itself"):
        graph.move(graph["line"], graph["in"])


def test_qualified_names_show_the_kind_of_unnamed_elements():
    graph = parse_text(LINE)
    assert graph.qualified_name(graph["in"]) == "<Package>::Gate::in"


def test_derived_values_are_stored_by_type():
    graph = Graph()
    graph.store(int, [1, 2])
    graph.store(int, [3])
    assert list(graph.derived(int)) == [3]
    assert list(graph.derived(str)) == []


@settings(deadline=None, suppress_health_check=[HealthCheck.too_slow])
@given(graphs(), st.data())
def test_any_sequence_of_changes_leaves_a_consistent_graph(graph, data):
    for _ in range(4):
        if not len(graph):
            break
        ids = st.sampled_from([element.id for element in graph])
        source, target = graph[data.draw(ids)], graph[data.draw(ids)]
        edge = data.draw(st.sampled_from(EDGES))
        match data.draw(st.sampled_from(["connect", "disconnect", "remove", "move", "replace"])):
            case "connect":
                graph.connect(edge, source, target)
            case "disconnect":
                graph.disconnect(edge, source, target)
            case "remove":
                graph.remove(source)
            case "replace":
                graph.replace_targets(edge, source, [target, source])
            case "move" if source not in (target, *graph.ancestors(target)):
                graph.move(source, target)
        assert is_consistent(graph)
        assert verify(graph) == []


def test_owned_elements_are_in_order_of_addition_however_many() -> None:
    graph = Graph()
    graph.add(Element("top", Kind.PACKAGE, "top"))
    names = [f"n{number}" for number in range(40)]
    for number, name in enumerate(names):
        graph.add(Element(name, Kind.CLASS, name, "top", number, "a.uml"))
        assert [child.name for child in graph.owned(graph["top"])] == names[: number + 1]


@pytest.mark.parametrize("id", ["", "top"])
def test_an_empty_or_used_id_is_rejected(id) -> None:
    graph = Graph()
    graph.add(Element("top", Kind.PACKAGE))
    with pytest.raises(ValueError, match="empty or taken"):
        graph.add(Element(id, Kind.CLASS))
    assert [element.kind for element in graph] == [Kind.PACKAGE]


def test_an_unknown_owner_is_rejected() -> None:
    graph = Graph()
    with pytest.raises(KeyError, match="nowhere"):
        graph.add(Element("part", Kind.PROPERTY, owner="nowhere"))
    assert len(graph) == 0


def test_the_view_for_networkx_has_only_the_requested_edges():
    view = parse_text(LINE).to_networkx(Edge.TYPED_BY)
    assert list(view.edges(data="kind")) == [
        ("in", "pallet", Edge.TYPED_BY),
        ("out", "pallet", Edge.TYPED_BY),
    ]
    assert view.nodes["in"] == {"kind": Kind.PORT, "name": "in"}
