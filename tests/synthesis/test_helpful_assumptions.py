"""Helpful assumptions: each makes the contract realizable, and the component cannot violate it."""

from contracts_in_lines import parse_contract
from explicit import ExplicitGame
from msgspec.structs import replace
from small_games import random_contract

from sysmlc.logic.printing import print_formula
from sysmlc.synthesis import Manager, make_game
from sysmlc.synthesis.unrealizable import explain_unrealizability, find_helpful_assumptions, is_won

TURN = """
    env wanted: 0..2
    sys at: 0..2
    promise always at'=at+1 | at'=at-1
    promise recurs at=wanted
"""


def list_helpful_assumptions(text):
    assumptions = find_helpful_assumptions(make_game(parse_contract(text), Manager()))
    return [
        (str(assumption.class_), print_formula(assumption.formula)) for assumption in assumptions
    ]


def test_missing_stability_assumption_is_suggested():
    assert ("safety", "wanted'=wanted") in list_helpful_assumptions(TURN)


def test_missing_liveness_assumption_is_suggested():
    lamp = "env go: bool\nsys on: bool\npromise always on -> go\npromise recurs on"
    assert list_helpful_assumptions(lamp) == [("liveness", "go")]


def test_an_assumption_that_the_component_could_violate_is_not_suggested():
    """The component could violate any assumption that relates ``go`` to its output."""
    stuck = "env go: bool\nsys on: bool\npromise always on' -> go'\npromise always !on' -> !go'"
    assert list_helpful_assumptions(stuck + "\npromise recurs go & !go") == []


def test_the_explanation_names_helpful_assumptions():
    turn = parse_contract(TURN)
    reasons = list(explain_unrealizability(make_game(turn, Manager()), turn))
    assert "it is realizable under the further assumption always: wanted'=wanted" in reasons


def test_each_helpful_assumption_makes_a_random_contract_realizable():
    number = 0
    for seed in range(400):
        contract = random_contract(seed)
        game = make_game(contract, Manager())
        if is_won(game):
            continue
        for assumption in find_helpful_assumptions(game):
            better = replace(contract, assumptions=(*contract.assumptions, assumption))
            assert ExplicitGame(better).is_realizable(), (seed, print_formula(assumption.formula))
            number += 1
    assert number > 5
