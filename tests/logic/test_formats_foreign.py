"""Texts for tools that are not here, SMV and CHASE, read by nothing of ours: Spot judges them.

The readers below know as much of the two languages as the texts have: LTL with the release of SMV
written ``V``, comparisons of a variable with a value, and the primes of CHASE.
"""

import re
from itertools import product

import pytest
import spot
from hypothesis import given, settings
from test_formats_spot import any_contracts, games, meaning

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


def of_smv(text, domains=()):
    """The formula of the only specification, with a proposition for each value."""
    (body,) = re.findall(r"^LTLSPEC NAME C := (.*);$", text, re.MULTILINE)
    body = re.sub(r"\bV\b", "R", body)
    return spot.formula(
        re.sub(rf"({TERM})\s*(!=|<=|>=|=|<|>)\s*({TERM})", meant(dict(domains)), body)
    )


def meant(domains):
    """What replaces a comparison: the values of its variables for which it holds."""

    def replaced(found):
        left, op, right = found.groups()
        names = [
            one for one in dict.fromkeys(re.findall(r"\w+", f"{left} {right}")) if one in domains
        ]
        rows = [
            " & ".join(f"{name}__{value}" for name, value in zip(names, row, strict=True))
            for row in product(*(values(domains[name]) for name in names))
            for known in [dict(zip(names, row, strict=True))]
            if OPERATORS[op](sum_of(left, known), sum_of(right, known))
        ]
        return "(" + (" | ".join(f"({row})" for row in rows) or "0") + ")"

    return replaced


def sum_of(term, known):
    first, *rest = re.findall(r"[+-]|\w+", term)
    total = value(first, known)
    for sign, word in zip(rest[::2], rest[1::2], strict=True):
        total += value(word, known) if sign == "+" else -value(word, known)
    return total


def value(word, known):
    return int(word) if word.isdigit() else known.get(word, word)


def of_chase(text):
    """Assumptions imply guarantees, a line each, primes as next steps."""
    _, assumed, promised = re.split(r"Assumptions:|Guarantees:", text)
    sides = [
        " & ".join(f"({line.strip().rstrip(';')})" for line in side.splitlines() if line.strip())
        for side in (assumed, promised)
    ]
    body = f"({sides[0] or '1'}) -> ({sides[1] or '1'})"
    return spot.formula(re.sub(r"(\w+)'", r"(X \1)", body))


@pytest.mark.parametrize(("form", "read"), [("smv", of_smv), ("chase", of_chase)])
@pytest.mark.parametrize("contracts", [games, any_contracts], ids=["games", "ltl"])
def test_others_read_what_the_contract_says(form, read, contracts):
    @given(contract=contracts)
    @settings(max_examples=examples(25), deadline=None)
    def judged(contract):
        assert spot.are_equivalent(meaning(contract), read(formats.write(contract, form)))

    judged()


MODE, LEVEL = EnumerationDomain(("red", "green")), IntegerDomain(0, 3)
VALUED = (
    Variable("m", Owner.ENVIRONMENT, MODE),
    Variable("x", Owner.SYSTEM, LEVEL),
    Variable("y", Owner.SYSTEM, LEVEL),
)
DOMAINS = {one.name: one.domain for one in VALUED}


def steps(formula):
    """The formula as the list of all pairs of steps in which it is true."""
    rows = []
    names = list(DOMAINS)
    for row in product(*(values(domain) for domain in (*DOMAINS.values(), *DOMAINS.values()))):
        now, after = dict(zip(names, row[:3], strict=True)), dict(zip(names, row[3:], strict=True))
        if value_of(formula, now, after):
            told = [f"{name}__{value}" for name, value in now.items()]
            told += [f"X {name}__{value}" for name, value in after.items()]
            rows.append("(" + " & ".join(told) + ")")
    return " | ".join(rows) or "0"


ONE_VALUE = " & ".join(
    "G (" + " | ".join(
        "(" + " & ".join(
            f"{'' if one == other else '!'}{name}__{other}" for other in values(domain)
        ) + ")"
        for one in values(domain)
    ) + ")"
    for name, domain in DOMAINS.items()
)  # fmt: skip
"""Every variable has exactly one value in each step."""


@pytest.mark.parametrize(
    "said",
    [
        "m=red & x<3 -> x'=x+1",
        "x'=y & m'!=m",
        "x>=2 | y'<=x",
        "x+y<=3",
        "x'!=y'",
    ],
)
def test_comparisons_of_values_are_written_out_for_smv(said):
    conjunct = Conjunct(parse_formula(said, DOMAINS), Class.SAFETY, "")
    contract = Contract("C", "", VALUED, (), (conjunct,))
    read = of_smv(formats.write(contract, "smv"), DOMAINS)
    listed = spot.formula(f"G ({steps(conjunct.formula)})")
    world = spot.formula(ONE_VALUE)
    assert spot.are_equivalent(spot.formula.And([world, read]), spot.formula.And([world, listed]))
