"""Facts that real models lost in the text: they are read back, or their loss is reported."""

import pytest
from test_v2_preserved_facts import graph_of, read_back_and_compare

from sysmlc.backends.sysml import write_document

METHOD = """
Package p "Plant"
  Class gate "Gate" role="block"
    Operation gate.check "check"
      -> method run
  Activity run "Run"
    Parameter run.a "a" direction="in"
"""
CONSTRAINT = """
Package p "Plant"
  Class gate "Gate" role="block"
    Property gate.x "x" role="value" aggregation="composite"
      -> typed-by real
    Constraint gate.c "" body="x >= 0" language="OCL"
      -> references gate.x
  DataType real "Length" role="value type"
"""
EMPTY_BODY = """
Package p "Plant"
  Class gate "Gate" role="block"
    Constraint gate.c "c" body=""
"""
ABOUT_MESSAGES = """
Package p "Plant"
  Constraint c "c" subkind="interaction"
"""
CONVERSATION = """
Package p "Plant"
  Class gate "Gate" role="block"
    Interaction gate.talk "Talk"
    -> classifier-behavior gate.talk
"""
END_OF_FLOW = """
Package p "Plant"
  Activity run "Run"
    Structured run.s "handler" subkind="structured"
      Action run.s.a "a" subkind="opaque"
      Control run.s.e "end" subkind="flow-final"
      ControlFlow run.s.f ""
        -> flow-source run.s.a
        -> flow-target run.s.e
"""
READING = """
Package p "Plant"
  Class gate "Gate" role="block"
    Property gate.x "x" role="reference"
      -> typed-by gate
  Activity run "Run"
    Action run.a "read x" subkind="read"
      -> calls gate.x
      Pin run.a.r "result" direction="out" subkind="result"
"""
NO_TEXT = """
Package p "Plant"
  Activity run "Run"
    Parameter run.a "a" direction="in" default="" default_language="UML"
"""
NO_BODY = """
Package p "Plant"
  Activity run "Run" subkind="function" language="Natural language"
"""
EXPANSION = """
Package p "Plant"
  Activity run "Run"
    Structured run.s "each" subkind="expansion" mode="parallel"
    ObjectNode run.o "in" subkind="expansion"
      -> typed-by box
  DataType box "Box" role="value type"
"""
OWN_UNIT = """
Package p "Plant"
  DataType v "Speed" role="value type"
    -> references u
    -> references q
  Instance u "{unit}" role="unit" description="distance in an hour"
  Instance q "velocity" role="quantity kind"
  Class c "Car" role="block"
    Property c.v "top" role="value" aggregation="composite" default=160.0
      -> typed-by v
"""
VIEW = """
Package p "Plant"
  {kind} v "How to start" role="view"
    Class v.g "Gate" role="block"
"""
BEHAVIOURS_AS_TYPES = """
Package p "Plant"
  Class c "Gate" role="block"
    Property c.p "Run" role="reference"
      -> typed-by m
    Property c.q "walking" role="reference"
      -> typed-by a
    StateMachine m "Run"
      Property m.q "doing" role="reference"
        -> typed-by a
      Region m.r ""
        State m.s "S"
  Activity a "Walk"
    Action a.x "x" subkind="opaque"
"""
INHERITED_UNIT = """
Package p "Plant"
  DataType l "length[nanometre]" role="value type"
    -> references l.u
    Unit l.u "nanometre" external=true library=true
  DataType e "Error" role="value type"
    -> specializes l
"""
END_TYPED_BY_BEHAVIOUR = """
Package p "Plant"
  Association k ""
    -> end m.q k.e
    Property k.e ""
      -> typed-by m
  Class c "Gate" role="block"
    StateMachine m "Run"
      Property m.q "doing" role="reference" aggregation="composite"
        -> typed-by a
      Region m.r ""
        State m.s "S"
          Activity a "Walk"
            Action a.x "x" subkind="opaque"
"""
SPARE = """
Package p "Plant"
  Class e "Lamp" role="block"
    Property e.p "spare" role="part" aggregation="composite" default="bulb" default_instance="i"
      -> typed-by b
  Class b "Bulb" role="block"
  Instance i "bulb"
    -> instance-of b
"""
MATRIX = """
Package p "Plant"
  Class c "Camera" role="block"
    Property c.p "pixels" role="value" aggregation="composite" multiplicity="2x1024"
"""
INPUT_FLOW = """
Package p "Plant"
  Activity run "Run"
    Action run.a "a" subkind="opaque"
      Pin run.a.o "o" direction="out" subkind="output-value"
    Control run.d "d" subkind="decision" decision_input_flow="run.f"
    ObjectFlow run.f "given"
      -> flow-source run.a.o
      -> flow-target run.d
    Action run.b "b" subkind="opaque"
    ControlFlow run.g ""
      -> flow-source run.d
      -> flow-target run.b
"""


@pytest.mark.parametrize(
    "text",
    [
        METHOD,
        CONSTRAINT,
        EMPTY_BODY,
        ABOUT_MESSAGES,
        CONVERSATION,
        END_OF_FLOW,
        READING,
        NO_TEXT,
        NO_BODY,
        EXPANSION,
        VIEW.format(kind="Package"),
        VIEW.format(kind="Class"),
        BEHAVIOURS_AS_TYPES,
        END_TYPED_BY_BEHAVIOUR,
        SPARE,
        INHERITED_UNIT,
        MATRIX,
        MATRIX.replace("2x1024", "2..1024"),
        OWN_UNIT.format(unit="km/hr"),
        OWN_UNIT.format(unit="leagues a day"),
    ],
)
def test_it_comes_back(text):
    _, differences = read_back_and_compare(text)
    assert differences == []


def test_the_flow_that_a_decision_is_made_over_is_kept_by_its_name():
    graph, differences = read_back_and_compare(INPUT_FLOW)
    assert [difference for difference in differences if "decision input flow" in difference] == []
    (decision,) = [element for element in graph if element.name == "d"]
    assert graph[str(decision.attrs["decision_input_flow"])].name == "given"


def list_losses(text):
    """Return the ids of elements with a reported loss, and the lost constructs."""
    writer, _ = write_document(graph_of(text))
    losses_by_id = writer.losses.by_element.items()
    return {
        id_: [facts.get("construct", code) for code, facts in losses]
        for id_, losses in losses_by_id
    }


WAITING = """
Package p "Plant"
  Activity run "Run"
    Action run.a "a" subkind="opaque"
    Action run.b "b" subkind="opaque"
    Action run.c "c" subkind="opaque"
    ControlFlow run.f "f" {guard}
      -> flow-source run.a
      -> flow-target run.c
    ControlFlow run.g "g"
      -> flow-source run.b
      -> flow-target run.c
"""


def test_a_step_that_waits_for_a_guarded_flow_is_reported():
    construct = "a step that waits for several flows, one of them with a guard,"
    assert list_losses(WAITING.format(guard='guard="1 < 2"')) == {"run.c": [construct]}
    assert list_losses(WAITING.format(guard="")) == {}


FORK = """
Package p "Plant"
  StateMachine m "M"
    Region m.r ""
      State m.r.s "S"
        Pseudostate m.r.s.f "f" subkind="{subkind}"
"""


def test_a_fork_that_a_state_owns_without_a_region_is_reported():
    construct = "a pseudostate that no region owns"
    assert list_losses(FORK.format(subkind="fork"))["m.r.s.f"] == [construct]
    assert "m.r.s.f" not in list_losses(FORK.format(subkind="exit-point"))


IMPORT = """
Package p "Plant"
  Import p.i "" subkind="package"
    -> references {target}
Package q "Other"
Package types "PrimitiveTypes" external=true
"""


def test_an_import_of_primitive_types_of_uml_is_reported():
    assert list_losses(IMPORT.format(target="types")) == {"p.i": ["an import of primitive types"]}
    assert "p.i" not in list_losses(IMPORT.format(target="q"))


DEGREES = """
Package p "Plant"
  DataType t "Temperature" role="value type"
    -> references t.u
    -> references t.q
    Unit t.u "degree" symbol="{symbol}" external=true library=true
    QuantityKind t.q "thermodynamic temperature" external=true library=true
"""


def test_a_quantity_kind_with_another_unit_is_reported():
    construct = "a quantity kind that has other units"
    assert list_losses(DEGREES.format(symbol="°C")) == {"t": [construct]}
    assert list_losses(DEGREES.format(symbol="K")) == {}
