"""The SPIN text of random formulas is read by Spot and has the meaning of the formula."""

import pytest
from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st
from spin_oracle import list_names, parse_leniently, read_text, spot, translate, write_axioms

from long_runs import examples
from sysmlc.logic import formula as f
from sysmlc.logic.contract import (
    BooleanDomain,
    Class,
    Conjunct,
    Contract,
    EnumerationDomain,
    IntegerDomain,
    Owner,
    Variable,
)
from sysmlc.logic.formats.spin import SpinPrinter, print_spin
from sysmlc.logic.formula import Apply, Const, Op, Var

DOMAINS = {
    "p": BooleanDomain(),
    "Door": BooleanDomain(),
    "n": IntegerDomain(-1, 2),
    "m": IntegerDomain(0, 3),
    "mode": EnumerationDomain(("idle", "busy", "Off")),
}


def print_conjunct(conjunct):
    return SpinPrinter(DOMAINS).print_conjunct(conjunct)


def assert_text_is_equivalent(conjunct):
    """Assert that Spot finds the SPIN text equivalent to the translation over bits."""
    temporal = {Class.SAFETY: "G({})", Class.LIVENESS: "G(F({}))", Class.INIT: "({})"}
    formula = translate(DOMAINS, conjunct.formula)
    axioms = spot.formula(f"G({write_axioms(DOMAINS, list_names(conjunct.formula))})")
    expected = spot.formula(temporal[conjunct.class_].format(formula))
    text = print_conjunct(conjunct)
    actual = spot.formula.And([axioms, read_text(text, DOMAINS)])
    assert spot.are_equivalent(actual, spot.formula.And([axioms, expected])), text


# -- random formulas ---------------------------------------------------------------------------

_numbers = st.sampled_from(
    [
        Var("n"),
        Var("m"),
        Var("m", True),
        Const(1),
        Const(9),
        Apply(Op.ADD, (Var("n"), Const(1))),
        Apply(Op.SUB, (Var("m"), Var("n"))),
        Apply(Op.MUL, (Var("m"), Const(2))),
    ]
)
_orders = st.sampled_from([Op.EQ, Op.NE, Op.LT, Op.LE, Op.GT, Op.GE])
_modes = st.sampled_from([Var("mode"), Var("mode", True), Const("idle"), Const("Off")])
_atoms = st.one_of(
    st.sampled_from([Var("p"), Var("p", True), Var("Door"), Var("Door", True), f.TRUE]),
    st.builds(f.compare, _orders, _numbers, _numbers),
    st.builds(f.compare, st.sampled_from([Op.EQ, Op.NE]), _modes, _modes),
)
formulas = st.recursive(
    _atoms,
    lambda inner: st.one_of(
        st.builds(f.negate, inner),
        st.builds(f.both, inner, inner),
        st.builds(f.either, inner, inner),
        st.builds(f.implies, inner, inner),
        st.builds(f.iff, inner, inner),
    ),
    max_leaves=3,
)


@pytest.mark.parametrize("op", [Op.EQ, Op.NE, Op.LT, Op.GE])
def test_a_value_beyond_the_range_has_no_proposition(op):
    formula = Apply(op, (Var("n"), Const(9)))
    assert "9" not in print_conjunct(Conjunct(formula, Class.SAFETY, "x"))
    assert_text_is_equivalent(Conjunct(formula, Class.SAFETY, "x"))


@given(formulas, st.sampled_from([Class.SAFETY, Class.LIVENESS]))
@settings(max_examples=examples(60), deadline=None, suppress_health_check=[HealthCheck.too_slow])
def test_the_text_of_a_random_formula_is_equivalent_to_it(formula, class_):
    assert_text_is_equivalent(Conjunct(formula, class_, "x"))


def test_a_contract_is_one_formula():
    contract = Contract(
        "C",
        "c",
        (
            Variable("p", Owner.ENVIRONMENT, BooleanDomain()),
            Variable("mode", Owner.SYSTEM, DOMAINS["mode"]),
        ),
        (Conjunct(Var("p"), Class.LIVENESS, "a"),),
        (
            Conjunct(f.eq(Var("mode"), Const("idle")), Class.INIT, "b"),
            Conjunct(
                f.implies(Var("p"), f.eq(Var("mode", True), Const("busy"))), Class.SAFETY, "c"
            ),
        ),
    )
    text = print_spin(contract)
    assert text == ("([]<>(p)) -> (({mode==idle}) && [](p -> X {mode==busy}))\n")
    assert parse_leniently(text) == spot.formula('GFp -> ("mode==idle" & G(p -> X"mode==busy"))')


def test_without_assumptions_the_guarantees_stand_alone():
    always_p = Conjunct(Var("p"), Class.SAFETY, "p")
    variables = (Variable("p", Owner.SYSTEM, BooleanDomain()),)
    assert print_spin(Contract("C", "c", variables, (), (always_p,))) == "[](p)\n"
    assert print_spin(Contract("C", "c", variables, (), ())) == "true\n"


@pytest.mark.parametrize(
    ("formula", "text"),
    [
        (Apply(Op.LT, (Var("n"), Apply(Op.ADD, (Var("m"), Const(1))))), "{n<m + 1}"),
        (Apply(Op.LE, (Var("m", True), Const(1))), "X {m<=1}"),
        (
            f.eq(Var("m", True), Apply(Op.ADD, (Var("n"), Const(1)))),
            "({n==-1} && X {m==0}) || ({n==0} && X {m==1}) || ({n==1} && X {m==2})"
            " || ({n==2} && X {m==3})",
        ),
    ],
)
def test_arithmetic_remains_except_across_a_step(formula, text):
    assert print_conjunct(Conjunct(formula, Class.INIT, "x")) == f"({text})"


def test_general_ltl_retains_its_operators():
    formula = Apply(Op.UNTIL, (f.negate(Var("p")), f.eventually(f.eq(Var("m"), Const(3)))))
    text = print_conjunct(Conjunct(formula, Class.OTHER, "x"))
    assert text == "(!p U <>{m==3})"
    assert spot.are_equivalent(parse_leniently(text), spot.formula('!p U F"m==3"'))
