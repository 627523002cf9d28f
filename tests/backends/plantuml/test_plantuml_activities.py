"""Activity diagrams: exceptions, expansion regions, and what tools write by themselves."""

import pytest
from diagrams import emitted, texts

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


def lines(text: str = MODEL) -> list[str]:
    return texts(parse_text(text))["run.act.puml"].splitlines()


def between(start: str, end: str) -> str:
    (found,) = (
        line for line in lines() if line.startswith(f"{start}_1 -") and f"> {end}_1" in line
    )
    return found


def test_a_handler_is_joined_to_the_node_that_it_protects():
    assert between("try", "repair") == "try_1 -[bold]-> repair_1 : ⚡ Fault"


def test_a_handler_whose_body_is_not_drawn_has_no_line():
    assert not any("⚡" in line for line in lines(MODEL.replace('["h"]', '["nobody"]')))


def test_the_literal_true_is_shown_after_a_decision_only():
    assert "[true]" not in between("try", "decision")
    assert "[true]" in between("decision", "each")


def test_a_weight_that_nobody_set_is_not_shown():
    assert "weight" not in between("try", "decision")
    assert "weight = 2}" in between("decision", "each")


def test_an_expansion_region_says_how_it_takes_the_elements():
    text = "\n".join(lines())
    assert "«iterative»" in text
    assert "«expansionNode»" in text


@pytest.mark.long
@pytest.mark.corpus
@pytest.mark.plantuml
def test_activities_of_a_large_library_render(corpus, plantuml):
    """Every fortieth of them: they are much alike, and drawing takes its time."""
    path, graph, sink = corpus / "xmi" / "papyrus" / "Alf.library.uml", Graph(), Sink()
    unit = read_unit([path], path.parent, [FRONTEND], sink)
    FRONTEND.read(unit.sources(), graph, sink, Coverage())
    pipeline.run(graph, sink, until="behaviours")
    files, _ = emitted(graph)
    drawn = {file.path: file.text for file in files if ".act." in file.path}
    some = dict(list(drawn.items())[::40])
    assert len(some) > 9
    assert len(plantuml.render(some)) == len(some)


def test_a_region_without_a_name_says_what_it_is_repeated_for():
    graph = parse_text("""\
Activity a "Count"
  Structured r subkind="expansion" mode="iterative" collection="belt.pallets"
    Property p "p" subkind="variable"
    Action look "look" subkind="opaque"
""")
    (written,) = texts(graph).values()
    assert "for each p of belt.pallets" in written


def test_the_value_of_a_pin_has_its_unit():
    text = 'Activity a "run"\n  Action x "x" subkind="opaque"\n    Pin p "time" value=1 {}\n'
    assert any("time = 1 s" in line for line in lines(text.format('value_unit="s"')))
    assert any(line.endswith("time = 1") for line in lines(text.format("")))
