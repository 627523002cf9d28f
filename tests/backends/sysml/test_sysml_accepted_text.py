"""sysmlc accepts the text that it writes, also where SysML v1 allows more than SysML v2."""

from sysml_texts import PASSES, refine, write

from sysmlc.diagnostics import Coverage, Sink
from sysmlc.frontends.sysml import FRONTEND
from sysmlc.ir import Graph
from sysmlc.passes import pipeline
from sysmlc.sources import Source


def write_accepted(model):
    """Return the lines of the text of a model, and its losses, after checking the text."""
    files, losses = write(refine(model))
    sink = Sink()
    graph = Graph()
    FRONTEND.read([Source("model.sysml", files["model.sysml"].encode())], graph, sink, Coverage())
    pipeline.build_pipeline(PASSES).run(graph, sink)
    assert [str(d.message) for d in sink if d.is_error] == []
    lines = [line.strip() for line in files["model.sysml"].splitlines() if line.strip()]
    return lines, losses


ALLOCATION = """
Package p "Plant"
  Class a "Logical" role="block"
    Property a.f "drilling" role="part" aggregation="composite"
      -> typed-by t
    Property a.g "milling" role="part" aggregation="composite"
      -> typed-by t
  Class b "Physical" role="block"
    Property b.m "machine" role="part" aggregation="composite"
      -> typed-by t
  Class t "Thing" role="block"
  Dependency d "" subkind="abstraction" role="allocate"
    -> client a.f
    -> supplier {supplier}
"""


def test_an_allocation_between_features_of_two_blocks_is_a_dependency():
    """An end of an allocation is an accessible feature; no chain leads from the package to it."""
    lines, _ = write_accepted(ALLOCATION.replace("{supplier}", "b.m"))
    assert "#allocates dependency from Logical::drilling to Physical::machine;" in lines


def test_an_allocation_between_features_of_one_block_is_an_allocation():
    lines, _ = write_accepted(ALLOCATION.replace("{supplier}", "a.g"))
    assert "allocate drilling to milling;" in lines


GUARD = """
Package p "Plant"
  Activity run "Run"
    Control run.i "" subkind="initial"
    Control run.d "" subkind="decision"
    Action run.a "a" subkind="opaque"
    Action run.b "b" subkind="opaque"
    ControlFlow run.f0 ""
      -> flow-source run.i
      -> flow-target run.d
    ControlFlow run.f1 "" guard="{guard}"
      -> flow-source run.d
      -> flow-target run.a
    ControlFlow run.f2 "" guard="else"
      -> flow-source run.d
      -> flow-target run.b
"""


def test_a_guard_that_is_a_number_is_a_boolean_feature_of_that_name():
    """The number of a branch is no condition; UML compares it with an input that is not drawn."""
    lines, losses = write_accepted(GUARD.replace("{guard}", "1"))
    assert "if '1' then a;" in lines
    assert "#inWords attribute '1' : Boolean;" in lines
    assert [loss for loss in losses if loss.startswith("SM735")] == [
        "SM735 '1' is not an expression over the model; it is written as a feature of that name"
    ]


def test_a_guard_that_is_a_truth_value_is_a_condition():
    lines, losses = write_accepted(GUARD.replace("{guard}", "true"))
    assert "if true then a;" in lines
    assert [loss for loss in losses if loss.startswith("SM735")] == []


OUTSIDE = """
Package p "Plant"
  Class gate "Gate" role="block"
    Property gate.owner "owner" role="part" aggregation="composite"
      -> typed-by gate
  Instance i "gate1"
    -> instance-of gate
    Slot i.s ""
      -> instance-of gate.owner
      -> references {value}
  Instance j "gate2"
    -> instance-of gate
Class outside "_19_0_1" external=true
"""


def test_a_value_outside_of_the_model_is_reported_as_lost():
    """Only its id is known: the stub is a definition, which has no value."""
    lines, losses = write_accepted(OUTSIDE.replace("{value}", "outside"))
    assert ":>> owner;" in lines
    assert losses == [
        "SM731 SysML v2 text cannot express 'references' from slot to class (1 omitted)"
    ]


def test_a_value_that_is_an_instance_is_written():
    lines, losses = write_accepted(OUTSIDE.replace("{value}", "j"))
    assert ":>> owner = gate2;" in lines
    assert losses == []


CONNECTOR = """
Package p "Plant"
  Class gate "Gate" role="block"
    Property gate.x "x" role="value" aggregation="composite"
    Connector gate.c "" role="binding connector"
      -> end gate.c.a gate.c.b
      ConnectorEnd gate.c.a
        -> role gate.x
      ConnectorEnd gate.c.b
        -> role outside
Class outside "_19_0_1" external=true
"""


def test_a_connector_to_an_end_outside_of_the_model_is_reported_as_lost():
    lines, losses = write_accepted(CONNECTOR)
    assert not any(line.startswith("bind") for line in lines)
    assert losses == [
        "SM736 'end' of connector leads to an element without a name in the text (1 omitted)"
    ]


ENUMERATION = """
Package p "Plant"
  Enumeration kind "Kind"
    EnumerationLiteral kind.a "small"
    Comment kind.d "" body="Sizes of pallets"
      -> references kind
    Constraint kind.c "known" body="self <> null" language="OCL"
"""


def test_a_constraint_of_an_enumeration_stands_beside_it():
    """An enumeration definition has enumerated values only (SysML 2.0, 7.8)."""
    lines, losses = write_accepted(ENUMERATION)
    start = lines.index("enum def Kind {")
    assert lines[start : start + 5] == [
        "enum def Kind {",
        "doc /* Sizes of pallets */",
        "enum small;",
        "}",
        "constraint known {",
    ]
    assert losses == [
        "SM734 the owner of constraint in an enumeration is written as its namespace "
        "(1 in the text)"
    ]
