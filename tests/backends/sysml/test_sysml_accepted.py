"""sysmlc and the OpenMBEE toolkit accept the text of models that SysML v2 writes differently."""

import pytest
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


def find_errors(model):
    """Return the errors of sysmlc and the complaints of the toolkit about the text of a model."""
    files, _ = write(refine(model))
    sink = Sink()
    sources = [Source(name, text.encode()) for name, text in files.items()]
    FRONTEND.read(sources, Graph(), sink, Coverage())
    errors = [f"{error.rule.code} {error.message}" for error in sink if error.is_error]
    return errors + load(files).complaints


def find_losses(model):
    return [loss for loss in write(refine(model))[1] if "SM730" not in loss]


@pytest.mark.parametrize(
    "model",
    [
        pytest.param(STRUCTURED_NODE, id="flow-out-of-a-structured-node"),
        pytest.param(THROUGH_A_MERGE, id="flow-through-a-merge"),
        pytest.param(SENDING.format(port="motor.p"), id="port-of-another-block"),
    ],
)
def test_both_tools_accept_the_text(model):
    assert find_errors(model) == []


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
