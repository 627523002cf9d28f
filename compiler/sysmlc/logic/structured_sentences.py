"""Structured requirements: ``[scope] [condition] [the] COMPONENT shall [timing] response``.

Grammar and meaning are those of FRET (Giannakopoulou, Pressburger, Mavridou, Schumann: Automated
formalization of structured natural language requirements, Information and Software Technology,
2021), for infinite traces: the scope selects intervals of steps, the condition triggers steps in an
interval, and the timing states where the response must hold between a trigger and the end of the
interval. ``formal_texts`` reads the sentences.
"""

from collections.abc import Callable
from typing import NamedTuple

from msgspec import Struct

from sysmlc.logic import formula as f
from sysmlc.logic.formula import Apply, Formula, Op


class Timing(Struct, frozen=True):
    """When the response must hold: the kind, with a number of steps or a stop condition."""

    kind: str = "eventually"
    steps: int = 0
    stop: Formula = f.FALSE


class Sentence(Struct, frozen=True):
    """The fields of a sentence; ``formalize`` returns its formula.

    ``scope`` is empty for the whole run, else "in", "notin", "before", "after", "only in",
    "only before" or "only after".
    ``condition`` is None if the interval itself is the trigger. It triggers where it becomes true
    and where an interval begins with it, or in each step if ``is_continual``. ``restriction`` is
    the condition of ``while`` after a scope, which shortens the intervals of the scope.
    """

    response: Formula
    timing: Timing = Timing()
    scope: str = ""
    mode: Formula = f.TRUE
    restriction: Formula = f.TRUE
    condition: Formula | None = None
    is_continual: bool = False


def find_inside(scope: str, mode: Formula, restriction: Formula) -> Formula:
    """Return the condition that a step is in an interval of the scope."""
    return f.both(_recognise_intervals(scope, mode).inside, restriction)


def formalize_persisted(steps: int, condition: Formula, inside: Formula) -> Formula:
    """Return that a condition holds now and held in the last *steps* steps of the interval."""
    formula = held = f.both(inside, condition)
    for _ in range(steps):
        formula = f.both(held, f.previous(formula))
    return formula


def formalize_occurred(steps: int, condition: Formula, inside: Formula) -> Formula:
    """Return that a condition holds now or held in one of the last *steps* of the interval."""
    formula = now = f.both(inside, condition)
    for _ in range(steps):
        formula = f.either(now, f.both(inside, f.previous(formula)))
    return formula


def formalize(sentence: Sentence) -> Formula:
    """Return the formula of a sentence; it may have operators of the past.

    A sentence with an "only" scope forbids outside of the scope what it demands inside: there the
    negation of the timing must hold.
    """
    interval = _recognise_intervals(sentence.scope, sentence.mode)
    inside = f.both(interval.inside, sentence.restriction)
    end = f.either(interval.end, f.negate(sentence.restriction))
    timing, response = sentence.timing, sentence.response
    if timing.kind == "finally":
        return _demand_finally(sentence, inside, end)
    if sentence.scope.startswith("only"):
        demand = _NEGATED_TIMINGS[timing.kind](response, timing, end)
    else:
        demand = _TIMINGS[timing.kind](response, timing, end)
    if sentence.condition is None:
        step = _stepwise_demand(sentence)
        if step is not None:
            return f.always(f.implies(inside, step))
        if inside == f.TRUE:
            return demand
    return f.always(f.implies(_find_trigger(sentence, inside), demand))


def _find_trigger(sentence: Sentence, inside: Formula) -> Formula:
    trigger = inside if sentence.condition is None else f.both(inside, sentence.condition)
    if not sentence.is_continual or sentence.condition is None:
        trigger = f.both(trigger, f.negate(f.previous(trigger)))
    return trigger


def _demand_finally(sentence: Sentence, inside: Formula, end: Formula) -> Formula:
    """In the step after an interval with a trigger, the response held one step ago.

    The formula is about the past, because a weak until with ``X end`` is not reduced to GR(1).
    """
    response = sentence.response
    if sentence.scope.startswith("only"):
        response = f.negate(response)
    is_due = inside
    if sentence.condition is not None:
        is_due = Apply(Op.SINCE, (inside, _find_trigger(sentence, inside)))
    return f.always(f.implies(f.both(end, f.previous(is_due)), f.previous(response)))


def _stepwise_demand(sentence: Sentence) -> Formula | None:
    """Return what must hold in each step of the scope, if the sentence without condition is that.

    The result is equivalent to the general form, and shorter.
    """
    is_negated = sentence.scope.startswith("only")
    match sentence.timing.kind, is_negated:
        case "always", False:
            return sentence.response
        case ("never", False) | ("eventually", True):
            return f.negate(sentence.response)
        case _:
            return None


# -- scopes ----------------------------------------------------------------------------------------


class _Interval(NamedTuple):
    """How an interval is recognised: ``inside`` is true in its steps, ``end`` in the step after."""

    inside: Formula
    end: Formula


def _recognise_intervals(scope: str, mode: Formula) -> _Interval:
    """Return the intervals of a scope, or for "only" those of its complement."""
    has_left = _once(f.both(f.negate(mode), f.previous(mode)))
    intervals = {
        "": _Interval(f.TRUE, f.FALSE),
        "in": _Interval(mode, f.negate(mode)),
        "notin": _Interval(f.negate(mode), mode),
        "before": _Interval(f.negate(_once(mode)), mode),
        "after": _Interval(has_left, f.FALSE),
        "only in": _Interval(f.negate(mode), mode),
        "only before": _Interval(_once(mode), f.FALSE),
        "only after": _Interval(f.negate(has_left), has_left),
    }
    return intervals[scope]


# -- timings ---------------------------------------------------------------------------------------
# Each function returns what must hold in a step that triggers the response. *end* is true in the
# first step after the interval; what would be due there or later is not due.


def _demand_immediately(response: Formula, timing: Timing, end: Formula) -> Formula:
    return response


def _demand_next(response: Formula, timing: Timing, end: Formula) -> Formula:
    return Apply(Op.NEXT, (f.either(response, end),))


def _demand_always(response: Formula, timing: Timing, end: Formula) -> Formula:
    return _weak_until(response, end)


def _demand_eventually(response: Formula, timing: Timing, end: Formula) -> Formula:
    """In an interval that ends, the response must hold before the end."""
    return _until(f.negate(end), f.both(response, f.negate(end)))


def _demand_within(response: Formula, timing: Timing, end: Formula) -> Formula:
    """The response holds at most ``steps`` later, unless the interval ends earlier."""
    goal = f.either(response, end)
    formula = goal
    for _ in range(timing.steps):
        formula = f.either(goal, Apply(Op.NEXT, (formula,)))
    return formula


def _demand_for(response: Formula, timing: Timing, end: Formula) -> Formula:
    """The response holds now and in the next ``steps`` steps, as far as the interval lasts."""
    return _hold_for(response, timing.steps, end, response)


def _demand_after(response: Formula, timing: Timing, end: Formula) -> Formula:
    """The response holds in the step after ``steps`` steps, and not from now until then."""
    last = f.both(f.negate(response), Apply(Op.NEXT, (f.either(response, end),)))
    return _hold_for(f.negate(response), timing.steps, end, last)


def _hold_for(stay: Formula, steps: int, end: Formula, last: Formula) -> Formula:
    """*stay* holds for *steps* steps and then *last*, unless the interval ends earlier."""
    formula = last
    for _ in range(steps):
        formula = f.both(stay, Apply(Op.NEXT, (f.either(end, formula),)))
    return formula


def _demand_until(response: Formula, timing: Timing, end: Formula) -> Formula:
    """The response holds up to the step before the stop condition, which need not occur."""
    return _weak_until(response, f.either(timing.stop, end))


def _demand_before(response: Formula, timing: Timing, end: Formula) -> Formula:
    """The response holds in a step before the stop condition, if that occurs."""
    not_stopped = f.negate(timing.stop)
    return _weak_until(not_stopped, f.either(f.both(response, not_stopped), end))


def _forbid_after(response: Formula, timing: Timing, end: Formula) -> Formula:
    """The negation of ``_demand_after``, unless the interval ends before its last step."""
    goal = f.either(response, end)
    formula = f.either(goal, Apply(Op.NEXT, (f.either(f.negate(response), end),)))
    for _ in range(timing.steps):
        formula = f.either(goal, Apply(Op.NEXT, (formula,)))
    return formula


_Demand = Callable[[Formula, Timing, Formula], Formula]


def _negate_response(demand: _Demand) -> _Demand:
    """Return the timing *demand* for the negated response."""
    return lambda response, timing, end: demand(f.negate(response), timing, end)


_TIMINGS: dict[str, _Demand] = {
    "immediately": _demand_immediately,
    "next": _demand_next,
    "eventually": _demand_eventually,
    "always": _demand_always,
    "never": _negate_response(_demand_always),
    "within": _demand_within,
    "for": _demand_for,
    "after": _demand_after,
    "until": _demand_until,
    "before": _demand_before,
}
_NEGATED_TIMINGS: dict[str, _Demand] = {
    "immediately": _negate_response(_demand_immediately),
    "next": _negate_response(_demand_next),
    "eventually": _negate_response(_demand_always),
    "always": _negate_response(_demand_eventually),
    "never": _demand_eventually,
    "within": _negate_response(_demand_for),
    "for": _negate_response(_demand_within),
    "after": _forbid_after,
    "until": _negate_response(_demand_before),
    "before": _negate_response(_demand_until),
}


# -- operators -------------------------------------------------------------------------------------


def _once(formula: Formula) -> Formula:
    return Apply(Op.ONCE, (formula,))


def _until(stay: Formula, goal: Formula) -> Formula:
    return f.eventually(goal) if stay == f.TRUE else Apply(Op.UNTIL, (stay, goal))


def _weak_until(stay: Formula, goal: Formula) -> Formula:
    return f.always(stay) if goal == f.FALSE else Apply(Op.WEAK_UNTIL, (stay, goal))
