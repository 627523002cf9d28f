"""Formulas as text: the neutral form of corpus/gr1, extended by the operators of LTL."""

from functools import lru_cache

from sysmlc.logic.formula import Apply, Const, Formula, Literal, Op, Var

_STRENGTH = {
    Op.IFF: 1,
    Op.IMPLIES: 2,
    Op.OR: 3,
    Op.AND: 4,
    **dict.fromkeys((Op.UNTIL, Op.RELEASE, Op.WEAK_UNTIL, Op.SINCE), 5),
    **dict.fromkeys((Op.NOT, Op.NEXT, Op.ALWAYS, Op.EVENTUALLY), 6),
    **dict.fromkeys((Op.PREVIOUS, Op.ONCE, Op.HISTORICALLY), 6),
    **dict.fromkeys((Op.EQ, Op.NE, Op.LT, Op.LE, Op.GT, Op.GE), 7),
    **dict.fromkeys((Op.ADD, Op.SUB), 8),
    **dict.fromkeys((Op.MUL, Op.DIV, Op.MOD), 9),
}
_PREFIX = (Op.NOT, Op.NEXT, Op.ALWAYS, Op.EVENTUALLY, Op.PREVIOUS, Op.ONCE, Op.HISTORICALLY)
_TIGHT = (Op.EQ, Op.NE, Op.LT, Op.LE, Op.GT, Op.GE)
_FROM_THE_RIGHT = (Op.IMPLIES, Op.UNTIL, Op.RELEASE, Op.WEAK_UNTIL)
_FROM_THE_LEFT = (Op.IFF, Op.ADD, Op.SUB, Op.MUL, Op.DIV, Op.MOD)
_REMEMBERED = 1 << 14
"""Texts that are kept: JSON and Markdown show the same formulas, machines of one kind have them."""


def print_formula(formula: Formula) -> str:
    """The formula with primes for next values and only the parentheses that it needs."""
    return _print(formula, 0)


def print_literal(value: Literal) -> str:
    """A value as formulas name it."""
    return str(value).lower() if isinstance(value, bool) else str(value)


@lru_cache(_REMEMBERED)
def _print(formula: Formula, strength: int) -> str:
    match formula:
        case Const(value):
            return print_literal(value)
        case Var(name, primed):
            return f"{name}'" if primed else name
        case Apply(op, args):
            own = _STRENGTH[op]
            text = _prefix(op, args[0]) if op in _PREFIX else _infix(op, args)
            return f"({text})" if own < strength else text


def _prefix(op: Op, operand: Formula) -> str:
    space = "" if op is Op.NOT else " "
    return f"{op}{space}{_print(operand, _STRENGTH[op])}"


def _infix(op: Op, args: tuple[Formula, ...]) -> str:
    own = _STRENGTH[op]
    left = own + (op not in _FROM_THE_LEFT)
    right = own + (op not in _FROM_THE_RIGHT)
    texts = [_print(args[0], left), *(_print(arg, right) for arg in args[1:])]
    return (op if op in _TIGHT else f" {op} ").join(texts)
