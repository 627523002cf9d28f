"""Spot reads what we write, and finds every form to say the same as the contract does."""

import pytest
import spot
from contract_cases import ltl
from hypothesis import given, settings
from hypothesis import strategies as st

from long_runs import examples
from sysmlc.diagnostics import Sink
from sysmlc.logic import formats
from sysmlc.logic import formula as f
from sysmlc.logic.contract import BooleanDomain, Class, Conjunct, Contract, Owner, Variable
from sysmlc.logic.formats import NotExpressibleError
from sysmlc.logic.formula import Apply, Const, Op, Var
from sysmlc.logic.infix import parse_formula

VARIABLES = tuple(
    Variable(name, owner, BooleanDomain())
    for name, owner in (
        ("a", Owner.ENVIRONMENT),
        ("b", Owner.ENVIRONMENT),
        ("c", Owner.SYSTEM),
        ("d", Owner.SYSTEM),
    )
)
WORDS = {
    Op.NOT: "!",
    Op.AND: "&",
    Op.OR: "|",
    Op.IMPLIES: "->",
    Op.IFF: "<->",
    Op.NEXT: "X",
    Op.ALWAYS: "G",
    Op.EVENTUALLY: "F",
    Op.UNTIL: "U",
    Op.RELEASE: "R",
    Op.WEAK_UNTIL: "W",
}


def for_spot(formula):
    """The formula with every pair of parentheses, in Spot's words."""
    match formula:
        case Const(value):
            return "1" if value else "0"
        case Var(name, primed):
            return f"(X {name})" if primed else name
        case Apply(op, (only,)):
            return f"({WORDS[op]} {for_spot(only)})"
        case Apply(op, args):
            return f"({f' {WORDS[op]} '.join(map(for_spot, args))})"


def meaning(contract):
    assumed = f.both(*map(ltl, contract.assumptions))
    promised = f.both(*map(ltl, contract.guarantees))
    return spot.formula(for_spot(Apply(Op.IMPLIES, (assumed, promised))))


def formulas(primes):
    leaves = st.builds(Var, st.sampled_from("abcd"), primes)
    return st.recursive(
        leaves,
        lambda inner: st.one_of(
            st.builds(f.negate, inner),
            st.builds(f.both, inner, inner),
            st.builds(f.either, inner, inner),
            st.builds(f.implies, inner, inner),
            st.builds(f.iff, inner, inner),
        ),
        max_leaves=4,
    )


general = st.recursive(
    formulas(st.just(False)),
    lambda inner: st.one_of(
        st.builds(lambda op, a: Apply(op, (a,)), st.sampled_from([Op.NEXT, Op.EVENTUALLY]), inner),
        st.builds(
            lambda op, a, b: Apply(op, (a, b)),
            st.sampled_from([Op.UNTIL, Op.RELEASE, Op.WEAK_UNTIL]),
            inner,
            inner,
        ),
    ),
    max_leaves=3,
)
now = formulas(st.just(False))
ahead = formulas(st.booleans())


def conjunct(class_, found):
    return st.builds(lambda formula: Conjunct(formula, class_, ""), found)


games = st.builds(
    lambda assumed, promised: Contract("C", "", VARIABLES, tuple(assumed), tuple(promised)),
    st.lists(conjunct(Class.LIVENESS, now), max_size=1),
    st.lists(st.one_of(conjunct(Class.SAFETY, ahead), conjunct(Class.LIVENESS, now)), max_size=2),
)
any_contracts = st.builds(
    lambda assumed, promised: Contract("C", "", VARIABLES, tuple(assumed), tuple(promised)),
    st.lists(conjunct(Class.OTHER, general), max_size=1),
    st.lists(st.one_of(conjunct(Class.OTHER, general), conjunct(Class.SAFETY, ahead)), max_size=2),
)


@pytest.mark.parametrize("form", ["gr1c", "slugsin", "structured", "tlsf", "smv", "chase"])
@given(contract=games)
@settings(max_examples=examples(25), deadline=None)
def test_a_game_says_the_same_in_every_form(form, contract):
    same(contract, form)


@pytest.mark.parametrize("form", ["tlsf", "spot", "spin", "smv", "chase", "chasejson", "neutral"])
@given(contract=any_contracts)
@settings(max_examples=examples(25), deadline=None)
def test_general_ltl_says_the_same_in_every_form(form, contract):
    same(contract, form)


def same(contract, form):
    text = formats.write(contract, form)
    (again,) = formats.read(text, "C.txt", Sink(), form)
    assert spot.are_equivalent(meaning(contract), meaning(again))


@pytest.mark.parametrize("form", ["gr1c", "slugsin", "structured"])
def test_what_can_be_reduced_is_written_with_history_bits(form):
    response = parse_formula("G (a -> F c)", {name: BooleanDomain() for name in "abcd"})
    contract = Contract("C", "", VARIABLES, (), (Conjunct(response, Class.OTHER, ""),))
    (again,) = formats.read(formats.write(contract, form), "C.txt", Sink(), form)
    assert [one.name for one in again.variables] == [*"abcd", "since_1"]
    assert [one.class_ for one in again.guarantees] == [Class.INIT, Class.SAFETY, Class.LIVENESS]


@pytest.mark.parametrize("form", ["spot", "spin"])
@given(contract=any_contracts)
@settings(max_examples=examples(40), deadline=None)
def test_spot_reads_the_formula_itself(form, contract):
    first = formats.write(contract, form).splitlines()[0]
    assert spot.are_equivalent(meaning(contract), spot.formula(first))


@pytest.mark.parametrize("form", ["gr1c", "slugsin", "structured"])
@given(formula=general)
@settings(max_examples=examples(25), deadline=None)
def test_what_a_form_has_no_words_for_names_the_conjunct(form, formula):
    stable = f.eventually(f.always(f.either(Var("d"), formula)))
    outside = Conjunct(stable, Class.OTHER, "model.uml:3:1")
    with pytest.raises(NotExpressibleError) as caught:
        formats.write(Contract("C", "", VARIABLES, (), (outside,)), form)
    assert caught.value.conjunct == outside


@pytest.mark.parametrize("form", ["gr1c", "slugsin", "structured"])
def test_an_assumption_about_what_the_system_does_next_is_named(form):
    ahead = Conjunct(f.implies(Var("a"), Var("c", True)), Class.SAFETY, "model.uml:3:1")
    with pytest.raises(NotExpressibleError) as caught:
        formats.write(Contract("C", "", VARIABLES, (ahead,), ()), form)
    assert caught.value.conjunct == ahead
