"""One component moves at a time: what is won so is won, the rest is decided with all moves."""

import random

import pytest
import small_games
from contracts_in_lines import contract

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


def arena(text: str):
    return small_games.encoded(contract(text))


def moving(text: str) -> list[list[str]]:
    """The numbers that change in each of the ways."""
    found = arena(text)
    ways = search_reductions.find_single_moves(found)
    return (
        [[name for name in "abc" if f"{name}.0" in bits] for bits in ways.moving_bits]
        if ways
        else []
    )


def test_each_number_moves_alone():
    assert moving(LIFTS) == [["a"], ["b"], ["c"]]


@pytest.mark.parametrize(
    "line",
    [
        "promise always !(move_a'=up & move_b'=up)",
        "promise always a!=b",
        "env d: bool\npromise always a=b -> d\nassume always move_a=up & move_b=up -> d'",
    ],
)
def test_rules_about_two_that_leave_one_free_to_move_tie_nothing(line):
    assert moving(f"{LIFTS}\n{line}") == [["a"], ["b"], ["c"]]


def test_what_cannot_move_without_another_moves_with_it(monkeypatch):
    tied = f"{LIFTS}\npromise always move_a'=move_b'"
    assert moving(tied) == []
    monkeypatch.setattr(search_reductions, "MIN_COMPONENTS", 2)
    assert moving(tied) == [["c"], ["a", "b"]]


def test_a_plant_that_does_not_obey_has_no_routes():
    assert moving(LIFTS.replace("move_a=stay -> a'=a", "move_a=stay -> a'<=a")) == []


def test_numbers_that_the_system_gives_after_the_environment_move_alone_too():
    own = "\n".join(f"sys {name}: 0..3\nenv goal_{name}: 0..3" for name in "abc")
    rules = "\n".join(f"promise always {name}' <= {name} + 1" for name in "abc")
    goal = "promise recurs a=goal_a"
    assert moving(f"{own}\n{rules}\n{goal}") == [["a"], ["b"], ["c"]]


@pytest.mark.parametrize("line", ["assume recurs a=1", "assume recurs goal_a=2"])
def test_where_the_system_may_wait_there_are_none(line):
    assert moving(f"{LIFTS}\n{line}") == []


def test_where_nothing_has_to_be_reached_there_are_none():
    assert moving("\n".join(line for line in LIFTS.splitlines() if "recurs" not in line)) == []


def test_what_needs_two_moves_at_once_is_found_with_all_moves():
    together = arena(f"{LIFTS}\nassume at first a=0 & b=0\npromise always a=b")
    assert solve_by_single_moves(together) is None
    assert solve_arena(together, is_complete=False).is_realizable


def test_what_is_won_by_single_moves_is_won():
    found = solve_by_single_moves(arena(f"{LIFTS}\nassume at first b=0\npromise always a=0 -> b=0"))
    assert found is not None
    assert found.is_realizable


def test_what_no_move_wins_is_lost():
    lost = arena(f"{LIFTS}\npromise always a!=3")
    assert solve_by_single_moves(lost) is None
    assert not solve_arena(lost, is_complete=False).is_realizable


def test_random_fleets_are_of_all_kinds(monkeypatch):
    monkeypatch.setattr(search_reductions, "MIN_COMPONENTS", 2)
    arenas = [small_games.encoded(fleet(seed)) for seed in range(FLEETS)]
    apart = [one for one in arenas if search_reductions.find_single_moves(one)]
    won = sum(solve_by_single_moves(one) is not None for one in apart)
    assert [len(apart) > 50, won > 10, won < len(apart) - 10] == [True, True, True]


@pytest.mark.parametrize("start", quick_first(range(0, FLEETS, 50)))
def test_the_verdict_on_random_fleets_is_that_of_listed_states(start, monkeypatch):
    monkeypatch.setattr(search_reductions, "MIN_COMPONENTS", 2)
    found = [small_games.encoded_disagreement(fleet(seed)) for seed in range(start, start + 50)]
    assert [text for text in found if text] == []


def fleet(seed: int) -> Contract:
    """Random machines that obey commands, some of them alike, with rules between them."""
    die = random.Random(seed)
    names = "pq" if die.random() < 0.7 else "pqr"
    places = {one: Variable(one, Owner.ENVIRONMENT, IntegerDomain(0, 1)) for one in names}
    commands = {one: Variable(f"x{one}", Owner.SYSTEM, BooleanDomain()) for one in names}
    where, every = list(places.values()), [*places.values(), *commands.values()]
    assumptions = [
        conjunct
        for one in names
        for conjunct in small_games.obedient(die, places[one], [places[one], commands[one]])
    ]
    guarantees = [
        *(small_games.later(one) for one in small_games.conjuncts(die, Class.INIT, 2, every, [])),
        *small_games.conjuncts(die, Class.SAFETY, 1, where, []),
        *small_games.conjuncts(die, Class.LIVENESS, 3, where, []),
    ]
    if die.random() < 0.3:
        paired = f.eq(*(Var(one.name) for one in where[:2]))
        assumptions.append(Conjunct(paired, Class.INIT, ""))
        guarantees.append(Conjunct(paired, Class.SAFETY, ""))
    if die.random() < 0.2:
        assumptions += small_games.conjuncts(die, Class.LIVENESS, 1, where, [])
    return Contract(f"f{seed}", "", tuple(every), tuple(assumptions), tuple(guarantees))
