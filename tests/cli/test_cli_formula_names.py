"""Names in the formulas of requirements: paths of parts, and advice for unknown names."""

import json
import re
from pathlib import Path

import pytest

PAGE = Path(__file__).parents[2] / "docs" / "contracts.md"

LINE = """package Line {{
  private import ScalarValues::*;
  attribute def Go;
  part def Robot {{
    attribute holding : Boolean := false;
    exhibit state machine {{
      entry; then Ask;
      state Ask;
      state Busy {{ do action handle {{
        action grip {{ assign holding := true; }} then action place {{ assign holding := false; }}
      }} }}
      transition first Ask accept Go then Busy;
      transition first Busy then Ask;
    }}
  }}
  part def Cell {{ part robot : Robot; }}
  requirement a {{ subject {subject};
    require constraint {{ language "LTL" /* {formula} */ }} }}
}}
"""


@pytest.mark.parametrize(
    ("formula", "reason"),
    [
        (
            "G !running(grap)",
            "'running(grap)' denotes no action of 'Robot'; did you mean 'running(grip)'?",
        ),
        (
            "F finished(plce)",
            "'finished(plce)' denotes no action of 'Robot'; did you mean 'finished(place)'?",
        ),
        ("G state!=Bsy", "'Bsy' is neither a variable nor a literal; did you mean 'Busy'?"),
        ("G event!=Goo", "'Goo' is neither a variable nor a literal; did you mean 'Go'?"),
        (
            "G !r.holdin",
            "'r.holdin' denotes no feature, value, state or event of 'Robot'; "
            "did you mean 'holding'?",
        ),
        (
            "G abs(holding) <= 3",
            "formulas have no functions: for 'abs(x) <= 3' write 'x >= -3 & x <= 3'",
        ),
        ("G (Busy -> F holding)", "'Busy' is not Boolean; did you mean 'state=Busy'?"),
    ],
)
def test_an_unknown_name_in_a_formula_is_compared_with_those_of_the_component(
    workspace, all_passes, formula, reason
):
    workspace.write("line.sysml", LINE.format(subject="r : Robot", formula=formula))
    result = workspace.sysmlc("contracts", "check", "line.sysml")
    assert result.exit_code == 1
    assert f"is not understood: {reason} (column" in result.stderr
    assert (
        "with these names: holding, state, event, running(handle), running(grip)" in result.stderr
    )


@pytest.mark.parametrize(
    ("subject", "formula"),
    [
        ("r : Robot", "G (finished(r.grip) -> X r.holding)"),
        ("r : Robot", "G (r.finished(grip) -> X r.holding)"),
        ("c : Cell", "G (finished(robot.grip) -> X robot.holding)"),
        ("c : Cell", "G (robot.finished(grip) -> X robot.holding)"),
        ("c : Cell", "G (c.robot.finished(handle.grip) -> X c.robot.holding)"),
    ],
)
def test_the_path_of_a_part_may_precede_its_actions(workspace, all_passes, subject, formula):
    workspace.write("line.sysml", LINE.format(subject=subject, formula=formula))
    result = workspace.sysmlc("contracts", "check", "line.sysml", "--format", "json")
    verdicts = [item["verdict"] for item in json.loads(result.stdout)["requirements"]]
    assert [result.exit_code, verdicts] == [0, ["holds"]]


def test_an_action_of_several_states_is_named_with_one_of_them(workspace, all_passes):
    states = "".join(f"state S{number} {{ exit wait; }} " for number in range(5))
    text = f"""package P {{ part def B {{
      action wait {{ first start then rest; action rest; then done; }}
      exhibit state M {{ entry; then S0; {states} transition first S0 then S1; }} }}
    requirement R {{ subject b : B; require constraint {{ language "LTL" /* F running(wait) */ }} }}
    }}"""
    workspace.write("model.sysml", text)
    result = workspace.sysmlc("contracts", "check", "model.sysml")
    advice = "'wait' is performed in several places: write S0.wait or S1.wait or S2.wait..."
    assert advice in result.stderr
    workspace.write("model.sysml", text.replace("running(wait)", "running(S0.wait)"))
    result = workspace.sysmlc("contracts", "check", "model.sysml")
    assert [result.exit_code, result.stderr.count("SM522")] == [0, 0]


OVEN = PAGE.read_text(encoding="utf-8").partition("<!-- names in formulas -->\n```sysml\n")[2]
OVEN = OVEN.partition("```")[0]


def test_the_documented_names_of_regions_and_nested_actions_hold(workspace, all_passes):
    workspace.write("oven.sysml", OVEN)
    result = workspace.sysmlc("contracts", "check", "oven.sysml", "--format", "json")
    entries = json.loads(result.stdout)["requirements"]
    assert [entry["verdict"] for entry in entries] == ["holds"] * 5


@pytest.mark.parametrize(
    ("formula", "reason"),
    [
        ("G Run.Heater.Hot", "did you mean 'Heater.state=Hot'? (column 3)"),
        ("G !running(grip)", "write job.left.grip or job.right.grip (column 4)"),
        ("G Heater.state", "'Heater.state' is not Boolean; compare it: 'Heater.state=Hot'"),
        ("G mode = Mode::fats", "did you mean 'Mode::fast'? (column 10)"),
        ("G mode = Oven.fast", "did you mean 'mode=fast'? (column 10)"),
    ],
)
def test_a_name_is_answered_with_the_nearest_one(workspace, all_passes, formula, reason):
    workspace.write("oven.sysml", re.sub("/\\* always .* \\*/", f"/* {formula} */", OVEN))
    assert reason in workspace.sysmlc("contracts", "check", "oven.sysml").stderr


@pytest.mark.parametrize("path", ["Run.Heater", "Machine.Run.Heater", "Heater", "o.Heater"])
def test_a_region_of_a_parallel_substate_has_the_path_of_its_states(workspace, all_passes, path):
    machine = "exhibit state Machine { entry; then Run; state Run parallel {"
    text = OVEN.replace("exhibit state Run parallel {", machine)
    text = text.replace("        perform action job", "        } perform action job", 1)
    text = text.replace("        }\n        } perform", "        }}\n        perform")
    text = text.replace("subject oven", "subject o").replace("Run.Heater.state", f"{path}.state")
    workspace.write("oven.sysml", text)
    result = workspace.sysmlc("contracts", "check", "oven.sysml", "--format", "json")
    entries = json.loads(result.stdout)["requirements"]
    assert [entry["verdict"] for entry in entries] == ["holds"] * 5


def test_equal_actions_in_places_without_names_are_to_be_renamed(workspace, all_passes):
    actions = "first start; then action { action grip; } then action { action grip; } then done;"
    workspace.write(
        "p.sysml",
        f"""package P {{ part def M {{ perform action job {{ {actions} }} }}
        requirement R {{ subject m : M;
            require constraint {{ language "ltl" /* G !running(grip) */ }} }} }}""",
    )
    result = workspace.sysmlc("contracts", "check", "p.sysml")
    assert "in several places: give these actions different names (column 4)" in result.stderr


def test_a_text_of_another_language_is_answered_with_the_language_that_reads_it(
    workspace, all_passes
):
    text = OVEN.replace("Globally, it is always the case that not (mode = Mode::fast) holds.", "{}")
    for sentence, language in (
        ("Oven shall satisfy mode = Mode::slow", "FRET"),
        ("G F mode = Mode::slow", "LTL"),
    ):
        workspace.write("oven.sysml", text.replace("{}", sentence))
        result = workspace.sysmlc("contracts", "check", "oven.sysml")
        advice = f"it is written in english; write the language '{language}' to have it read"
        assert advice in result.stdout
