"""Evaluation of formulas on valuations, finite traces and lassos; Spot judges the lassos."""

import pickle

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from random_contracts import apply_binary, apply_unary

from long_runs import examples
from sysmlc.logic import formula as f
from sysmlc.logic.contract import Class, Conjunct
from sysmlc.logic.evaluate import compile_evaluation, evaluate_on_lasso, find_violation, value_of
from sysmlc.logic.formula import Apply, Const, Op, Var
from sysmlc.logic.printing import print_formula

P, Q = Var("p"), Var("q")


@pytest.mark.parametrize(
    ("left", "right", "quotient", "rest"),
    [(7, 2, 3, 1), (-7, 2, -3, -1), (7, -2, -3, 1), (5, 0, 0, 5)],
)
def test_integers_divide_towards_zero(left, right, quotient, rest):
    assert value_of(Apply(Op.DIV, (Const(left), Const(right))), {}) == quotient
    assert value_of(Apply(Op.MOD, (Const(left), Const(right))), {}) == rest


def test_a_violation_is_found_at_its_first_step():
    rises = Conjunct(f.implies(P, Var("q", True)), Class.SAFETY, "x")
    trace = [{"p": False, "q": False}, {"p": True, "q": False}, {"p": True, "q": False}]
    assert find_violation(rises, trace) == 1
    assert find_violation(rises, trace[:2]) is None
    assert find_violation(Conjunct(P, Class.INIT, "x"), trace) == 0
    assert find_violation(Conjunct(f.negate(P), Class.SAFETY, "x"), trace) == 1


def test_liveness_is_violated_only_by_a_lasso():
    recurrence = Conjunct(P, Class.LIVENESS, "x")
    trace = [{"p": True}, {"p": False}, {"p": False}]
    assert find_violation(recurrence, trace) is None
    assert find_violation(recurrence, trace, loop=1) == 1
    assert find_violation(recurrence, trace, loop=0) is None


_formulas = st.recursive(
    st.sampled_from([P, Q]),
    lambda inner: st.one_of(
        st.builds(f.negate, inner),
        st.builds(f.both, inner, inner),
        st.builds(f.implies, inner, inner),
        apply_unary([Op.NEXT, Op.ALWAYS, Op.EVENTUALLY], inner),
        apply_binary([Op.UNTIL, Op.RELEASE, Op.WEAK_UNTIL], inner, inner),
    ),
    max_leaves=5,
)
_traces = st.lists(
    st.fixed_dictionaries({"p": st.booleans(), "q": st.booleans()}), min_size=1, max_size=4
)


@given(_formulas, _traces, st.data())
@settings(max_examples=examples(120), deadline=None)
def test_spot_agrees_on_the_truth_on_lassos(formula, trace, data):
    spot = pytest.importorskip("spot")
    loop = data.draw(st.integers(0, len(trace) - 1))
    letters = ["&".join(n if step[n] else f"!{n}" for n in "pq") for step in trace]
    word = spot.parse_word(";".join([*letters[:loop], f"cycle{{{';'.join(letters[loop:])}}}"]))
    accepts = spot.formula(print_formula(formula)).translate().intersects(word.as_automaton())
    assert evaluate_on_lasso(formula, trace, loop)[0] == accepts


_numbers = st.one_of(
    st.integers(-3, 3).map(Const), st.builds(Var, st.sampled_from("xy"), st.booleans())
)
_sums = apply_binary([Op.ADD, Op.SUB, Op.MUL, Op.DIV, Op.MOD], _numbers, _numbers)
_orders = [Op.EQ, Op.NE, Op.LT, Op.LE, Op.GT, Op.GE]
_comparisons = apply_binary(_orders, st.one_of(_numbers, _sums), _numbers)
_steps = st.recursive(
    _comparisons,
    lambda inner: st.one_of(
        apply_unary([Op.NOT], inner),
        apply_binary([Op.AND, Op.OR, Op.IMPLIES, Op.IFF], inner, inner),
    ),
    max_leaves=6,
)
_values = st.fixed_dictionaries({"x": st.integers(-3, 3), "y": st.integers(-3, 3)})


@given(_steps, _values, _values)
def test_a_compiled_evaluation_gives_the_value_of_the_formula(formula, before, after):
    assert compile_evaluation(formula)(before, after) == value_of(formula, before, after)


def test_an_unpickled_formula_is_the_interned_one():
    formula = f.both(P, f.negate(Q))
    assert {pickle.loads(pickle.dumps(formula)): 1} == {formula: 1}
