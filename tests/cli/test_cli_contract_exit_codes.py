"""Exit codes of ``sysmlc contracts check``, with and without ``--strict``."""

import pytest

MODEL = """package Shop {{
    private import ScalarValues::*;
    item def Go;
    part def Lamp {{
        attribute on : Boolean := false; attribute heat : Real; {stated}
        exhibit state Work {{
            entry; then Off; state Off; state Lit;
            transition first Off accept Go {guard} do assign on := true then Lit;
        }}
    }}
    requirement def Demand {{ subject lamp : Lamp; {demand} }}
    requirement def Bright {{ subject lamp : Lamp; doc /* It is bright. */ }}
}}"""
OUTSIDE_GR1 = 'assert constraint { language "ltl" /* F G on | F G !on */ }'


def run_check(workspace, demand, *options, stated="", guard=""):
    workspace.write("lamp.sysml", MODEL.format(demand=demand, stated=stated, guard=guard))
    return workspace.sysmlc("contracts", "check", "lamp.sysml", *options)


def require(formula):
    return f'require constraint {{ language "ltl" /* {formula} */ }}'


@pytest.mark.parametrize(
    ("demand", "code", "strict_code"),
    [
        (require("G (state=Lit -> on)"), 0, 0),
        (require("G on"), 1, 1),
        (require("G state=Off"), 0, 1),
        ("doc /* It is quiet. */", 0, 0),
    ],
    ids=["holds", "broken", "undecided formula", "text"],
)
def test_strict_refuses_formulas_that_are_not_decided(
    workspace, all_passes, demand, code, strict_code
):
    guard = "if heat * heat < 3.5"
    assert run_check(workspace, demand, guard=guard).exit_code == code
    result = run_check(workspace, demand, "--strict", "--ignore", "SM", guard=guard)
    assert result.exit_code == strict_code


def test_texts_are_counted_apart_from_undecided_formulas(workspace, all_passes):
    result = run_check(workspace, require("G !on"), guard="if heat * heat < 3.5")
    lines = result.stdout.splitlines()
    assert lines[0] == "Shop::Lamp: realizable, 1 of 1 requirement not decided"
    assert lines[-1] == "1 requirement not formalised: Bright"


def test_strict_refuses_warnings(workspace, all_passes):
    demand = require("G (on | !on)")
    assert run_check(workspace, demand).exit_code == 0
    result = run_check(workspace, demand, "--strict")
    assert "warning[SM557" in result.stderr
    assert result.exit_code == 1
    assert run_check(workspace, demand, "--strict", "--ignore", "SM557").exit_code == 0


@pytest.mark.parametrize(("formula", "code"), [("G !on", 1), ("G (state=Lit -> on)", 2)])
def test_a_violation_beside_an_undecided_contract_is_a_violation(
    workspace, all_passes, formula, code
):
    result = run_check(workspace, require(formula), stated=OUTSIDE_GR1)
    assert "Shop::Lamp: not decided, " in result.stdout
    assert result.exit_code == code
