"""How many steps a token takes: what follows an action runs in the next step."""

import json

import pytest

MODEL = """package P {{
private import ScalarValues::*;
item def Go;
part def Cell {{
    attribute ok : Boolean := false;
    action work {{
        first start then close;
        action close;
        then fork both;
        then left;
        then right;
        action left;
        action right;
        first left then sync;
        first right then sync;
        join sync;
        then again;
        merge again;
        then action measure assign ok := true;
        then decide test;
        if ok then done;
        else again;
    }}
    exhibit state M {{
        entry; then Idle;
        state Idle;
        transition first Idle accept Go then Busy;
        state Busy {{ do work; }}
        transition first Busy then Idle;
    }}
    requirement r {{ subject c : Cell; require constraint {{ language "ltl" /* {formula} */ }} }}
}}
}}
"""


@pytest.fixture
def decide(workspace, all_passes):
    """Return a function from a formula about the cell to the entry of its verdict."""

    def check(formula):
        workspace.write("model.sysml", MODEL.format(formula=formula))
        result = workspace.sysmlc("contracts", "check", "--format", "json", "model.sysml")
        (entry,) = json.loads(result.stdout)["requirements"]
        return entry

    return check


@pytest.mark.parametrize(
    "formula",
    [
        "G (state=Idle & event=Go -> X running(close))",
        "G (finished(close) -> X (running(left) & running(right)))",
        "G (finished(left) & finished(right) -> X running(measure))",
        "G (finished(left) & running(right) & !finished(right) -> X !running(measure))",
        "G (finished(measure) -> X X (ok & state=Idle))",
        "G (finished(work) -> ok)",
    ],
)
def test_forks_joins_and_merges_take_no_step(decide, formula):
    entry = decide(formula)
    assert (entry["verdict"], entry["vacuous"]) == ("holds", False)


@pytest.mark.parametrize(
    "formula",
    ["G (finished(measure) -> finished(work))", "G (finished(close) -> X running(measure))"],
)
def test_a_decision_takes_one_step_and_reads_what_the_action_before_has_written(decide, formula):
    assert decide(formula)["verdict"] == "broken"


def test_the_end_of_an_action_with_steps_is_no_valid_formula(decide):
    assert decide("G (finished(work) -> finished(work))")["vacuous"]
    assert not decide("G (finished(work) -> ok)")["vacuous"]


CHOICE = """package P {
private import ScalarValues::*;
item def Go; item def Stop;
part def Cell {
    in attribute x : Boolean;
    in attribute y : Boolean;
    action work {
        first start then a;
        action a;
        then decide d;
        if x then b;
        if y then c;
        action b; then done;
        action c; then done;
    }
    exhibit state M {
        entry; then Idle;
        state Idle;
        transition first Idle accept Go then Busy;
        state Busy { do work; }
        transition first Busy then Idle;
        transition first Busy accept Stop then Idle;
    }
    requirement r {
        subject c : Cell;
        require constraint {
            language "ltl" /* G (finished(a) & event!=Stop -> X !(x & event=Stop)) */
        }
    }
}
}
"""


def test_a_state_is_left_in_the_step_in_which_its_do_behaviour_chooses_a_branch(
    workspace, all_passes
):
    """The token could not be on a branch and be removed: such runs were lost (a wrong 'holds')."""
    workspace.write("model.sysml", CHOICE)
    result = workspace.sysmlc("contracts", "check", "--format", "json", "model.sysml")
    (entry,) = json.loads(result.stdout)["requirements"]
    assert entry["verdict"] == "broken"
