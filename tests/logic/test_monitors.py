"""Monitors of contracts: the first step that breaks a contract, and who breaks it."""

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from msgspec.structs import replace
from random_contracts import VARIABLES, contracts

from long_runs import examples
from sysmlc.controllers.monitor import build_monitor, find_first_violation
from sysmlc.logic import domains
from sysmlc.logic import formula as f
from sysmlc.logic.classification import classify
from sysmlc.logic.contract import BooleanDomain, Class, Conjunct, Contract, Owner, Variable
from sysmlc.logic.evaluate import find_violation
from sysmlc.logic.formula import Apply, Op
from sysmlc.logic.infix import parse_formula

LETTERS = ("a", "b", "c")
DOMAINS = dict.fromkeys(LETTERS, BooleanDomain())


def make_contract(guarantees, assumptions=()):
    """Return a contract about the Booleans a (of the environment), b and c."""
    owners = (Owner.ENVIRONMENT, Owner.SYSTEM, Owner.SYSTEM)
    variables = [
        Variable(name, owner, BooleanDomain()) for name, owner in zip(LETTERS, owners, strict=True)
    ]

    def parse(formulas):
        return tuple(
            Conjunct(part, class_, "")
            for text in formulas
            for class_, part in classify(parse_formula(text, DOMAINS))
        )

    return Contract("Gate", "", tuple(variables), parse(assumptions), parse(guarantees))


def make_run(text):
    """Return the steps that a text such as ``a - ab`` describes: the letters that are true."""
    return [{letter: letter in step for letter in LETTERS} for step in text.split()]


def find_broken_step(guarantee, run):
    """Return the number of the first step that breaks a guarantee, from 0, or None."""
    violation = find_first_violation(build_monitor(make_contract([guarantee])), make_run(run))
    return violation and violation.step


@pytest.mark.parametrize(
    ("guarantee", "run", "step"),
    [
        ("b", "b -", None),
        ("b", "- b", 0),
        ("G b", "b b - b", 2),
        ("G (a -> X b)", "- a b a b", None),
        ("G (a -> X b)", "- a -", 2),
        ("G (a -> X X b)", "a - b", None),
        ("G (a -> X X b)", "a b -", 2),
        ("G (a -> b W c)", "ab b c -", None),
        ("G (a -> b W c)", "ab b -", 2),
        ("b W a", "b ab -", None),
        ("b W a", "b -", 1),
        ("G (a -> F b)", "a - - -", None),
    ],
)
def test_the_step_that_breaks_a_guarantee(guarantee, run, step):
    assert find_broken_step(guarantee, run) == step


A, B, C = map(f.var, LETTERS)


@pytest.mark.parametrize(
    ("demand", "run", "step"),
    [
        (f.implies(A, Apply(Op.ONCE, (B,))), "b - a", None),
        (f.implies(A, Apply(Op.ONCE, (B,))), "- a", 1),
        (f.implies(A, Apply(Op.PREVIOUS, (B,))), "b a", None),
        (f.implies(A, Apply(Op.PREVIOUS, (B,))), "a", 0),
        (f.implies(C, Apply(Op.SINCE, (f.negate(B), A))), "a - c bc", 3),
        (f.implies(C, Apply(Op.HISTORICALLY, (A,))), "a ac -", None),
        (f.implies(C, Apply(Op.HISTORICALLY, (A,))), "a - ac", 2),
    ],
)
def test_a_demand_about_the_past(demand, run, step):
    contract = replace(make_contract([]), guarantees=(Conjunct(demand, Class.SAFETY, ""),))
    violation = find_first_violation(build_monitor(contract), make_run(run))
    assert (violation and violation.step) == step


def test_promises_without_a_bound_are_not_monitored():
    monitor = build_monitor(make_contract(["G F b", "G (a -> X b)"]))
    assert len(monitor.unmonitored) == 1
    assert len(monitor.checks) == 1


def test_after_a_broken_assumption_nothing_is_owed():
    monitor = build_monitor(make_contract(["G b"], ["G !a"]))
    violation = find_first_violation(monitor, make_run("b ab -"))
    assert (violation.step, violation.check.owner) == (1, Owner.ENVIRONMENT)
    # A guarantee that is broken before the assumption counts.
    violation = find_first_violation(monitor, make_run("b - a"))
    assert (violation.step, violation.check.owner) == (1, Owner.SYSTEM)


def test_checks_of_missing_variables_are_skipped():
    monitor = build_monitor(make_contract(["G (c -> X X b)", "G (a -> b)"]))
    run = [{"a": False, "b": False}, {"a": True, "b": False}]
    assert find_first_violation(monitor, run, frozenset("c")).step == 1
    assert find_first_violation(monitor, run[:1], frozenset("c")) is None


# -- random contracts ------------------------------------------------------------------------------

STEPS = st.fixed_dictionaries(
    {variable.name: st.sampled_from(domains.values(variable.domain)) for variable in VARIABLES}
)


@settings(max_examples=examples(300))
@given(contracts, st.lists(STEPS, min_size=1, max_size=6))
def test_a_monitor_accepts_exactly_the_runs_in_which_no_conjunct_is_violated(contract, run):
    has_violation = any(
        find_violation(conjunct, run) is not None
        for conjunct in (*contract.assumptions, *contract.guarantees)
    )
    assert (find_first_violation(build_monitor(contract), run) is not None) == has_violation


@settings(max_examples=examples(300))
@given(contracts, st.lists(STEPS, min_size=2, max_size=6), st.data())
def test_no_continuation_of_a_broken_run_satisfies_the_contract(contract, run, data):
    violation = find_first_violation(build_monitor(contract), run)
    if violation is None:
        return
    broken = run[: violation.step + 1]
    continuation = data.draw(st.lists(STEPS, min_size=1, max_size=3))
    lasso, loop = broken + continuation, len(broken)
    conjuncts = (*contract.assumptions, *contract.guarantees)
    assert any(find_violation(conjunct, lasso, loop) is not None for conjunct in conjuncts)
