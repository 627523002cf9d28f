"""Names of variables: pages show those of formulas, contract files and monitors both."""

import json
from pathlib import Path

import pytest

MODEL = """package Shop {
  private import ScalarValues::*;
  item def Done;
  item def Go;
  part def Tray { attribute full : Boolean := false; }
  part def Press {
    attribute ready : Boolean := false;
    part tray : Tray;
    exhibit state Run parallel {
      state Heater { entry; then Cold; state Cold; accept Go then Hot; state Hot; }
      state Fan { entry; then Still; state Still; }
    }
    perform action work {
      first start;
      then action 'load piece' { first start; then action grip; then done; }
      then action unload { first start; then action grip; then done; }
      then action wait accept Done;
      then assign ready := true;
      then done;
    }
  }
  requirement def Turns {
    subject press : Press;
    require constraint { language "ltl" /* FORMULA */ }
  }
}
"""
LOADS = "G (finished(load_piece.grip) -> !tray.full)"
NAMES = {
    "run_load_piece": "running(load_piece)",
    "done_grip": "finished(load_piece.grip)",
    "done_grip_2": "finished(unload.grip)",
    "receive_Done": "finished(wait)",
    "running_work": "running(work)",
}


@pytest.fixture
def build(workspace, all_passes):
    def run(formula=LOADS):
        workspace.write("shop.sysml", MODEL.replace("FORMULA", formula))
        workspace.sysmlc("shop.sysml", "-o", "out", "--emit", "+monitor")
        return Path("out")

    return run


def test_the_page_of_an_activity_names_actions_as_formulas_do(build):
    page = (build() / "contracts" / "Shop.Press.work.md").read_text()
    assert "| `finished(load_piece.grip)` | Boolean; `done_grip` in the other files |" in page
    assert (
        "- Whenever action 'grip' runs, the environment ends it sooner or later. "
        "*(action 'grip' of 'unload')*\n  `!running(unload.grip) | finished(unload.grip)`"
    ) in page
    assert "**Performance.** It runs from the first step until it ends, and not again." in page
    formulas = page.partition("## Assumptions")[2]
    assert not any(variable in formulas for variable in NAMES)


def test_the_page_of_a_machine_names_regions_as_formulas_do(build):
    page = (build() / "contracts" / "Shop.Press.md").read_text()
    assert "- At the start: Heater.state=Cold." in page
    assert "`Heater.state=Cold & event=Go -> Heater.state'=Hot`" in page


def test_the_page_of_requirements_shows_the_formula_of_the_author(build):
    page = (build() / "contracts" / "Shop.Press.requirements.md").read_text()
    assert f"`{LOADS}`" in page
    assert "| `tray.full` | Boolean; `tray_full` in the other files |" in page


def test_contract_files_and_monitors_have_both_names(build):
    out = build()
    contract = json.loads((out / "contracts" / "Shop.Press.work.contract.json").read_text())
    wordings = {name: item.get("wording") for name, item in contract["variables"].items()}
    assert {name: wordings[name] for name in NAMES} == NAMES
    header = (out / "monitors" / "press_work_monitor.h").read_text()
    assert (
        "bool done_grip; /* done_grip: Boolean, finished(load_piece.grip) in formulas */" in header
    )
    monitor = (out / "monitors" / "press_work_monitor.py").read_text()
    assert "'done_grip',  # done_grip: Boolean, finished(load_piece.grip) in formulas" in monitor


def test_a_recorded_run_may_use_the_names_of_formulas(build, workspace):
    contract = build() / "contracts" / "Shop.Press.contract.json"
    workspace.write("run.csv", "event,Heater.state,Fan.state\nGo,Cold,Still\nnone,Cold,Still\n")
    result = workspace.sysmlc("contracts", "accept", str(contract), "run.csv")
    assert result.stdout == "Shop::Press: it breaks a guarantee in step 2\n"
    workspace.write("twice.csv", "event,Heater.state,Heater\nGo,Cold,Cold\n")
    result = workspace.sysmlc("contracts", "accept", str(contract), "twice.csv")
    assert "'Heater.state' and 'Heater' are one variable" in result.stderr


@pytest.mark.parametrize("spelling", ["load_piece", "load piece", "'load piece'"])
def test_a_name_with_a_blank_may_be_written_with_it(build, workspace, spelling):
    build(f"F running({spelling})")
    result = workspace.sysmlc("contracts", "check", "shop.sysml", "--verbose")
    assert f"Turns: holds: F running({spelling})" in result.stdout
    build(f"G !running({spelling})")
    result = workspace.sysmlc("contracts", "check", "shop.sysml")
    assert "running(load_piece)=true" in result.stderr


def test_accept_says_who_broke_what(workspace):
    contract = {
        "variables": {"go": {"owner": "env", "type": "bool"}},
        "assumptions": {"safety": ["go -> !go'"]},
    }
    workspace.write("gate.gr1.json", json.dumps(contract))
    workspace.write("run.csv", "go\n1\n1\n")
    result = workspace.sysmlc("contracts", "accept", "gate.gr1.json", "run.csv")
    assert result.stdout == "gate: the environment breaks an assumption in step 2\n"
    assert result.exit_code == 0


def test_a_guarantee_about_the_next_inputs_is_not_called_one_about_inputs_alone(workspace):
    contract = {
        "variables": {
            "go": {"owner": "env", "type": "bool"},
            "lamp": {"owner": "sys", "type": "bool"},
        },
        "guarantees": {"safety": ["lamp -> !go'", "!go"]},
    }
    workspace.write("gate.gr1.json", json.dumps(contract))
    result = workspace.sysmlc("contracts", "check", "gate.gr1.json")
    assert "promises 'lamp -> !go'', whose next values the environment decides alone" in (
        result.stderr
    )
    assert "promises '!go', which the environment decides alone" in result.stderr
