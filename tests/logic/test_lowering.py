"""A lowered contract has the same meaning, checked over all values."""

from itertools import product

import pytest
from hypothesis import given, settings
from random_contracts import VARIABLES, conditions, primed_or_not

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
    expand_comparison,
    flatten_atom,
    index_domains,
    rename_reserved,
    rewrite_atoms,
    rewrite_contract_atoms,
    separate_steps,
)
from sysmlc.logic.formula import Apply, Const, Op, Var
from sysmlc.logic.infix import parse_formula
from sysmlc.logic.printing import print_formula

DOMAINS = {variable.name: variable.domain for variable in VARIABLES}


def eliminate_arithmetic(contract):
    """Rewrite comparisons so that each compares a variable with one of its values."""
    variable_domains = index_domains(contract)
    return rewrite_contract_atoms(contract, lambda atom: flatten_atom(atom, variable_domains))


def index_of(variable, value):
    """Return the integer that encodes a value, from 0."""
    return domains.values(variable.domain).index(value)


def encode_integers(row):
    return {variable.name: index_of(variable, row[variable.name]) for variable in VARIABLES}


def encode_bits(row):
    bits = {}
    for variable in VARIABLES:
        name = variable.name
        if isinstance(variable.domain, IntegerDomain | EnumerationDomain):
            width = max((domains.size(variable.domain) - 1).bit_length(), 1)
            index = index_of(variable, row[name])
            bits |= {f"{name}_{bit}": bool(index >> bit & 1) for bit in range(width)}
        else:
            bits[name] = row[name]
    return bits


ROWS = [
    dict(zip([variable.name for variable in VARIABLES], row, strict=True))
    for row in product(*(domains.values(variable.domain) for variable in VARIABLES))
]
PAIRS = [
    (ROWS[(7 * index) % len(ROWS)], ROWS[(11 * index + 5) % len(ROWS)]) for index in range(400)
]


@given(conditions(primed_or_not))
@settings(max_examples=examples(60), deadline=None)
def test_a_lowered_formula_is_true_for_the_same_values(formula):
    contract = Contract("C", "", VARIABLES, (), (Conjunct(formula, Class.SAFETY, "here"),))
    flat = eliminate_arithmetic(contract).guarantees[0].formula
    integers = encode_as_integers(contract, is_flat=True).guarantees[0].formula
    bits = encode_as_bits(contract).guarantees[-1].formula
    for row, next_row in PAIRS:
        truth = is_true(formula, row, next_row)
        assert is_true(flat, row, next_row) == truth
        assert is_true(integers, encode_integers(row), encode_integers(next_row)) == truth
        assert is_true(bits, encode_bits(row), encode_bits(next_row)) == truth


@given(conditions(primed_or_not))
@settings(max_examples=examples(60), deadline=None)
def test_comparisons_across_a_step_become_cases_with_the_same_meaning(formula):
    cases = rewrite_atoms(formula, lambda atom: separate_steps(atom, DOMAINS))
    for row, next_row in PAIRS[:100]:
        assert is_true(cases, row, next_row) == is_true(formula, row, next_row)


@pytest.mark.parametrize(
    ("text", "cases"),
    [
        ("n + low>m", "n + low>m"),  # one step: arithmetic remains
        ("m'=n + low", "m'=2 & n + low=2 | m'=3 & n + low=3 | m'=4 & n + low=4"),
        ("m'=n + 1", "m'=2 & n=1 | m'=3 & n=2 | m'=4 & n=3"),
        ("done'=go", "done' <-> go"),
        ("m=7", "false"),
        ("1<m", "true"),
    ],
)
def test_the_step_with_fewer_values_is_listed(text, cases):
    assert print_formula(separate_steps(parse_formula(text, DOMAINS), DOMAINS)) == cases


def encode_for_slugs(row):
    """Encode a row: structured slugs shifts ranges that begin below 0, and no others."""
    unchanged = {name: row[name] for name in ("n", "m", "go", "done")}
    return encode_integers(row) | unchanged


@given(conditions(primed_or_not))
@settings(max_examples=examples(100), deadline=None)
def test_sums_of_slugs_are_true_for_the_same_values(formula):
    contract = Contract("C", "", VARIABLES, (), (Conjunct(formula, Class.SAFETY, "here"),))
    sums = lower(contract, "structured").guarantees[0].formula
    for row, next_row in PAIRS[:100]:
        truth = is_true(formula, row, next_row)
        assert is_true(sums, encode_for_slugs(row), encode_for_slugs(next_row)) == truth


@pytest.mark.parametrize("text", ["low + 2<n", "low * 2<n", "low - 1<n", "n<low + low"])
def test_a_sum_about_a_range_below_0_counts_from_0_in_slugs(text):
    formula = parse_formula(text, DOMAINS)
    contract = Contract("C", "", VARIABLES, (), (Conjunct(formula, Class.SAFETY, "here"),))
    sums = lower(contract, "structured").guarantees[0].formula
    for row in ROWS:
        encoded = encode_for_slugs(row)
        assert is_true(sums, encoded, encoded) == is_true(formula, row, row), row


@pytest.mark.parametrize("text", ["1<n", "1<=n", "1>n", "1>=n", "3<=m", "0>low", "1=n", "1!=n"])
def test_a_comparison_may_begin_with_the_constant(text):
    formula = parse_formula(text, DOMAINS)
    contract = Contract("C", "", VARIABLES, (), (Conjunct(formula, Class.SAFETY, "here"),))
    flat = eliminate_arithmetic(contract).guarantees[0].formula
    bits = encode_as_bits(contract).guarantees[-1].formula
    for row in ROWS:
        truth, encoded = is_true(formula, row, row), encode_bits(row)
        assert is_true(flat, row, row) == truth
        assert is_true(bits, encoded, encoded) == truth


def test_the_owner_of_a_variable_excludes_bits_that_encode_no_value():
    encoded = encode_as_bits(Contract("C", "", VARIABLES, (), ()))
    names = [variable.name for variable in encoded.variables]
    assert [name for name in names if name.startswith("m_")] == ["m_0", "m_1"]
    ranges = {conjunct.text: conjunct.class_ for conjunct in encoded.guarantees}
    assert ranges == {"'m' is at most 2.": Class.SAFETY, "'mode' is at most 2.": Class.SAFETY}
    assert encoded.assumptions == ()


BUSY = Conjunct(f.eq(Var("mode"), Const("busy")), Class.INIT, "here")


def test_reserved_names_get_an_underscore():
    contract = Contract("C", "", VARIABLES, (), (BUSY,))
    renamed = rename_reserved(contract, ("go", "mode", "busy"))
    names = [variable.name for variable in renamed.variables]
    assert names == ["go_", "n", "low", "done", "m", "mode_"]
    assert renamed.variables[-1].domain == EnumerationDomain(("idle", "busy_", "stop"))
    assert renamed.guarantees[0].formula == f.eq(Var("mode_"), Const("busy_"))


def test_a_reserved_name_gets_two_underscores_if_one_is_taken():
    mode = Variable("mode", Owner.SYSTEM, EnumerationDomain(("busy", "busy_")))
    renamed = rename_reserved(Contract("C", "", (mode,), (BUSY,), (BUSY,)), ("busy",))
    assert renamed.variables[0].domain == EnumerationDomain(("busy__", "busy_"))
    assert renamed.assumptions[0].formula == f.eq(Var("mode"), Const("busy__"))
    assert renamed.guarantees[0].formula == f.eq(Var("mode"), Const("busy__"))


def test_a_comparison_of_too_many_values_is_not_expanded():
    large = {name: IntegerDomain(0, 299) for name in "ab"}
    comparison = Apply(Op.LT, (Var("a"), Var("b")))
    with pytest.raises(TooManyValuesError):
        expand_comparison(comparison, large)
    assert expand_comparison(comparison, large, 1 << 17) is not None
