"""Property patterns as formulas about the present and the past.

Patterns and scopes are those of Dwyer, Avrunin and Corbett (Patterns in Property Specifications
for Finite-State Verification, 1999). Every pattern is written as ``G p`` or ``G F p`` where p is
about the present and the past, so that history bits bring it into GR(1); the tests compare the
patterns with the published formulas. "After Q" means after the first Q.

Each function returns a formula, and its docstring states what the formula says. *inside* is true in
the steps of the scope, *missing* where a wanted condition does not hold, *pending* from the step of
an obligation until the step that fulfils it.
"""

from msgspec import Struct

from sysmlc.logic import formula as f
from sysmlc.logic.formula import Apply, Formula, Op


class Scope(Struct, frozen=True):
    """The steps in which a pattern must hold: ``globally``, ``before``, ``after``, ``between`` or
    ``until``.
    """

    kind: str
    start: Formula = f.TRUE
    end: Formula = f.FALSE


# -- patterns ------------------------------------------------------------------------------------


def absence(scope: Scope, bad: Formula) -> Formula:
    """The condition never holds inside the scope."""
    return _forbid(scope, f.both(_is_inside(scope), bad))


def universality(scope: Scope, good: Formula) -> Formula:
    """The condition always holds inside the scope."""
    return absence(scope, f.negate(good))


def existence(scope: Scope, wanted: Formula) -> Formula:
    """The condition holds at some step inside the scope."""
    if scope.kind in ("globally", "after"):
        inside = _is_inside(scope)
        missing = f.negate(_once(f.both(wanted, inside)))
        return _infinitely_often_not(f.both(inside, missing))
    if scope.kind == "before":
        return _forbid_at_end(scope, f.negate(_once(wanted)))
    return _require_answer(scope, wanted, scope.start)


def precedence(scope: Scope, first: Formula, then: Formula) -> Formula:
    """``then`` holds inside the scope only if ``first`` held there before or holds with it."""
    missing = f.negate(first)
    if scope.kind in ("globally", "before"):
        return _forbid(scope, f.both(then, f.negate(_once(first))))
    if scope.kind == "after":
        inside = _is_inside(scope)
        return _never(f.both(inside, then, f.negate(_once(f.both(first, inside)))))
    is_open = f.negate(scope.end)
    unprepared = _since(f.both(missing, is_open), f.both(scope.start, is_open, missing))
    return _forbid(scope, f.both(then, unprepared))


def response(scope: Scope, trigger: Formula, answer: Formula) -> Formula:
    """Whenever the trigger holds inside the scope, the answer holds then or later inside it."""
    return _require_answer(scope, answer, f.both(trigger, _is_inside(scope)))


def bounded_response(scope: Scope, trigger: Formula, answer: Formula, steps: int) -> Formula:
    """As ``response``, but the answer holds at most *steps* later.

    A trigger fewer steps before the end of the scope needs no answer.
    """
    missing = f.both(f.negate(answer), f.negate(scope.end))
    waiting = f.both(trigger, _is_inside(scope), missing)
    for _ in range(steps):
        waiting = f.both(f.previous(waiting), missing)
    return _forbid(scope, waiting)


def bounded_existence(scope: Scope, counted: Formula, times: int) -> Formula:
    """The condition holds in at most *times* runs of consecutive steps inside the scope."""
    phase = f.both(counted, _is_inside(scope))
    begins = f.both(phase, f.negate(f.previous(phase)))
    has_more = _once_inside(scope, begins)
    for _ in range(times):
        has_more = _once_inside(scope, f.both(begins, f.previous(has_more)))
    return _forbid(scope, has_more)


# -- operators -----------------------------------------------------------------------------------


def _once(formula: Formula) -> Formula:
    """The formula holds now or held at some step before."""
    return f.TRUE if formula == f.TRUE else Apply(Op.ONCE, (formula,))


def _since(stay: Formula, goal: Formula) -> Formula:
    """``goal`` held at some step up to now, and ``stay`` at all steps after it."""
    return Apply(Op.SINCE, (stay, goal))


def _never(bad: Formula) -> Formula:
    return f.always(f.negate(bad))


def _infinitely_often_not(pending: Formula) -> Formula:
    return f.always(f.eventually(f.negate(pending)))


# -- scopes --------------------------------------------------------------------------------------


def _is_inside(scope: Scope) -> Formula:
    """The scope has begun and has not ended; whether an end will come is not known yet."""
    is_open = f.negate(scope.end)
    match scope.kind:
        case "globally":
            return f.TRUE
        case "before":
            return f.negate(_once(scope.end))
        case "after":
            return _once(scope.start)
        case _:
            return _since(is_open, f.both(scope.start, is_open))


def _once_inside(scope: Scope, formula: Formula) -> Formula:
    """The formula holds now or held at some step since the scope began."""
    if scope.kind in ("between", "until"):
        return _since(f.negate(scope.end), formula)
    return _once(formula)


def _forbid(scope: Scope, bad: Formula) -> Formula:
    """``bad`` never holds inside the scope.

    "Before R" and "between Q and R" are scopes only if R comes: the formula is about the step
    before R, and looks back from there.
    """
    if scope.kind in ("globally", "after", "until"):
        return _never(bad)
    if scope.kind == "before":
        return _forbid_at_end(scope, _once(bad))
    return _forbid_at_end(scope, _since(f.negate(scope.end), bad))


def _forbid_at_end(scope: Scope, bad: Formula) -> Formula:
    """``bad`` does not hold in the last step of the scope, the step before its end.

    "Before R" ends at the first R. If R holds in the first step, the scope is empty; then the
    formula is violated if ``bad`` states that something is missing.
    """
    if scope.kind == "before":
        is_first_end = f.negate(f.previous(_once(scope.end)))
        is_good = f.previous(f.negate(bad))
        has_steps = f.previous(f.TRUE)
        if not _is_missing(bad):
            is_good = f.either(is_good, f.negate(has_steps))
        return _never(f.both(scope.end, is_first_end, f.negate(is_good)))
    return _never(f.both(scope.end, f.previous(bad)))


def _is_missing(bad: Formula) -> bool:
    """Whether *bad* states that something is missing, as it is in a scope without steps."""
    return isinstance(bad, Apply) and bad.op is Op.NOT


def _require_answer(scope: Scope, answer: Formula, obligation: Formula) -> Formula:
    """Every obligation inside the scope is answered inside it."""
    missing = f.negate(answer)
    if scope.kind in ("globally", "after"):
        return _infinitely_often_not(_since(missing, f.both(obligation, missing)))
    if scope.kind == "before":
        return _forbid_at_end(scope, _since(missing, f.both(obligation, missing)))
    is_unanswered = f.both(missing, f.negate(scope.end))
    pending = _since(is_unanswered, f.both(obligation, is_unanswered))
    if scope.kind == "between":
        return _forbid_at_end(scope, pending)
    return f.both(_forbid_at_end(scope, pending), _infinitely_often_not(pending))
