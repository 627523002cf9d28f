"""Restriction of a game to its reachable states, which leaves the verdict unchanged."""

import pytest
import small_games
from contracts_in_lines import parse_contract
from explicit import ExplicitGame

from sysmlc.synthesis import Manager, make_game
from sysmlc.synthesis.games import search_reductions as reach
from sysmlc.synthesis.games.arena import PredecessorOperator, build_plain_arena
from sysmlc.synthesis.games.solver import solve_arena

GAMES = 200


def describe_token_ring(count: int, more: str = "") -> str:
    """Return a ring of places with one token, which moves when the environment signals it."""
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


def build_arena(text: str):
    return build_plain_arena(make_game(parse_contract(text), Manager()))


def test_the_token_is_in_one_place():
    arena = build_arena(describe_token_ring(60))
    reachable = reach.find_reachable_states(arena)
    assert (
        arena.manager.count(reachable, (*arena.symbols.all_bits(arena.symbols.variables),)) == 120
    )


def test_a_ring_of_many_places_is_decided():
    solution = solve_arena(build_arena(describe_token_ring(60)), is_complete=False)
    assert [solution.is_realizable, solution.is_complete] == [True, True]
    lost = solve_arena(
        build_arena(describe_token_ring(60, "promise always !at30")), is_complete=False
    )
    assert not lost.is_realizable


def test_small_games_are_not_searched():
    assert reach.find_reachable_states(build_arena(describe_token_ring(20))) is None


def test_the_search_stops_after_too_many_steps(monkeypatch):
    monkeypatch.setattr(reach, "MAX_STEPS", 10)
    assert reach.find_reachable_states(build_arena(describe_token_ring(60))) is None


@pytest.mark.parametrize("kind", [small_games.random_contract, small_games.random_plant])
def test_the_verdict_within_reached_states_is_that_of_listed_states(kind, monkeypatch):
    monkeypatch.setattr(reach, "MIN_STATE_BITS", 0)
    disagreements = [small_games.describe_encoded_disagreement(kind(seed)) for seed in range(GAMES)]
    assert [text for text in disagreements if text] == []


def test_no_turn_leads_out_of_the_reached_states(monkeypatch):
    monkeypatch.setattr(reach, "MIN_STATE_BITS", 0)
    for seed in range(60):
        explicit = ExplicitGame(small_games.random_contract(seed))
        game = make_game(small_games.random_contract(seed), Manager())
        reachable = reach.find_reachable_states(build_plain_arena(game))
        inside = {s for s in explicit.states if game.symbols.encode(explicit.value[s]) <= reachable}
        successors = {
            successor
            for s in inside
            for answers in explicit.moves[s].values()
            for successor in answers
        }
        assert successors <= inside


def test_restricted_predecessors_are_exact_in_reachable_states():
    arena = build_arena(describe_token_ring(50))
    reachable = reach.find_reachable_states(arena)
    goal = arena.goals[0] & reachable
    inside, everywhere = PredecessorOperator(arena, reachable), PredecessorOperator(arena)
    assert (
        inside.controllable_predecessors(goal) & reachable
        == everywhere.controllable_predecessors(goal) & reachable
    )
