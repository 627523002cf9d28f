"""Assumptions that would help: each makes the contract one that can be kept, none is impossible."""

from contracts_in_lines import contract
from explicit import Explicit
from msgspec.structs import replace
from small_games import contract as random_contract

from sysmlc.logic.printing import print_formula
from sysmlc.synthesis import Manager, make_game
from sysmlc.synthesis.unrealizable import explain_unrealizability, helpful_assumptions, is_won

TURN = """
    env wanted: 0..2
    sys at: 0..2
    promise always at'=at+1 | at'=at-1
    promise recurs at=wanted
"""


def helped(text):
    found = helpful_assumptions(make_game(contract(text), Manager()))
    return [(str(one.class_), print_formula(one.formula)) for one in found]


def test_that_a_command_stays_would_help():
    assert ("safety", "wanted'=wanted") in helped(TURN)


def test_that_something_recurs_would_help():
    lamp = "env go: bool\nsys on: bool\npromise always on -> go\npromise recurs on"
    assert helped(lamp) == [("liveness", "go")]


def test_what_the_component_could_make_impossible_is_no_help():
    """That the door stays open whenever the lamp is on would be broken by the component."""
    stuck = "env go: bool\nsys on: bool\npromise always on' -> go'\npromise always !on' -> !go'"
    assert helped(stuck + "\npromise recurs go & !go") == []


def test_the_reasons_name_them():
    turn = contract(TURN)
    said = list(explain_unrealizability(make_game(turn, Manager()), turn))
    assert "it is realizable under the further assumption always: wanted'=wanted" in said


def test_with_each_of_them_a_random_contract_can_be_kept():
    number = 0
    for seed in range(400):
        made = random_contract(seed)
        game = make_game(made, Manager())
        if is_won(game):
            continue
        for one in helpful_assumptions(game):
            better = replace(made, assumptions=(*made.assumptions, one))
            assert Explicit(better).is_realizable(), (seed, print_formula(one.formula))
            number += 1
    assert number > 5
