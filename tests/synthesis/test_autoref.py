"""All ways to a verdict with decision diagrams in pure Python, as used without CUDD."""

import pytest
import small_games
from contracts_in_lines import parse_contract
from test_reach import describe_token_ring
from test_routes import LIFT, random_fleet

from sysmlc.diagnostics import Sink, Subject
from sysmlc.synthesis import Manager, make_game
from sysmlc.synthesis.decision import Options, decide, find_deadline
from sysmlc.synthesis.games import search_reductions
from sysmlc.synthesis.games.solver import solve_by_single_moves
from sysmlc.synthesis.unrealizable import find_unrealizable_core

PURE = Options(engine="autoref")
LIFTS = "".join(LIFT.replace("0..3", "0..2").format(name) for name in "abc")


def is_realizable(text: str) -> bool | None:
    text = text.replace("!=3", "!=2")
    return decide(parse_contract(text), lambda origin: Subject(), Sink(), PURE).is_realizable


@pytest.mark.parametrize(
    "kind", [small_games.random_contract, small_games.random_plant, random_fleet]
)
def test_random_games_have_the_verdict_of_listed_states(kind, monkeypatch):
    monkeypatch.setattr(search_reductions, "MIN_COMPONENTS", 2)
    disagreements = [
        small_games.describe_encoded_disagreement(kind(seed), "autoref") for seed in range(25)
    ]
    assert [text for text in disagreements if text] == []


@pytest.mark.parametrize("kind", [small_games.random_contract, small_games.random_plant])
def test_random_games_restricted_to_reachable_states_have_the_same_verdict(kind, monkeypatch):
    monkeypatch.setattr(search_reductions, "MIN_STATE_BITS", 0)
    disagreements = [
        small_games.describe_encoded_disagreement(kind(seed), "autoref") for seed in range(25)
    ]
    assert [text for text in disagreements if text] == []


def test_single_moves_are_found():
    solution = solve_by_single_moves(
        small_games.encode_game(parse_contract(LIFTS.replace("!=3", "!=2")), "autoref")
    )
    assert solution is not None


def test_lifts_are_decided():
    assert is_realizable(LIFTS) is True
    assert is_realizable(f"{LIFTS}\npromise always a!=1") is False


def test_a_ring_of_tokens_is_decided():
    assert is_realizable(describe_token_ring(50)) is True


def test_a_core_is_found():
    contract = parse_contract("env a: bool\nsys x: bool\npromise always x <-> a'\npromise recurs x")
    assert len(find_unrealizable_core(make_game(contract, Manager("autoref")))) == 1


def test_a_deadline_is_found():
    contract = parse_contract(
        "env due: bool\nsys late: 0..3\npromise at first late=0\n"
        "assume always due -> !due'\npromise always !due -> late'=0\n"
        "promise always due & late!=3 -> late'=late + 1\npromise always due & late=3 -> late'=3"
    )
    assert find_deadline(contract, ["late"], lambda origin: Subject(), Sink(), PURE).bound == 1
