"""The pass ``views``: diagrams of authors become elements of the graph."""

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


def drawing(**fields):
    given = {
        "id": "d",
        "name": "Gates",
        "type": "Class Diagram",
        "diagram": "class",
        "file": "a.uml",
        "source": "a.uml",
        "ordinal": 7,
    }
    return Drawing(**(given | fields))


def refined(*drawings, text=PLANT):
    graph, sink = parse_text(text), Sink()
    graph.store(Drawing, drawings)
    pipeline.load("views").run(graph, sink)
    assert verify(graph) == []
    return graph, sink


def shown(graph, id="d"):
    return [one.id for one in graph.targets(graph[id], Edge.REFERENCES)]


def test_a_drawing_becomes_a_view_below_its_owner():
    graph, sink = refined(drawing(owner="plant", context="gate", shown=("gate",)))
    view = graph["d"]
    assert (view.kind, view.name, view.owner, view.ordinal) == (Kind.VIEW, "Gates", "plant", 7)
    assert view.attrs == {
        "subkind": "diagram",
        "diagram": "class",
        "diagram_type": "Class Diagram",
        "relations": (),
    }
    assert shown(graph) == ["gate"]
    assert graph.target(view, Edge.REPRESENTS) is graph["gate"]
    assert list(sink) == []


def test_an_id_means_the_element_of_the_drawings_own_file():
    graph, _ = refined(drawing(shown=("lift",)), drawing(id="e", file="b.uml", shown=("lift",)))
    assert shown(graph) == ["a.uml#lift"]
    assert shown(graph, "e") == ["b.uml#lift"]


def test_an_href_means_the_element_or_its_stand_in():
    graph, sink = refined(drawing(shown=("a.uml#gate", "lib.uml#_pallet")))
    assert shown(graph) == ["gate", "far"]
    assert list(sink) == []


def test_lines_that_are_edges_are_kept_with_the_ids_of_the_graph():
    lines = ((Edge.SPECIALIZES, "gate", "lift"), (Edge.SPECIALIZES, "gate", "gone"))
    graph, sink = refined(drawing(shown=("gate", "g1", "g2"), relations=lines))
    assert graph["d"].attrs["relations"] == (("specializes", "gate", "a.uml#lift"),)
    assert list(sink) == []


def test_nesting_and_rows_are_kept_as_far_as_they_are_known():
    graph, _ = refined(
        drawing(
            shown=("gate", "lift"), paths=(("gate", "lift"), ("gate", "gone")), listed=("lift",)
        )
    )
    assert graph["d"].attrs["nesting"] == (("gate", "a.uml#lift"),)
    assert graph["d"].attrs["listed"] == ("a.uml#lift",)


def test_what_is_in_no_file_is_reported():
    _, sink = refined(drawing(owner="plant", shown=("gate", "gone", "x.uml#far away")))
    (found,) = sink
    assert (found.rule.code, found.subject.name) == ("SM162", "Plant::Gates")
    assert found.message == (
        "2 of the 3 elements that diagram 'Gates' shows are in no file of the unit"
    )


def test_a_diagram_without_an_id_or_with_that_of_an_element_has_one_of_its_own():
    graph, _ = refined(drawing(id="gate"), drawing(id=""))
    assert graph["gate"].kind is Kind.CLASS
    assert graph["a.uml#gate"].kind is Kind.VIEW
    assert len(graph.of_kind(Kind.VIEW)) == 2


def test_without_drawings_nothing_happens_and_twice_is_once():
    graph, _ = refined()
    assert print_text(graph) == print_text(parse_text(PLANT))
    graph, _ = refined(drawing(shown=("gate",)))
    once = print_text(graph)
    graph.store(Drawing, [drawing(shown=("gate",))])
    pipeline.load("views").run(graph, Sink())
    assert print_text(graph) == once


def test_a_diagram_is_no_view_of_sysml_when_it_is_read_again():
    graph = parse_text('View v "Gates" subkind="diagram"\nView w "Safety"\n')
    pipeline.load("classify").run(graph, Sink())
    assert (graph["v"].role, graph["w"].role) == ("", "view")
