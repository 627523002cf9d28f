"""Requirements and contracts of the examples: what is proved, and which faults are refuted."""

import json
import re

import pytest
from click.testing import CliRunner

from examples.compiling import (
    EXAMPLES,
    PLANT,
    ROOT,
    TANKS,
    TEXT,
    compile_example,
    list_silent_contracts,
)
from plantuml_jar import PlantUml, list_missing_tools
from sysmlc.cli.group import sysmlc
from sysmlc.logic.contract import Contract

GATE = ROOT / "examples" / "baygate-behaviour" / "baygate-behaviour.uml"
TASKS = ROOT / "examples" / "four-tasks" / "four-tasks.uml"
LEGO = ROOT / "examples" / "lego-recipe" / "lego-recipe.uml"


def check(model, *options):
    """Return the result and the JSON document of ``contracts check``."""
    arguments = ["contracts", "check", str(model), "--format", "json", *options]
    result = CliRunner().invoke(sysmlc, arguments)
    return result, json.loads(result.stdout)


def list_verdicts(entries):
    """Return requirement, component and verdict of each entry by their last names."""
    return [
        (last_name(entry["requirement"]), last_name(entry["component"]), entry["verdict"])
        for entry in entries
    ]


def last_name(qualified_name):
    return qualified_name.rpartition("::")[2]


LEGO_VERDICTS = [
    ("AssembleQuality", "Assemble", "holds-within-assumed-ranges"),
    ("AssembleQuality", "Assemble", "holds-within-assumed-ranges"),
    ("BoundedRetry", "Assemble", "holds-within-assumed-ranges"),
    ("BoundedRetry", "Assemble", "holds-within-assumed-ranges"),
    ("BoundedRetry", "Assemble", "holds-within-assumed-ranges"),
    ("HoldPiece", "Robot1", "holds"),
    ("HoldPiece", "Robot1", "holds"),
    ("HoldPiece", "Robot2", "holds"),
    ("HoldPiece", "Robot2", "holds"),
    ("CycleTime", "BuildLegoStack", "holds"),
    ("AssembleTime", "Assemble", "holds"),
    ("StoreTime", "Store", "holds"),
]
GATE_VERDICTS = [
    ("ReadBeforeRelease", "Stopper", "holds"),
    ("ReadBeforeRelease", "Stopper", "holds"),
    ("ReadBeforeRelease", "Stopper", "holds"),
    ("RaisedWhenStopped", "Stopper", "holds"),
    ("AdmitExpectedPallet", "BayGate.HandlePallet", "not-decided"),
    ("OnePalletInBay", "BayGate", "not-decided"),
]
TASK_VERDICTS = [
    ("OrderOfTasks", "FourTasks", "holds"),
    ("OrderOfTasks", "FourTasks", "holds"),
    ("TightPins", "T2", "holds"),
]


@pytest.mark.parametrize(
    ("model", "verdicts"),
    [
        (LEGO, LEGO_VERDICTS),
        pytest.param(TEXT, LEGO_VERDICTS, marks=pytest.mark.long),
        (GATE, GATE_VERDICTS),
        (TASKS, TASK_VERDICTS),
        (PLANT, []),
    ],
)
def test_contracts_are_realizable_and_requirements_have_these_verdicts(model, verdicts):
    result, document = check(model)
    assert [result.exit_code, document["diagnostics"]] == [0, []]
    assert ": realizable" in result.stderr
    assert not re.search(": (unrealizable|not decided)", result.stderr)
    entries = document["requirements"]
    assert list_verdicts(entries) == verdicts
    assert not any(entry["vacuous"] for entry in entries)
    # Three requirements on times are decided by the recipe; the others that hold are formulas.
    texts = [entry for entry in entries if "only text" in (entry["reason"] or "")]
    assert all("the recipe decides it" in e["reason"] for e in texts if e["verdict"] == "holds")


TANK_VERDICTS = [
    ("RefillsInTime", "Pump", "holds"),
    ("DoesNotChatter", "Pump", "holds"),
    ("StopsBeforeOverflow", "Station", "broken"),
    ("StopsBeforeOverflowIfSlow", "Station", "holds"),
    ("OverflowStopsFilling", "Station", "holds"),
    ("NeverTooFull", "Mixer", "holds"),
    ("FullMeansFourDoses", "Mixer", "holds"),
    ("LeavesRoom", "Mixer", "broken"),
    ("FindsScale", "Heater", "holds"),
    ("HeatsUpTo60", "Heater", "broken"),
]


def test_three_requirements_on_the_tanks_are_refuted_with_numbers():
    result, document = check(TANKS)
    assert result.exit_code == 1
    assert {item["code"] for item in document["diagnostics"]} == {"SM560"}
    entries = {last_name(entry["requirement"]): entry for entry in document["requirements"]}
    assert list_verdicts(entries.values()) == TANK_VERDICTS
    assert not any(entry["vacuous"] for entry in entries.values())
    fifth = entries["LeavesRoom"]["witness"]["numbers"][4]
    assert fifth == {"volume": {"number": 10, "unit": "L"}}


FAULTS = [
    (
        LEGO,
        # The gripper does not store that it is closed.
        ("closed := true", "closed := false"),
        "LegoRecipe::Plant::Robot1",
        "gripper.state=Closed -> gripper.closed",
        ["p0 -> p1 : gripper.event=CloseGripper", "gripper.state=Closed"],
    ),
    (
        GATE,
        # An emergency stop lowers the pin.
        (r'(name="holdAll".*?)PinPosition::raised', r"\1PinPosition::lowered"),
        "BayGate::BayGate Breakdown::Stopper",
        "state=Stopped -> pin=raised",
        ["p0 -> p1 : event=EmergencyStop", "state=Stopped"],
    ),
]


@pytest.mark.parametrize(("model", "fault", "component", "formula", "steps"), FAULTS)
def test_a_deliberate_fault_is_refuted_with_a_run_that_is_drawn(
    tmp_path, model, fault, component, formula, steps
):
    text = model.read_text("utf-8")
    mutant = tmp_path / model.name
    mutant.write_text(re.sub(*fault, text, count=1, flags=re.DOTALL), "utf-8")
    assert mutant.read_text("utf-8") != text
    result, document = check(mutant, "-c", component, "-o", str(tmp_path / "runs"))
    broken = [entry for entry in document["requirements"] if entry["verdict"] == "broken"]
    assert result.exit_code == 1
    assert f"G ({formula})" in [entry["formula"] for entry in broken]
    diagrams = {path.name: path.read_text("utf-8") for path in (tmp_path / "runs").glob("*.puml")}
    drawn = "\n".join(diagrams.values())
    assert all(step in drawn for step in steps)
    if not list_missing_tools():
        assert PlantUml(tmp_path / "pictures").render(diagrams)


# -- what the contracts state ----------------------------------------------------------------------


@pytest.mark.parametrize("model", [*EXAMPLES, PLANT], ids=lambda path: path.parent.name)
def test_a_contract_is_about_a_feature_or_says_why_it_is_not(model):
    graph = compile_example(model, "ir").graph
    assert list(graph.derived(Contract))
    assert list_silent_contracts(graph) == []
