"""Counterexamples show the step that violates the requirement."""

import json

import pytest

COUNTER = """package Shop {{
    private import ScalarValues::*;
    attribute def Tick;
    part def Counter {{
        attribute n : Integer := 0;
        assert constraint {{ 0 <= n and n <= 20 }}
        in attribute lamp : Boolean;
        exhibit state Count {{
            entry; then Run;
            state Run;
            transition first Run accept Tick if n < 20 do assign n := n + 1 then Run;
        }}
    }}
    requirement def Limit {{ subject c : Counter;
        require constraint {{ language "ltl" /* {formula} */ }} }}
}}
"""


@pytest.fixture
def check(workspace, all_passes):
    def run(formula, *options):
        workspace.write("shop.sysml", COUNTER.format(formula=formula))
        return workspace.sysmlc("contracts", "check", "shop.sysml", *options)

    return run


@pytest.mark.parametrize("most", [2, 6, 14])
def test_the_violated_step_is_shown_however_late_it_is(check, most):
    text = check(f"G (n <= {most})").stderr
    assert f"note: step {most + 2}: event=none, n={most + 1}  <-- violated here\n" in text or (
        f"note: step {most + 2}: n={most + 1}  <-- violated here\n" in text
    )
    assert text.count("note: ") == 4
    assert "lamp" not in text


def test_a_demand_that_is_never_met_is_marked_where_it_arises(check):
    text = check("G (n = 2 -> F n = 20)").stderr
    assert "n=2  <-- never fulfilled from here on\n" in text


def test_json_and_diagrams_have_the_violated_step(check, workspace):
    result = check("G (n <= 2)", "-o", "out", "--format", "json")
    (entry,) = json.loads(result.stdout)["requirements"]
    assert entry["witness"]["violated"] == 3
    assert entry["witness"]["steps"][3]["n"] == 3
    (diagram,) = workspace.folder.glob("out/**/*.run1.puml")
    after = diagram.read_text().partition("== step 4 ==\n")[2].partition("== step 5 ==")[0]
    assert "note over p1 #FFDDDD : violated here\n" in after


GUARDED = """package Shop {{
    private import ScalarValues::*;
    attribute def Go;
    part def Feeder {{
        in attribute n : Integer;
        assert constraint {{ 0 <= n and n <= 5 }}
        in attribute armed : Boolean;
        attribute on : Boolean := false;
        exhibit state Feed {{
            entry; then Waiting;
            state Waiting;
            transition first Waiting accept Go if {guard} do assign on := true then Feeding;
            state Feeding;
        }}
    }}
    requirement def Starts {{
        subject feeder : Feeder;
        assume constraint {{ language "ltl" /* G F event=Go{assumed} */ }}
        require constraint {{ language "ltl" /* F on */ }}
    }}
}}
"""


@pytest.mark.parametrize(
    ("guard", "assumed", "shown", "hidden"),
    [
        ("armed", "", " armed=false, ", " n="),
        ("n > 3", "", " n=0, ", "armed"),
        # Each of the two inputs alone disables the transition.
        ("n > 3 and armed", "", " armed=false, ", " n="),
        ("n > 3 or armed", "", " n=0, armed=false, ", "Waiting"),
        ("n > 3 and armed", " & G armed", " n=0, ", "Waiting"),
    ],
)
def test_the_first_step_shows_inputs_that_never_change_but_matter(
    workspace, all_passes, guard, assumed, shown, hidden
):
    workspace.write("shop.sysml", GUARDED.format(guard=guard, assumed=assumed))
    text = workspace.sysmlc("contracts", "check", "shop.sysml").stderr
    (first,) = [line for line in text.splitlines() if "note: step 1: " in line]
    assert shown in first
    assert hidden not in first
