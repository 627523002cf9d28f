"""The parser of formulas accepts the same texts as grammars/ltl.lark, with the same result."""

from functools import cache

import pytest
from hypothesis import example, given, settings
from hypothesis import strategies as st
from lark import Lark, Tree
from lark.exceptions import UnexpectedInput

from long_runs import examples
from sysmlc.logic import formula as f
from sysmlc.logic.contract import BooleanDomain, IntegerDomain
from sysmlc.logic.formula import Apply, Const, Op, Var
from sysmlc.logic.infix import parse_formula
from sysmlc.logic.syntax import FormulaError, line_and_column
from sysmlc.support import resources

TEMPORAL = {"G": Op.ALWAYS, "[]": Op.ALWAYS, "F": Op.EVENTUALLY, "<>": Op.EVENTUALLY, "X": Op.NEXT}
UNTIL = {"U": Op.UNTIL, "R": Op.RELEASE, "V": Op.RELEASE, "W": Op.WEAK_UNTIL}
CONNECTIVES = {
    "negate": f.negate,
    "both": f.both,
    "either": f.either,
    "implies": f.implies,
    "iff": f.iff,
}
ATOMS = {
    "name": Var,
    "primed": lambda name: Var(name, primed=True),
    "integer": lambda digits: Const(int(digits)),
    "true": lambda _: f.TRUE,
    "false": lambda _: f.FALSE,
}


@cache
def create_parser():
    return Lark(
        resources.read_text("grammars", "ltl.lark"), parser="lalr", maybe_placeholders=False
    )


def parse_with_grammar(text):
    """Return the formula that Lark parses; literals of enumerations are variables.

    Raise lark's UnexpectedInput for a text that is not in the language.
    """
    (tree,) = (child for child in create_parser().parse(text).children if isinstance(child, Tree))
    return build_formula(tree)


def build_formula(tree):
    words = [str(child) for child in tree.children if isinstance(child, str)]
    if tree.data in ATOMS:
        return ATOMS[tree.data](*words)
    args = [build_formula(node) for node in tree.children if isinstance(node, Tree)]
    if tree.data in CONNECTIVES:
        return CONNECTIVES[tree.data](*args)
    word = words[0]
    op = TEMPORAL.get(word) or UNTIL.get(word) or Op("=" if word == "==" else word)
    return Apply(op, tuple(args))


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
        ("p & n", (1, 5), "'n' is not Boolean; compare it: 'n=9'"),
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
