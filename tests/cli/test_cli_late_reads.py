"""Guards and effects read what a do behaviour assigns in the step in which they are evaluated.

A guard behind a choice does, and that of a completion transition when the do behaviour ends; the
guard of any other transition reads the values before the step.
"""

import json

import pytest

MODEL = """package P {
  private import ScalarValues::*;
  attribute def Stop;
  part def Gauge {
    attribute ok : Boolean := false;
    attribute level : Integer := 0;
    assert constraint { level >= 0 and level <= 3 }
    exhibit state control {
      entry; then Measure;
      state Measure {
        do action measure {
          action probe; action set { assign ok := true; assign level := 3; } action lift;
          first start then probe; first probe then set; %s
        }
      }
      state Good; state Bad;
      %s
    }
  }
  requirement it { subject gauge : Gauge;
    require constraint { language "LTL" /* G (finished(set) %s) */ } }
}
"""
LAST = "first set then done;"
FOLLOWED = "first set then lift; first lift then done;"
GUARDS = "first check if ok then Good; transition first check if not ok then Bad;"
CHOICE = f"#SysMLC::Choice state check; transition first Measure then check; transition {GUARDS}"
STOPPED = CHOICE.replace("first Measure", "first Measure accept Stop")
DIRECT = "transition first Measure if not ok then Bad; transition first Measure if ok then Good;"
GUARDED = "transition first Measure accept Stop if ok then Good;"
RAISED = "transition first Measure accept Stop do assign level := level + 1 then Good;"
C_TEXT = '{ language "C" /* ok |= 1; */ }'
STOPS = "& state=Measure & event=Stop ->"


@pytest.mark.parametrize(
    ("end", "transitions", "condition", "verdict"),
    [
        (LAST, CHOICE, "-> X state=Good", "holds"),
        (LAST, DIRECT, "-> X state=Good", "holds"),
        (FOLLOWED, CHOICE, "-> X !state=Bad", "holds"),
        (FOLLOWED, DIRECT, "-> X !state=Bad", "holds"),
        (FOLLOWED, STOPPED, f"{STOPS} X state=Good", "holds"),
        (FOLLOWED, STOPPED, f"{STOPS} X state=Bad", "broken"),
        (FOLLOWED, GUARDED, f"{STOPS} X state=Measure", "holds"),
        (LAST, GUARDED, f"{STOPS} X state=Good", "broken"),
    ],
)
def test_the_end_of_an_action_assigns_before_the_guards_that_follow_from_it(
    workspace, all_passes, end, transitions, condition, verdict
):
    """The values before the step would lead to state Bad."""
    assert check(workspace, end, transitions, condition) == verdict


def test_an_effect_stops_at_the_bound_after_what_the_do_behaviour_assigns(workspace, all_passes):
    """The level before the step is 0, so that the case of the bound was missing in the step."""
    assert check(workspace, LAST, RAISED, f"{STOPS} X (state=Good & level=3)") == "holds"
    assert check(workspace, LAST, RAISED, f"{STOPS} X state=Measure") == "broken"


def test_a_guard_may_read_what_an_action_assigns_in_a_way_that_is_not_described(
    workspace, all_passes
):
    text = MODEL % (LAST, DIRECT, "-> X !state=Good")
    text = text.replace("{ assign ok := true; assign level := 3; }", C_TEXT)
    workspace.write("gauge.sysml", text.replace("finished(set)", "!ok"))
    assert read_verdict(workspace) == "not-decided"


def check(workspace, end, transitions, condition):
    """Return the verdict about what follows from the end of action ``set``."""
    workspace.write("gauge.sysml", MODEL % (end, transitions, condition))
    return read_verdict(workspace)


def read_verdict(workspace):
    """Return the verdict about the only requirement of the model."""
    result = workspace.sysmlc("contracts", "check", "gauge.sysml", "--format", "json")
    (requirement,) = json.loads(result.stdout)["requirements"]
    return requirement["verdict"]
