"""The graph keeps both directions of every edge, ownership and kinds right through changes."""

import pytest
from graphs import EDGES, graphs
from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st

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


def consistent(graph: Graph) -> bool:
    """Every edge is seen from both of its ends, and of_kind finds every element once."""
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


def test_edges_are_seen_from_both_ends():
    graph = parse_text(LINE)
    assert [p.name for p in graph.sources(graph["pallet"], Edge.TYPED_BY)] == ["in", "out"]
    assert graph.target(graph["in"], Edge.TYPED_BY) is graph["pallet"]


def test_removing_an_element_removes_what_it_owns_and_all_edges():
    graph = parse_text(LINE)
    graph.remove(graph["gate"])
    assert [element.id for element in graph] == ["line", "pallet"]
    assert graph.sources(graph["pallet"], Edge.TYPED_BY) == []


def test_an_element_cannot_come_to_own_itself():
    graph = parse_text(LINE)
    with pytest.raises(ValueError, match="cannot own itself"):
        graph.move(graph["line"], graph["in"])


def test_ids_are_unique_and_owners_exist():
    graph = parse_text(LINE)
    with pytest.raises(ValueError, match="taken"):
        graph.add(Element("gate", Kind.CLASS))
    with pytest.raises(KeyError):
        graph.add(Element("new", Kind.CLASS, owner="nowhere"))


def test_qualified_names_show_the_kind_of_what_has_no_name():
    graph = parse_text(LINE)
    assert graph.qualified_name(graph["in"]) == "<Package>::Gate::in"


def test_derived_values_are_kept_by_type():
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
        one, two = graph[data.draw(ids)], graph[data.draw(ids)]
        edge = data.draw(st.sampled_from(EDGES))
        match data.draw(st.sampled_from(["connect", "disconnect", "remove", "move", "replace"])):
            case "connect":
                graph.connect(edge, one, two)
            case "disconnect":
                graph.disconnect(edge, one, two)
            case "remove":
                graph.remove(one)
            case "replace":
                graph.replace_targets(edge, one, [two, one])
            case "move" if one not in (two, *graph.ancestors(two)):
                graph.move(one, two)
        assert consistent(graph)
        assert verify(graph) == []


def test_owned_elements_are_in_order_of_addition_however_many() -> None:
    graph = Graph()
    graph.add(Element("top", Kind.PACKAGE, "top"))
    names = [f"n{number}" for number in range(40)]
    for number, name in enumerate(names):
        graph.add(Element(name, Kind.CLASS, name, "top", number, "a.uml"))
        assert [child.name for child in graph.owned(graph["top"])] == names[: number + 1]


@pytest.mark.parametrize("id", ["", "top"])
def test_an_empty_or_used_id_is_refused(id) -> None:
    graph = Graph()
    graph.add(Element("top", Kind.PACKAGE))
    with pytest.raises(ValueError, match="empty or taken"):
        graph.add(Element(id, Kind.CLASS))
    assert [element.kind for element in graph] == [Kind.PACKAGE]


def test_an_owner_that_does_not_exist_is_refused() -> None:
    graph = Graph()
    with pytest.raises(KeyError, match="nowhere"):
        graph.add(Element("part", Kind.PROPERTY, owner="nowhere"))
    assert len(graph) == 0
