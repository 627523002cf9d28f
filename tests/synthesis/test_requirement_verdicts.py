"""Verdicts about single requirements, and the tableau of formulas outside GR(1)."""

import pytest

from sysmlc.logic.classification import is_safety
from sysmlc.logic.components.derivation import ComponentBehaviour
from sysmlc.logic.contract import (
    BooleanDomain,
    Class,
    Conjunct,
    Contract,
    Owner,
    Source,
    Variable,
)
from sysmlc.logic.infix import parse_formula
from sysmlc.synthesis.algebra.refinement import RunSearch
from sysmlc.synthesis.bdd.limits import LimitError
from sysmlc.synthesis.decision import Options
from sysmlc.synthesis.requirement_verdicts import BehaviourCheck

NAMES = {"run": Owner.SYSTEM, "full": Owner.SYSTEM, "done": Owner.ENVIRONMENT}
DOMAINS = {name: BooleanDomain() for name in NAMES}


def conjunct(text, class_, source=Source.DERIVED):
    return Conjunct(parse_formula(text, DOMAINS), class_, "", text, source=source)


def contract(assumptions, guarantees):
    variables = tuple(Variable(name, owner, DOMAINS[name]) for name, owner in NAMES.items())
    return Contract("Cell", "", variables, assumptions, guarantees)


FILLING = contract(
    (conjunct("!run | done", Class.LIVENESS),),
    (
        conjunct("run & !full", Class.INIT),
        conjunct("run' <-> run & !done", Class.SAFETY),
        conjunct("full' <-> full | run & done", Class.SAFETY),
    ),
)
"""An action runs until the environment ends it; then a place is full."""


def decide(formula, behaviour=None, class_=Class.OTHER):
    required = contract((), (conjunct(formula, class_, Source.AUTHOR),))
    checked = behaviour or ComponentBehaviour(FILLING)
    (verdict,) = BehaviourCheck(checked, required, (), Options()).decide_requirements()
    return verdict


@pytest.mark.parametrize(
    ("formula", "answer"),
    [
        ("G (full -> G full)", "holds"),
        ("F full", "holds-if-actions-end"),
        ("F G full", "holds-if-actions-end"),
        ("run U full", "holds-if-actions-end"),
        ("run W full", "holds"),
        ("full R (run | full)", "holds"),
        ("full R run", "broken"),
        ("F G !run | G run", "holds"),
        ("G F !full", "broken"),
        ("G F done -> F G full", "holds"),
        ("F (run & X run)", "broken"),
        ("X X full", "broken"),
        ("G (full -> X full)", "holds"),
        ("G F done", "broken"),
    ],
)
def test_each_operator_has_its_meaning(formula, answer):
    assert decide(formula).answer == answer


def test_a_derived_assumption_is_named_where_it_is_needed():
    assert decide("F full").reason == "!run | done"
    assert decide("G (full -> G full)").reason == ""


def test_a_limit_in_the_search_for_a_minimal_set_does_not_hide_the_proof(monkeypatch):
    entails, questions = RunSearch.entails, []

    def entails_but_for_one(search, facts, conjunct):
        questions.append(conjunct)
        if len(questions) == 3:
            raise LimitError("of CPU time", "10 s")
        return entails(search, facts, conjunct)

    monkeypatch.setattr(RunSearch, "entails", entails_but_for_one)
    verdict = decide("F full")
    assert (verdict.answer, verdict.reason) == ("holds-if-actions-end", "!run | done")


def test_a_broken_requirement_has_a_run_and_no_auxiliary_variables():
    verdict = decide("F G !full")
    assert verdict.answer == "broken"
    assert all(set(values) == set(NAMES) for values in verdict.trace.steps)
    assert verdict.trace.steps[verdict.trace.loop]["full"] is True


def test_a_variable_that_the_model_restricts_further_refutes_nothing():
    gaps = ComponentBehaviour(FILLING, gaps={"done": "it is not known when it ends"})
    assert decide("G run", gaps).answer == "not-decided"
    assert decide("G run", gaps).reason == "it is not known when it ends"
    assert decide("run W full", gaps).answer == "holds"


def test_an_action_that_has_not_ended_yet_may_refute_safety():
    gaps = ComponentBehaviour(FILLING, gaps={"done": "unknown"}, undescribed=frozenset({"done"}))
    assert decide("G !run", gaps).answer == "broken"
    assert decide("G !full", gaps).answer == "not-decided"


@pytest.mark.parametrize(
    ("formula", "expected"),
    [
        ("G (run -> X full)", True),
        ("!(F run)", True),
        ("run W full", True),
        ("F run", False),
        ("G run -> full", False),
        ("!(run U full)", True),
        ("G (run <-> X full)", True),
    ],
)
def test_safety_is_judged_by_polarity(formula, expected):
    assert is_safety(parse_formula(formula, DOMAINS)) == expected
