"""The meaning of SPIN texts, computed with Spot without the printer's code.

The oracle encodes every variable in bits, and every comparison and every proposition of the text,
such as ``{x<y + 1}``, as the disjunction of the values for which it is true. Spot then decides
whether text and formula are equivalent where the axioms hold.
"""

import re
from itertools import product

import pytest

from sysmlc.logic.domains import values
from sysmlc.logic.formula import Apply, Const, Op, Var, variables

spot = pytest.importorskip("spot")

CONNECTIVES = {Op.AND: " & ", Op.OR: " | ", Op.IMPLIES: " -> ", Op.IFF: " <-> "}
OPERATIONS = {
    Op.EQ: lambda left, right: left == right,
    Op.NE: lambda left, right: left != right,
    Op.LT: lambda left, right: left < right,
    Op.LE: lambda left, right: left <= right,
    Op.GT: lambda left, right: left > right,
    Op.GE: lambda left, right: left >= right,
    Op.ADD: lambda left, right: left + right,
    Op.SUB: lambda left, right: left - right,
    Op.MUL: lambda left, right: left * right,
}


def parse_leniently(text):
    """Parse with Spot, whose lenient mode reads braces as propositions."""
    parsed = spot.parse_infix_psl(text, spot.default_environment.instance(), False, True)
    assert not parsed.errors, text
    return parsed.f


def read_text(text, domains):
    """Parse with Spot; the proposition in each pair of braces becomes its truth table over bits."""
    parse_leniently(text)
    return parse_leniently(re.sub(r"\{(.*?)\}", lambda match: tabulate(match[1], domains), text))


def tabulate(proposition, domains):
    """Return the truth table of a C expression. Names without values are literals."""
    words = re.findall(r"[^\W\d]\w*", proposition)
    names = sorted({word for word in words if word in domains})
    rows = []
    for row in product(*(values(domains[name]) for name in names)):
        meanings = {word: word for word in words} | dict(zip(names, row, strict=True))
        if eval(proposition, {}, meanings):
            codes = (encode_value(domains, *pair) for pair in zip(names, row, strict=True))
            rows.append(f"({' & '.join(codes) or '1'})")
    return f"({' | '.join(rows) or '0'})"


def list_domains(contract):
    return {variable.name: variable.domain for variable in contract.variables}


def list_names(formula):
    """Return the names of the variables in the order of the formula."""
    return dict.fromkeys(variable.name for variable in variables(formula))


def encode_value(domains, name, value):
    """Return the conjunction of bits that encodes a value of a variable."""
    domain_values = values(domains[name])
    index = domain_values.index(value)
    width = max(1, (len(domain_values) - 1).bit_length())
    return " & ".join(f'{"" if index >> bit & 1 else "!"}"{name}.{bit}"' for bit in range(width))


def write_axioms(domains, names):
    """Return that the bits of each variable encode a value; ``p`` is the bit of a Boolean."""
    axioms = []
    for name in sorted(names):
        codes = [f"({encode_value(domains, name, value)})" for value in values(domains[name])]
        axioms.append(f"({' | '.join(codes)})")
        if values(domains[name]) == (False, True) and re.match("[a-z_]", name):
            axioms.append(f'("{name}" <-> {codes[1]})')
    return " & ".join(axioms) or "1"


def write_step_axioms(domains, names):
    """Return the axioms for a state and the next one, as a formula of Spot."""
    axioms = write_axioms(domains, names)
    return spot.formula(f"({axioms}) & X({axioms})")


def translate(domains, formula):
    """Return the formula over bits: connectives stay, comparisons become truth tables."""
    if isinstance(formula, Const):
        return "1" if formula.value else "0"
    if isinstance(formula, Var):
        text = f"({encode_value(domains, formula.name, True)})"
        return f"X{text}" if formula.primed else text
    if formula.op in OPERATIONS:
        return f"({write_truth_table(domains, formula)})"
    operands = [f"({translate(domains, operand)})" for operand in formula.args]
    if formula.op is Op.NOT:
        return f"!{operands[0]}"
    return CONNECTIVES[formula.op].join(operands)


def write_truth_table(domains, comparison):
    """Return the valuations that satisfy a comparison as a disjunction."""
    names = sorted({(variable.name, variable.primed) for variable in variables(comparison)})
    rows = []
    for row in product(*(values(domains[name]) for name, _ in names)):
        valuation = dict(zip(names, row, strict=True))
        if evaluate(comparison, valuation):
            codes = [
                f"{'X' if primed else ''}({encode_value(domains, name, value)})"
                for (name, primed), value in valuation.items()
            ]
            rows.append(" & ".join(codes) or "1")
    return " | ".join(f"({row})" for row in rows) or "0"


def evaluate(term, valuation):
    """Return the value of a comparison, a sum, a product, a variable or a constant."""
    match term:
        case Const(value):
            return value
        case Var(name, primed):
            return valuation[name, primed]
        case Apply(op, (left, right)):
            return OPERATIONS[op](evaluate(left, valuation), evaluate(right, valuation))
