"""Messages between parts: which of the behaviours of a part send them."""

import json

import pytest

MODEL = """package Line {
  private import ScalarValues::*;
  item def Go;
  port def GoPort { out item go : Go; }
  part def Feeder {
    port p : GoPort;
    OFFERED
    exhibit state control {
      entry; then Wait;
      state Wait; state Sent { ENTRY }
      transition first Wait EFFECT then Sent;
    }
  }
  part def Robot {
    port p : ~GoPort;
    exhibit state control {
      entry; then Ask;
      state Ask; state Busy;
      transition first Ask accept Go via p then Busy;
    }
  }
  part def Cell {
    part feeder : Feeder;
    part robot : Robot;
    interface connect feeder.p to robot.p;
    requirement r { subject cell : Cell; require constraint { language "LTL" /* FORMULA */ } }
  }
}
"""
SEND = "do send Go() via p"
GIVE = "action give { first start then s; action s send Go() via p; first s then done; }"


@pytest.mark.parametrize(
    ("formula", "verdict"),
    [("!robot.state=Busy W running(feeder.s)", "broken"), ("F robot.state=Busy", "holds")],
)
def test_all_behaviours_of_a_part_send_one_message(workspace, all_passes, formula, verdict):
    """The transition sends the message, and so does an action that others may start."""
    text = MODEL.replace("OFFERED", GIVE).replace("ENTRY", "").replace("EFFECT", SEND)
    workspace.write("line.sysml", text.replace("FORMULA", formula))
    result = workspace.sysmlc("contracts", "check", "line.sysml", "--format", "json")
    (requirement,) = json.loads(result.stdout)["requirements"]
    assert requirement["verdict"] == verdict


@pytest.mark.parametrize(
    ("entry", "effect", "reason"),
    [
        ("", f"do {GIVE}", "no step describes what effect 'give' sends"),
        (f"entry {GIVE}", "", "no step describes what entry 'give' sends"),
    ],
)
def test_what_the_actions_of_an_effect_send_is_not_decided(
    workspace, all_passes, entry, effect, reason
):
    """Without the message, the robot would wait for ever."""
    text = MODEL.replace("OFFERED", "").replace("ENTRY", entry).replace("EFFECT", effect)
    workspace.write("line.sysml", text.replace("FORMULA", "G !robot.state=Busy"))
    result = workspace.sysmlc("contracts", "check", "line.sysml", "--format", "json")
    (requirement,) = json.loads(result.stdout)["requirements"]
    assert requirement["verdict"] == "not-decided"
    assert requirement["reason"].endswith(reason)
