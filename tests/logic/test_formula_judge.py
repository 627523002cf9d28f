"""The parser of formulas accepts the same texts as grammars/ltl.lark, with the same result."""

import pytest
from hypothesis import example, given, settings
from hypothesis import strategies as st
from lark.exceptions import UnexpectedInput
from ltl_judge import parse_with_grammar

from long_runs import examples
from sysmlc.logic.contract import BooleanDomain, IntegerDomain
from sysmlc.logic.infix import parse_formula
from sysmlc.logic.syntax import FormulaError, line_and_column

BOOLEANS = ("p", "q", "r'", "true", "false")
SIGNS = ("&", "&&", "|", "||", "->", "<->", "!", "(", ")", "G", "F", "X", "[]", "<>", "U", "W", "V")
NUMBERS = ("n=1", "n<m + 2", "n' != -1", "m*2 >= n - 1", "{n==3}", "n mod 2=0", "=", "+", "n")
DOMAINS = {name: BooleanDomain() for name in "pqr"} | {n: IntegerDomain(0, 9) for n in "nm"}

SEMANTIC_FAULTS = ("is not Boolean", "is not a number", "be compared", "neither a variable")
"""Faults beyond the grammar: wrong kinds of values, and unknown names."""


@given(st.lists(st.sampled_from((*BOOLEANS, *BOOLEANS, *SIGNS, *NUMBERS)), min_size=1, max_size=9))
@example(["p", "=", "G"])
@settings(max_examples=examples(1500), deadline=None)
def test_the_parser_agrees_with_the_grammar(words):
    text = " ".join(words)
    try:
        expected = parse_with_grammar(text)
    except UnexpectedInput:
        with pytest.raises(FormulaError):
            parse_formula(text, DOMAINS)
        return
    try:
        assert parse_formula(text, DOMAINS) == expected
    except FormulaError as error:
        assert any(reason in str(error) for reason in SEMANTIC_FAULTS), str(error)  # noqa: PT017


@pytest.mark.parametrize(
    ("text", "location", "reason"),
    [
        ("p &", (1, 4), "the end is not expected here"),
        ("p ->\n  (q &\n   nn=1)", (3, 4), "'nn' is neither a variable nor a literal"),
        ("p & n", (1, 5), "'n' is not Boolean"),
        ("p & (q | r", (1, 11), "')' is expected, not the end"),
        ("n=p", (1, 2), "'n' and 'p' cannot be compared"),
        ("p q", (1, 3), "'q' is not expected here"),
        ("p + 1 = n", (1, 1), "'p' is not a number"),
        ("!" * 300 + "p", (1, 201), "it is nested more than 200 deep"),
        ("n = " + "9" * 40, (1, 5), "a number has at most 18 digits"),
    ],
)
def test_a_fault_has_its_location(text, location, reason):
    with pytest.raises(FormulaError) as caught:
        parse_formula(text, DOMAINS)
    assert (line_and_column(text, caught.value.offset), str(caught.value)) == (location, reason)


def test_a_variable_may_have_the_name_of_an_operator():
    domains = {"X": IntegerDomain(0, 3), "U": BooleanDomain(), "p": BooleanDomain()}
    assert str(parse_formula("X = 3 -> X X=1 & U", domains)) == str(
        parse_formula("(X=3) -> ((X (X=1)) & (U))", domains)
    )


def test_a_chain_of_5000_operands_is_parsed():
    text = " & ".join(["(p | q)"] * 5_000)
    assert parse_formula(text, DOMAINS) == parse_formula("p | q", DOMAINS)
