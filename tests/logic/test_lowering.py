"""Contracts with fewer words say the same: checked over all values."""

from itertools import product

import pytest
from contract_cases import VARIABLES, conditions, then_or_now
from hypothesis import given, settings

from sysmlc.logic import domains
from sysmlc.logic import formula as f
from sysmlc.logic.contract import Class, Conjunct, Contract, EnumerationDomain, IntegerDomain
from sysmlc.logic.evaluate import is_true
from sysmlc.logic.formats.counting import counted, in_bits
from sysmlc.logic.formats.lower import TooManyValuesError, renamed, without_arithmetic, written_out
from sysmlc.logic.formula import Apply, Const, Op, Var


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
@settings(max_examples=60, deadline=None)
def test_a_lowered_formula_is_true_for_the_same_values(formula):
    contract = Contract("C", "", VARIABLES, (), (Conjunct(formula, Class.SAFETY, "here"),))
    flat = without_arithmetic(contract).guarantees[0].formula
    numbers = counted(contract, is_flat=True).guarantees[0].formula
    bits = in_bits(contract).guarantees[-1].formula
    for now, then in PAIRS:
        truth = is_true(formula, now, then)
        assert is_true(flat, now, then) == truth
        assert is_true(numbers, as_counted(now), as_counted(then)) == truth
        assert is_true(bits, as_bits(now), as_bits(then)) == truth


def test_bits_that_stand_for_no_value_are_ruled_out_on_their_owner_s_side():
    made = in_bits(Contract("C", "", VARIABLES, (), ()))
    assert [one.name for one in made.variables if one.name.startswith("m_")] == ["m_0", "m_1"]
    ruled = {one.text: one.class_ for one in made.guarantees}
    assert ruled == {"'m' is at most 2.": Class.SAFETY, "'mode' is at most 2.": Class.SAFETY}
    assert made.assumptions == ()


def test_names_that_a_language_has_taken_get_an_underscore():
    made = renamed(Contract("C", "", VARIABLES, (), (busy("mode"),)), ("go", "mode", "busy"))
    names = [one.name for one in made.variables]
    assert names == ["go_", "n", "low", "done", "m", "mode_"]
    assert made.variables[-1].domain == EnumerationDomain(("idle", "busy_", "stop"))
    assert made.guarantees[0].formula == f.eq(Var("mode_"), Const("busy_"))


def busy(name):
    return Conjunct(f.eq(Var(name), Const("busy")), Class.INIT, "here")


def test_what_compares_too_many_values_is_named():
    domain = {name: IntegerDomain(0, 999) for name in "ab"}
    comparison = Apply(Op.LT, (Var("a"), Var("b")))
    with pytest.raises(TooManyValuesError):
        written_out(comparison, domain)
    assert written_out(comparison, domain, 1 << 20) is not None
