"""Formulas as texts, parsed and printed without loss, and formulas as interned objects."""

import copy
import gc
import json
import os
import pickle
from pathlib import Path

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from random_contracts import apply_binary, apply_unary, connect

from long_runs import examples
from sysmlc.logic import formula as f
from sysmlc.logic.contract import BooleanDomain, EnumerationDomain, IntegerDomain
from sysmlc.logic.formula import Const, Op, Var
from sysmlc.logic.infix import parse_formula
from sysmlc.logic.printing import print_formula
from sysmlc.logic.syntax import FormulaError

VARIABLES = {
    "p": BooleanDomain(),
    "q": BooleanDomain(),
    "n": IntegerDomain(-2, 7),
    "m": IntegerDomain(0, 3),
    "mode": EnumerationDomain(("idle", "busy", "p")),
}

_numbers = st.recursive(
    st.sampled_from([Const(3), Const(-2), Var("n"), Var("m"), Var("n", primed=True)]),
    lambda inner: st.builds(
        f.compare, st.sampled_from([Op.ADD, Op.SUB, Op.MUL, Op.DIV, Op.MOD]), inner, inner
    ),
    max_leaves=4,
)
_orders = st.sampled_from([Op.EQ, Op.NE, Op.LT, Op.LE, Op.GT, Op.GE])
_atoms = st.one_of(
    st.sampled_from([Var("p"), Var("q"), Var("q", primed=True), f.TRUE, f.FALSE]),
    st.builds(f.compare, _orders, _numbers, _numbers),
    st.builds(f.eq, st.sampled_from([Var("mode"), Var("mode", True)]), st.just(Const("p"))),
)
formulas = st.recursive(
    _atoms,
    lambda inner: st.one_of(
        connect(inner),
        apply_unary([Op.NEXT, Op.ALWAYS, Op.EVENTUALLY], inner),
        apply_binary([Op.UNTIL, Op.RELEASE, Op.WEAK_UNTIL], inner, inner),
    ),
    max_leaves=10,
)


@given(formulas)
@settings(max_examples=examples(200), deadline=None)
def test_a_printed_formula_is_parsed_to_the_same_formula(formula):
    assert parse_formula(print_formula(formula), VARIABLES) == formula


@pytest.mark.parametrize(
    ("text", "neutral"),
    [
        ("[](p -> <>q)", "G (p -> F q)"),
        ("p && {n==3} || !q", "p & n=3 | !q"),
        ("mode=p & p", "mode=p & p"),
        ("n'=n+1 -> X p", "n'=n + 1 -> X p"),
        ("(p U q) V q", "(p U q) R q"),
    ],
)
def test_other_spellings_are_printed_in_the_neutral_form(text, neutral):
    assert print_formula(parse_formula(text, VARIABLES)) == neutral


@pytest.mark.parametrize("text", ["p &", "r", "mode", "n + 1", "mode=idle -> n", "p -> (", "3"])
def test_a_malformed_formula_is_rejected(text):
    with pytest.raises(FormulaError):
        parse_formula(text, VARIABLES)


def read_domain(json_type):
    """Return the domain of a variable in the neutral JSON format."""
    if json_type == "bool":
        return BooleanDomain()
    if isinstance(json_type[0], int):
        return IntegerDomain(*json_type)
    return EnumerationDomain(tuple(json_type))


@pytest.mark.corpus
def test_the_formulas_of_din_8580_are_printed_without_loss():
    corpus = os.environ["SYSMLC_CORPUS"]
    files = sorted(Path(corpus, "gr1", "din8580").glob("*.json"))
    assert len(files) == 33
    for file in files:
        contract = json.loads(file.read_text(encoding="utf-8"))
        domains = {
            name: read_domain(variable["type"]) for name, variable in contract["variables"].items()
        }
        sides = [contract["assumptions"], contract["guarantees"]]
        for text in (text for side in sides for texts in side.values() for text in texts):
            formula = parse_formula(text, domains)
            assert parse_formula(print_formula(formula), domains) == formula


@given(formulas, formulas)
@settings(max_examples=examples(100), deadline=None)
def test_equal_formulas_are_the_same_object(left, right):
    assert (left is right) == (repr(left) == repr(right))
    assert pickle.loads(pickle.dumps(left)) is left
    assert copy.deepcopy(left) is left


def test_true_is_different_from_1():
    """In Python True equals 1, so tables of formulas could confuse them."""
    boolean, number = f.eq(Var("x"), f.TRUE), f.eq(Var("x"), Const(1))
    assert Const(True) != Const(1)
    assert boolean != number
    assert [print_formula(formula) for formula in (boolean, number)] == ["x=true", "x=1"]
    assert f.both(f.eq(Var("n"), Const(1)), Const(1)) != f.eq(Var("n"), Const(1))
    assert [Const(0) in {Const(False)}, Const(False) in {Const(False)}] == [False, True]


def test_unreferenced_formulas_are_freed():
    """The cache of recent formulas, which holds references, is bounded."""
    assert f._apply.cache_info().maxsize is not None
    f._apply.cache_clear()
    gc.collect()
    before = len(f._APPLIED)
    formulas = [f.eq(Var(f"only_here_{number}"), Const(number)) for number in range(51)]
    assert len(f._APPLIED) > before + 50
    del formulas
    f._apply.cache_clear()
    gc.collect()
    assert len(f._APPLIED) == before
