"""``sysmlc contracts refine``, ``quotient``, ``merge``, ``conjoin`` and ``compose``."""

import json

import pytest
from jsonschema import Draft202012Validator

from json_documents import SCHEMAS

VARIABLES = {
    "order": {"owner": "env", "type": "bool"},
    "filled": {"owner": "sys", "type": "bool"},
    "packed": {"owner": "sys", "type": "bool"},
}


def write_contract(workspace, name, variables, safety, assumed=("order -> !order'",)):
    contract = {
        "variables": {name: VARIABLES[name] for name in variables.split()},
        "assumptions": {"safety": list(assumed)},
        "guarantees": {"safety": safety},
    }
    workspace.write(f"{name}.gr1.json", json.dumps(contract))


@pytest.fixture(autouse=True)
def contracts(workspace):
    write_contract(
        workspace, "line", "order filled packed", ["order -> filled'", "filled -> packed'"]
    )
    write_contract(workspace, "filler", "order filled", ["order -> filled'"])


def test_a_contract_that_guarantees_more_refines_another_one(workspace):
    result = workspace.sysmlc("contracts", "refine", "filler.gr1.json", "line.gr1.json")
    assert [result.exit_code, result.stdout] == [0, "line refines filler\n"]


def test_a_run_shows_a_missing_guarantee(workspace):
    arguments = ("line.gr1.json", "filler.gr1.json", "-o", "runs")
    result = workspace.sysmlc("contracts", "refine", *arguments)
    assert [result.exit_code, result.stdout] == [1, "filler does not refine line\n"]
    assert (
        "error[SM527 refinement-guarantees-less]: 'filler' does not guarantee "
        "'G (filled -> packed')', which 'line' guarantees\n  --> line.gr1.json:1:" in result.stderr
    )
    assert "note: step 1: filled=true, packed=false" in result.stderr
    assert "@startuml" in workspace.read("runs/filler.run1.puml")


def test_json_lists_a_verdict_for_each_conjunct(workspace):
    arguments = ("line.gr1.json", "filler.gr1.json", "--format", "json")
    result = workspace.sysmlc("contracts", "refine", *arguments)
    document = json.loads(result.stdout)
    Draft202012Validator(SCHEMAS["sysmlc-diagnostics"]).validate(document)
    entries = document["requirements"]
    assert [list(entry.values())[:4] for entry in entries] == [
        ["filler", "filler", "G (order -> !order')", "holds"],
        ["line", "filler", "G (order -> filled')", "holds"],
        ["line", "filler", "G (filled -> packed')", "broken"],
    ]
    assert [entry["reason"] for entry in entries] == [None, None, "'filler' does not guarantee it"]
    assert entries[2]["witness"]["steps"][0]["filled"]
    assert [entry["witness"] for entry in entries[:2]] == [None, None]


def test_json_lists_what_is_not_decided(workspace):
    """The two contracts disagree on who decides 'filled'."""
    contract = {
        "variables": dict.fromkeys(("order", "filled"), VARIABLES["order"]),
        "assumptions": {"safety": ["filled -> filled'"]},
        "guarantees": {"safety": []},
    }
    workspace.write("reader.gr1.json", json.dumps(contract))
    arguments = ("filler.gr1.json", "reader.gr1.json", "--format", "json")
    result = workspace.sysmlc("contracts", "refine", *arguments)
    entries = json.loads(result.stdout)["requirements"]
    assert [result.exit_code, len(entries)] == [2, 2]
    assert {entry["verdict"] for entry in entries} == {"not-decided"}
    assert "filled" in entries[0]["reason"]


def test_an_additional_assumption_is_named_at_the_concrete_contract(workspace):
    write_contract(workspace, "free", "order filled", ["order -> filled'"], assumed=())
    result = workspace.sysmlc("contracts", "refine", "free.gr1.json", "filler.gr1.json")
    assert result.exit_code == 1
    assert (
        "error[SM528 refinement-assumes-more]: 'filler' assumes 'G (order -> !order')', which the "
        "assumptions of 'free' do not imply\n  --> filler.gr1.json:1:" in result.stderr
    )


def test_a_part_and_its_quotient_together_refine_the_system(workspace):
    quotient = workspace.sysmlc(
        "contracts", "quotient", "line.gr1.json", "filler.gr1.json", "-o", "packer.spc"
    )
    assert quotient.stdout == "line_without_filler: 2 assumptions, 1 guarantee\n"
    assert "SYSTRANS:\n  [](filled -> packed')" in workspace.read("packer.spc")
    workspace.sysmlc("contracts", "compose", "filler.gr1.json", "packer.spc", "-o", "both.json")
    result = workspace.sysmlc("contracts", "refine", "line.gr1.json", "both.json")
    assert [result.exit_code, result.stdout] == [0, "filler_and_packer refines line\n"]


@pytest.mark.parametrize("operation", ["merge", "conjoin"])
def test_without_a_file_the_contract_is_printed(workspace, operation):
    result = workspace.sysmlc("contracts", operation, "filler.gr1.json", "line.gr1.json")
    contract = json.loads(result.stdout)
    formulas = [conjunct["formula"] for conjunct in contract["guarantees"]["safety"]]
    assert [result.exit_code, formulas] == [0, ["order -> filled'", "filled -> packed'"]]


def test_parts_with_the_same_output_are_not_composed(workspace):
    result = workspace.sysmlc("contracts", "compose", "filler.gr1.json", "line.gr1.json")
    assert [result.exit_code, result.stdout] == [2, ""]
    assert (
        "error[SM529 contracts-not-comparable]: 'filler' and 'line' cannot be composed: "
        "'filled' is an output of 'filler' and of 'line'" in result.stderr
    )


@pytest.mark.usefixtures("all_passes")
def test_one_of_several_contracts_is_selected_by_its_component(workspace):
    workspace.write(
        "plant.sysml",
        """package Plant {
            part def Gate {
                in attribute go : ScalarValues::Boolean;
                out attribute done : ScalarValues::Boolean;
            }
            requirement def Fast { subject gate : Gate;
                require constraint { language "ltl" /* G (go -> X done) */ }
            }
            part def Door {
                in attribute go : ScalarValues::Boolean;
                out attribute done : ScalarValues::Boolean;
            }
            requirement def Slow { subject door : Door;
                require constraint { language "ltl" /* G (go -> F done) */ }
            }
        }""",
    )
    result = workspace.sysmlc(
        "contracts", "refine", "plant.sysml#Plant::Door", "plant.sysml#Plant::Gate"
    )
    assert result.stderr == ""
    assert [result.exit_code, result.stdout] == [0, "Plant::Gate refines Plant::Door\n"]
    result = workspace.sysmlc("contracts", "refine", "plant.sysml", "plant.sysml")
    assert result.exit_code == 2
    assert "'plant.sysml' has 2 contracts; append '#' and one of" in result.stderr


@pytest.mark.parametrize(
    ("arguments", "message"),
    [
        (("line.gr1.json", "nowhere.json"), "cannot read 'nowhere.json'"),
        (("line.gr1.json", "line.gr1.json#other"), "no component 'other'"),
        (
            ("line.gr1.json", "filler.gr1.json", "-o", "x.docx"),
            "has no ending of a contract format",
        ),
        (("line.gr1.json", "filler.gr1.json", "--format", "json"), "give the contract a file"),
    ],
)
def test_faulty_arguments_end_with_code_2(workspace, arguments, message):
    result = workspace.sysmlc("contracts", "merge", *arguments)
    assert result.exit_code == 2
    assert message in result.stderr


def test_an_undecided_question_is_reported(workspace):
    write_contract(workspace, "odd", "order filled", ["Y (F filled)"])
    result = workspace.sysmlc("contracts", "refine", "odd.gr1.json", "filler.gr1.json")
    assert result.exit_code == 2
    assert "Traceback" not in result.stderr
