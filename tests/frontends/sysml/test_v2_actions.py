"""The library DIN8580: elementary actions of machines, with the contracts that usages have."""

import os
from pathlib import Path

import pytest
from reading_v2 import read

from refinement import run_all
from sysmlc.diagnostics import Sink
from sysmlc.logic import formula as f
from sysmlc.logic.contract import Contract, EnumerationDomain, IntegerDomain, Owner
from sysmlc.logic.formats import read as read_contracts
from sysmlc.logic.printing import print_formula
from sysmlc.logic.simplification import rebuild

CELL = """
package Cells {
    private import DIN8580::*;
    part def Cell {
        action turn : Turn;
        action pick : Pick;
        action place : Place;
        action move : Move;
        action compose : Compose;
        action decompose : Decompose;
    }
    part def Machine :> Picking, Placing, Moving, Turning, Composing, Decomposing;
    part def Small {
        action turn : Turn { constant attribute :>> positions = 6; }
        action swing : Turn { constant attribute :>> step = 3; }
    }
}
"""
NAMES = {
    "turn": {"turn_executed": "executed"},
    "move": {"move_executed": "executed"},
    "pick": {"pick_executed": "executed", "place_executed": "placed"},
    "place": {"place_executed": "executed", "pick_executed": "picked"},
    "compose": {},
    "decompose": {},
}
"""What the corpus calls the variables of each action, and the library."""
REPLACED = {
    "move": {
        "executed' <-> xpos'=xtarget' & ypos'=ytarget'": "executed' <-> "
        "xpos'=xtarget' & ypos'=ytarget' | xpos=xtarget & ypos=ytarget"
    },
    "place": {"grip' <-> picked' | grip & !placing": "grip' <-> !placing & (picked' | grip)"},
}
"""Guarantees of the corpus, and those that give what tables B.1 and B.3 of the thesis print."""
ADDED = {
    "coordinator": [
        "turn_executed -> available'",
        "command=pick & pick_executed -> grip",
        "command=place & place_executed -> !grip",
    ]
}
"""Guarantees of table 5.1 of the thesis that the corpus lacks."""


def read_contracts_of(text=CELL):
    reading = read(text)
    run_all(reading.graph, reading.sink)
    assert [diagnostic.rule.code for diagnostic in reading.sink] == []
    return {contract.component: contract for contract in reading.graph.derived(Contract)}


def test_every_usage_has_the_contract_of_its_action_and_nothing_else_has_one():
    contracts = read_contracts_of()
    actions = [f"Cells::Cell.{name}" for name in sorted(NAMES)]
    assert sorted(contracts) == [
        *actions,
        *("Cells::Machine", "Cells::Small.swing", "Cells::Small.turn"),
    ]


def test_a_usage_has_constants_of_its_own():
    contracts = read_contracts_of()
    for component, high in (("Cells::Cell.turn", 11), ("Cells::Small.turn", 5)):
        domains = {variable.name: variable.domain for variable in contracts[component].variables}
        assert domains["angle"] == domains["desired"] == IntegerDomain(0, high)


def test_a_step_above_1_assumes_that_the_target_is_a_multiple_of_it():
    contracts = read_contracts_of()
    swing, turn = (
        list_conjuncts(contracts[f"Cells::{name}"], {}) for name in ("Small.swing", "Cell.turn")
    )
    assert swing - turn == {
        ("assumed", "safety", "desired mod 3=0"),
        ("guaranteed", "safety", "turning & angle<desired -> angle'=angle + 3"),
        ("guaranteed", "safety", "turning & angle>desired -> angle'=angle - 3"),
    }
    assert {line for line in turn - swing if line[0] == "assumed"} == set()


@pytest.mark.parametrize(("size", "assumed"), [(1, []), (2, ["level mod 2=0", "level mod 2!=3"])])
def test_assumptions_that_the_values_of_constants_make_true_are_omitted(size, assumed):
    contracts = read_contracts_of(f"""package P {{
        private import ScalarValues::*;
        part def Tank {{
            constant attribute size : Integer = {size};
            in attribute level : Integer;
            out attribute full : Boolean;
            assert constraint {{ 0 <= level and level < 5 }}
        }}
        requirement def R {{
            subject tank : Tank;
            assume constraint {{ language "ltl" /* G level mod size=0 */ }}
            assume constraint {{ language "ltl" /* G level mod size!=3 */ }}
            require constraint {{ language "ltl" /* G (full <-> level mod size=0) */ }}
        }}
    }}""")
    contract = contracts["P::Tank"]
    assert [print_formula(part.formula) for part in contract.assumptions] == assumed
    assert len(contract.guarantees) == 1


def test_inputs_are_the_environments_and_outputs_the_machines():
    owners = {
        variable.name: variable.owner
        for variable in read_contracts_of()["Cells::Cell.turn"].variables
    }
    inputs = {name for name, owner in owners.items() if owner is Owner.ENVIRONMENT}
    assert inputs == {"command", "grip", "desired"}
    assert set(owners) - inputs == {"angle", "turning", "executed"}


def list_conjuncts(contract, names):
    sides = {"assumed": contract.assumptions, "guaranteed": contract.guarantees}
    return {
        (side, str(part.class_), print_formula(rename_variables(part.formula, names)))
        for side, parts in sides.items()
        for part in parts
    }


def rename_variables(formula, names):
    match formula:
        case f.Var(name, primed):
            return f.Var(names.get(name, name), primed)
        case f.Apply(op, args):
            return rebuild(op, tuple(rename_variables(arg, names) for arg in args))
        case _:
            return formula


def is_possible(line):
    """The corpus lists conditions that no position meets: arms beyond the ends of their reach."""
    return "arm1<0" not in line[2] and "arm2>4" not in line[2]


@pytest.mark.corpus
@pytest.mark.parametrize("action", [*sorted(NAMES), "coordinator"])
def test_contracts_are_those_that_other_solvers_decided(action):
    corpus = os.environ["SYSMLC_CORPUS"]
    path = Path(corpus) / "gr1" / "din8580" / f"{action}.json"
    (theirs,) = read_contracts(path.read_text(), path.name, Sink())
    component = "Cells::Machine" if action == "coordinator" else f"Cells::Cell.{action}"
    ours = read_contracts_of()[component]
    names = NAMES.get(action, {})
    replaced = REPLACED.get(action, {})
    expected = {
        (side, class_, replaced.get(text, text))
        for side, class_, text in filter(is_possible, list_conjuncts(theirs, names))
    }
    added = {("guaranteed", "safety", text) for text in ADDED.get(action, ())}
    assert list_conjuncts(ours, {}) == expected | added
    variables = {names.get(variable.name, variable.name): variable for variable in theirs.variables}
    for variable in ours.variables:
        assert variable.owner is variables[variable.name].owner
        if not isinstance(variable.domain, EnumerationDomain):
            assert variable.domain == variables[variable.name].domain
