"""Evaluation of guards for sample values, to find overlaps and gaps of one decision.

Booleans and enumerations take every value. A number takes the constants that it is compared with,
their neighbours, and a few small numbers, so that the result is not a proof.
"""

import operator
from collections.abc import Callable, Iterator, Mapping
from itertools import product

from sysmlc.recipe.expression import Apply, Expr, Lit, Var, iter_variables
from sysmlc.recipe.model import EnumType, Scalar, ValueType

_MOST_VALUATIONS = 5000
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


class UndecidedError(ValueError):
    """A part of the expression has no value in the valuation."""


def is_condition(expression: Expr, types: Mapping[str, ValueType | None]) -> bool:
    """Return whether the expression is Boolean; an unknown type counts as Boolean."""
    match expression:
        case Lit(value):
            return isinstance(value, bool)
        case Var(name):
            return types.get(name) in ("boolean", None)
        case Apply(op, _):
            return op in (*_COMPARISONS, "and", "or", "not")
        case _:
            return True


def iter_valuations(
    guards: list[Expr], types: Mapping[str, ValueType | None]
) -> Iterator[dict[str, Scalar]]:
    """Iterate over sample valuations of the guards' variables; over none if there are too many."""
    names = sorted({name for guard in guards for name in iter_variables(guard)})
    domains = [_sample_domain(name, guards, types.get(name)) for name in names]
    size = 1
    for domain in domains:
        size *= len(domain)
    if size <= _MOST_VALUATIONS:
        for values in product(*domains):
            yield dict(zip(names, values, strict=True))


def is_satisfied(expression: Expr, values: Mapping[str, Scalar]) -> bool:
    """Return whether a condition is true. Raise UndecidedError."""
    return bool(_evaluate(expression, values))


def _evaluate(  # noqa: PLR0911 - one a kind
    expression: Expr, values: Mapping[str, Scalar]
) -> Scalar:
    match expression:
        case Lit(value):
            return value
        case Var(name) if name in values:
            return values[name]
        case Apply("and", (left, right)):
            return is_satisfied(left, values) and is_satisfied(right, values)
        case Apply("or", (left, right)):
            return is_satisfied(left, values) or is_satisfied(right, values)
        case Apply("not", (operand,)):
            return not is_satisfied(operand, values)
        case Apply("-", (operand,)):
            return _calculate("-", 0, _evaluate(operand, values))
        case Apply(op, (left, right)):
            return _calculate(op, _evaluate(left, values), _evaluate(right, values))
        case _:
            raise UndecidedError


def _calculate(op: str, *values: Scalar) -> Scalar:
    try:
        return _OPERATIONS[op](*values)
    except (TypeError, ZeroDivisionError, KeyError):
        raise UndecidedError from None


def _sample_domain(name: str, guards: list[Expr], type_: ValueType | None) -> list[Scalar]:
    if isinstance(type_, EnumType):
        return [*type_.literals]
    constants = [value for guard in guards for value in _iter_constants(name, guard)]
    texts = sorted({value for value in constants if isinstance(value, str)})
    if texts:
        # One text that is equal to none of the constants stands for all the others.
        return [*texts, "\x00other"]
    numeric = type_ in ("integer", "real") or any(_is_numeric(name, guard) for guard in guards)
    if not numeric:
        return [False, True]
    # Guards change their value at a constant: one value below, at and above each is enough.
    step = 1 if type_ == "integer" else 0.5
    numbers = {value for value in constants if isinstance(value, int | float)} | {0, 1, 2}
    return sorted({value + shift for value in numbers for shift in (-step, 0, step)})


def _iter_constants(name: str, expression: Expr) -> Iterator[Scalar]:
    """Iterate over the constants that a variable is compared with."""
    match expression:
        case Apply(op, (Var(variable), Lit(value)) | (Lit(value), Var(variable))) if (
            op in _COMPARISONS and variable == name
        ):
            yield value
        case Apply(_, args):
            for arg in args:
                yield from _iter_constants(name, arg)


def _is_numeric(name: str, expression: Expr) -> bool:
    match expression:
        case Apply(op, args):
            is_operand = op in _NUMERIC and Var(name) in args
            has_number = any(isinstance(a, Lit) and type(a.value) in (int, float) for a in args)
            is_compared = op in _COMPARISONS and Var(name) in args and has_number
            return is_operand or is_compared or any(_is_numeric(name, arg) for arg in args)
        case _:
            return False


def resolve_literals(expression: Expr, types: Mapping[str, ValueType | None]) -> Expr:
    """Return the expression with values in place of names of enumeration literals."""
    literals = {
        literal
        for type_ in types.values()
        if isinstance(type_, EnumType)
        for literal in type_.literals
    }
    match expression:
        case Var(name) if name not in types and _local_name(name) in literals:
            return Lit(_local_name(name))
        case Apply(op, args):
            return Apply(op, tuple(resolve_literals(arg, types) for arg in args))
        case _:
            return expression


def _local_name(name: str) -> str:
    return name.replace("::", ".").rpartition(".")[2]
