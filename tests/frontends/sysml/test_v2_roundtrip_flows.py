"""Object flows past control nodes are written as successions with metadata, and read back."""

import pytest
from test_v2_roundtrip import list_differences, read_back

from sysmlc.ir import Kind
from sysmlc.ir.text import parse_text

MODEL = """\
Package p "P"
  Activity a "A"
    Control i "start" subkind="initial"
    Action x "x" subkind="opaque"
      Pin xo "o" direction="out" subkind="output-value"
    Control f "f" subkind="{control}"
    Action y "y" subkind="opaque"
      Pin yi "i" direction="in" subkind="input-value"
    Action z "z" subkind="opaque"
      Pin zi "i" direction="in" subkind="input-value"
    Control d "d" subkind="decision"
    Action w "w" subkind="opaque"
      Pin wi "i" direction="in" subkind="input-value"
    ControlFlow c ""
      -> flow-source i
      -> flow-target x
    ObjectFlow o1 "first"
      -> flow-source xo
      -> flow-target f
    ObjectFlow o2 ""
      -> flow-source f
      -> flow-target yi
    ObjectFlow o3 ""
      -> flow-source f
      -> flow-target d
    ObjectFlow o4 "" guard="x.o > 3"
      -> flow-source d
      -> flow-target zi
    ObjectFlow o5 "" guard="else"
      -> flow-source d
      -> flow-target wi
"""


@pytest.mark.parametrize("control", ["fork", "merge", "decision", "join"])
def test_objects_flow_past_control_nodes_as_before(control):
    assert list_differences(parse_text(MODEL.replace("{control}", control))) == []


def test_flows_that_follow_from_others_are_not_read_again():
    again, sink = read_back(parse_text(MODEL.replace("{control}", "fork")))
    assert len(list(again.of_kind(Kind.OBJECT_FLOW))) == 5
    assert [diagnostic.rule.code for diagnostic in sink if diagnostic.is_error] == []


def test_flows_from_pin_to_pin_stay_flows():
    text = MODEL.replace("{control}", "fork").replace("-> flow-target f\n", "-> flow-target yi\n")
    assert list_differences(parse_text(text)) == []
