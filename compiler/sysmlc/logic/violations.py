"""The step of a run in which a formula becomes false, whatever follows.

A prefix of the run decides some formulas: ``G p`` is false as soon as p is false once, while
``F p`` stays open. The evaluation has three values (Kleene); None means
that the prefix leaves the value open.
"""

from collections.abc import Callable, Sequence

from sysmlc.logic.contract import Class, Conjunct
from sysmlc.logic.evaluate import Valuation, evaluate_on_lasso, is_true
from sysmlc.logic.formula import PAST, Apply, Formula, Op, has_future, has_past, has_primes

_Truth = bool | None
_LAPS = 2
"""Rounds of the loop behind the steps of the run: some violations follow after one round only."""


def find_violated_step(
    conjunct: Conjunct, trace: Sequence[Valuation], loop: int
) -> tuple[int, bool] | None:
    """Return the step of a run that violates the conjunct, and whether it is decided there.

    If it is not, the step is the first one from which on a demand is never fulfilled. The result is
    None if no step is to blame, as for ``F p``. The run continues at step *loop*.
    """
    formula = conjunct.formula
    if conjunct.class_ is Class.SAFETY:
        formula = Apply(Op.ALWAYS, (formula,))
    elif conjunct.class_ is Class.LIVENESS:
        return None
    lap = list(trace[loop:])
    try:
        length = _find_bad_prefix(formula, [*trace, *(lap * _LAPS)])
        if length is not None:
            step = length - 1
            return step if step < len(trace) else loop + (step - loop) % len(lap), True
        if isinstance(formula, Apply) and formula.op is Op.ALWAYS and lap:
            return evaluate_on_lasso(formula.args[0], trace, loop).index(False), False
    except (KeyError, ValueError):
        # A variable has no value in the last step, or a past operator meets the infinite future.
        pass
    return None


def _find_bad_prefix(formula: Formula, steps: Sequence[Valuation]) -> int | None:
    """Return the length of the shortest prefix that makes the formula false, or None."""
    if _evaluate(formula, steps)[0] is not False:
        return None
    shortest, longest = 1, len(steps)
    while shortest < longest:
        middle = (shortest + longest) // 2
        if _evaluate(formula, steps[:middle])[0] is False:
            longest = middle
        else:
            shortest = middle + 1
    return shortest


def _evaluate(formula: Formula, steps: Sequence[Valuation]) -> list[_Truth]:
    """Return the value of the formula in each step, as far as the steps decide it."""
    if isinstance(formula, Apply) and (formula.op in PAST or _is_connected(formula)):
        columns = [_evaluate(arg, steps) for arg in formula.args]
        if formula.op in _FUTURE:
            return _scan(_FUTURE[formula.op], [column[::-1] for column in columns], None)[::-1]
        if formula.op in PAST:
            return _scan(_PAST[formula.op], columns, formula.op is Op.HISTORICALLY)
        return [_CONNECTIVES[formula.op](row) for row in zip(*columns, strict=True)]
    followers: list[Valuation | None] = [*steps[1:], None]
    is_open = has_primes(formula)
    return [
        None if then is None and is_open else is_true(formula, now, then)
        for now, then in zip(steps, followers, strict=True)
    ]


def _is_connected(formula: Apply) -> bool:
    """Whether the operator is evaluated here, and not by ``is_true`` together with its operands."""
    is_open = has_future(formula) or has_past(formula) or has_primes(formula)
    return formula.op in _FUTURE or (formula.op in _CONNECTIVES and is_open)


def _scan(
    combine: Callable[[Sequence[_Truth], Sequence[_Truth], _Truth], _Truth],
    columns: Sequence[Sequence[_Truth]],
    start: _Truth,
) -> list[_Truth]:
    """Return the values of an operator, each from its operands and the last value."""
    values: list[_Truth] = []
    result = start
    before: Sequence[_Truth] = [start] * len(columns)
    for row in zip(*columns, strict=True):
        result = combine(row, before, result)
        values.append(result)
        before = row
    return values


def _both(*values: _Truth) -> _Truth:
    return False if False in values else None if None in values else True


def _either(*values: _Truth) -> _Truth:
    return True if True in values else None if None in values else False


def _negate(value: _Truth) -> _Truth:
    return None if value is None else not value


def _until(row: Sequence[_Truth], _: Sequence[_Truth], following: _Truth) -> _Truth:
    return _either(row[1], _both(row[0], following))


_FUTURE: dict[Op, Callable[[Sequence[_Truth], Sequence[_Truth], _Truth], _Truth]] = {
    Op.NEXT: lambda row, following, _: following[0],
    Op.ALWAYS: lambda row, _, following: _both(row[0], following),
    Op.EVENTUALLY: lambda row, _, following: _either(row[0], following),
    Op.UNTIL: _until,
    Op.WEAK_UNTIL: _until,
    Op.RELEASE: lambda row, _, following: _both(row[1], _either(row[0], following)),
}
_PAST: dict[Op, Callable[[Sequence[_Truth], Sequence[_Truth], _Truth], _Truth]] = {
    Op.PREVIOUS: lambda row, before, _: before[0],
    Op.ONCE: lambda row, _, earlier: _either(row[0], earlier),
    Op.HISTORICALLY: lambda row, _, earlier: _both(row[0], earlier),
    Op.SINCE: lambda row, _, earlier: _either(row[1], _both(row[0], earlier)),
}
_CONNECTIVES: dict[Op, Callable[[Sequence[_Truth]], _Truth]] = {
    Op.NOT: lambda row: _negate(row[0]),
    Op.AND: lambda row: _both(*row),
    Op.OR: lambda row: _either(*row),
    Op.IMPLIES: lambda row: _either(_negate(row[0]), row[1]),
    Op.IFF: lambda row: None if None in row else row[0] == row[1],
}
