"""Guards that read what a do behaviour assigns in the step in which they are evaluated."""

import json

import pytest

MODEL = """package P {
  private import ScalarValues::*;
  attribute def Stop;
  part def Gauge {
    attribute ok : Boolean := false;
    exhibit state control {
      entry; then Measure;
      state Measure {
        do action measure {
          action probe; action set { assign ok := true; } action lift;
          first start then probe; first probe then set; %s
        }
      }
      state Good; state Bad;
      %s
    }
  }
  requirement never { subject gauge : Gauge;
    require constraint { language "LTL" /* G !state=Bad */ } }
}
"""
LAST = "first set then done;"
FOLLOWED = "first set then lift; first lift then done;"
GUARDS = "first check if ok then Good; transition first check if not ok then Bad;"
CHOICE = f"#SysMLC::Choice state check; transition first Measure then check; transition {GUARDS}"
STOPPED = CHOICE.replace("first Measure", "first Measure accept Stop")
DIRECT = "transition first Measure if not ok then Bad; transition first Measure if ok then Good;"


@pytest.mark.parametrize(
    ("end", "transitions", "verdict"),
    [
        (LAST, CHOICE, "not-decided"),
        (LAST, DIRECT, "not-decided"),
        (FOLLOWED, STOPPED, "not-decided"),
        (FOLLOWED, CHOICE, "holds"),
        (FOLLOWED, DIRECT, "holds"),
    ],
)
def test_what_an_action_assigns_when_it_ends_is_not_read_in_the_same_step(
    workspace, all_passes, end, transitions, verdict
):
    """The values before the step would give the wrong answer that state Bad is reached."""
    workspace.write("gauge.sysml", MODEL % (end, transitions))
    result = workspace.sysmlc("contracts", "check", "gauge.sysml", "--format", "json")
    (requirement,) = json.loads(result.stdout)["requirements"]
    assert requirement["verdict"] == verdict
    if verdict == "not-decided":
        assert "a guard reads 'ok' in the step in which the do behaviour" in requirement["reason"]
