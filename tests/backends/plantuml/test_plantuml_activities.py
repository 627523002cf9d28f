"""Activity diagrams: exception handlers, expansion regions, guards, weights and values."""

import pytest
from diagrams import draw, emit

from sysmlc.diagnostics import Coverage, Sink
from sysmlc.driver.reading import read_unit
from sysmlc.frontends.xmi import FRONTEND
from sysmlc.ir import Graph
from sysmlc.ir.text import parse_text
from sysmlc.passes import pipeline

MODEL = """
Class fault "Fault"
Activity a "run"
  Structured s "try" subkind="structured" handlers=[[["h"], ["h.e"], ["fault"]]]
    Action x "x" subkind="opaque"
  Structured h "repair" subkind="structured"
    Pin h.e "e" direction="in"
    Action y "y" subkind="opaque"
  ObjectNode list "list" subkind="expansion" region_as_input="each"
  Structured each "each" subkind="expansion" mode="iterative"
    Action z "z" subkind="opaque"
  Control d "" subkind="decision"
  ControlFlow f1 guard="true" guard_literal=true weight=0
    -> flow-source s
    -> flow-target d
  ControlFlow f2 guard="true" guard_literal=true weight=2
    -> flow-source d
    -> flow-target each
  ObjectFlow f3
    -> flow-source list
    -> flow-target z
"""


def draw_lines(text: str = MODEL) -> list[str]:
    """Return the lines of the diagram of the activity 'run'."""
    return draw(parse_text(text))["run.act.puml"].splitlines()


def find_arrow(source: str, target: str) -> str:
    """Return the line of the only arrow between two nodes."""
    (arrow,) = (
        line
        for line in draw_lines()
        if line.startswith(f"{source}_1 -") and f"> {target}_1" in line
    )
    return arrow


def test_a_handler_is_connected_to_the_protected_node():
    assert find_arrow("try", "repair") == "try_1 -[bold]-> repair_1 : ⚡ Fault"


def test_a_handler_whose_body_is_not_drawn_has_no_arrow():
    assert not any("⚡" in line for line in draw_lines(MODEL.replace('["h"]', '["nobody"]')))


def test_the_literal_true_is_shown_after_a_decision_only():
    assert "[true]" not in find_arrow("try", "decision")
    assert "[true]" in find_arrow("decision", "each")


def test_names_of_flows_and_final_nodes_are_shown_unless_a_tool_made_them_up():
    text = """
Activity a "run"
  Action x "x" subkind="opaque"
  Control good "accepted" subkind="final"
  Control bad "ActivityFinalNode2" subkind="final"
  ControlFlow f1 "part is good"
    -> flow-source x
    -> flow-target good
  ControlFlow f2 "ControlFlow7"
    -> flow-source x
    -> flow-target bad
"""
    lines = draw_lines(text)
    assert "x_1 -[dashed]-> accepted_1 : part is good" in lines
    assert "note right of accepted_1 : accepted" in lines
    assert "x_1 -[dashed]-> activityfinalnode2_1" in lines
    assert not any(line.startswith("note right of activityfinal") for line in lines)


def test_the_default_weight_is_not_shown():
    assert "weight" not in find_arrow("try", "decision")
    assert "weight = 2}" in find_arrow("decision", "each")


def test_an_expansion_region_has_its_mode():
    text = "\n".join(draw_lines())
    assert "«iterative»" in text
    assert "«expansionNode»" in text


@pytest.mark.long
@pytest.mark.corpus
@pytest.mark.plantuml
def test_activities_of_a_large_library_are_rendered(corpus, plantuml):
    """Only every fortieth is rendered: they are much alike, and rendering is slow."""
    path, graph, sink = corpus / "xmi" / "papyrus" / "Alf.library.uml", Graph(), Sink()
    unit = read_unit([path], path.parent, [FRONTEND], sink)
    FRONTEND.read(unit.sources(), graph, sink, Coverage())
    pipeline.run(graph, sink, until="behaviours")
    files, _ = emit(graph)
    diagrams = {file.path: file.text for file in files if ".act." in file.path}
    every_fortieth = dict(list(diagrams.items())[::40])
    assert len(every_fortieth) > 9
    assert len(plantuml.render(every_fortieth)) == len(every_fortieth)


def test_an_expansion_region_without_a_name_has_its_variable_and_collection():
    graph = parse_text("""\
Activity a "Count"
  Structured r subkind="expansion" mode="iterative" collection="belt.pallets"
    Property p "p" subkind="variable"
    Action look "look" subkind="opaque"
""")
    (diagram,) = draw(graph).values()
    assert "for each p of belt.pallets" in diagram


def test_the_value_of_a_pin_has_its_unit():
    text = 'Activity a "run"\n  Action x "x" subkind="opaque"\n    Pin p "time" value=1 {}\n'
    assert any("time = 1 s" in line for line in draw_lines(text.format('value_unit="s"')))
    assert any(line.endswith("time = 1") for line in draw_lines(text.format("")))
