"""Symbols: what names in expressions denote, and why an expression has no formula."""

from collections.abc import Callable
from enum import StrEnum

from msgspec import Struct

from sysmlc.ir.expressions import (
    Expression,
    Statement,
    element_of,
    name_of,
    print_expression,
)
from sysmlc.logic import domains
from sysmlc.logic import formula as f
from sysmlc.logic.contract import BooleanDomain, Domain, EnumerationDomain, IntegerDomain
from sysmlc.logic.expressions.linear import Number
from sysmlc.logic.formula import Formula
from sysmlc.logic.regions import Term


class Fault(StrEnum):
    """Why an expression has no formula."""

    UNKNOWN = "unknown name"
    TYPE = "type mismatch"
    OUTSIDE = "out of domain"
    UNSUPPORTED = "not supported"


class ElaborationError(ValueError):
    """An expression has no formula; ``name`` is the name or value at fault, with its element."""

    def __init__(self, fault: Fault, message: str, name: str, element: str = "") -> None:
        super().__init__(message)
        self.fault = fault
        self.name = name
        self.element = element


class Case(Struct, frozen=True):
    """A value, and the condition under which an expression has it."""

    condition: Formula
    value: Formula


class GuardedValue(Struct, frozen=True):
    """The value of an expression as cases; exactly one of their conditions holds in each step."""

    cases: tuple[Case, ...]
    domain: Domain

    def as_formula(self) -> Formula:
        """Return the formula of a Boolean value."""
        if len(self.cases) == 1:
            return self.cases[0].value
        return f.either(*(f.both(case.condition, case.value) for case in self.cases))


class Symbol(Struct, frozen=True):
    """The formula and the domain of a name; ``number`` if an enumeration literal stands for one."""

    formula: Formula
    domain: Domain | None
    number: int | None = None
    has_several_values: bool = False
    quantity: Number | None = None
    """The number that the name stands for in sums and comparisons, if any."""
    term: Term = ()
    """The sum of variables whose region the name stands for, if any."""


Scope = Callable[[str, str], Symbol | None]
"""Looks up a name and the id of its element, which may be empty; None if they are unknown."""


def make_value(formula: Formula, domain: Domain) -> GuardedValue:
    """Return the value of an expression that has one case."""
    return GuardedValue((Case(f.TRUE, formula),), domain)


def find_symbol(expression: Expression | Statement, scope: Scope) -> Symbol | None:
    """Return the symbol of a name or of a chain of features; None for any other expression."""
    name = name_of(expression)
    return scope(name, element_of(expression)) if name else None


def describe_kind(domain: Domain) -> str:
    """Return what the values of a domain are, for messages."""
    match domain:
        case BooleanDomain():
            return "a condition"
        case IntegerDomain():
            return "a number"
        case EnumerationDomain():
            return f"one of {domains.describe(domain)}"


def mismatch(expression: Expression, expected: str, actual: Domain) -> ElaborationError:
    """Return the error about an expression that has values of another kind than expected."""
    text = print_expression(expression)
    if isinstance(actual, EnumerationDomain) and actual.regions is not None:
        reason = f"'{text}' is a number, and only comparisons of sums of numbers have a formula"
        return ElaborationError(Fault.UNSUPPORTED, reason, text)
    message = f"'{text}' is {describe_kind(actual)}, not {expected}"
    return ElaborationError(Fault.TYPE, message, text)
