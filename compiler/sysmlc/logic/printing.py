"""Formulas as text in the neutral form of corpus/gr1, extended by the operators of LTL.

``infix.parse_formula`` reads what this module prints. Writers of other formats print formulas with
``formats.writing.Notation``.
"""

from functools import lru_cache

from sysmlc.logic.formula import Apply, Const, Formula, Literal, Op, Var
from sysmlc.logic.syntax import COMPARISONS, PRECEDENCE, RIGHT_ASSOCIATIVE

_PREFIX = (Op.NOT, Op.NEXT, Op.ALWAYS, Op.EVENTUALLY, Op.PREVIOUS, Op.ONCE, Op.HISTORICALLY)
_LEFT_ASSOCIATIVE = (Op.IFF, Op.ADD, Op.SUB, Op.MUL, Op.DIV, Op.MOD)
_CACHED_TEXTS = 1 << 14
"""Cache size: JSON and Markdown show the same formulas, and machines of one kind share them."""


def print_formula(formula: Formula) -> str:
    """Return the formula with primes for next values and without superfluous parentheses."""
    return _print(formula, 0)


def print_literal(value: Literal) -> str:
    """Return a value as formulas spell it."""
    return str(value).lower() if isinstance(value, bool) else str(value)


@lru_cache(_CACHED_TEXTS)
def _print(formula: Formula, min_precedence: int) -> str:
    """Print *formula*, in parentheses if its operator has a lower precedence."""
    match formula:
        case Const(value):
            return print_literal(value)
        case Var(name, primed):
            return f"{name}'" if primed else name
        case Apply(op, args):
            text = _print_prefix(op, args[0]) if op in _PREFIX else _print_infix(op, args)
            return f"({text})" if PRECEDENCE[op] < min_precedence else text


def _print_prefix(op: Op, operand: Formula) -> str:
    space = "" if op is Op.NOT else " "
    return f"{op}{space}{_print(operand, PRECEDENCE[op])}"


def _print_infix(op: Op, args: tuple[Formula, ...]) -> str:
    first_precedence = PRECEDENCE[op] + (op not in _LEFT_ASSOCIATIVE)
    rest_precedence = PRECEDENCE[op] + (op not in RIGHT_ASSOCIATIVE)
    texts = [_print(args[0], first_precedence), *(_print(arg, rest_precedence) for arg in args[1:])]
    return (op if op in COMPARISONS else f" {op} ").join(texts)
