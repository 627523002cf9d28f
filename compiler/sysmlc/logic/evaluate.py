"""What formulas say of traces: values, single steps, finite traces and lassos."""

from collections.abc import Callable, Mapping, Sequence

from sysmlc.logic.contract import Class, Conjunct
from sysmlc.logic.formula import Apply, Const, Formula, Literal, Op, Var

Valuation = Mapping[str, Literal]


def value_of(formula: Formula, now: Valuation, then: Valuation | None = None) -> Literal:
    """Value of a formula without temporal operators; ``then`` gives the primed variables.

    Integers divide towards zero; x / 0 is 0 and x mod 0 is x, so that every formula has a
    value. Raises KeyError for a variable without value.
    """
    match formula:
        case Const(value):
            return value
        case Var(name, primed):
            return _next(then)[name] if primed else now[name]
        case Apply(Op.IMPLIES, (left, right)):
            return not value_of(left, now, then) or bool(value_of(right, now, then))
        case Apply(Op.AND, args):
            return all(value_of(arg, now, then) for arg in args)
        case Apply(Op.OR, args):
            return any(value_of(arg, now, then) for arg in args)
        case Apply(op, args):
            return _OPERATIONS[op](*(value_of(arg, now, then) for arg in args))


Evaluation = Callable[[Valuation, Valuation | None], Literal]
"""``value_of`` for one formula."""


def evaluation(formula: Formula) -> Evaluation:
    """``value_of`` for one formula that is asked for many values: it is walked through once."""
    match formula:
        case Const(value):
            return lambda now, then: value
        case Var(name, True):
            return lambda now, then: _next(then)[name]
        case Var(name):
            return lambda now, then: now[name]
        case Apply(op, args):
            return _applied(op, tuple(evaluation(arg) for arg in args))


def _applied(op: Op, parts: tuple[Evaluation, ...]) -> Evaluation:
    match op, parts:
        case Op.IMPLIES, (left, right):
            return lambda now, then: not left(now, then) or bool(right(now, then))
        case Op.AND, _:
            return lambda now, then: _every(parts, now, then)
        case Op.OR, _:
            return lambda now, then: _some(parts, now, then)
        case _, (only,):
            act = _OPERATIONS[op]
            return lambda now, then: act(only(now, then))
        case _, (left, right):
            act = _OPERATIONS[op]
            return lambda now, then: act(left(now, then), right(now, then))
        case _:
            raise KeyError(op)


def _every(parts: tuple[Evaluation, ...], now: Valuation, then: Valuation | None) -> bool:
    for part in parts:  # noqa: SIM110 - a generator for every connective costs as much again
        if not part(now, then):
            return False
    return True


def _some(parts: tuple[Evaluation, ...], now: Valuation, then: Valuation | None) -> bool:
    for part in parts:  # noqa: SIM110
        if part(now, then):
            return True
    return False


def is_true(formula: Formula, now: Valuation, then: Valuation | None = None) -> bool:
    """Truth of a formula without temporal operators in one step."""
    return bool(value_of(formula, now, then))


def has_primes(formula: Formula) -> bool:
    """Whether the formula speaks of the next step."""
    match formula:
        case Var(_, primed):
            return primed
        case Apply(_, args):
            return any(has_primes(arg) for arg in args)
        case _:
            return False


def violation(
    conjunct: Conjunct, trace: Sequence[Valuation], loop: int | None = None
) -> int | None:
    """The first step in which the conjunct is violated, or None.

    ``loop`` is the step to which the last one returns; without it the trace is finite: a
    formula about the next step is not asked of the last one, and liveness cannot be violated.
    """
    if conjunct.class_ is Class.INIT:
        return None if is_true(conjunct.formula, trace[0]) else 0
    if conjunct.class_ is Class.SAFETY:
        return _first_unsafe(conjunct.formula, trace, loop)
    if loop is None:
        return None
    if conjunct.class_ is Class.OTHER:
        return None if lasso_truth(conjunct.formula, trace, loop)[0] else 0
    holds = any(is_true(conjunct.formula, now, then) for now, then in _steps(trace, loop)[loop:])
    return None if holds else loop


def _first_unsafe(formula: Formula, trace: Sequence[Valuation], loop: int | None) -> int | None:
    for index, (now, then) in enumerate(_steps(trace, loop)):
        if then is None and has_primes(formula):
            continue
        if not is_true(formula, now, then):
            return index
    return None


def _steps(
    trace: Sequence[Valuation], loop: int | None
) -> list[tuple[Valuation, Valuation | None]]:
    last = None if loop is None else trace[loop]
    return list(zip(trace, [*trace[1:], last], strict=True))


def lasso_truth(formula: Formula, trace: Sequence[Valuation], loop: int) -> list[bool]:
    """Truth of an LTL formula at each step of the infinite trace that returns to ``loop``."""
    match formula:
        case Apply(op, args) if op in _TEMPORAL:
            return _TEMPORAL[op](loop, *(lasso_truth(arg, trace, loop) for arg in args))
        case Apply(op, args) if op in _CONNECTIVES:
            columns = [lasso_truth(arg, trace, loop) for arg in args]
            return [_CONNECTIVES[op](row) for row in zip(*columns, strict=True)]
        case _:
            return [is_true(formula, now, then) for now, then in _steps(trace, loop)]


def _next(then: Valuation | None) -> Valuation:
    if then is None:
        raise KeyError("there is no next step")
    return then


def _shift(loop: int, column: Sequence[bool]) -> list[bool]:
    return [*column[1:], column[loop]]


def _least(loop: int, stay: list[bool], goal: list[bool], start: bool) -> list[bool]:
    found = [start] * len(goal)
    for _ in range(2 * len(goal)):
        ahead = _shift(loop, found)
        found = [g or (s and a) for g, s, a in zip(goal, stay, ahead, strict=True)]
    return found


def _until(loop: int, stay: list[bool], goal: list[bool]) -> list[bool]:
    return _least(loop, stay, goal, start=False)


def _weak_until(loop: int, stay: list[bool], goal: list[bool]) -> list[bool]:
    return _least(loop, stay, goal, start=True)


def _release(loop: int, goal: list[bool], stay: list[bool]) -> list[bool]:
    meeting = [g and s for g, s in zip(goal, stay, strict=True)]
    return _weak_until(loop, stay, meeting)


def _eventually(loop: int, goal: list[bool]) -> list[bool]:
    return _until(loop, [True] * len(goal), goal)


def _always(loop: int, stay: list[bool]) -> list[bool]:
    return _weak_until(loop, stay, [False] * len(stay))


def _divide(left: int, right: int) -> int:
    if right == 0:
        return 0
    quotient = abs(left) // abs(right)
    return quotient if (left < 0) == (right < 0) else -quotient


_OPERATIONS: dict[Op, Callable[..., Literal]] = {
    Op.NOT: lambda a: not a,
    Op.IFF: lambda a, b: bool(a) == bool(b),
    Op.EQ: lambda a, b: a == b,
    Op.NE: lambda a, b: a != b,
    Op.LT: lambda a, b: a < b,
    Op.LE: lambda a, b: a <= b,
    Op.GT: lambda a, b: a > b,
    Op.GE: lambda a, b: a >= b,
    Op.ADD: lambda a, b: a + b,
    Op.SUB: lambda a, b: a - b,
    Op.MUL: lambda a, b: a * b,
    Op.DIV: _divide,
    Op.MOD: lambda a, b: a - b * _divide(a, b),
}
_TEMPORAL: dict[Op, Callable[..., list[bool]]] = {
    Op.NEXT: _shift,
    Op.ALWAYS: _always,
    Op.EVENTUALLY: _eventually,
    Op.UNTIL: _until,
    Op.WEAK_UNTIL: _weak_until,
    Op.RELEASE: _release,
}
_CONNECTIVES: dict[Op, Callable[[Sequence[bool]], bool]] = {
    Op.NOT: lambda row: not row[0],
    Op.AND: all,
    Op.OR: any,
    Op.IMPLIES: lambda row: not row[0] or row[1],
    Op.IFF: lambda row: row[0] == row[1],
}
