"""Each kind of diagram: golden texts, nothing of the model left out, and real PlantUML."""

import pytest
from diagrams import emitted, model, texts

from sysmlc.ir import Graph, Kind
from sysmlc.ir.text import parse_text

KINDS = ("bdd", "ibd", "par", "act", "stm", "req", "sd", "uc")
UNNAMED_IN_PICTURES = (Kind.APPLICATION, Kind.COMMENT)


@pytest.mark.parametrize("kind", KINDS)
def test_the_text_of_a_small_model(kind, golden):
    golden.check(f"plantuml/{kind}", texts(model(kind)))


@pytest.mark.parametrize("kind", KINDS)
def test_every_name_of_the_model_is_in_some_diagram(kind):
    graph = model(kind)
    written = "\n".join(texts(graph).values())
    named = [item for item in graph if _is_drawn(item) and not item.attrs.get("body")]
    missing = [item for item in named if _escaped(item.name) not in written]
    assert missing == []


@pytest.mark.parametrize("kind", KINDS)
def test_every_element_is_in_some_trace(kind):
    graph = model(kind)
    files, sink = emitted(graph)
    traced = {id for file in files for id in file.trace}
    untraced = [item for item in graph if item.id not in traced and _is_drawn(item)]
    assert untraced == []
    assert list(sink) == []


@pytest.mark.parametrize("kind", KINDS)
def test_bodies_guards_and_values_are_in_the_text(kind):
    graph = model(kind)
    written = "\n".join(texts(graph).values())
    for item in graph:
        for key in ("guard", "body", "default", "multiplicity", "req_id", "join_spec", "when"):
            for part in str(item.attrs.get(key, "")).split():
                assert _escaped(part) in written, (item, key)


@pytest.mark.plantuml
def test_real_plantuml_renders_every_diagram(plantuml):
    made = {f"{kind}/{path}": text for kind in KINDS for path, text in texts(model(kind)).items()}
    assert set(plantuml.render(made)) == set(made)


def test_two_runs_give_the_same_bytes():
    assert [texts(model(kind)) for kind in KINDS] == [texts(model(kind)) for kind in KINDS]


def _is_drawn(item) -> bool:
    return item.kind not in UNNAMED_IN_PICTURES


def _escaped(text: str) -> str:
    """As the back end writes it; spelled out here, so that a fault there does not hide itself."""
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


def test_a_redefined_feature_without_a_name_is_told_by_its_type_or_what_it_redefines():
    (text,) = (text for path, text in texts(parse_text(REDEFINED)).items() if "bdd" in path)
    assert "a <U+007B>redefines : Pump}" in text
    assert "b <U+007B>redefines spare}" in text


def test_a_view_with_nothing_in_it_is_not_written():
    assert texts(Graph()) == {}


def test_what_is_inside_a_port_is_an_end_of_a_connector():
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
    written = texts(graph)["Tank.ibd.puml"]
    assert "out.fuelFlow</back>" in written
