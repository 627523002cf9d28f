"""Diagrams of a model's author show the elements and lines that the author chose."""

import re

import pytest
from diagrams import emit, load_model

from sysmlc.ir import Edge
from sysmlc.ir.text import parse_text


def emit_authored(graph):
    """Return the files of the author's diagrams, and the diagnostics."""
    return emit(graph, diagrams="author")


def draw_authored(graph=None):
    """Return the texts of the author's diagrams, by default of the small model."""
    files, _ = emit_authored(graph or load_model("author"))
    return {file.path.removeprefix("diagrams/author/"): file.text for file in files}


def list_lines(name):
    """Return the lines of one diagram: name of an end, arrow, name of the other end, label."""
    text = draw_authored()[name]
    names = {
        alias: re.sub(r"<[^>]*>|\*", "", title).split("\\n")[-1]
        for title, alias in re.findall(r'"([^"]*)" as (\w+)', text)
    }
    lines = re.findall(r'^(\w+) (?:"[^"]*" )?(\S+)(?: "[^"]*")? (\w+)(?: : (.*))?$', text, re.M)
    return [
        (names[source], arrow, names[target], re.sub(r"<[^>]*>", "", label))
        for source, arrow, target, label in lines
        if source in names and target in names and "hidden" not in arrow
    ]


def test_the_diagrams_of_the_author_have_their_golden_texts(golden):
    golden.check("plantuml/author", draw_authored())


def test_boxes_have_the_rows_that_the_author_chose():
    text = draw_authored()["Plant.Machines.bdd.puml"]
    assert "power" in text
    assert "length" in text
    assert "infeed" in text
    assert "outfeed" not in text
    assert "Delivered in May" in text
    assert "**Line**" not in text


def test_lines_that_the_author_omitted_are_not_drawn():
    lines = list_lines("Plant.Machines.bdd.puml")
    assert ("Device", "<|--", "Motor", "") in lines
    assert ("Device", "<|--", "Conveyor", "") not in lines
    assert not any("drives" in label for *_, label in lines)


def test_a_diagram_without_a_choice_of_lines_and_rows_has_all_of_them():
    text = draw_authored()["Plant.Everything.class.puml"]
    lines = list_lines("Plant.Everything.class.puml")
    assert ("Device", "<|--", "Conveyor", "") in lines
    assert "drives" in text


def test_parts_are_nested_as_in_the_diagram_of_the_author():
    text = draw_authored()["Plant.Line.Belt.ibd.puml"]
    loader = text.index("loader : Conveyor")
    assert loader < text.index("outfeed") < text.index("drive : Motor") < text.index("unloader")
    assert "power" in text
    assert text.count(">infeed<") == 1
    assert "hidden :" not in text
    assert [label for *_, label in list_lines("Plant.Line.Belt.ibd.puml")] == ["belt"]


def test_a_diagram_without_nesting_has_the_ports_of_the_types():
    assert draw_authored()["Plant.Line.By_type.ibd.puml"].count(">outfeed<") == 2


def test_a_long_row_has_its_size_in_each_of_its_lines():
    graph = load_model("author")
    graph.rename(graph["motor.kw"], "the electrical power that the motor takes at full load")
    (row,) = [
        line
        for line in draw_authored(graph)["Plant.Line.Belt.ibd.puml"].splitlines()
        if "Motor" in line
    ]
    assert row.count("<size:10>") == row.count("</size>") == row.count("\\n") == 2


def test_requirements_and_use_cases_have_the_chosen_relations():
    assert [label for *_, label in list_lines("Plant.Goals.req.puml")] == ["«satisfy»"]
    assert "«include»" in draw_authored()["Plant.Use.uc.puml"]


def test_behaviours_have_no_elements_that_the_author_omitted():
    half = draw_authored()["Plant.Half.act.puml"]
    assert "Pull" in half
    assert "Push" not in half
    modes = draw_authored()["Plant.Modes.stm.puml"]
    assert modes.count("-->") == 1
    assert "initial" not in modes


def test_views_that_are_not_drawn_are_reported():
    _, diagnostics = emit_authored(load_model("author"))
    assert [(diagnostic.rule.code, diagnostic.message) for diagnostic in diagnostics] == [
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


def test_elements_without_a_place_in_the_notation_are_reported():
    graph = parse_text(
        'Package p "Plant"\n  UseCase u "Start"\n  Class c "Pump"\n'
        '  View v "Use" subkind="diagram" diagram="uc"\n    -> references u c\n'
    )
    _, diagnostics = emit_authored(graph)
    (diagnostic,) = diagnostics
    assert diagnostic.rule.code == "SM703"
    assert diagnostic.message == "diagram 'Use' is drawn without 1 of 2 elements: Pump"


def test_a_use_case_diagram_has_no_omitted_comment_and_is_not_empty():
    graph = parse_text(
        'UseCase u "Start"\nClass c "Pump"\nComment n body="Later"\n  -> references u\n'
        'View v "Use" subkind="diagram" diagram="uc"\n  -> references u\n'
        'View w "Pumps" subkind="diagram" diagram="uc"\n  -> references c\n'
    )
    (file,), diagnostics = emit_authored(graph)
    assert "Later" not in file.text
    assert [diagnostic.rule.code for diagnostic in diagnostics] == ["SM702"]


def test_the_frame_may_be_a_shape_too():
    """In Papyrus the block is a shape of its own diagram, with the parts inside it."""
    graph = parse_text(
        'Class line "Line"\n  Property a "loader" role="part"\n'
        'View v "Parts" subkind="diagram" diagram="ibd" nesting=[["line","a"]]\n'
        "  -> represents line\n  -> references line a\n"
    )
    files, diagnostics = emit_authored(graph)
    assert diagnostics == []
    assert '"Line' not in files[0].text
    assert "loader" in files[0].text


def test_only_chosen_elements_and_their_contents_are_drawn():
    graph = load_model("author")
    for file in emit_authored(graph)[0]:
        view, *drawn_ids = file.trace
        chosen = graph.targets(graph[view], Edge.REFERENCES)
        frames = graph.targets(graph[view], Edge.REPRESENTS)
        owned = [part for element in chosen for part in graph.subtree(element)]
        assert set(drawn_ids) <= {element.id for element in (*chosen, *frames, *owned)}, file.path


@pytest.mark.parametrize(
    ("diagrams", "folders"), [("derived", {False}), ("author", {True}), ("both", {True, False})]
)
def test_the_option_selects_derived_diagrams_or_those_of_the_author_or_both(diagrams, folders):
    files, _ = emit(load_model("author"), diagrams=diagrams)
    assert {file.path.startswith("diagrams/author/") for file in files} == folders


def test_views_are_not_reported_when_only_derived_diagrams_are_drawn():
    _, diagnostics = emit(load_model("author"), diagrams="derived")
    assert not any("View" in diagnostic.message for diagnostic in diagnostics)


@pytest.mark.plantuml
def test_real_plantuml_renders_every_diagram(plantuml):
    assert set(plantuml.render(draw_authored())) == set(draw_authored())
