"""The library DIN8580: elementary actions of machines, with the contracts that usages have."""

import os
from pathlib import Path

import pytest
from reading_v2 import read

from sysmlc.diagnostics import Sink
from sysmlc.logic import formula as f
from sysmlc.logic.contract import Contract, EnumerationDomain, IntegerDomain, Owner
from sysmlc.logic.formats import read as read_contracts
from sysmlc.logic.printing import print_formula
from sysmlc.logic.simplification import rebuild
from sysmlc.passes import pipeline

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


def read_contracts_of(text=CELL):
    reading = read(text)
    pipeline.run(reading.graph, reading.sink)
    assert [diagnostic.rule.code for diagnostic in reading.sink] == []
    return {contract.component: contract for contract in reading.graph.derived(Contract)}


def test_every_usage_has_the_contract_of_its_action_and_nothing_else_has_one():
    contracts = read_contracts_of()
    actions = [f"Cells::Cell.{name}" for name in sorted(NAMES)]
    assert sorted(contracts) == [*actions, "Cells::Machine", "Cells::Small.turn"]


def test_a_usage_has_constants_of_its_own():
    contracts = read_contracts_of()
    for component, high in (("Cells::Cell.turn", 11), ("Cells::Small.turn", 5)):
        domains = {variable.name: variable.domain for variable in contracts[component].variables}
        assert domains["angle"] == domains["desired"] == IntegerDomain(0, high)


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
    corpus = os.environ.get("SYSMLC_CORPUS")
    if not corpus:
        pytest.skip("SYSMLC_CORPUS is not set")
    path = Path(corpus) / "gr1" / "din8580" / f"{action}.json"
    (theirs,) = read_contracts(path.read_text(), path.name, Sink())
    component = "Cells::Machine" if action == "coordinator" else f"Cells::Cell.{action}"
    ours = read_contracts_of()[component]
    names = NAMES.get(action, {})
    assert list_conjuncts(ours, {}) == set(filter(is_possible, list_conjuncts(theirs, names)))
    expected = {names.get(variable.name, variable.name): variable for variable in theirs.variables}
    for variable in ours.variables:
        assert variable.owner is expected[variable.name].owner
        if not isinstance(variable.domain, EnumerationDomain):
            assert variable.domain == expected[variable.name].domain
