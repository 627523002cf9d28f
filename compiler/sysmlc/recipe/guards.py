"""Whether guards of one decision overlap or leave a gap, found by trying values.

Not a proof for numbers: each variable takes the constants that it is compared with, their
neighbours, and a few small numbers; Booleans and enumerations take every value.
"""

import operator
from collections.abc import Callable, Iterator, Mapping
from itertools import product

from sysmlc.recipe.expression import Apply, Expr, Lit, Var, variables
from sysmlc.recipe.model import EnumType, Scalar, ValueType

_LIMIT = 5000
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
    """The expression has a part without a value here."""


def is_condition(expression: Expr, types: Mapping[str, ValueType | None]) -> bool:
    """Whether the expression can be true or false; what is unknown gets the benefit of doubt."""
    match expression:
        case Lit(value):
            return isinstance(value, bool)
        case Var(name):
            return types.get(name) in ("boolean", None)
        case Apply(op, _):
            return op in (*_COMPARISONS, "and", "or", "not")
        case _:
            return True


def valuations(
    guards: list[Expr], types: Mapping[str, ValueType | None]
) -> Iterator[dict[str, Scalar]]:
    """Values to try for the variables of the guards; none when there would be too many."""
    names = sorted({name for guard in guards for name in variables(guard)})
    domains = [_domain(name, guards, types.get(name)) for name in names]
    size = 1
    for domain in domains:
        size *= len(domain)
    if size <= _LIMIT:
        for values in product(*domains):
            yield dict(zip(names, values, strict=True))


def holds(expression: Expr, values: Mapping[str, Scalar]) -> bool:
    """Whether a condition is true. Raises UndecidedError."""
    return bool(_value(expression, values))


def _value(  # noqa: PLR0911 - one a kind
    expression: Expr, values: Mapping[str, Scalar]
) -> Scalar:
    match expression:
        case Lit(value):
            return value
        case Var(name) if name in values:
            return values[name]
        case Apply("and", (left, right)):
            return holds(left, values) and holds(right, values)
        case Apply("or", (left, right)):
            return holds(left, values) or holds(right, values)
        case Apply("not", (inner,)):
            return not holds(inner, values)
        case Apply("-", (inner,)):
            return _calculated("-", 0, _value(inner, values))
        case Apply(op, (left, right)):
            return _calculated(op, _value(left, values), _value(right, values))
        case _:
            raise UndecidedError


def _calculated(op: str, *values: Scalar) -> Scalar:
    try:
        return _OPERATIONS[op](*values)
    except (TypeError, ZeroDivisionError, KeyError):
        raise UndecidedError from None


def _domain(name: str, guards: list[Expr], type_: ValueType | None) -> list[Scalar]:
    if isinstance(type_, EnumType):
        return [*type_.literals]
    found = [value for guard in guards for value in _compared(name, guard)]
    texts = sorted({value for value in found if isinstance(value, str)})
    if texts:
        return [*texts, "\x00other"]
    numeric = type_ in ("integer", "real") or any(_is_numeric(name, guard) for guard in guards)
    if not numeric:
        return [False, True]
    step = 1 if type_ == "integer" else 0.5
    numbers = {value for value in found if isinstance(value, int | float)} | {0, 1, 2}
    return sorted({value + shift for value in numbers for shift in (-step, 0, step)})


def _compared(name: str, expression: Expr) -> Iterator[Scalar]:
    """Constants that a variable is compared with."""
    match expression:
        case Apply(op, (Var(found), Lit(value)) | (Lit(value), Var(found))) if (
            op in _COMPARISONS and found == name
        ):
            yield value
        case Apply(_, args):
            for arg in args:
                yield from _compared(name, arg)


def _is_numeric(name: str, expression: Expr) -> bool:
    match expression:
        case Apply(op, args):
            direct = op in _NUMERIC and Var(name) in args
            numbers = any(isinstance(a, Lit) and type(a.value) in (int, float) for a in args)
            compared = op in _COMPARISONS and Var(name) in args and numbers
            return direct or compared or any(_is_numeric(name, arg) for arg in args)
        case _:
            return False


def literals_as_values(expression: Expr, types: Mapping[str, ValueType | None]) -> Expr:
    """The expression with names of enumeration literals as their values."""
    known = {
        literal
        for type_ in types.values()
        if isinstance(type_, EnumType)
        for literal in type_.literals
    }
    match expression:
        case Var(name) if name not in types and _last(name) in known:
            return Lit(_last(name))
        case Apply(op, args):
            return Apply(op, tuple(literals_as_values(arg, types) for arg in args))
        case _:
            return expression


def _last(name: str) -> str:
    return name.replace("::", ".").rpartition(".")[2]
