"""Evaluation of formulas on valuations, single steps, finite traces and lassos."""

from collections.abc import Callable, Mapping, Sequence

from sysmlc.logic.contract import Class, Conjunct
from sysmlc.logic.formula import Apply, Const, Formula, Literal, Op, Var, has_primes

Valuation = Mapping[str, Literal]


def value_of(formula: Formula, now: Valuation, then: Valuation | None = None) -> Literal:
    """Return the value of a formula without temporal operators; *then* gives the primed variables.

    Integers divide towards zero; x / 0 is 0 and x mod 0 is x, so that every formula has a value.
    Raises KeyError for a variable without a value.
    """
    match formula:
        case Const(value):
            return value
        case Var(name, primed):
            return _require_next(then)[name] if primed else now[name]
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


def compile_evaluation(formula: Formula) -> Evaluation:
    """Return a closure that computes ``value_of`` faster, for a formula that is evaluated often."""
    match formula:
        case Const(value):
            return lambda now, then: value
        case Var(name, True):
            return lambda now, then: _require_next(then)[name]
        case Var(name):
            return lambda now, then: now[name]
        case Apply(op, args):
            return _compile_operator(op, tuple(compile_evaluation(arg) for arg in args))


def _compile_operator(op: Op, parts: tuple[Evaluation, ...]) -> Evaluation:
    match op, parts:
        case Op.IMPLIES, (left, right):
            return lambda now, then: not left(now, then) or bool(right(now, then))
        case Op.AND, _:
            return lambda now, then: _all_true(parts, now, then)
        case Op.OR, _:
            return lambda now, then: _any_true(parts, now, then)
        case _, (only,):
            act = _OPERATIONS[op]
            return lambda now, then: act(only(now, then))
        case _, (left, right):
            act = _OPERATIONS[op]
            return lambda now, then: act(left(now, then), right(now, then))
        case _:
            raise KeyError(op)


def _all_true(parts: tuple[Evaluation, ...], now: Valuation, then: Valuation | None) -> bool:
    for part in parts:  # noqa: SIM110 - a generator for every connective costs as much again
        if not part(now, then):
            return False
    return True


def _any_true(parts: tuple[Evaluation, ...], now: Valuation, then: Valuation | None) -> bool:
    for part in parts:  # noqa: SIM110
        if part(now, then):
            return True
    return False


def is_true(formula: Formula, now: Valuation, then: Valuation | None = None) -> bool:
    """Whether a formula without temporal operators holds in one step."""
    return bool(value_of(formula, now, then))


def find_violation(
    conjunct: Conjunct, trace: Sequence[Valuation], loop: int | None = None
) -> int | None:
    """Return the first step in which the conjunct is violated, or None.

    *loop* is the step to which the last one returns. Without it the trace is finite: a formula
    about the next step is not evaluated in the last one, and liveness cannot be violated.
    """
    if conjunct.class_ is Class.INIT:
        return None if is_true(conjunct.formula, trace[0]) else 0
    if conjunct.class_ is Class.SAFETY:
        return _find_unsafe_step(conjunct.formula, trace, loop)
    if loop is None:
        return None
    if conjunct.class_ is Class.OTHER:
        return None if evaluate_on_lasso(conjunct.formula, trace, loop)[0] else 0
    holds = any(
        is_true(conjunct.formula, now, then) for now, then in _pair_steps(trace, loop)[loop:]
    )
    return None if holds else loop


def _find_unsafe_step(formula: Formula, trace: Sequence[Valuation], loop: int | None) -> int | None:
    for index, (now, then) in enumerate(_pair_steps(trace, loop)):
        if then is None and has_primes(formula):
            continue
        if not is_true(formula, now, then):
            return index
    return None


def _pair_steps(
    trace: Sequence[Valuation], loop: int | None
) -> list[tuple[Valuation, Valuation | None]]:
    last = None if loop is None else trace[loop]
    return list(zip(trace, [*trace[1:], last], strict=True))


def evaluate_on_lasso(formula: Formula, trace: Sequence[Valuation], loop: int) -> list[bool]:
    """Return whether an LTL formula holds, for each step of an infinite trace.

    The trace consists of *trace* and, repeated for ever, its steps from *loop* on.
    """
    match formula:
        case Apply(op, args) if op in _TEMPORAL:
            return _TEMPORAL[op](loop, *(evaluate_on_lasso(arg, trace, loop) for arg in args))
        case Apply(op, args) if op in _CONNECTIVES:
            columns = [evaluate_on_lasso(arg, trace, loop) for arg in args]
            return [_CONNECTIVES[op](row) for row in zip(*columns, strict=True)]
        case _:
            return [is_true(formula, now, then) for now, then in _pair_steps(trace, loop)]


def _require_next(then: Valuation | None) -> Valuation:
    if then is None:
        raise KeyError("there is no next step")
    return then


def _shift(loop: int, column: Sequence[bool]) -> list[bool]:
    return [*column[1:], column[loop]]


def _iterate_backwards(loop: int, stay: list[bool], goal: list[bool], start: bool) -> list[bool]:
    """Return at which steps ``stay until goal`` holds, as a fixpoint of its expansion law.

    *start* is the value before the first round: false for strong until, true for weak until.
    """
    truth = [start] * len(goal)
    # Each round carries values one step backwards: two laps of the trace reach the fixpoint.
    for _ in range(2 * len(goal)):
        next_truth = _shift(loop, truth)
        truth = [
            goal_holds or (stay_holds and next_holds)
            for goal_holds, stay_holds, next_holds in zip(goal, stay, next_truth, strict=True)
        ]
    return truth


def _until(loop: int, stay: list[bool], goal: list[bool]) -> list[bool]:
    return _iterate_backwards(loop, stay, goal, start=False)


def _weak_until(loop: int, stay: list[bool], goal: list[bool]) -> list[bool]:
    return _iterate_backwards(loop, stay, goal, start=True)


def _release(loop: int, goal: list[bool], stay: list[bool]) -> list[bool]:
    meeting = [g and s for g, s in zip(goal, stay, strict=True)]
    return _weak_until(loop, stay, meeting)


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
    Op.ALWAYS: lambda loop, stay: _weak_until(loop, stay, [False] * len(stay)),
    Op.EVENTUALLY: lambda loop, goal: _until(loop, [True] * len(goal), goal),
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
