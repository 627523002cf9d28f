"""The pass ``views``: each diagram of the model becomes a view in the graph."""

from sysmlc.diagnostics import Sink
from sysmlc.ir import Edge, Kind
from sysmlc.ir.pending import Drawing
from sysmlc.ir.text import parse_text, print_text
from sysmlc.ir.verify import verify
from sysmlc.passes import pipeline

PLANT = """\
Package plant "Plant" @a.uml:1
  Class gate "Gate" @a.uml:2
  Class b.uml#lift "Lift" @b.uml:2
  Class a.uml#lift "Lift" @a.uml:3
Class far "Pallet" external=true href="lib.uml#_pallet"
"""


def make_drawing(**fields):
    defaults = {
        "id": "d",
        "name": "Gates",
        "type": "Class Diagram",
        "diagram": "class",
        "file": "a.uml",
        "source": "a.uml",
        "ordinal": 7,
    }
    return Drawing(**(defaults | fields))


def run_views(*drawings, text=PLANT):
    graph, sink = parse_text(text), Sink()
    graph.store(Drawing, drawings)
    pipeline.load("views").run(graph, sink)
    assert verify(graph) == []
    return graph, sink


def list_shown(graph, id="d"):
    """Return the ids of the elements that a diagram shows."""
    return [element.id for element in graph.targets(graph[id], Edge.REFERENCES)]


def test_a_diagram_becomes_a_view_below_its_owner():
    graph, sink = run_views(make_drawing(owner="plant", context="gate", shown=("gate",)))
    view = graph["d"]
    assert (view.kind, view.name, view.owner, view.ordinal) == (Kind.VIEW, "Gates", "plant", 7)
    assert view.attrs == {
        "subkind": "diagram",
        "diagram": "class",
        "diagram_type": "Class Diagram",
        "relations": (),
    }
    assert list_shown(graph) == ["gate"]
    assert graph.target(view, Edge.REPRESENTS) is graph["gate"]
    assert list(sink) == []


def test_an_id_refers_to_an_element_of_the_file_of_the_diagram():
    graph, _ = run_views(
        make_drawing(shown=("lift",)), make_drawing(id="e", file="b.uml", shown=("lift",))
    )
    assert list_shown(graph) == ["a.uml#lift"]
    assert list_shown(graph, "e") == ["b.uml#lift"]


def test_an_href_refers_to_the_element_or_its_stub():
    graph, sink = run_views(make_drawing(shown=("a.uml#gate", "lib.uml#_pallet")))
    assert list_shown(graph) == ["gate", "far"]
    assert list(sink) == []


def test_lines_between_existing_elements_become_relations():
    lines = ((Edge.SPECIALIZES, "gate", "lift"), (Edge.SPECIALIZES, "gate", "gone"))
    graph, sink = run_views(make_drawing(shown=("gate", "g1", "g2"), relations=lines))
    assert graph["d"].attrs["relations"] == (("specializes", "gate", "a.uml#lift"),)
    assert list(sink) == []


def test_nesting_and_compartments_of_existing_elements_are_preserved():
    graph, _ = run_views(
        make_drawing(
            shown=("gate", "lift"), paths=(("gate", "lift"), ("gate", "gone")), listed=("lift",)
        )
    )
    assert graph["d"].attrs["nesting"] == (("gate", "a.uml#lift"),)
    assert graph["d"].attrs["listed"] == ("a.uml#lift",)


def test_shown_elements_outside_the_unit_are_reported():
    _, sink = run_views(make_drawing(owner="plant", shown=("gate", "gone", "x.uml#far away")))
    (diagnostic,) = sink
    assert (diagnostic.rule.code, diagnostic.subject.name) == ("SM162", "Plant::Gates")
    assert diagnostic.message == (
        "diagram 'Gates' shows 3 elements, 2 of them from no file of the unit"
    )


def test_a_diagram_with_an_empty_or_used_id_gets_another_id():
    graph, _ = run_views(make_drawing(id="gate"), make_drawing(id=""))
    assert graph["gate"].kind is Kind.CLASS
    assert graph["a.uml#gate"].kind is Kind.VIEW
    assert len(graph.of_kind(Kind.VIEW)) == 2


def test_the_pass_is_idempotent_and_without_diagrams_changes_nothing():
    graph, _ = run_views()
    assert print_text(graph) == print_text(parse_text(PLANT))
    graph, _ = run_views(make_drawing(shown=("gate",)))
    once = print_text(graph)
    graph.store(Drawing, [make_drawing(shown=("gate",))])
    pipeline.load("views").run(graph, Sink())
    assert print_text(graph) == once


def test_a_diagram_does_not_get_the_role_of_a_sysml_view():
    graph = parse_text('View v "Gates" subkind="diagram"\nView w "Safety"\n')
    pipeline.load("classify").run(graph, Sink())
    assert (graph["v"].role, graph["w"].role) == ("", "view")
