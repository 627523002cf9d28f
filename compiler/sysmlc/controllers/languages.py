"""Formulas about one or two steps as expressions of programming languages."""

import sys
from collections.abc import Callable, Mapping
from fractions import Fraction

from msgspec import Struct

from sysmlc.logic.formula import Apply, Const, Formula, Literal, Op, Var
from sysmlc.logic.regions import Term
from sysmlc.support.program_text import quote_python


class Language(Struct, frozen=True):
    """How a programming language spells the parts of an expression."""

    negation: str
    conjunction: str
    disjunction: str
    print_constant: Callable[[Literal], str]
    print_variable: Callable[[str, str], str]
    """Prints a step, ``before`` or ``now``, and the name of a variable."""


_OPERATORS = {
    Op.IFF: "({0} == {1})",
    Op.EQ: "({0} == {1})",
    Op.NE: "({0} != {1})",
    # The model divides towards zero, x / 0 is 0, and x mod 0 is x (logic.evaluate).
    Op.DIV: "divide({0}, {1})",
    Op.MOD: "({0} - {1} * divide({0}, {1}))",
}
"""Operators that C and Python spell differently from formulas, but in the same way."""


def make_c_language(fields: Mapping[str, str], constants: Mapping[str, str]) -> Language:
    def print_constant(value: Literal) -> str:
        if isinstance(value, str):
            return constants[value]
        return str(value).lower() if isinstance(value, bool) else f"{value}L"

    return Language(
        "!", " && ", " || ", print_constant, lambda step, name: f"{step}->{fields[name]}"
    )


def print_c_number(number: Fraction, *, is_integral: bool = False) -> str:
    """Return a number as a double, the nearest one, or as an Integer if it *is_integral*."""
    if is_integral and number.denominator == 1 and abs(number) <= _MAX_LONG:
        return f"{number}L"
    return repr(round_to_double(number))


def round_to_double(number: Fraction) -> float:
    """Return the nearest finite double."""
    return float(max(-_MAX_DOUBLE, min(_MAX_DOUBLE, number)))


_MAX_LONG = 2**63 - 1
"""The largest Integer in programs of C99; one that is no ``long`` is read as ``long long``."""
_MAX_DOUBLE = Fraction(sys.float_info.max)


def print_python_number(number: Fraction) -> str:
    """Return a number as an exact number of Python."""
    if number.denominator == 1:
        return str(number)
    return f"Fraction({number.numerator}, {number.denominator})"


def _print_python_constant(value: Literal) -> str:
    return quote_python(value) if isinstance(value, str) else str(value)


PYTHON = Language(
    "not ",
    " and ",
    " or ",
    _print_python_constant,
    lambda step, name: f"{step}[{quote_python(name)}]",
)


def print_expression(formula: Formula, language: Language, is_about_two_steps: bool) -> str:
    """Return a formula without temporal operators as an expression in parentheses.

    If it *is_about_two_steps*, variables without primes have the values of the step before.
    """

    def print_part(part: Formula) -> str:
        match part:
            case Const(value):
                return language.print_constant(value)
            case Var(name, primed):
                is_past = is_about_two_steps and not primed
                return language.print_variable("before" if is_past else "now", name)
            case Apply(op, args):
                return _join_operands(op, [print_part(arg) for arg in args], language)

    return print_part(formula)


def print_sum(term: Term, language: Language, print_number: Callable[[Fraction], str]) -> str:
    """Return a sum of the numbers in ``values`` as an expression."""
    text = ""
    for name, factor in term:
        operand = language.print_variable("values", name)
        if abs(factor) != 1:
            operand = f"{print_number(abs(factor))} * {operand}"
        sign = "-" if factor < 0 else "+"
        text = f"{text} {sign} {operand}" if text else operand
    return text


def _join_operands(op: Op, operands: list[str], language: Language) -> str:
    match op:
        case Op.NOT:
            return f"({language.negation}{operands[0]})"
        case Op.AND:
            return f"({language.conjunction.join(operands)})"
        case Op.OR:
            return f"({language.disjunction.join(operands)})"
        case Op.IMPLIES:
            return f"(({language.negation}{operands[0]}){language.disjunction}{operands[1]})"
        case _:
            return _OPERATORS.get(op, f"({{0}} {op} {{1}})").format(*operands)
