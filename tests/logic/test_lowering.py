"""Contracts with fewer words say the same: checked over all values."""

from itertools import product

import pytest
from contract_cases import VARIABLES, conditions, then_or_now
from hypothesis import given, settings

from long_runs import examples
from sysmlc.logic import domains
from sysmlc.logic import formula as f
from sysmlc.logic.contract import (
    Class,
    Conjunct,
    Contract,
    EnumerationDomain,
    IntegerDomain,
    Owner,
    Variable,
)
from sysmlc.logic.evaluate import is_true
from sysmlc.logic.formats import lower
from sysmlc.logic.formats.encodings import encode_as_bits, encode_as_integers
from sysmlc.logic.formats.lowering import (
    TooManyValuesError,
    eliminate_arithmetic,
    expand_comparison,
    rename_reserved,
)
from sysmlc.logic.formula import Apply, Const, Op, Var
from sysmlc.logic.infix import parse_formula


def number(variable, value):
    """The number that stands for a value, from 0."""
    return domains.values(variable.domain).index(value)


def as_counted(row):
    return {one.name: number(one, row[one.name]) for one in VARIABLES}


def as_bits(row):
    made = {}
    for one in VARIABLES:
        if isinstance(one.domain, IntegerDomain | EnumerationDomain):
            width = max((domains.size(one.domain) - 1).bit_length(), 1)
            bits = {
                f"{one.name}_{k}": bool(number(one, row[one.name]) >> k & 1) for k in range(width)
            }
            made |= bits
        else:
            made[one.name] = row[one.name]
    return made


def rows():
    """Some values of all variables: each alone and all together."""
    names = [one.name for one in VARIABLES]
    lists = [domains.values(one.domain) for one in VARIABLES]
    return [dict(zip(names, row, strict=True)) for row in product(*lists)]


ROWS = rows()
PAIRS = [
    (ROWS[(7 * index) % len(ROWS)], ROWS[(11 * index + 5) % len(ROWS)]) for index in range(400)
]


@given(conditions(then_or_now))
@settings(max_examples=examples(60), deadline=None)
def test_a_lowered_formula_is_true_for_the_same_values(formula):
    contract = Contract("C", "", VARIABLES, (), (Conjunct(formula, Class.SAFETY, "here"),))
    flat = eliminate_arithmetic(contract).guarantees[0].formula
    numbers = encode_as_integers(contract, is_flat=True).guarantees[0].formula
    bits = encode_as_bits(contract).guarantees[-1].formula
    for now, then in PAIRS:
        truth = is_true(formula, now, then)
        assert is_true(flat, now, then) == truth
        assert is_true(numbers, as_counted(now), as_counted(then)) == truth
        assert is_true(bits, as_bits(now), as_bits(then)) == truth


def as_sums(row):
    """Ranges that begin below 0 begin at 0 in structured slugs, all others where they do."""
    return as_counted(row) | {"n": row["n"], "m": row["m"], "go": row["go"], "done": row["done"]}


@given(conditions(then_or_now))
@settings(max_examples=examples(100), deadline=None)
def test_sums_of_slugs_are_true_for_the_same_values(formula):
    contract = Contract("C", "", VARIABLES, (), (Conjunct(formula, Class.SAFETY, "here"),))
    sums = lower(contract, "structured").guarantees[0].formula
    for now, then in PAIRS[:100]:
        assert is_true(sums, as_sums(now), as_sums(then)) == is_true(formula, now, then)


@pytest.mark.parametrize("text", ["low + 2<n", "low * 2<n", "low - 1<n", "n<low + low"])
def test_a_sum_about_a_range_below_0_counts_from_0_in_slugs(text):
    known = {one.name: one.domain for one in VARIABLES}
    formula = parse_formula(text, known)
    contract = Contract("C", "", VARIABLES, (), (Conjunct(formula, Class.SAFETY, "here"),))
    sums = lower(contract, "structured").guarantees[0].formula
    truths = [
        (is_true(formula, row, row), is_true(sums, as_sums(row), as_sums(row))) for row in ROWS
    ]
    assert [one for one in truths if one[0] != one[1]] == []


@pytest.mark.parametrize("text", ["1<n", "1<=n", "1>n", "1>=n", "3<=m", "0>low", "1=n", "1!=n"])
def test_a_comparison_may_begin_with_the_constant(text):
    formula = parse_formula(text, {one.name: one.domain for one in VARIABLES})
    contract = Contract("C", "", VARIABLES, (), (Conjunct(formula, Class.SAFETY, "here"),))
    flat = eliminate_arithmetic(contract).guarantees[0].formula
    bits = encode_as_bits(contract).guarantees[-1].formula
    for row in ROWS:
        truth = is_true(formula, row, row)
        assert [is_true(flat, row, row), is_true(bits, as_bits(row), as_bits(row))] == [truth] * 2


def test_bits_that_stand_for_no_value_are_ruled_out_on_their_owner_s_side():
    made = encode_as_bits(Contract("C", "", VARIABLES, (), ()))
    assert [one.name for one in made.variables if one.name.startswith("m_")] == ["m_0", "m_1"]
    ruled = {one.text: one.class_ for one in made.guarantees}
    assert ruled == {"'m' is at most 2.": Class.SAFETY, "'mode' is at most 2.": Class.SAFETY}
    assert made.assumptions == ()


def test_names_that_a_language_has_taken_get_an_underscore():
    made = rename_reserved(
        Contract("C", "", VARIABLES, (), (busy("mode"),)), ("go", "mode", "busy")
    )
    names = [one.name for one in made.variables]
    assert names == ["go_", "n", "low", "done", "m", "mode_"]
    assert made.variables[-1].domain == EnumerationDomain(("idle", "busy_", "stop"))
    assert made.guarantees[0].formula == f.eq(Var("mode_"), Const("busy_"))


def test_a_name_that_is_taken_gets_another_underscore_wherever_it_is_said():
    domain = EnumerationDomain(("busy", "busy_"))
    mode, said = Variable("mode", Owner.SYSTEM, domain), (busy("mode"), busy("mode"))
    made = rename_reserved(Contract("C", "", (mode,), said[:1], said[1:]), ("busy",))
    assert made.variables[0].domain == EnumerationDomain(("busy__", "busy_"))
    assert made.assumptions[0].formula == f.eq(Var("mode"), Const("busy__"))
    assert made.guarantees[0].formula == f.eq(Var("mode"), Const("busy__"))


def busy(name):
    return Conjunct(f.eq(Var(name), Const("busy")), Class.INIT, "here")


def test_what_compares_too_many_values_is_named():
    domain = {name: IntegerDomain(0, 999) for name in "ab"}
    comparison = Apply(Op.LT, (Var("a"), Var("b")))
    with pytest.raises(TooManyValuesError):
        expand_comparison(comparison, domain)
    assert expand_comparison(comparison, domain, 1 << 20) is not None
