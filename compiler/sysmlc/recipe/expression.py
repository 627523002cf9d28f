"""Expressions of recipes: those of ``ir.expressions`` in the normal form of the JSON schema.

A name has one segment, which may contain dots (``belt.places``). The operators are
+ - * / mod == != < <= > >= and or not.

Guards are evaluated for sample values, to find overlaps and gaps of one decision. Booleans and
enumerations take every value. A number takes the constants that it is compared with, their
neighbours, and a few small numbers, so that the result is not a proof.
"""

import operator
from collections.abc import Callable, Iterator, Mapping
from dataclasses import dataclass
from itertools import product

from sysmlc.ir.expressions import (
    Binary,
    Call,
    Expression,
    Index,
    Literal,
    Name,
    Unary,
    last_name,
)
from sysmlc.recipe.model import EnumType, Scalar, ValueType


@dataclass(frozen=True, slots=True)
class Opaque(Name):
    """Text outside the expression grammar, for human readers; executors cannot evaluate it."""


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
    """Return the operands of an operator, the parts of an index, or the arguments of a call."""
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
    """Return the expression with *change* applied to each of its operands."""
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
    """Yield the names of the variables, with repetitions, from left to right."""
    name = variable_name(expression)
    if name is not None:
        yield name
    for operand in operands(expression):
        yield from iter_variables(operand)


def iter_opaque_texts(expression: Expression) -> Iterator[str]:
    """Yield the texts in an expression that the grammar does not cover."""
    if isinstance(expression, Opaque):
        yield expression.path[0]
    for operand in operands(expression):
        yield from iter_opaque_texts(operand)


# -- evaluation of guards ----------------------------------------------------------------------

ANOTHER_TEXT = "\x00"
"""Sample value that stands for all texts with which no guard compares the variable."""
_MOST_VALUATIONS = 5000
"""Most combinations of sample values for one decision."""
_COMPARISONS = ("==", "!=", "<", "<=", ">", ">=")
_NUMERIC = (*"+-*/", "mod", "<", "<=", ">", ">=")
_OPERATIONS: dict[str, Callable[..., Scalar]] = {
    "+": operator.add,
    "-": operator.sub,
    "*": operator.mul,
    "/": operator.truediv,
    "mod": operator.mod,
    "==": operator.eq,
    "!=": operator.ne,
    "<": operator.lt,
    "<=": operator.le,
    ">": operator.gt,
    ">=": operator.ge,
}


def is_condition(expression: Expression, types: Mapping[str, ValueType | None]) -> bool:
    """Whether the expression is Boolean; an unknown type counts as Boolean."""
    name = variable_name(expression)
    if name is not None:
        return types.get(name) in ("boolean", None)
    match expression:
        case Literal(value):
            return isinstance(value, bool)
        case Unary(op, _) | Binary(op, _, _):
            return op in (*_COMPARISONS, "and", "or", "not")
        case _:
            return True


def iter_valuations(
    guards: list[Expression], types: Mapping[str, ValueType | None]
) -> Iterator[dict[str, Scalar]]:
    """Yield the combinations of sample values of all variables; none if there are too many."""
    names = sorted({name for guard in guards for name in iter_variables(guard)})
    domains = [_sample_domain(name, guards, types.get(name)) for name in names]
    size = 1
    for domain in domains:
        size *= len(domain)
    if size <= _MOST_VALUATIONS:
        for values in product(*domains):
            yield dict(zip(names, values, strict=True))


def evaluate(  # noqa: PLR0911 - one for each kind
    expression: Expression, values: Mapping[str, Scalar]
) -> Scalar | None:
    """Return the value of an expression, or None if the known values do not determine it."""
    name = variable_name(expression)
    if name is not None:
        return values.get(name)
    match expression:
        case Literal(value):
            return value
        case Unary("not", operand):
            truth = evaluate(operand, values)
            return None if truth is None else not truth
        case Unary("-", operand):
            return _calculate("-", 0, evaluate(operand, values))
        case Binary("and" | "or" as op, left, right):
            truths = [evaluate(operand, values) for operand in (left, right)]
            # One operand is enough if it is true in a disjunction, or false in a conjunction.
            if any(truth is not None and bool(truth) is (op == "or") for truth in truths):
                return op == "or"
            return None if None in truths else op == "and"
        case Binary(op, left, right):
            return _calculate(op, evaluate(left, values), evaluate(right, values))
        case _:
            return None


def _calculate(op: str, left: Scalar | None, right: Scalar | None) -> Scalar | None:
    if left is None or right is None:
        return None
    try:
        return _OPERATIONS[op](left, right)
    except (TypeError, ZeroDivisionError, KeyError):
        return None


def _sample_domain(name: str, guards: list[Expression], type_: ValueType | None) -> list[Scalar]:
    if isinstance(type_, EnumType):
        return [*type_.literals]
    constants = [value for guard in guards for value in _iter_constants(name, guard)]
    texts = sorted({value for value in constants if isinstance(value, str)})
    if texts:
        return [*texts, ANOTHER_TEXT]
    is_number = type_ in ("integer", "real") or any(_is_numeric(name, guard) for guard in guards)
    if not is_number:
        return [False, True]
    # Guards change their value at a constant: one value below, at and above each is enough.
    step = 1 if type_ == "integer" else 0.5
    numbers = {value for value in constants if isinstance(value, int | float)} | {0, 1, 2}
    return sorted({value + shift for value in numbers for shift in (-step, 0, step)})


def _iter_constants(name: str, expression: Expression) -> Iterator[Scalar]:
    """Yield the constants that a variable is compared with."""
    constant = _compared_constant(name, expression)
    if constant is not None:
        yield constant.value
        return
    for operand in _operands_of_operator(expression):
        yield from _iter_constants(name, operand)


def _compared_constant(name: str, expression: Expression) -> Literal | None:
    match expression:
        case Binary(op, left, right) if op in _COMPARISONS:
            if variable_name(left) == name and isinstance(right, Literal):
                return right
            if variable_name(right) == name and isinstance(left, Literal):
                return left
    return None


def _operands_of_operator(expression: Expression) -> tuple[Expression, ...]:
    return operands(expression) if isinstance(expression, Unary | Binary) else ()


def _is_numeric(name: str, expression: Expression) -> bool:
    """Whether the variable is an operand of arithmetic or is compared with a number."""
    if not isinstance(expression, Unary | Binary):
        return False
    inner = operands(expression)
    if any(variable_name(operand) == name for operand in inner):
        has_number = any(
            isinstance(operand, Literal) and type(operand.value) in (int, float)
            for operand in inner
        )
        if expression.op in _NUMERIC or (expression.op in _COMPARISONS and has_number):
            return True
    return any(_is_numeric(name, operand) for operand in inner)


def resolve_literals(expression: Expression, types: Mapping[str, ValueType | None]) -> Expression:
    """Return the expression with each name of an enumeration literal replaced by its value."""
    literals = {
        literal
        for type_ in types.values()
        if isinstance(type_, EnumType)
        for literal in type_.literals
    }
    name = variable_name(expression)
    if name is not None and name not in types and last_name(name) in literals:
        return Literal(last_name(name))
    if isinstance(expression, Unary | Binary):
        return map_operands(expression, lambda operand: resolve_literals(operand, types))
    return expression
