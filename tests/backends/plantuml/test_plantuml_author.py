"""Diagrams of authors: what they chose is drawn, and nothing else."""

import re

import pytest
from diagrams import model

from sysmlc.backends.base import EmitOptions
from sysmlc.backends.plantuml import BACKEND
from sysmlc.diagnostics import Sink
from sysmlc.ir import Edge
from sysmlc.ir.text import parse_text
from sysmlc.support.output import Output


def emitted(graph, diagrams="author"):
    output, sink = Output(), Sink()
    BACKEND.emit(graph, output, sink, EmitOptions(diagrams=diagrams))
    return output.artefacts(), sink


def texts(graph=None):
    files, _ = emitted(graph or model("author"))
    return {file.path.removeprefix("diagrams/author/"): file.text for file in files}


def lines(name):
    """Arrows and labels of one diagram, between the names of their ends."""
    text = texts()[name]
    names = {alias: title for title, alias in re.findall(r'"([^"]*)" as (\w+)', text)}
    plain = {alias: re.sub(r"<[^>]*>|\*", "", one).split("\\n")[-1] for alias, one in names.items()}
    found = re.findall(r'^(\w+) (?:"[^"]*" )?(\S+)(?: "[^"]*")? (\w+)(?: : (.*))?$', text, re.M)
    return [
        (plain[a], arrow, plain[b], re.sub(r"<[^>]*>", "", label))
        for a, arrow, b, label in found
        if a in plain and b in plain and "hidden" not in arrow
    ]


def test_the_texts_of_a_small_model(golden):
    golden.check("plantuml/author", texts())


def test_boxes_have_the_rows_that_the_author_shows():
    text = texts()["Plant.Machines.bdd.puml"]
    assert "power" in text
    assert "length" in text
    assert "infeed" in text
    assert "outfeed" not in text
    assert "Delivered in May" in text
    assert "**Line**" not in text


def test_lines_that_the_author_left_out_are_not_drawn():
    found = lines("Plant.Machines.bdd.puml")
    assert ("Device", "<|--", "Motor", "") in found
    assert ("Device", "<|--", "Conveyor", "") not in found
    assert not any("drives" in label for *_, label in found)


def test_without_a_word_on_lines_and_rows_all_between_the_boxes_are_drawn():
    text = texts()["Plant.Everything.class.puml"]
    found = lines("Plant.Everything.class.puml")
    assert ("Device", "<|--", "Conveyor", "") in found
    assert "drives" in text


def test_parts_are_nested_as_they_were_drawn():
    text = texts()["Plant.Line.Belt.ibd.puml"]
    loader = text.index("loader : Conveyor")
    assert loader < text.index("outfeed") < text.index("drive : Motor") < text.index("unloader")
    assert "power" in text
    assert text.count(">infeed<") == 1
    assert "hidden :" not in text
    assert [label for *_, label in lines("Plant.Line.Belt.ibd.puml")] == ["belt"]


def test_without_nesting_the_types_say_what_is_inside():
    assert texts()["Plant.Line.By%20type.ibd.puml"].count(">outfeed<") == 2


def test_a_long_row_is_small_in_each_of_its_lines():
    graph = model("author")
    graph.rename(graph["motor.kw"], "the electrical power that the motor takes at full load")
    (row,) = [
        line for line in texts(graph)["Plant.Line.Belt.ibd.puml"].splitlines() if "Motor" in line
    ]
    assert row.count("<size:10>") == row.count("</size>") == row.count("\\n") == 2


def test_requirements_and_use_cases_have_the_chosen_relations():
    assert [one[3] for one in lines("Plant.Goals.req.puml")] == ["«satisfy»"]
    assert "«include»" in texts()["Plant.Use.uc.puml"]


def test_behaviours_lose_what_was_left_out():
    half = texts()["Plant.Half.act.puml"]
    assert "Pull" in half
    assert "Push" not in half
    modes = texts()["Plant.Modes.stm.puml"]
    assert modes.count("-->") == 1
    assert "initial" not in modes


def test_what_is_no_drawing_is_reported():
    _, sink = emitted(model("author"))
    assert [(found.rule.code, found.message) for found in sink] == [
        (
            "SM702",
            "diagram 'Goals as a table' of the model's author is not drawn: "
            "a Requirement Table is not drawn",
        ),
        (
            "SM702",
            "diagram 'Nothing' of the model's author is not drawn: "
            "it shows nothing of the model that its notation has a place for",
        ),
        ("SM702", "diagram 'Ideas' of the model's author is not drawn: a Mind Map is not drawn"),
    ]


def test_what_has_no_place_in_the_notation_is_reported():
    graph = parse_text(
        'Package p "Plant"\n  UseCase u "Start"\n  Class c "Pump"\n'
        '  View v "Use" subkind="diagram" diagram="uc"\n    -> references u c\n'
    )
    _, sink = emitted(graph)
    (found,) = sink
    assert found.rule.code == "SM703"
    assert found.message == "1 of the 2 elements that diagram 'Use' shows are not drawn: Pump"


def test_a_use_case_diagram_has_no_comment_that_was_left_out_and_is_not_empty():
    graph = parse_text(
        'UseCase u "Start"\nClass c "Pump"\nComment n body="Later"\n  -> references u\n'
        'View v "Use" subkind="diagram" diagram="uc"\n  -> references u\n'
        'View w "Pumps" subkind="diagram" diagram="uc"\n  -> references c\n'
    )
    (file,), sink = emitted(graph)
    assert "Later" not in file.text
    assert [found.rule.code for found in sink] == ["SM702"]


def test_the_frame_may_be_a_shape_too():
    """Papyrus draws the block itself, and the parts inside it."""
    graph = parse_text(
        'Class line "Line"\n  Property a "loader" role="part"\n'
        'View v "Parts" subkind="diagram" diagram="ibd" nesting=[["line","a"]]\n'
        "  -> represents line\n  -> references line a\n"
    )
    files, sink = emitted(graph)
    assert list(sink) == []
    assert '"Line' not in files[0].text
    assert "loader" in files[0].text


def test_everything_that_is_drawn_was_chosen():
    graph = model("author")
    for file in emitted(graph)[0]:
        view, *shown = file.trace
        chosen = {one.id for one in graph.targets(graph[view], Edge.REFERENCES)}
        about = {one.id for one in graph.targets(graph[view], Edge.REPRESENTS)}
        owned = {part.id for id in chosen for part in graph.subtree(graph[id])}
        assert set(shown) <= chosen | about | owned, file.path


@pytest.mark.parametrize(
    ("diagrams", "folders"), [("derived", {False}), ("author", {True}), ("both", {True, False})]
)
def test_derived_authored_or_both(diagrams, folders):
    files, _ = emitted(model("author"), diagrams)
    assert {file.path.startswith("diagrams/author/") for file in files} == folders


def test_derived_diagrams_do_not_miss_the_views():
    _, sink = emitted(model("author"), "derived")
    assert [found.message for found in sink if "View" in found.message] == []


@pytest.mark.plantuml
def test_real_plantuml_renders_every_diagram(plantuml):
    assert set(plantuml.render(texts())) == set(texts())
