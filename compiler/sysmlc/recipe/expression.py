"""Expressions of recipes: those of ``logic.expressions`` in the normal form of the JSON schema.

A name has one segment, which may contain dots (``belt.places``). The operators are
+ - * / mod == != < <= > >= and or not.
"""

from collections.abc import Callable, Iterator
from dataclasses import dataclass

from sysmlc.logic.expressions.expression import (
    Binary,
    Call,
    Expression,
    Index,
    Literal,
    Name,
    Unary,
)


@dataclass(frozen=True, slots=True)
class Opaque(Name):
    """Text outside the expression grammar, for people; executors cannot evaluate it."""


def make_variable(name: str) -> Name:
    """Return the expression for a parameter or variable, or for a feature of one."""
    return Name((name,))


def make_opaque(text: str) -> Opaque:
    """Return the expression for a text outside the grammar."""
    return Opaque((text,))


def variable_name(expression: Expression) -> str | None:
    """Return the name of a variable; None for any other expression."""
    if isinstance(expression, Name) and not isinstance(expression, Opaque):
        return expression.path[0]
    return None


def negation(expression: Expression) -> Expression:
    """Return the negation of a condition."""
    match expression:
        case Unary("not", operand):
            return operand
        case Literal(bool(value)):
            return Literal(not value)
        case _:
            return Unary("not", expression)


def disjunction(expressions: tuple[Expression, ...]) -> Expression:
    """Return the disjunction of conditions; false for none."""
    if not expressions:
        return Literal(False)
    result = expressions[0]
    for expression in expressions[1:]:
        result = Binary("or", result, expression)
    return result


def operands(expression: Expression) -> tuple[Expression, ...]:
    """Return the operands of an operator, an index or a call; none for other expressions."""
    match expression:
        case Unary(_, operand):
            return (operand,)
        case Binary(_, left, right):
            return (left, right)
        case Index(base, index):
            return (base, index)
        case Call(_, args):
            return args
        case _:
            return ()


def map_operands(expression: Expression, change: Callable[[Expression], Expression]) -> Expression:
    """Return the expression with changed operands."""
    match expression:
        case Unary(op, operand):
            return Unary(op, change(operand))
        case Binary(op, left, right):
            return Binary(op, change(left), change(right))
        case Index(base, index):
            return Index(change(base), change(index))
        case Call(function, args):
            return Call(function, tuple(map(change, args)))
        case _:
            return expression


def iter_variables(expression: Expression) -> Iterator[str]:
    """Iterate over the names of the variables, with repetitions, from left to right."""
    name = variable_name(expression)
    if name is not None:
        yield name
    for operand in operands(expression):
        yield from iter_variables(operand)


def iter_opaque_texts(expression: Expression) -> Iterator[str]:
    """Iterate over the texts in an expression that the grammar does not cover."""
    if isinstance(expression, Opaque):
        yield expression.path[0]
    for operand in operands(expression):
        yield from iter_opaque_texts(operand)
