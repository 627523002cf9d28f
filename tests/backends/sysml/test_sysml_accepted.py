"""sysmlc and the OpenMBEE toolkit accept the text of models that SysML v2 writes differently."""

from sysml_texts import lines_of, refine, write
from toolkit import load

from sysmlc.diagnostics import Coverage, Sink
from sysmlc.frontends.sysml import FRONTEND
from sysmlc.ir import Graph
from sysmlc.sources import Source

STRUCTURED_NODE = """
Package p "Plant"
  Activity a "Fill"
    Structured region "Region" subkind="structured"
      Action x "x" subkind="opaque"
        Pin x.o "output" direction="out"
      ObjectFlow f "outwards"
        -> flow-source x.o
        -> flow-target y.i
    Action y "y" subkind="opaque"
      Pin y.i "input" direction="in"
"""
THROUGH_A_MERGE = (
    STRUCTURED_NODE.replace("flow-target y.i", "flow-target m")
    + """\
    Control m "m" subkind="merge"
    ObjectFlow g ""
      -> flow-source m
      -> flow-target y.i
"""
)
INSIDE_THE_NODE = """
Package p "Plant"
  Activity a "Fill"
    Structured region "Region" subkind="structured"
      Action x "x" subkind="opaque"
        Pin x.o "output" direction="out"
      Action y "y" subkind="opaque"
        Pin y.i "input" direction="in"
      ObjectFlow f "within"
        -> flow-source x.o
        -> flow-target y.i
"""
SENDING = """
Package p "Plant"
  Signal s "Start"
  Class motor "Motor" role="block"
    Port motor.p "line" role="proxy port"
  Class gate "Gate" role="block"
    Port gate.p "line" role="proxy port"
    Activity gate.a "work"
      Action c "send" subkind="send" port="{port}"
        -> calls s
"""


def find_errors(*models):
    """Return the errors of sysmlc and the complaints of the toolkit about the texts of models.

    Both tools read all texts at once, each in a package of its own: the toolkit takes a second to
    load the standard library.
    """
    files = {}
    for number, model in enumerate(models):
        texts, _ = write(refine(model))
        text = texts.pop("model.sysml")
        files |= texts | {f"{number}.sysml": f"package 'model {number}' {{\n{text}}}\n"}
    sink = Sink()
    sources = [Source(name, text.encode()) for name, text in files.items()]
    FRONTEND.read(sources, Graph(), sink, Coverage())
    errors = [f"{error.rule.code} {error.message}" for error in sink if error.is_error]
    return errors + load(files).complaints


def find_losses(model):
    return [loss for loss in write(refine(model))[1] if "SM730" not in loss]


def test_both_tools_accept_flows_of_structured_nodes_and_ports_of_other_blocks():
    assert find_errors(STRUCTURED_NODE, THROUGH_A_MERGE, SENDING.format(port="motor.p")) == []


def test_a_flow_stands_in_the_innermost_action_that_contains_both_ends():
    assert "flow outwards from Region.x.output to y.input;" in lines_of(STRUCTURED_NODE)
    assert find_losses(STRUCTURED_NODE) == [
        "SM734 the owner of an object flow is written as that of both its ends (1 in the text)"
    ]


def test_a_flow_inside_of_one_action_stays_there():
    assert find_losses(INSIDE_THE_NODE) == []


def test_an_action_sends_via_a_port_of_its_own_block():
    assert any("via line" in line for line in lines_of(SENDING.format(port="gate.p")))
    model = SENDING.format(port="motor.p")
    assert not any(" via " in line for line in lines_of(model))
    assert [loss[:5] for loss in find_losses(model)] == ["SM736"]


UNKNOWN_FEATURE = """
Package p "Plant"
  Class gate "Gate" role="block"
    Property gate.s "speed" role="value"
  Instance i "gate1"
    -> instance-of gate
    Slot s "" value="5"
      -> instance-of {feature}
Class u "unknown" external=true href="lost#unknown"
"""
ARGUMENT = """
Package p "Plant"
  DataType position "Position" role="value type"
  Signal s "Start"
  Activity a "work"
    Action c "notify" subkind="{action}"
      -> calls {called}
      Pin c.x "position" direction="in"
        -> typed-by position
  Activity b "move"
    Parameter b.x "what" direction="in"
      -> typed-by thing
  Class thing "Thing" role="block"
"""
GUARD = """
Package p "Plant"
  Class thing "Thing" role="block"
  DataType boolean "Boolean" external=true
  Activity a "work"
    Parameter a.x "acquired" direction="in"
      -> typed-by {type}
    ActivityParameter a.n "acquired"
      -> references a.x
    Control d "choose" subkind="decision"
    Action x "act" subkind="opaque"
    ControlFlow f guard="acquired"
      -> flow-source d
      -> flow-target x
"""
FLOW_OF_FEATURES = """
Package p "Plant"
  Class motor "Motor" role="block"
    Port motor.p "line" role="proxy port"
  Class gate "Gate" role="block"
    Port gate.p "line" role="proxy port"
  ItemFlow f "" role="item flow"
    -> flow-source motor.p
    -> flow-target gate.p
"""


def test_both_tools_accept_what_sysml_v1_allows_more_freely():
    slot_of_an_unknown_feature = UNKNOWN_FEATURE.format(feature="u")
    value_that_is_sent = ARGUMENT.format(action="send", called="s")
    value_for_a_part = ARGUMENT.format(action="call-behavior", called="b")
    guard_that_is_a_part = GUARD.format(type="thing")
    models = (
        slot_of_an_unknown_feature,
        value_that_is_sent,
        value_for_a_part,
        guard_that_is_a_part,
        FLOW_OF_FEATURES,
    )
    assert find_errors(*models) == []


def test_a_value_of_an_unknown_feature_is_lost():
    assert [loss[:5] for loss in find_losses(UNKNOWN_FEATURE.format(feature="u"))] == ["SM736"]
    assert find_losses(UNKNOWN_FEATURE.format(feature="gate.s")) == []


def test_the_arguments_of_a_signal_are_references():
    assert "in position : Position;" in lines_of(ARGUMENT.format(action="send", called="s"))
    assert "in attribute position : Position;" in lines_of(ARGUMENT.format(action="x", called="s"))


def test_a_guard_that_names_a_part_is_a_text():
    def find_line(type_):
        return next(line for line in lines_of(GUARD.format(type=type_)) if line.startswith("if "))

    assert find_line("thing") == "if acquired_2 then act;"
    assert find_line("boolean") == "if acquired then act;"


def test_a_flow_between_features_of_two_definitions_is_lost():
    assert [loss[:5] for loss in find_losses(FLOW_OF_FEATURES)] == ["SM736"]


REDEFINED_IN_ANOTHER_ORDER = """
Package p "Plant"
  DataType flag "Flag" role="value type"
  Class piece "Piece" role="block"
  Class store "Store" role="block"
    Operation store.add "add"
      Parameter store.add.r "result" direction="{first}"
        -> typed-by flag
      Parameter store.add.e "element" direction="in"
        -> typed-by piece
  Class shelf "Shelf" role="block"
    -> specializes store
    Operation shelf.add "add"
      -> redefines store.add
      Parameter shelf.add.e "element" direction="in"
        -> typed-by {type}
      Parameter shelf.add.r "result" direction="out"
        -> typed-by {other}
"""


def test_parameters_that_redefine_others_by_position_may_have_another_kind():
    model = REDEFINED_IN_ANOTHER_ORDER.format(first="out", type="piece", other="flag")
    assert find_errors(model) == []
    assert "in ref element : Piece;" in lines_of(model)


def test_parameters_of_the_same_kind_keep_their_keywords():
    model = REDEFINED_IN_ANOTHER_ORDER.format(first="in", type="flag", other="piece")
    assert find_errors(model) == []
    assert "in attribute element : Flag;" in lines_of(model)


LAW = """
Package p "Plant"
  Signal add "Add"
  DataType real "Real" external=true
  Class law "Newton 2.0" role="constraint block"
    Constraint law.c "" body="force == 2 * mass"
    Property law.f "force" role="constraint parameter"
      -> typed-by real
    Port law.m "mass" role="constraint parameter"
      -> typed-by real
  Class line "Line" role="interface block"
    Reception line.add ""
      -> typed-by add
"""


def test_the_result_of_a_constraint_block_ends_its_body():
    lines = lines_of(LAW)
    assert lines[lines.index("force == 2 * mass") + 1] == "}"
    assert find_errors(LAW) == []


def test_a_reception_of_an_interface_block_is_a_reference():
    assert "ref action action1 accept : Add { @Named; }" in lines_of(LAW)
