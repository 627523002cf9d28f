"""``sysmlc contracts accept``: a recorded run and the first step that breaks a contract."""

import json

import pytest

CONTRACT = {
    "variables": {
        "go": {"owner": "env", "type": "bool"},
        "level": {"owner": "env", "type": [0, 3]},
        "mode": {"owner": "sys", "type": ["idle", "busy"]},
        "done": {"owner": "sys", "type": "bool"},
    },
    "assumptions": {"safety": ["go -> !go'"]},
    "guarantees": {"safety": ["go -> done'"], "liveness": ["mode=idle"]},
}


@pytest.fixture(autouse=True)
def gate(workspace):
    workspace.write("gate.gr1.json", json.dumps(CONTRACT))


def accept(workspace, run, name="run.csv", *options):
    workspace.write(name, run)
    return workspace.sysmlc("contracts", "accept", "gate.gr1.json", name, *options)


def test_a_run_that_breaks_nothing_is_one_line(workspace):
    run = "time,go,level,mode,done\n0,true,1,idle,0\n1,false,2,busy,1\n"
    result = accept(workspace, run)
    assert [result.exit_code, result.stdout] == [0, "gate: 2 steps, no check is broken\n"]
    assert result.stderr == ""


def test_a_broken_guarantee_is_an_error_at_its_step(workspace):
    run = "go;level;mode;done\n0;1;idle;0\n1;1;idle;0\n0;1;busy;0\n"
    result = accept(workspace, run)
    assert [result.exit_code, result.stdout] == [1, "gate: it breaks a guarantee in step 3\n"]
    assert (
        "error[SM592 run-breaks-guarantee]: step 3 (run.csv:4) breaks a guarantee of 'gate': "
        "G (go -> done')" in result.stderr
    )


def test_a_broken_assumption_is_a_warning(workspace):
    run = "go,level,mode,done\n1,1,idle,0\n1,1,idle,1\n0,1,busy,0\n"
    result = accept(workspace, run)
    assert result.exit_code == 0
    assert "warning[SM593 run-breaks-assumption]: step 2 (run.csv:3)" in result.stderr
    assert accept(workspace, run, "run.csv", "--strict").exit_code == 1


def test_a_number_outside_of_its_range_breaks_the_contract(workspace):
    result = accept(workspace, "go,level,mode,done\n0,4,idle,0\n")
    assert "'level' stays between 0 and 3." in result.stderr


def test_checks_of_variables_that_are_not_recorded_are_skipped(workspace):
    result = accept(workspace, "go\n1\n1\n")
    assert "warning[SM594 variables-not-recorded]: 'run.csv' has no values for 'done', 'level'" in (
        result.stderr
    )
    assert "SM593" in result.stderr


@pytest.mark.parametrize("form", ["[{step}, {step}]", '{{"steps": [{step}, {step}], "loop": 0}}'])
def test_a_run_in_json(workspace, form):
    step = json.dumps({"go": False, "level": 0, "mode": "idle", "done": True})
    result = accept(workspace, form.format(step=step), "run.json")
    assert [result.exit_code, result.stdout] == [0, "gate: 2 steps, no check is broken\n"]


@pytest.mark.parametrize(
    ("name", "run", "fault"),
    [
        ("run.csv", "go,done\ntrue,maybe\n", "run.csv:2:1: 'maybe' is not a value of 'done'"),
        ("run.csv", "go,done\ntrue\n", "run.csv:2:1: the line has 1 value, the"),
        ("run.csv", "go,go\n1,1\n", "run.csv:1:1: the name 'go' occurs twice"),
        ("run.csv", "goo,don\n1,1\n", "did you mean 'go'?"),
        ("run.csv", "", "run.csv:1:1: it has no step"),
        ("run.csv", 'go\n"1\n', "it is not CSV"),
        ("run.json", "{", "run.json:1:1: it is not JSON"),
        ("run.json", '[{"go": "\\ud800"}]', "only half of a character"),
        ("run.json", "3", "it is not a list of steps"),
        ("run.json", '[{"go": true,\n"go": false}]', "run.json:2:1: the name 'go' occurs twice"),
        ("run.json", '{"steps": [],\n"steps": []}', "run.json:2:1: the member 'steps' occurs"),
        ("run.json", "[\n3]", "step 1 is not an object"),
        ("run.json", '[{"go": true},\n{"done": true}]', "run.json:2:1: not each step has a value"),
        ("run.json", '[{"go": true, "level": 1.5}]', "'1.5' is not a value of 'level'"),
        ("run.json", "[" * 100_000, "nested too deeply"),
    ],
)
def test_a_run_that_cannot_be_read_is_a_located_error(workspace, name, run, fault):
    result = accept(workspace, run, name, "--format", "concise")
    assert result.exit_code == 2
    assert "SM591" in result.stderr
    for part in fault.split(": ", 1):
        assert part in result.stderr


def test_a_missing_run_is_an_error(workspace):
    result = workspace.sysmlc("contracts", "accept", "gate.gr1.json", "none.csv")
    assert result.exit_code == 2
    assert "cannot read 'none.csv'" in result.stderr


@pytest.mark.parametrize(
    "arguments", ["lamp.sysml run.csv -c P::Lamp", "lamp.sysml#P::Lamp run.csv"]
)
def test_a_run_of_a_model_names_the_broken_element(workspace, all_passes, arguments):
    workspace.write("lamp.sysml", LAMP)
    workspace.write("run.csv", "event,state,level\nSwitch,Off,0\nnone,Off,0\n")
    result = workspace.sysmlc("contracts", "accept", *arguments.split())
    assert result.exit_code == 1
    assert "In 'Off', when 'Switch' occurs: the next state is 'On'" in result.stderr
    assert "--> lamp.sysml:6:9" in result.stderr


LAMP = """\
package P {
    item def Switch;
    part def Lamp {
        exhibit state light { entry; then Off;
        state Off;
        transition first Off accept Switch then On;
        state On;
        }
    }
}
"""
