"""Without CUDD the same code decides on diagrams in pure Python: all ways to a verdict."""

import pytest
import small_games
from contracts_in_lines import contract
from test_reach import tokens
from test_routes import LIFT, fleet

from sysmlc.diagnostics import Sink, Subject
from sysmlc.synthesis import Manager, make_game
from sysmlc.synthesis.decision import Options, decide, find_deadline
from sysmlc.synthesis.games import search_reductions
from sysmlc.synthesis.games.solver import solve_by_single_moves
from sysmlc.synthesis.unrealizable import unrealizable_core

PURE = Options(engine="autoref")
LIFTS = "".join(LIFT.replace("0..3", "0..2").format(name) for name in "abc")


def verdict(text: str) -> bool | None:
    text = text.replace("!=3", "!=2")
    return decide(contract(text), lambda origin: Subject(), Sink(), PURE).is_realizable


@pytest.mark.parametrize("kind", [small_games.contract, small_games.plant, fleet])
def test_random_games_have_the_verdict_of_listed_states(kind, monkeypatch):
    monkeypatch.setattr(search_reductions, "MIN_COMPONENTS", 2)
    found = [small_games.encoded_disagreement(kind(seed), "autoref") for seed in range(25)]
    assert [text for text in found if text] == []


@pytest.mark.parametrize("kind", [small_games.contract, small_games.plant])
def test_so_they_have_within_reached_states(kind, monkeypatch):
    monkeypatch.setattr(search_reductions, "MIN_STATE_BITS", 0)
    found = [small_games.encoded_disagreement(kind(seed), "autoref") for seed in range(25)]
    assert [text for text in found if text] == []


def test_single_moves_are_found():
    found = solve_by_single_moves(
        small_games.encoded(contract(LIFTS.replace("!=3", "!=2")), "autoref")
    )
    assert found is not None


def test_lifts_are_decided():
    assert verdict(LIFTS) is True
    assert verdict(f"{LIFTS}\npromise always a!=1") is False


def test_tokens_are_decided():
    assert verdict(tokens(50)) is True


def test_a_core_is_found():
    made = contract("env a: bool\nsys x: bool\npromise always x <-> a'\npromise recurs x")
    assert len(unrealizable_core(make_game(made, Manager("autoref")))) == 1


def test_a_deadline_is_found():
    made = contract(
        "env due: bool\nsys late: 0..3\npromise at first late=0\n"
        "assume always due -> !due'\npromise always !due -> late'=0\n"
        "promise always due & late!=3 -> late'=late + 1\npromise always due & late=3 -> late'=3"
    )
    assert find_deadline(made, ["late"], lambda origin: Subject(), Sink(), PURE).bound == 1
