"""Search with single moves: a game won by them is won; others are decided with all moves."""

import random

import pytest
import small_games
from contracts_in_lines import parse_contract

from long_runs import quick_first
from sysmlc.logic import formula as f
from sysmlc.logic.contract import (
    BooleanDomain,
    Class,
    Conjunct,
    Contract,
    IntegerDomain,
    Owner,
    Variable,
)
from sysmlc.logic.formula import Var
from sysmlc.synthesis.games import search_reductions
from sysmlc.synthesis.games.solver import solve_arena, solve_by_single_moves

FLEETS = 150
LIFT = """
    env {0}: 0..3
    env goal_{0}: 0..3
    sys move_{0}: stay up down
    promise at first move_{0}=stay
    assume always move_{0}=stay -> {0}'={0}
    assume always move_{0}=up -> {0}'={0} + 1
    assume always move_{0}=down -> {0}'={0} - 1
    assume always {0}!=goal_{0} -> goal_{0}'=goal_{0}
    promise always move_{0}'=up -> {0}'!=3
    promise always move_{0}'=down -> {0}'!=0
    promise recurs {0}=goal_{0}
"""
LIFTS = "".join(LIFT.format(name) for name in ("a", "b", "c"))


def build_arena(text: str):
    return small_games.encode_game(parse_contract(text))


def list_moving_names(text: str) -> list[list[str]]:
    """List for each single move the numbers that it changes."""
    arena = build_arena(text)
    ways = search_reductions.find_single_moves(arena)
    return (
        [[name for name in "abc" if f"{name}.0" in bits] for bits in ways.moving_bits]
        if ways
        else []
    )


def test_each_number_moves_alone():
    assert list_moving_names(LIFTS) == [["a"], ["b"], ["c"]]


@pytest.mark.parametrize(
    "line",
    [
        "promise always !(move_a'=up & move_b'=up)",
        "promise always a!=b",
        "env d: bool\npromise always a=b -> d\nassume always move_a=up & move_b=up -> d'",
    ],
)
def test_rules_about_two_numbers_that_let_each_move_alone_tie_nothing(line):
    assert list_moving_names(f"{LIFTS}\n{line}") == [["a"], ["b"], ["c"]]


def test_numbers_tied_by_a_rule_move_together(monkeypatch):
    tied = f"{LIFTS}\npromise always move_a'=move_b'"
    assert list_moving_names(tied) == []
    monkeypatch.setattr(search_reductions, "MIN_COMPONENTS", 2)
    assert list_moving_names(tied) == [["c"], ["a", "b"]]


def test_a_plant_that_does_not_obey_has_no_routes():
    assert list_moving_names(LIFTS.replace("move_a=stay -> a'=a", "move_a=stay -> a'<=a")) == []


def test_numbers_that_the_system_assigns_move_alone():
    variables = "\n".join(f"sys {name}: 0..3\nenv goal_{name}: 0..3" for name in "abc")
    rules = "\n".join(f"promise always {name}' <= {name} + 1" for name in "abc")
    goal = "promise recurs a=goal_a"
    assert list_moving_names(f"{variables}\n{rules}\n{goal}") == [["a"], ["b"], ["c"]]


@pytest.mark.parametrize("line", ["assume recurs a=1", "assume recurs goal_a=2"])
def test_games_with_fairness_have_no_single_moves(line):
    assert list_moving_names(f"{LIFTS}\n{line}") == []


def test_games_without_goals_have_no_single_moves():
    assert (
        list_moving_names("\n".join(line for line in LIFTS.splitlines() if "recurs" not in line))
        == []
    )


def test_a_game_that_needs_two_moves_at_once_is_won_with_all_moves():
    together = build_arena(f"{LIFTS}\nassume at first a=0 & b=0\npromise always a=b")
    assert solve_by_single_moves(together) is None
    assert solve_arena(together, is_complete=False).is_realizable


def test_a_game_won_by_single_moves_is_won():
    solution = solve_by_single_moves(
        build_arena(f"{LIFTS}\nassume at first b=0\npromise always a=0 -> b=0")
    )
    assert solution is not None
    assert solution.is_realizable


def test_a_game_that_no_move_wins_is_lost():
    lost = build_arena(f"{LIFTS}\npromise always a!=3")
    assert solve_by_single_moves(lost) is None
    assert not solve_arena(lost, is_complete=False).is_realizable


def test_random_fleets_are_of_all_kinds(monkeypatch):
    monkeypatch.setattr(search_reductions, "MIN_COMPONENTS", 2)
    arenas = [small_games.encode_game(random_fleet(seed)) for seed in range(FLEETS)]
    movable = [arena for arena in arenas if search_reductions.find_single_moves(arena)]
    won = sum(solve_by_single_moves(arena) is not None for arena in movable)
    assert [len(movable) > 50, won > 10, won < len(movable) - 10] == [True, True, True]


@pytest.mark.parametrize("start", quick_first(range(0, FLEETS, 50)))
def test_the_verdict_on_random_fleets_is_that_of_listed_states(start, monkeypatch):
    monkeypatch.setattr(search_reductions, "MIN_COMPONENTS", 2)
    disagreements = [
        small_games.describe_encoded_disagreement(random_fleet(seed))
        for seed in range(start, start + 50)
    ]
    assert [text for text in disagreements if text] == []


def random_fleet(seed: int) -> Contract:
    """Return a random contract of machines that obey commands, with rules between them."""
    die = random.Random(seed)
    names = "pq" if die.random() < 0.7 else "pqr"
    positions = {name: Variable(name, Owner.ENVIRONMENT, IntegerDomain(0, 1)) for name in names}
    commands = {name: Variable(f"x{name}", Owner.SYSTEM, BooleanDomain()) for name in names}
    position_list, variables = list(positions.values()), [*positions.values(), *commands.values()]
    assumptions = [
        conjunct
        for name in names
        for conjunct in small_games.iter_plant_rules(
            die, positions[name], [positions[name], commands[name]]
        )
    ]
    guarantees = [
        *(
            small_games.shift_to_next_step(initial)
            for initial in small_games.iter_random_conjuncts(die, Class.INIT, 2, variables, [])
        ),
        *small_games.iter_random_conjuncts(die, Class.SAFETY, 1, position_list, []),
        *small_games.iter_random_conjuncts(die, Class.LIVENESS, 3, position_list, []),
    ]
    if die.random() < 0.3:
        equality = f.eq(*(Var(position.name) for position in position_list[:2]))
        assumptions.append(Conjunct(equality, Class.INIT, ""))
        guarantees.append(Conjunct(equality, Class.SAFETY, ""))
    if die.random() < 0.2:
        assumptions += small_games.iter_random_conjuncts(die, Class.LIVENESS, 1, position_list, [])
    return Contract(f"f{seed}", "", tuple(variables), tuple(assumptions), tuple(guarantees))
