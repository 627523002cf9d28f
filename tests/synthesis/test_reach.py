"""States that plays come to: what a verdict looks at when they are few, and that it stays."""

import pytest
import small_games
from contracts_in_lines import contract
from explicit import Explicit

from sysmlc.synthesis import Manager, make_game
from sysmlc.synthesis.games import search_reductions as reach
from sysmlc.synthesis.games.arena import PredecessorOperator, build_plain_arena
from sysmlc.synthesis.games.solver import solve_arena

GAMES = 200


def tokens(count: int, more: str = "") -> str:
    """A ring of places with one token, which goes on when the environment says so."""
    places = "\n".join(
        f"sys at{n}: bool\npromise at first {'' if n == 0 else '!'}at{n}" for n in range(count)
    )
    moves = "\n".join(
        f"promise always at{n}' <-> (at{n} & !go' | at{(n - 1) % count} & go')"
        for n in range(count)
    )
    return (
        f"env go: bool\nassume recurs go\n{places}\n{moves}\npromise recurs at{count - 1}\n{more}"
    )


def arena(text: str):
    return build_plain_arena(make_game(contract(text), Manager()))


def test_the_token_is_in_one_place():
    found = arena(tokens(60))
    reached = reach.find_reachable_states(found)
    assert found.manager.count(reached, (*found.symbols.all_bits(found.symbols.variables),)) == 120


def test_a_ring_of_many_places_is_decided():
    found = solve_arena(arena(tokens(60)), is_complete=False)
    assert [found.is_realizable, found.is_complete] == [True, True]
    lost = solve_arena(arena(tokens(60, "promise always !at30")), is_complete=False)
    assert not lost.is_realizable


def test_small_games_are_not_searched():
    assert reach.find_reachable_states(arena(tokens(20))) is None


def test_what_is_reached_in_too_many_steps_is_left(monkeypatch):
    monkeypatch.setattr(reach, "MAX_STEPS", 10)
    assert reach.find_reachable_states(arena(tokens(60))) is None


@pytest.mark.parametrize("kind", [small_games.contract, small_games.plant])
def test_the_verdict_within_reached_states_is_that_of_listed_states(kind, monkeypatch):
    monkeypatch.setattr(reach, "MIN_STATE_BITS", 0)
    found = [small_games.encoded_disagreement(kind(seed)) for seed in range(GAMES)]
    assert [text for text in found if text] == []


def test_no_turn_leads_out_of_the_reached_states(monkeypatch):
    monkeypatch.setattr(reach, "MIN_STATE_BITS", 0)
    for seed in range(60):
        listed = Explicit(small_games.contract(seed))
        game = make_game(small_games.contract(seed), Manager())
        reached = reach.find_reachable_states(build_plain_arena(game))
        inside = {s for s in listed.states if game.symbols.encode(listed.value[s]) <= reached}
        after = {one for s in inside for found in listed.moves[s].values() for one in found}
        assert after <= inside


def test_steps_within_states_are_right_in_them():
    found = arena(tokens(50))
    reached = reach.find_reachable_states(found)
    goal = found.goals[0] & reached
    inside, everywhere = PredecessorOperator(found, reached), PredecessorOperator(found)
    assert (
        inside.controllable_predecessors(goal) & reached
        == everywhere.controllable_predecessors(goal) & reached
    )
