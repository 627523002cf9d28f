"""Rules that reduce formulas of temporal logic to GR(1) with history bits.

The reductions are known: response, next inside liveness, bounded response, precedence, the past
(Bloem et al., Synthesis of Reactive(1) Designs; Pnueli's testers; Maoz and Ringert, GR(1) with
patterns). Every rule is an equivalence in all traces in which the bits follow their rules.
"""

from collections.abc import Iterator

from sysmlc.logic import formula as f
from sysmlc.logic.classification import classify
from sysmlc.logic.contract import Class
from sysmlc.logic.formula import FUTURE, PAST, Apply, Formula, Op, has_future, has_past, has_primes
from sysmlc.logic.reduction.history import History
from sysmlc.logic.reduction.normal_form import normalise

_MAX_NEXT_DEPTH = 64
"""Most nested X of a formula; each level needs a history bit."""
Part = tuple[Class, Formula]
"""A conjunct of GR(1): its class, and its formula without the operators that the class implies."""


class NotReducibleError(ValueError):
    """No known reduction brings the formula into GR(1); ``part`` is the part at fault."""

    def __init__(self, part: Formula) -> None:
        super().__init__("no reduction to GR(1) is known for it")
        self.part = part


def reduce_formula(formula: Formula, history: History, origin: str = "") -> list[Part]:
    """Return the formula as conjuncts of GR(1), and add the bits that they need to *history*.

    Raises NotReducibleError; then the history is unchanged.
    """
    try:
        return _reduce_as_written(formula, history, origin)
    except NotReducibleError:
        normal_form = normalise(formula)
        if normal_form == formula:
            raise
        return _reduce_as_written(normal_form, history, origin)


def _reduce_as_written(formula: Formula, history: History, origin: str) -> list[Part]:
    # A reduction that fails half way must leave no bits behind.
    trial = history.copy()
    parts = list(FormulaReduction(trial, origin).reduce(formula))
    history.adopt(trial)
    return parts


class FormulaReduction:
    """Applies the rules to a formula and creates history bits as it needs them.

    All methods raise NotReducibleError. In their parameters, *trigger* is a formula about the
    present and the past, and *body* is what must hold from every step in which the trigger holds.
    """

    def __init__(self, history: History, origin: str) -> None:
        self._history = history
        self._origin = origin

    def reduce(self, formula: Formula) -> Iterator[Part]:
        """Yield the conjuncts of a formula about the first step."""
        for class_, part in classify(self.replace_past(formula)):
            if class_ is Class.LIVENESS and has_primes(part):
                yield Class.LIVENESS, self._last_step(part)
            elif class_ is not Class.OTHER:
                yield class_, part
            else:
                yield from self._reduce_general(part)

    def _reduce_general(self, formula: Formula) -> Iterator[Part]:
        match formula:
            case Apply(Op.ALWAYS, (Apply(Op.EVENTUALLY, (inner,)),)) if (
                depth := _next_depth(inner)
            ) and not has_primes(inner):
                has_occurred = f.both(self._has_steps(depth), self._look_back(inner, depth))
                yield Class.LIVENESS, self._last_step(has_occurred)
            case Apply(Op.ALWAYS, (inner,)):
                yield from self._reduce_obligation(f.TRUE, inner)
            case _:
                yield from self._reduce_obligation(f.negate(self._previous(f.TRUE)), formula)

    def replace_past(self, formula: Formula) -> Formula:
        """Return the formula with history bits in place of operators of the past."""
        if not isinstance(formula, Apply):
            return formula
        if formula.op is Op.NEXT and has_past(formula):
            return self._replace_past_of_next(formula.args[0])
        args = tuple(self.replace_past(arg) for arg in formula.args)
        if formula.op not in PAST:
            return f.apply(formula.op, args)
        if any(has_future(arg) or has_primes(arg) for arg in args):
            raise NotReducibleError(formula)
        history, origin = self._history, self._origin
        if formula.op is Op.SINCE:
            return history.since(args[0], args[1], origin)
        observe = {
            Op.ONCE: history.once,
            Op.PREVIOUS: history.previous,
            Op.HISTORICALLY: history.historically,
        }
        return observe[formula.op](args[0], origin)

    def _replace_past_of_next(self, formula: Formula) -> Formula:
        """Return ``X formula`` with X in front of the present only: ``X Y p`` is p."""
        match formula:
            case Apply(Op.PREVIOUS, (inner,)):
                return self.replace_past(inner)
            case Apply(Op.SINCE, (stay, goal)):
                next_stay = self._replace_past_of_next(stay)
                return f.either(
                    self._replace_past_of_next(goal),
                    f.both(next_stay, self.replace_past(formula)),
                )
            case Apply(Op.ONCE, (inner,)):
                return f.either(self._replace_past_of_next(inner), self.replace_past(formula))
            case Apply(Op.HISTORICALLY, (inner,)):
                return f.both(self._replace_past_of_next(inner), self.replace_past(formula))
            case Apply(op, args) if has_past(formula) and op not in FUTURE:
                return f.apply(op, tuple(map(self._replace_past_of_next, args)))
            case _:
                return Apply(Op.NEXT, (self.replace_past(formula),))

    # -- obligations: G (trigger -> body) --------------------------------------------------------

    def _reduce_obligation(self, trigger: Formula, body: Formula) -> Iterator[Part]:
        """Reduce ``G (trigger -> body)``."""
        if not has_future(body):
            yield Class.SAFETY, f.implies(trigger, body)
            return
        assert isinstance(body, Apply)
        bounded = None if self._is_stepwise(trigger, body) else self._reduce_next(trigger, body)
        if bounded is not None:
            yield Class.SAFETY, bounded
            return
        yield from self._reduce_by_operator(trigger, body, body.op)

    def _reduce_by_operator(self, trigger: Formula, body: Apply, op: Op) -> Iterator[Part]:
        """Reduce an obligation by *op*, the outermost operator of its body."""
        args = body.args
        if op is Op.AND:
            for arg in args:
                yield from self._reduce_obligation(trigger, arg)
        elif op is Op.IMPLIES and not has_future(args[0]):
            yield from self._reduce_obligation(f.both(trigger, args[0]), args[1])
        elif op is Op.OR and sum(map(has_future, args)) == 1:
            negated = [f.negate(arg) for arg in args if not has_future(arg)]
            (future,) = (arg for arg in args if has_future(arg))
            yield from self._reduce_obligation(f.both(trigger, *negated), future)
        elif op is Op.NOT:
            yield from self._reduce_obligation(trigger, _push_negation(args[0]))
        elif op is Op.NEXT:
            _check_unprimed(trigger, body)
            yield from self._reduce_obligation(self._previous(trigger), args[0])
        elif op is Op.ALWAYS:
            yield from self._reduce_obligation(self._history.once(trigger, self._origin), args[0])
        elif op in _UNTIL_OPERATORS and not any(map(has_future, args)):
            yield from self._reduce_until(trigger, body)
        elif op is Op.EVENTUALLY:
            yield from self._reduce_eventually(trigger, body, args[0])
        else:
            raise NotReducibleError(body)

    def _reduce_until(self, trigger: Formula, body: Apply) -> Iterator[Part]:
        """Reduce until, weak until, release or eventually, whose operands are about the present.

        A bit stores whether an obligation is pending: the trigger has held, and the goal has not
        held since then.
        """
        if any(map(has_primes, body.args)):
            raise NotReducibleError(body)
        # ``p R q``: p ends the obligation that q holds. Else the last operand is the goal.
        goal = body.args[0] if body.op is Op.RELEASE else body.args[-1]
        is_missing = f.negate(goal)
        pending = self._since(is_missing, f.both(trigger, is_missing))
        if body.op is Op.RELEASE:
            # q must hold in the step of the goal, too, which ends the obligation.
            was_pending = self._previous(pending)
            yield Class.SAFETY, f.implies(f.either(trigger, was_pending), body.args[1])
            return
        if body.op is not Op.EVENTUALLY:
            yield Class.SAFETY, f.implies(pending, body.args[0])
        if body.op is not Op.WEAK_UNTIL:
            yield Class.LIVENESS, f.negate(pending)

    def _reduce_eventually(self, trigger: Formula, body: Apply, inner: Formula) -> Iterator[Part]:
        """Reduce ``F inner``, where *inner* needs a bounded number of steps or contains one F.

        The latter is ``F F q`` or ``F (a & F b)``. A b that follows a later a also follows the
        first a, so it is enough to wait for the first a and then for b.
        """
        depth = _next_depth(inner)
        if depth and not has_primes(body):
            _check_unprimed(trigger, body)
            has_occurred = f.both(self._has_steps(depth), self._look_back(inner, depth))
            goal = f.eventually(self._last_step(has_occurred))
            yield from self._reduce_obligation(self._shift_back(trigger, depth), goal)
            return
        parts = f.split_conjunction(inner)
        future = [part for part in parts if has_future(part)]
        if (
            len(future) != 1
            or not isinstance(future[0], Apply)
            or future[0].op is not Op.EVENTUALLY
        ):
            raise NotReducibleError(body)
        present = f.both(*(part for part in parts if part != future[0]))
        yield from self._reduce_sequence(trigger, body, present, future[0])

    def _reduce_sequence(
        self, trigger: Formula, body: Apply, present: Formula, future: Formula
    ) -> Iterator[Part]:
        """Reduce the obligation that *present* holds in some step, and *future* in that step."""
        is_missing = f.negate(present)
        if has_primes(present) or has_primes(trigger):
            raise NotReducibleError(body)
        if present == f.TRUE:
            yield from self._reduce_obligation(trigger, future)
            return
        pending = self._since(is_missing, f.both(trigger, is_missing))
        yield Class.LIVENESS, f.negate(pending)
        is_due = f.either(trigger, self._previous(pending))
        yield from self._reduce_obligation(f.both(present, is_due), future)

    # -- bounded look-ahead: X --------------------------------------------------------------------

    def _is_stepwise(self, trigger: Formula, body: Apply) -> bool:
        """Whether each X of the body can be reduced by itself.

        A bit for each step then stores what is still due, as for ``q | X (q | X q)``. To evaluate
        the whole body in its last step takes a bit for each step and each of its conditions.
        """
        depth = _next_depth(body)
        if depth is None or depth < 2 or has_primes(body) or has_primes(trigger):
            return False
        if depth > _MAX_NEXT_DEPTH:
            raise NotReducibleError(body)
        is_single = sum(map(has_future, body.args)) == 1
        is_premise_present = body.op is Op.IMPLIES and not has_future(body.args[0])
        return (
            body.op in (Op.NEXT, Op.AND) or (body.op is Op.OR and is_single) or is_premise_present
        )

    def _reduce_next(self, trigger: Formula, body: Formula) -> Formula | None:
        """Return the obligation for a body with no temporal operator but X; None for another body.

        It is evaluated in the last step that it refers to; bits store the steps before that step.
        """
        depth = _next_depth(body)
        if depth is None or has_primes(body) or has_primes(trigger):
            return None
        obligation = f.implies(trigger, body)
        return f.implies(self._has_steps(depth), self._look_back(obligation, depth))

    def _has_steps(self, depth: int) -> Formula:
        """Return the condition that at least ``depth - 1`` steps precede this one."""
        if depth > _MAX_NEXT_DEPTH:
            raise NotReducibleError(f.TRUE)
        has_steps: Formula = f.TRUE
        for _ in range(depth - 1):
            has_steps = self._previous(has_steps)
        return has_steps

    def _look_back(self, formula: Formula, depth: int) -> Formula:
        """Return the condition that *formula* held ``depth - 1`` steps ago."""
        match formula:
            case Apply(Op.NEXT, (inner,)):
                return self._look_back(inner, depth - 1)
            case Apply(op, args) if _next_depth(formula):
                return f.apply(op, tuple(self._look_back(arg, depth) for arg in args))
            case _:
                return self._shift_back(formula, depth - 1)

    def _shift_back(self, formula: Formula, steps: int) -> Formula:
        """Return the condition that *formula* held *steps* steps ago; -1 is the next step."""
        if steps < 0:
            return f.prime(formula)
        for _ in range(steps):
            formula = self._previous(formula)
        return formula

    # -- history bits -----------------------------------------------------------------------------

    def _previous(self, formula: Formula) -> Formula:
        return self._history.previous(formula, self._origin)

    def _since(self, stay: Formula, goal: Formula) -> Formula:
        return self._history.since(stay, goal, self._origin)

    def _last_step(self, step: Formula) -> Formula:
        """Return a bit that is true in the next step if and only if *step* holds now."""
        return self._history.last_step(step, self._origin)


# -- formulas ------------------------------------------------------------------------------------

_UNTIL_OPERATORS = (Op.EVENTUALLY, Op.UNTIL, Op.WEAK_UNTIL, Op.RELEASE)
_DUAL = {
    Op.AND: Op.OR,
    Op.OR: Op.AND,
    Op.NEXT: Op.NEXT,
    Op.ALWAYS: Op.EVENTUALLY,
    Op.EVENTUALLY: Op.ALWAYS,
    Op.IMPLIES: Op.AND,
    Op.UNTIL: Op.RELEASE,
    Op.RELEASE: Op.UNTIL,
    Op.WEAK_UNTIL: Op.UNTIL,
}


def _push_negation(body: Formula) -> Formula:
    """Return ``not body`` with the negation moved to the operands (De Morgan, duality)."""
    if not isinstance(body, Apply) or body.op not in _DUAL:
        raise NotReducibleError(body)
    negated = tuple(map(f.negate, body.args))
    match body.op:
        case Op.IMPLIES:
            return f.both(body.args[0], negated[1])
        case Op.WEAK_UNTIL:
            left, right = negated
            return Apply(Op.UNTIL, (right, f.both(left, right)))
        case op:
            return f.apply(_DUAL[op], negated)


def _check_unprimed(trigger: Formula, body: Formula) -> None:
    """Raise NotReducibleError if the trigger has primes, because no history bit can store it."""
    if has_primes(trigger):
        raise NotReducibleError(body)


def _next_depth(formula: Formula) -> int | None:
    """Return how deep operators X are nested; None if there are other operators of the future."""
    if not isinstance(formula, Apply):
        return 0
    if formula.op in FUTURE and formula.op is not Op.NEXT:
        return None
    deepest = 0
    for arg in formula.args:
        depth = _next_depth(arg)
        if depth is None:
            return None
        deepest = max(deepest, depth)
    return deepest + (formula.op is Op.NEXT)
