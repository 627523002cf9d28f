"""Symmetric goals: found where variables can be exchanged, with an unchanged verdict."""

import random

import pytest
import small_games
from contracts_in_lines import parse_contract
from explicit import ExplicitGame

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


def count_goals_by_kind(text: str) -> list[int]:
    """Count the goals in each class of symmetric goals."""
    arena = build_plain_arena(make_game(parse_contract(text), Manager()))
    return [1 + len(exchanges) for exchanges in group_symmetric_goals(arena).values()]


def test_twins_have_symmetric_goals():
    assert count_goals_by_kind(TWINS) == [2]


@pytest.mark.parametrize(
    "line",
    [
        "promise always x' != 1",
        "assume always b' != 1",
        "assume recurs a=0",
        "promise recurs x=1",
    ],
)
def test_a_conjunct_about_one_twin_breaks_the_symmetry(line):
    assert set(count_goals_by_kind(f"{TWINS}\n{line}")) == {1}


def test_different_ranges_break_the_symmetry():
    assert count_goals_by_kind(TWINS.replace("env b: 0..2", "env b: 0..3")) == [1, 1]


def exchange_names(formula: Formula) -> Formula:
    match formula:
        case Var(name, primed):
            return Var(NAMES[name], primed)
        case Apply(op, args):
            return Apply(op, tuple(exchange_names(arg) for arg in args))
        case _:
            return formula


def random_twins(seed: int) -> Contract:
    """Return a random contract that is symmetric in (a, x) and (b, y)."""
    die = random.Random(seed)
    variables = [Variable("a", Owner.ENVIRONMENT, BooleanDomain())]
    variables.append(Variable("x", Owner.SYSTEM, BooleanDomain()))
    twin_variables = [Variable(NAMES[v.name], v.owner, v.domain) for v in variables]
    all_variables = [*variables, *twin_variables]
    goal = Conjunct(
        small_games.random_condition(
            die, [Var("a"), Var("x")], dict.fromkeys("ax", BooleanDomain()), 1
        ),
        Class.LIVENESS,
        "",
    )
    assumptions = [
        *small_games.iter_random_conjuncts(die, Class.SAFETY, 2, all_variables, [variables[0]]),
        *small_games.iter_random_conjuncts(die, Class.LIVENESS, 1, all_variables, []),
    ]
    guarantees = [
        goal,
        *small_games.iter_random_conjuncts(die, Class.SAFETY, 2, all_variables, all_variables),
    ]
    return Contract(
        f"t{seed}", "", tuple(all_variables), add_exchanged(assumptions), add_exchanged(guarantees)
    )


def add_exchanged(conjuncts) -> tuple[Conjunct, ...]:
    counterparts = [
        Conjunct(exchange_names(conjunct.formula), conjunct.class_, "") for conjunct in conjuncts
    ]
    return (*conjuncts, *counterparts)


def test_the_verdict_on_random_twins_is_that_of_listed_states():
    wrong, symmetric = [], 0
    for seed in range(150):
        contract = random_twins(seed)
        arena = build_plain_arena(make_game(contract, Manager()))
        symmetric += any(group_symmetric_goals(arena).values())
        verdict = solve_arena(arena, is_complete=False).is_realizable
        if verdict != ExplicitGame(contract).is_realizable():
            wrong.append(seed)
    assert [wrong, symmetric > 100] == [[], True]


def test_formulas_of_the_twins_are_exchanged():
    assert exchange_names(f.implies(Var("a"), Var("x", True))) == f.implies(
        Var("b"), Var("y", True)
    )
