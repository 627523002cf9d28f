"""kinds.py is current; verify finds faults; views, differences and EMF XMI."""

from ecore_reader import read_ecore_xmi
from graphs import graphs
from hypothesis import given

from graph_differences import Change, diff
from sysmlc.backends.ecore import print_xmi
from sysmlc.ir import Edge, Element, Graph, Kind, derived_id, parse_text, print_text, verify
from sysmlc.ir.generate import generate
from sysmlc.support import resources

GATE = """\
Package p "Plant"
  Class g "Gate"
    Port i "in" direction="in"
      -> typed-by m
  Class m "Pallet"
"""


def test_kinds_are_generated_from_the_metamodel_as_it_is_now():
    written = resources.find_root() / "compiler" / "sysmlc" / "ir" / "kinds.py"
    assert "".join(generate().split()) == "".join(written.read_text().split())


def test_derived_ids_depend_on_origin_and_role_only():
    assert derived_id("gate", "token") == derived_id("gate", "token")
    assert len({derived_id("a", "b"), derived_id("ab", ""), derived_id("", "ab")}) == 3


def test_verify_finds_a_flow_with_two_sources():
    graph = parse_text(
        "Activity a\n  Action x\n  Action y\n  ControlFlow f\n    -> flow-source x y\n"
    )
    assert verify(graph) == ["<ControlFlow f> (f) has several flow-source edges"]


def test_verify_finds_a_wrong_owner_and_a_lost_origin():
    graph = parse_text('Class c\n  Region r\n  Action a origin="gone"\n')
    assert verify(graph) == [
        "<Region r> (r) must not be owned by <Class c>",
        "<Action a> (a) names an origin that does not exist",
    ]


def test_networkx_sees_only_the_edges_that_are_asked_for():
    view = parse_text(GATE).to_networkx(Edge.TYPED_BY)
    assert list(view.edges(data="kind")) == [("i", "m", Edge.TYPED_BY)]
    assert view.nodes["i"] == {"kind": Kind.PORT, "name": "in"}


def test_equal_graphs_have_no_difference():
    assert diff(parse_text(GATE), parse_text(GATE)) == []


def test_differences_name_the_element_and_say_what_changed():
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
def test_a_graph_equals_itself(graph):
    assert diff(graph, parse_text(print_text(graph))) == []


@given(graph=graphs(max_size=6))
def test_pyecore_loads_a_saved_graph_unchanged(graph, tmp_path_factory):
    saved = tmp_path_factory.mktemp("ecore") / "graph.xmi"
    saved.write_text(print_xmi(graph), encoding="utf-8")
    assert print_text(read_ecore_xmi(str(saved))) == print_text(graph)


def test_an_empty_graph_is_saved_too(tmp_path):
    saved = tmp_path / "graph.xmi"
    saved.write_text(print_xmi(Graph()), encoding="utf-8")
    assert len(read_ecore_xmi(str(saved))) == 0


def test_elements_show_their_kind_and_name():
    assert repr(Element("x", Kind.PORT, "infeed")) == "<Port infeed>"
