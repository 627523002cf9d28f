"""Goals that are alike: found where variables can be exchanged, and the verdict stays."""

import random

import pytest
import small_games
from contracts_in_lines import contract
from explicit import Explicit

from sysmlc.logic import formula as f
from sysmlc.logic.contract import BooleanDomain, Class, Conjunct, Contract, Owner, Variable
from sysmlc.logic.formula import Apply, Formula, Var
from sysmlc.synthesis import Manager, make_game
from sysmlc.synthesis.games.arena import build_plain_arena
from sysmlc.synthesis.games.search_reductions import group_symmetric_goals
from sysmlc.synthesis.games.solver import solve_arena

TWINS = """
    env a: 0..2
    sys x: 0..2
    env b: 0..2
    sys y: 0..2
    assume always x!=a -> a'=a
    assume always y!=b -> b'=b
    promise always x'!=y'
    promise always x' <= x + 1
    promise always y' <= y + 1
    promise recurs x=a
    promise recurs y=b
"""
NAMES = {"a": "b", "b": "a", "x": "y", "y": "x"}


def kinds(text: str) -> list[int]:
    """How many goals there are of each kind."""
    arena = build_plain_arena(make_game(contract(text), Manager()))
    return [1 + len(exchanges) for exchanges in group_symmetric_goals(arena).values()]


def test_twins_are_alike():
    assert kinds(TWINS) == [2]


@pytest.mark.parametrize(
    "line",
    [
        "promise always x' != 1",
        "assume always b' != 1",
        "assume recurs a=0",
        "promise recurs x=1",
    ],
)
def test_what_is_said_of_one_only_tells_them_apart(line):
    assert set(kinds(f"{TWINS}\n{line}")) == {1}


def test_a_range_tells_them_apart():
    assert kinds(TWINS.replace("env b: 0..2", "env b: 0..3")) == [1, 1]


def exchanged(formula: Formula) -> Formula:
    match formula:
        case Var(name, primed):
            return Var(NAMES[name], primed)
        case Apply(op, args):
            return Apply(op, tuple(exchanged(arg) for arg in args))
        case _:
            return formula


def twins(seed: int) -> Contract:
    """A random contract that says of b and y what it says of a and x."""
    die = random.Random(seed)
    one = [Variable("a", Owner.ENVIRONMENT, BooleanDomain())]
    one.append(Variable("x", Owner.SYSTEM, BooleanDomain()))
    other = [Variable(NAMES[v.name], v.owner, v.domain) for v in one]
    every = [*one, *other]
    goal = Conjunct(
        small_games.truth(die, [Var("a"), Var("x")], dict.fromkeys("ax", BooleanDomain()), 1),
        Class.LIVENESS,
        "",
    )
    assumed = [
        *small_games.conjuncts(die, Class.SAFETY, 2, every, [one[0]]),
        *small_games.conjuncts(die, Class.LIVENESS, 1, every, []),
    ]
    promised = [goal, *small_games.conjuncts(die, Class.SAFETY, 2, every, every)]
    return Contract(f"t{seed}", "", tuple(every), both(assumed), both(promised))


def both(conjuncts) -> tuple[Conjunct, ...]:
    twins = [Conjunct(exchanged(one.formula), one.class_, "") for one in conjuncts]
    return (*conjuncts, *twins)


def test_the_verdict_on_random_twins_is_that_of_listed_states():
    wrong, alike = [], 0
    for seed in range(150):
        made = twins(seed)
        arena = build_plain_arena(make_game(made, Manager()))
        alike += any(group_symmetric_goals(arena).values())
        verdict = solve_arena(arena, is_complete=False).is_realizable
        if verdict != Explicit(made).is_realizable():
            wrong.append(seed)
    assert [wrong, alike > 100] == [[], True]


def test_formulas_of_the_twins_are_exchanged():
    assert exchanged(f.implies(Var("a"), Var("x", True))) == f.implies(Var("b"), Var("y", True))
