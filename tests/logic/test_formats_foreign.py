"""Spot judges texts for SMV and CHASE, which are not installed, without the readers of sysmlc.

The readers below know what the texts use of the two languages: LTL with ``V`` for the release of
SMV, comparisons of a variable with a value, and the primes of CHASE.
"""

import re
from itertools import product

import pytest
import spot
from hypothesis import given, settings
from test_formats_spot import any_contracts, games, translate

from long_runs import examples
from sysmlc.logic import formats
from sysmlc.logic.contract import (
    Class,
    Conjunct,
    Contract,
    EnumerationDomain,
    IntegerDomain,
    Owner,
    Variable,
)
from sysmlc.logic.domains import values
from sysmlc.logic.evaluate import value_of
from sysmlc.logic.infix import parse_formula

OPERATORS = {
    "=": lambda a, b: a == b,
    "!=": lambda a, b: a != b,
    "<": lambda a, b: a < b,
    "<=": lambda a, b: a <= b,
    ">": lambda a, b: a > b,
    ">=": lambda a, b: a >= b,
}


TERM = r"\w+(?:\s*[+-]\s*\w+)*"


def read_smv(text, domains=()):
    """Return the formula of the only specification, with a proposition for each value."""
    (body,) = re.findall(r"^LTLSPEC NAME C := (.*);$", text, re.MULTILINE)
    body = re.sub(r"\bV\b", "R", body)
    return spot.formula(
        re.sub(rf"({TERM})\s*(!=|<=|>=|=|<|>)\s*({TERM})", expand_with(dict(domains)), body)
    )


def expand_with(domains):
    """Return a function that replaces a comparison by the valuations for which it holds."""

    def expand(comparison):
        left, op, right = comparison.groups()
        words = dict.fromkeys(re.findall(r"\w+", f"{left} {right}"))
        names = [word for word in words if word in domains]
        cases = []
        for row in product(*(values(domains[name]) for name in names)):
            valuation = dict(zip(names, row, strict=True))
            if OPERATORS[op](evaluate_sum(left, valuation), evaluate_sum(right, valuation)):
                cases.append(" & ".join(f"{name}__{value}" for name, value in valuation.items()))
        return "(" + (" | ".join(f"({case})" for case in cases) or "0") + ")"

    return expand


def evaluate_sum(term, valuation):
    first, *rest = re.findall(r"[+-]|\w+", term)
    total = evaluate_word(first, valuation)
    for sign, word in zip(rest[::2], rest[1::2], strict=True):
        value = evaluate_word(word, valuation)
        total += value if sign == "+" else -value
    return total


def evaluate_word(word, valuation):
    return int(word) if word.isdigit() else valuation.get(word, word)


def read_chase(text):
    """Return that the assumptions imply the guarantees, one a line, with X for primes."""
    _, assumptions, guarantees = re.split(r"Assumptions:|Guarantees:", text)
    sides = [
        " & ".join(f"({line.strip().rstrip(';')})" for line in side.splitlines() if line.strip())
        for side in (assumptions, guarantees)
    ]
    body = f"({sides[0] or '1'}) -> ({sides[1] or '1'})"
    return spot.formula(re.sub(r"(\w+)'", r"(X \1)", body))


@pytest.mark.parametrize(("format_name", "read"), [("smv", read_smv), ("chase", read_chase)])
@pytest.mark.parametrize("contracts", [games, any_contracts], ids=["games", "ltl"])
def test_the_text_means_the_same_as_the_contract(format_name, read, contracts):
    @given(contract=contracts)
    @settings(max_examples=examples(25), deadline=None)
    def judge(contract):
        text = formats.write(contract, format_name)
        assert spot.are_equivalent(translate(contract), read(text))

    judge()


MODE, LEVEL = EnumerationDomain(("red", "green")), IntegerDomain(0, 3)
VALUED = (
    Variable("m", Owner.ENVIRONMENT, MODE),
    Variable("x", Owner.SYSTEM, LEVEL),
    Variable("y", Owner.SYSTEM, LEVEL),
)
DOMAINS = {variable.name: variable.domain for variable in VALUED}


def list_steps(formula):
    """Return the disjunction of all pairs of steps in which the formula is true."""
    cases = []
    names = list(DOMAINS)
    for row in product(*(values(domain) for domain in (*DOMAINS.values(), *DOMAINS.values()))):
        before = dict(zip(names, row[:3], strict=True))
        after = dict(zip(names, row[3:], strict=True))
        if value_of(formula, before, after):
            propositions = [f"{name}__{value}" for name, value in before.items()]
            propositions += [f"X {name}__{value}" for name, value in after.items()]
            cases.append("(" + " & ".join(propositions) + ")")
    return " | ".join(cases) or "0"


ONE_VALUE = " & ".join(
    "G (" + " | ".join(
        "(" + " & ".join(
            f"{'' if value == chosen else '!'}{name}__{value}" for value in values(domain)
        ) + ")"
        for chosen in values(domain)
    ) + ")"
    for name, domain in DOMAINS.items()
)  # fmt: skip
"""Every variable has exactly one value in each step."""


@pytest.mark.parametrize(
    "text",
    [
        "m=red & x<3 -> x'=x+1",
        "x'=y & m'!=m",
        "x>=2 | y'<=x",
        "x+y<=3",
        "x'!=y'",
    ],
)
def test_comparisons_of_values_are_expanded_for_smv(text):
    conjunct = Conjunct(parse_formula(text, DOMAINS), Class.SAFETY, "")
    contract = Contract("C", "", VALUED, (), (conjunct,))
    read = read_smv(formats.write(contract, "smv"), DOMAINS)
    expected = spot.formula(f"G ({list_steps(conjunct.formula)})")
    world = spot.formula(ONE_VALUE)
    assert spot.are_equivalent(spot.formula.And([world, read]), spot.formula.And([world, expected]))
