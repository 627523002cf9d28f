"""Spot judges that a contract means the same in every format."""

import pytest
import spot
from hypothesis import given, settings
from hypothesis import strategies as st
from random_contracts import apply_binary, apply_unary, connect

from long_runs import examples
from spot_formulas import conjoin, print_for_spot
from sysmlc.diagnostics import Sink
from sysmlc.logic import formats
from sysmlc.logic import formula as f
from sysmlc.logic.contract import BooleanDomain, Class, Conjunct, Contract, Owner, Variable
from sysmlc.logic.formats import NotExpressibleError
from sysmlc.logic.formula import Op, Var
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


def translate(contract):
    """Return the contract as a formula of Spot: the assumptions imply the guarantees."""
    assumptions, guarantees = conjoin(contract.assumptions), conjoin(contract.guarantees)
    return spot.formula(f"{print_for_spot(assumptions)} -> {print_for_spot(guarantees)}")


def formulas(primes):
    return st.recursive(st.builds(Var, st.sampled_from("abcd"), primes), connect, max_leaves=4)


general = st.recursive(
    formulas(st.just(False)),
    lambda inner: st.one_of(
        apply_unary([Op.NEXT, Op.EVENTUALLY], inner),
        apply_binary([Op.UNTIL, Op.RELEASE, Op.WEAK_UNTIL], inner, inner),
    ),
    max_leaves=3,
)
unprimed = formulas(st.just(False))
primed_or_not = formulas(st.booleans())


def conjunct(class_, formula):
    return st.builds(lambda formula: Conjunct(formula, class_, ""), formula)


games = st.builds(
    lambda assumptions, guarantees: Contract(
        "C", "", VARIABLES, tuple(assumptions), tuple(guarantees)
    ),
    st.lists(conjunct(Class.LIVENESS, unprimed), max_size=1),
    st.lists(
        st.one_of(conjunct(Class.SAFETY, primed_or_not), conjunct(Class.LIVENESS, unprimed)),
        max_size=2,
    ),
)
any_contracts = st.builds(
    lambda assumptions, guarantees: Contract(
        "C", "", VARIABLES, tuple(assumptions), tuple(guarantees)
    ),
    st.lists(conjunct(Class.OTHER, general), max_size=1),
    st.lists(
        st.one_of(conjunct(Class.OTHER, general), conjunct(Class.SAFETY, primed_or_not)), max_size=2
    ),
)


@pytest.mark.parametrize("format_name", ["gr1c", "slugsin", "structured", "tlsf", "smv", "chase"])
@given(contract=games)
@settings(max_examples=examples(25), deadline=None)
def test_a_gr1_contract_means_the_same_in_every_format(format_name, contract):
    check_same_meaning(contract, format_name)


@pytest.mark.parametrize(
    "format_name", ["tlsf", "spot", "spin", "smv", "chase", "chasejson", "neutral"]
)
@given(contract=any_contracts)
@settings(max_examples=examples(25), deadline=None)
def test_general_ltl_means_the_same_in_every_format(format_name, contract):
    check_same_meaning(contract, format_name)


def check_same_meaning(contract, format_name):
    text = formats.write(contract, format_name)
    (read_contract,) = formats.read(text, "C.txt", Sink(), format_name)
    assert spot.are_equivalent(translate(contract), translate(read_contract))


@pytest.mark.parametrize("format_name", ["gr1c", "slugsin", "structured"])
def test_a_reducible_formula_is_written_with_history_bits(format_name):
    response = parse_formula("G (a -> F c)", {name: BooleanDomain() for name in "abcd"})
    contract = Contract("C", "", VARIABLES, (), (Conjunct(response, Class.OTHER, ""),))
    (read_contract,) = formats.read(
        formats.write(contract, format_name), "C.txt", Sink(), format_name
    )
    assert [variable.name for variable in read_contract.variables] == [*"abcd", "since_1"]
    classes = [conjunct.class_ for conjunct in read_contract.guarantees]
    assert classes == [Class.INIT, Class.SAFETY, Class.LIVENESS]


@pytest.mark.parametrize("format_name", ["spot", "spin"])
@given(contract=any_contracts)
@settings(max_examples=examples(40), deadline=None)
def test_spot_reads_the_written_formula(format_name, contract):
    first = formats.write(contract, format_name).splitlines()[0]
    assert spot.are_equivalent(translate(contract), spot.formula(first))


@pytest.mark.parametrize("format_name", ["gr1c", "slugsin", "structured"])
@given(formula=general)
@settings(max_examples=examples(25), deadline=None)
def test_an_inexpressible_conjunct_is_named(format_name, formula):
    stable = f.eventually(f.always(f.either(Var("d"), formula)))
    outside = Conjunct(stable, Class.OTHER, "model.uml:3:1")
    with pytest.raises(NotExpressibleError) as caught:
        formats.write(Contract("C", "", VARIABLES, (), (outside,)), format_name)
    assert caught.value.conjunct == outside


@pytest.mark.parametrize("format_name", ["gr1c", "slugsin", "structured"])
def test_an_assumption_about_the_next_output_is_named(format_name):
    assumption = Conjunct(f.implies(Var("a"), Var("c", True)), Class.SAFETY, "model.uml:3:1")
    with pytest.raises(NotExpressibleError) as caught:
        formats.write(Contract("C", "", VARIABLES, (assumption,), ()), format_name)
    assert caught.value.conjunct == assumption


def test_propositions_of_spot_may_be_quoted():
    texts = ('G ("a" -> F "c") & 1', "G (a -> F c) & 1")
    quoted, plain = (
        formats.read(f"{text}\n.inputs a b\n.outputs c d\n", "C.txt", Sink(), "spot")[0]
        for text in texts
    )
    assert quoted.guarantees == plain.guarantees
    assert [variable.name for variable in quoted.variables] == [*"abcd"]
    sink = Sink()
    formats.read('G "x y"\n.inputs a\n.outputs c\n', "C.txt", sink, "spot")
    assert ["'x y' is among neither" in found.message for found in sink] == [True]
