"""The exact comparison of two graphs that other tests use."""

from hypothesis import given
from random_graphs import graphs

from graph_differences import Change, diff
from sysmlc.ir import parse_text, print_text

GATE = """\
Package p "Plant"
  Class g "Gate"
    Port i "in" direction="in"
      -> typed-by m
  Class m "Pallet"
"""


def test_differences_name_the_element_and_the_change():
    new = GATE.replace('"in" direction="in"', '"in" direction="out"').replace(
        "-> typed-by m", "-> typed-by g"
    )
    assert diff(parse_text(GATE), parse_text(new + '  Class n "New"\n')) == [
        Change("Plant::Gate::in", "attribute", "direction: 'in' -> 'out'"),
        Change("Plant::Gate::in", "edge-added", "typed-by Plant::Gate"),
        Change("Plant::Gate::in", "edge-removed", "typed-by Plant::Pallet"),
        Change("Plant::New", "added", "Class"),
    ]


def test_other_ids_are_no_difference_when_ids_are_ignored():
    renamed = (
        GATE.replace(" g ", " g2 ").replace(" m ", " m2 ").replace("typed-by m", "typed-by m2")
    )
    assert diff(parse_text(GATE), parse_text(renamed), ignore={"id"}) == []
    assert diff(parse_text(GATE), parse_text(renamed)) != []


def test_a_retyped_port_is_a_difference_also_when_ids_are_ignored():
    retyped = GATE.replace("typed-by m", "typed-by g")
    assert diff(parse_text(GATE), parse_text(retyped), ignore={"id"}) == [
        Change("Plant::Gate::in", "edge-added", "typed-by Plant::Gate"),
        Change("Plant::Gate::in", "edge-removed", "typed-by Plant::Pallet"),
    ]


@given(graphs())
def test_a_graph_does_not_differ_from_itself(graph):
    assert diff(graph, parse_text(print_text(graph))) == []
