"""Each kind of diagram has its golden text, the whole model, and is rendered by PlantUML."""

import pytest
from diagrams import draw, emit, load_model

from sysmlc.ir import Graph, Kind
from sysmlc.ir.text import parse_text

KINDS = ("bdd", "ibd", "par", "act", "stm", "req", "sd", "uc")
UNNAMED_IN_PICTURES = (Kind.APPLICATION, Kind.COMMENT)


@pytest.mark.parametrize("kind", KINDS)
def test_the_diagrams_of_a_small_model_have_their_golden_texts(kind, golden):
    golden.check(f"plantuml/{kind}", draw(load_model(kind)))


@pytest.mark.parametrize("kind", KINDS)
def test_every_name_of_the_model_is_in_some_diagram(kind):
    graph = load_model(kind)
    text = "\n".join(draw(graph).values())
    named = [element for element in graph if is_drawn(element) and not element.attrs.get("body")]
    missing = [element for element in named if escape(element.name) not in text]
    assert missing == []


@pytest.mark.parametrize("kind", KINDS)
def test_every_element_is_in_some_trace(kind):
    graph = load_model(kind)
    files, diagnostics = emit(graph)
    traced = {id for file in files for id in file.trace}
    untraced = [element for element in graph if element.id not in traced and is_drawn(element)]
    assert untraced == []
    assert diagnostics == []


@pytest.mark.parametrize("kind", KINDS)
def test_bodies_guards_and_values_are_in_the_text(kind):
    graph = load_model(kind)
    text = "\n".join(draw(graph).values())
    for element in graph:
        for key in ("guard", "body", "default", "multiplicity", "req_id", "join_spec", "when"):
            for part in str(element.attrs.get(key, "")).split():
                assert escape(part) in text, (element, key)


@pytest.mark.plantuml
def test_real_plantuml_renders_every_diagram(plantuml):
    files = {
        f"{kind}/{path}": text for kind in KINDS for path, text in draw(load_model(kind)).items()
    }
    assert set(plantuml.render(files)) == set(files)


def test_two_runs_give_the_same_texts():
    assert [draw(load_model(kind)) for kind in KINDS] == [draw(load_model(kind)) for kind in KINDS]


def is_drawn(element) -> bool:
    return element.kind not in UNNAMED_IN_PICTURES


def escape(text: str) -> str:
    """Escape markup independently of the back end, so that a fault there is found."""
    table = {'"': "22", "<": "3C", ">": "3E", "&": "26", "{": "7B"}
    return "".join(f"<U+00{table[char]}>" if char in table else char for char in text)


REDEFINED = """\
Package line "Line"
  Class pump "Pump" role="block"
  Class station "Station" role="block"
    Property station.unnamed "" role="part" aggregation="composite"
      -> typed-by pump
    Property station.spare "spare" role="value"
  Class big "Big station" role="block"
    -> specializes station
    Property big.unnamed "" role="value"
      -> redefines station.spare
    Property big.a "a" role="value"
      -> redefines station.unnamed
    Property big.b "b" role="value"
      -> redefines big.unnamed
"""


def test_a_redefined_feature_without_a_name_is_shown_by_its_type_or_the_feature_it_redefines():
    (text,) = (text for path, text in draw(parse_text(REDEFINED)).items() if "bdd" in path)
    assert "a <U+007B>redefines : Pump}" in text
    assert "b <U+007B>redefines spare}" in text


def test_an_empty_view_is_not_written():
    assert draw(Graph()) == {}


def test_a_feature_within_a_port_may_be_the_end_of_a_connector():
    graph = parse_text("""\
Class port "FuelPort" role="interface block"
  Property port.flow "fuelFlow" role="flow property" direction="out"
Class pump "Pump" role="block"
  Port pump.p "out" role="proxy port"
    -> typed-by port
Class tank "Tank" role="block"
  Property tank.pump "pump" role="part" aggregation="composite"
    -> typed-by pump
  Property tank.level "level" role="value"
  Connector b role="binding connector"
    -> end b.1 b.2
    ConnectorEnd b.1
      -> path tank.pump pump.p
      -> role port.flow
    ConnectorEnd b.2
      -> role tank.level
""")
    text = draw(graph)["Tank.ibd.puml"]
    assert "out.fuelFlow</back>" in text
