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
from sysmlc.logic.simplify import rebuild
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


def contracts(text=CELL):
    reading = read(text)
    pipeline.run(reading.graph, reading.sink)
    assert [one.rule.code for one in reading.sink] == []
    return {one.component: one for one in reading.graph.derived(Contract)}


def test_every_usage_has_the_contract_of_its_action_and_nothing_else_has_one():
    found = contracts()
    actions = [f"Cells::Cell.{name}" for name in sorted(NAMES)]
    assert sorted(found) == [*actions, "Cells::Machine", "Cells::Small.turn"]


def test_a_usage_has_constants_of_its_own():
    found = contracts()
    for component, high in (("Cells::Cell.turn", 11), ("Cells::Small.turn", 5)):
        domains = {one.name: one.domain for one in found[component].variables}
        assert domains["angle"] == domains["desired"] == IntegerDomain(0, high)


def test_inputs_are_the_environments_and_outputs_the_machines():
    owners = {one.name: one.owner for one in contracts()["Cells::Cell.turn"].variables}
    inputs = {name for name, owner in owners.items() if owner is Owner.ENVIRONMENT}
    assert inputs == {"command", "grip", "desired"}
    assert set(owners) - inputs == {"angle", "turning", "executed"}


def conjuncts(contract, names):
    sides = {"assumed": contract.assumptions, "guaranteed": contract.guarantees}
    return {
        (side, str(part.class_), print_formula(renamed(part.formula, names)))
        for side, parts in sides.items()
        for part in parts
    }


def renamed(formula, names):
    match formula:
        case f.Var(name, primed):
            return f.Var(names.get(name, name), primed)
        case f.Apply(op, args):
            return rebuild(op, tuple(renamed(arg, names) for arg in args))
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
    ours = contracts()[component]
    names = NAMES.get(action, {})
    assert conjuncts(ours, {}) == set(filter(is_possible, conjuncts(theirs, names)))
    known = {names.get(one.name, one.name): one for one in theirs.variables}
    for one in ours.variables:
        assert one.owner is known[one.name].owner
        if not isinstance(one.domain, EnumerationDomain):
            assert one.domain == known[one.name].domain
