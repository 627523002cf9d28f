"""Property patterns, as formulas about the present and the past.

Patterns and scopes are those of Dwyer, Avrunin and Corbett (Patterns in Property Specifications
for Finite-State Verification, 1999). Every pattern is said as ``G`` and ``G F`` of what is known
by now, which history bits bring into GR(1); the tests hold them against the published formulas.
"After Q" means after the first Q.
"""

from collections.abc import Callable, Mapping

from msgspec import Struct

from sysmlc.logic import formula as f
from sysmlc.logic.formula import Apply, Formula, Op


class Scope(Struct, frozen=True):
    """When a pattern must hold: ``globally``, ``before``, ``after``, ``between``, ``until``."""

    kind: str
    start: Formula = f.TRUE
    end: Formula = f.FALSE


# -- the past --------------------------------------------------------------------------------------


def previous(formula: Formula) -> Formula:
    """One step ago."""
    return Apply(Op.PREVIOUS, (formula,))


def once(formula: Formula) -> Formula:
    """Now or before."""
    return f.TRUE if formula == f.TRUE else Apply(Op.ONCE, (formula,))


def since(stay: Formula, goal: Formula) -> Formula:
    """The goal at some step up to now, ``stay`` at all steps after it."""
    return Apply(Op.SINCE, (stay, goal))


def _never(bad: Formula) -> Formula:
    return f.always(f.negate(bad))


def _again_not(pending: Formula) -> Formula:
    return f.always(f.eventually(f.negate(pending)))


# -- patterns --------------------------------------------------------------------------------------


def absence(scope: Scope, bad: Formula) -> Formula:
    """The condition never holds inside the scope."""
    return _unless(scope, f.both(_inside(scope), bad))


def universality(scope: Scope, good: Formula) -> Formula:
    """The condition always holds inside the scope."""
    return absence(scope, f.negate(good))


def existence(scope: Scope, wanted: Formula) -> Formula:
    """The condition holds at some step inside the scope."""
    if scope.kind in ("globally", "after"):
        inside = _inside(scope)
        return _again_not(f.both(inside, f.negate(once(f.both(wanted, inside)))))
    if scope.kind == "before":
        return _at_end(scope, f.negate(once(wanted)))
    return _obligation(scope, wanted, scope.start)


def precedence(scope: Scope, first: Formula, then: Formula) -> Formula:
    """``then`` holds inside the scope only if ``first`` held there before, or holds with it."""
    missing = f.negate(first)
    if scope.kind in ("globally", "before"):
        return _unless(scope, f.both(then, f.negate(once(first))))
    if scope.kind == "after":
        inside = _inside(scope)
        return _never(f.both(inside, then, f.negate(once(f.both(first, inside)))))
    open_ = f.negate(scope.end)
    unprepared = since(f.both(missing, open_), f.both(scope.start, open_, missing))
    return _unless(scope, f.both(then, unprepared))


def response(scope: Scope, trigger: Formula, answer: Formula) -> Formula:
    """Whenever the trigger holds inside the scope, the answer holds then or later inside it."""
    return _obligation(scope, answer, f.both(trigger, _inside(scope)))


def within_steps(scope: Scope, trigger: Formula, answer: Formula, steps: int) -> Formula:
    """As response, but at most so many steps later; what the scope's end cuts off is let off."""
    missing = f.both(f.negate(answer), f.negate(scope.end))
    waits = f.both(trigger, _inside(scope), missing)
    for _ in range(steps):
        waits = f.both(previous(waits), missing)
    return _unless(scope, waits)


def bounded_existence(scope: Scope, counted: Formula, times: int) -> Formula:
    """There are at most so many phases inside the scope in which the condition holds."""
    phase = f.both(counted, _inside(scope))
    begins = f.both(phase, f.negate(previous(phase)))
    many = _within(scope, begins)
    for _ in range(times):
        many = _within(scope, f.both(begins, previous(many)))
    return _unless(scope, many)


# -- scopes ----------------------------------------------------------------------------------------


def _inside(scope: Scope) -> Formula:
    """That this step is one of the scope, as far as is known by now."""
    open_ = f.negate(scope.end)
    inside: Mapping[str, Callable[[], Formula]] = {
        "globally": lambda: f.TRUE,
        "before": lambda: f.negate(once(scope.end)),
        "after": lambda: once(scope.start),
    }
    return inside.get(scope.kind, lambda: since(open_, f.both(scope.start, open_)))()


def _within(scope: Scope, formula: Formula) -> Formula:
    """That it held at some step since the scope began."""
    if scope.kind in ("between", "until"):
        return since(f.negate(scope.end), formula)
    return once(formula)


def _unless(scope: Scope, bad: Formula) -> Formula:
    """What is bad never happens; where the scope needs an end, only what ends there counts."""
    if scope.kind in ("globally", "after", "until"):
        return _never(bad)
    if scope.kind == "before":
        return _at_end(scope, once(bad))
    return _at_end(scope, since(f.negate(scope.end), bad))


def _at_end(scope: Scope, bad: Formula) -> Formula:
    """When the scope ends, what is bad was not so in the step before.

    Before R ends at the first R, and what does not hold at any step before it, if it is the
    first of all, is bad too.
    """
    if scope.kind == "before":
        first = f.negate(previous(once(scope.end)))
        good = previous(f.negate(bad))
        begun = previous(f.TRUE)
        is_fine = f.either(good, f.negate(begun)) if _is_empty_fine(bad) else good
        return _never(f.both(scope.end, first, f.negate(is_fine)))
    return _never(f.both(scope.end, previous(bad)))


def _is_empty_fine(bad: Formula) -> bool:
    """Whether nothing bad is in a scope without steps: what is missing there is bad."""
    return not (isinstance(bad, Apply) and bad.op is Op.NOT)


def _obligation(scope: Scope, answer: Formula, owed: Formula) -> Formula:
    """What is owed inside the scope is answered inside of it."""
    missing = f.negate(answer)
    if scope.kind in ("globally", "after"):
        return _again_not(since(missing, f.both(owed, missing)))
    open_ = f.both(missing, f.negate(scope.end))
    pending = since(open_, f.both(owed, open_))
    if scope.kind == "before":
        return _at_end(scope, since(missing, f.both(owed, missing)))
    if scope.kind == "between":
        return _at_end(scope, pending)
    return f.both(_at_end(scope, pending), _again_not(pending))
