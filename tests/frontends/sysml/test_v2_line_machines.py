"""The library LineMachines: the contracts of its four machines are realizable."""

import pytest
from msgspec.structs import replace
from reading_v2 import read

from refinement import run_all
from sysmlc.logic.contract import Contract, IntegerDomain
from sysmlc.logic.printing import print_formula
from sysmlc.synthesis.bdd.manager import Manager
from sysmlc.synthesis.games.game import make_game
from sysmlc.synthesis.games.solver import solve

LINE = """
package Lines {
    private import LineMachines::*;
    part def Line {
        action carry : Convey;
        action print : Print;
        action inspect : Check;
        action mill : Mill { constant attribute :>> depths = 5; }
    }
}
"""
NEEDED = {
    "carry": "occupied | loaded",
    "print": "busy | start",
    "inspect": "busy | start",
    "mill": "busy | start",
}
"""What must happen again and again for the machine to do something again and again."""


def read_contracts():
    reading = read(LINE)
    run_all(reading.graph, reading.sink)
    assert [diagnostic.rule.code for diagnostic in reading.sink] == []
    contracts = reading.graph.derived(Contract)
    return {contract.component.removeprefix("Lines::Line."): contract for contract in contracts}


def is_realizable(contract):
    return solve(make_game(contract, Manager())).is_realizable


def drop_assumption(contract, text):
    assumptions = tuple(
        assumption
        for assumption in contract.assumptions
        if print_formula(assumption.formula) != text
    )
    assert len(assumptions) == len(contract.assumptions) - 1
    return replace(contract, assumptions=assumptions)


@pytest.mark.parametrize("action", sorted(NEEDED))
def test_the_contract_of_a_machine_can_be_kept_and_not_by_doing_nothing(action):
    contract = read_contracts()[action]
    assert is_realizable(contract)
    assert not is_realizable(drop_assumption(contract, NEEDED[action]))


def test_the_constants_of_a_general_action_hold_for_the_special_one():
    domains = {variable.name: variable.domain for variable in read_contracts()["mill"].variables}
    assert domains["depth"] == domains["wanted"] == IntegerDomain(0, 5)
    assert domains["column"] == IntegerDomain(0, 2)


def test_two_requirements_of_a_component_are_one_contract():
    requirements = {
        guarantee.text.partition(" of ")[2] for guarantee in read_contracts()["print"].guarantees
    }
    assert {"'GridContract' demands it.", "'PrintContract' demands it."} <= requirements
