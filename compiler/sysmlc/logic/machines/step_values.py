"""Values of expressions for the reference interpreter, straight from what is written.

Independent of ``elaborate`` and ``evaluate``, which the derivation uses.
"""

from collections.abc import Callable, Mapping

from sysmlc.logic.expressions.expression import (
    Binary,
    Conditional,
    Expression,
    Member,
    Name,
    Unary,
    name_of,
)
from sysmlc.logic.expressions.expression import Literal as Written
from sysmlc.logic.formula import Const, Literal, Var
from sysmlc.logic.machines.machine import Machine


def value_of(machine: Machine, expression: Expression, store: Mapping[str, Literal]) -> Literal:
    """Value of an expression with these values of the variables.

    Integers divide towards zero; x / 0 is 0 and x % 0 is x.
    """
    match expression:
        case Written(value):
            return value if isinstance(value, bool | int | str) else 0
        case Name() | Member():
            return _named(machine, expression, store)
        case Unary(op, operand):
            inner = value_of(machine, operand, store)
            return not inner if op == "not" else int(inner) * (-1 if op == "-" else 1)
        case Conditional(condition, then, otherwise):
            branch = then if value_of(machine, condition, store) else otherwise
            return value_of(machine, branch, store)
        case Binary(op, left, right):
            return _OPERATIONS[op](value_of(machine, left, store), value_of(machine, right, store))
        case _:
            raise TypeError(f"{expression} has no finite value")


def _named(machine: Machine, name: Name | Member, store: Mapping[str, Literal]) -> Literal:
    written = name_of(name) or ""
    symbol = machine.scope(written)
    match None if symbol is None else symbol.formula:
        case Var(variable):
            return store[variable]
        case Const(value):
            return value
        case _:
            return written.replace(".", "::").rpartition("::")[2]


def _quotient(left: int, right: int) -> int:
    if right == 0:
        return 0
    sign = 1 if (left < 0) == (right < 0) else -1
    return sign * (abs(left) // abs(right))


_OPERATIONS: dict[str, Callable[..., Literal]] = {
    "and": lambda a, b: a and b,
    "or": lambda a, b: a or b,
    "xor": lambda a, b: a != b,
    "implies": lambda a, b: not a or b,
    "==": lambda a, b: a == b,
    "!=": lambda a, b: a != b,
    "<": lambda a, b: a < b,
    "<=": lambda a, b: a <= b,
    ">": lambda a, b: a > b,
    ">=": lambda a, b: a >= b,
    "+": lambda a, b: a + b,
    "-": lambda a, b: a - b,
    "*": lambda a, b: a * b,
    "/": _quotient,
    "%": lambda a, b: a - b * _quotient(a, b),
}
