"""Flows between parts of one type: the chain at an end says through which of them."""

from reading_v2 import PASSES, Reading
from test_v2_roundtrip import read_back

from sysmlc.ir import Kind
from sysmlc.ir.compare import compare
from sysmlc.logic.composition.structure import find_unclear_flows, iter_links

PLANT = """
package P {
    item def Water;
    part def Pump { out item w : Water; }
    part def Tank { in item w : Water; }
    part def Plant {
        %s
        part c : Tank;
        flow from a.w to c.w;
    }
}
"""
TWO = PLANT % "part a : Pump; part b : Pump;"
ONE = PLANT % "part a : Pump;"


def list_paths(graph):
    """Names of the parts that lead to both ends of the only flow."""
    (flow,) = graph.of_kind(Kind.ITEM_FLOW)
    keys = ("source_path", "target_path")
    return [[graph[id_].name for id_ in flow.attrs.get(key, ())] for key in keys]


def list_linked_features(graph):
    """The ends that flows of the plant join, and of how many it is not clear what they do."""
    (plant,) = [element for element in graph if element.name == "Plant"]
    ends = [[f"{end.path}.{end.feature}" for end in link] for link in iter_links(graph, plant)]
    return ends, len(list(find_unclear_flows(graph, plant)))


def test_one_of_two_parts_of_a_type_is_the_one_that_the_text_names():
    graph = Reading(TWO, passes=PASSES).graph
    assert list_paths(graph) == [["a"], []]
    assert list_linked_features(graph) == ([["a.w", "c.w"]], 0)


def test_a_part_of_a_more_special_type_is_alike():
    text = TWO.replace("part b : Pump;", "part def Fast :> Pump; part b : Fast;")
    assert list_paths(Reading(text, passes=PASSES).graph) == [["a"], []]


def test_the_only_part_needs_no_path():
    graph = Reading(ONE, passes=PASSES).graph
    assert list_paths(graph) == [[], []]
    assert list_linked_features(graph) == ([["a.w", "c.w"]], 0)


def test_the_path_is_written_again():
    graph = Reading(TWO, passes=(*PASSES, "flows")).graph
    again, _ = read_back(graph)
    assert list_paths(again) == [["a"], []]
    assert list(compare(graph, again, ("id", "declaration"))) == []
