"""The step of a run that violates a formula."""

import pytest

from sysmlc.logic.contract import BooleanDomain, Class, Conjunct
from sysmlc.logic.formal_texts import read_temporal_logic
from sysmlc.logic.violations import find_violated_step


def find_step(formula, steps, loop, class_=Class.OTHER):
    """Return the violated step of a run of p and q, counted from 1; the run is ``p pq - q``."""
    trace = [{name: name in step for name in "pq"} for step in steps.split()]
    parsed = read_temporal_logic(formula, {name: BooleanDomain() for name in "pq"})
    found = find_violated_step(Conjunct(parsed, class_, ""), trace, loop - 1)
    return found and (found[0] + 1, found[1])


@pytest.mark.parametrize(
    ("formula", "steps", "loop", "expected"),
    [
        ("G !p", "- - p -", 4, (3, True)),
        ("p", "- p", 2, (1, True)),
        ("X p", "p - p", 3, (2, True)),
        ("G (p -> X q)", "q p pq -", 4, (4, True)),
        ("G (p & X q)", "pq - q", 3, (2, True)),
        ("G (p -> q')", "q p - -", 4, (3, True)),
        ("G (p -> X X q)", "p - - q", 4, (3, True)),
        ("G !(p & Y p)", "p - p p", 4, (4, True)),
        ("G !O (p & Y O q)", "- q - p", 4, (4, True)),
        ("G H p", "p p - p", 4, (3, True)),
        ("G (q -> p S q)", "p q p", 3, None),
        ("p U q", "p p - q", 4, (3, True)),
        ("p W q", "p p -", 3, (3, True)),
        ("G (p -> (p W q))", "- p p -", 1, (4, True)),
        ("q R p", "p p -", 3, (3, True)),
        ("G (p -> F q)", "q p - p", 3, (2, False)),
        ("F q", "p -", 2, None),
        ("G F q", "q -", 2, (2, False)),
        ("F G p", "p -", 1, None),
        ("(F q) & G p", "p p - -", 4, (3, True)),
        ("G (p -> X X X q)", "- p", 1, (1, True)),
    ],
)
def test_a_run_has_a_violated_step(formula, steps, loop, expected):
    assert find_step(formula, steps, loop) == expected


def test_a_safety_conjunct_is_violated_where_its_formula_is_false():
    assert find_step("p", "p - p", 1, Class.SAFETY) == (2, True)


def test_a_recurring_condition_has_no_violated_step():
    assert find_step("q", "p -", 1, Class.LIVENESS) is None
