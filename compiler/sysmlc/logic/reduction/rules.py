"""Rules that bring temporal logic into GR(1) with history bits, formula by formula.

Known reductions: response, next inside liveness, bounded response, precedence, the past (Bloem et
al., Synthesis of Reactive(1) Designs; Pnueli's testers; Maoz and Ringert, GR(1) with patterns).
Every rule is an equivalence in all traces in which the bits follow their rules.
"""

from collections.abc import Iterator

from sysmlc.logic import formula as f
from sysmlc.logic.classification import classify
from sysmlc.logic.contract import Class
from sysmlc.logic.evaluate import has_primes
from sysmlc.logic.formula import Apply, Formula, Op
from sysmlc.logic.reduction.history import History
from sysmlc.logic.spelling import PAST, TEMPORAL

DEEPEST_NEXT = 64
"""Steps ahead that are remembered, one bit each."""
Part = tuple[Class, Formula]


class NotReducibleError(ValueError):
    """A formula that no known reduction brings into GR(1); ``part`` is what cannot be said."""

    def __init__(self, part: Formula) -> None:
        super().__init__("no reduction to GR(1) is known for it")
        self.part = part


def parts_of(formula: Formula, history: History, origin: str = "") -> list[Part]:
    """The formula as conjuncts of GR(1); its bits are added to the history, if it has some.

    Raises NotReducibleError.
    """
    trial = history.copy()
    found = list(Reduction(trial, origin).parts(formula))
    history.take(trial)
    return found


class Reduction:
    """Applies the rules; makes bits as it needs them. All raise NotReducibleError."""

    def __init__(self, history: History, origin: str) -> None:
        self._history = history
        self._origin = origin

    def parts(self, formula: Formula) -> Iterator[Part]:
        """The conjuncts of a formula about the first step."""
        for class_, part in classify(self.present(formula)):
            if class_ is Class.LIVENESS and has_primes(part):
                yield Class.LIVENESS, self._happened(part)
            elif class_ is not Class.OTHER:
                yield class_, part
            else:
                yield from self._general(part)

    def _general(self, formula: Formula) -> Iterator[Part]:
        match formula:
            case Apply(Op.ALWAYS, (Apply(Op.EVENTUALLY, (inner,)),)) if (
                depth := _next_depth(inner)
            ) and not has_primes(inner):
                seen = f.both(self._passed(depth), self._seen_from(inner, depth))
                yield Class.LIVENESS, self._happened(seen)
            case Apply(Op.ALWAYS, (inner,)):
                yield from self._whenever(f.TRUE, inner)
            case _:
                yield from self._whenever(self._first(), formula)

    def present(self, formula: Formula) -> Formula:
        """The formula with bits for its past."""
        if not isinstance(formula, Apply):
            return formula
        args = tuple(self.present(arg) for arg in formula.args)
        if formula.op not in PAST:
            return rebuilt(formula.op, args)
        if any(is_ahead(arg) or has_primes(arg) for arg in args):
            raise NotReducibleError(formula)
        return self._of_past(formula.op, args)

    def _of_past(self, op: Op, args: tuple[Formula, ...]) -> Formula:
        if op is Op.SINCE:
            return self._history.since(args[0], args[1], self._origin)
        if op is Op.ONCE:
            return self._history.once(args[0], self._origin)
        make = self._history.previous if op is Op.PREVIOUS else self._history.historically
        return make(args[0], self._origin)

    def _previous(self, formula: Formula) -> Formula:
        return self._history.previous(formula, self._origin)

    def _first(self) -> Formula:
        """That this is the first step."""
        return f.negate(self._previous(f.TRUE))

    def _happened(self, step: Formula) -> Formula:
        """A bit that tells whether the last step was of that kind: again and again it is."""
        return self._history.step(step, self._origin)

    def _whenever(self, when: Formula, body: Formula) -> Iterator[Part]:
        """``G (when -> body)``; ``when`` is about the present."""
        if not is_ahead(body):
            yield Class.SAFETY, f.implies(when, body)
            return
        assert isinstance(body, Apply)
        if (step := self._steps(when, body)) is not None:
            yield Class.SAFETY, step
            return
        yield from self._by_operator(when, body, body.op)

    def _by_operator(self, when: Formula, body: Apply, op: Op) -> Iterator[Part]:
        args = body.args
        if op is Op.AND:
            for arg in args:
                yield from self._whenever(when, arg)
        elif op is Op.IMPLIES and not is_ahead(args[0]):
            yield from self._whenever(f.both(when, args[0]), args[1])
        elif op is Op.OR and sum(map(is_ahead, args)) == 1:
            rest = [f.negate(arg) for arg in args if not is_ahead(arg)]
            (body_,) = (arg for arg in args if is_ahead(arg))
            yield from self._whenever(f.both(when, *rest), body_)
        elif op is Op.NOT:
            yield from self._whenever(when, self._dual(args[0]))
        elif op is Op.NEXT:
            yield from self._whenever(self._previous(self._present_only(when, body)), args[0])
        elif op is Op.ALWAYS:
            yield from self._whenever(self._history.once(when, self._origin), args[0])
        elif op in _OPEN and not any(map(is_ahead, args)):
            yield from self._opened(when, body)
        elif op is Op.EVENTUALLY:
            yield from self._far(when, body, args[0])
        else:
            raise NotReducibleError(body)

    def _far(self, when: Formula, body: Apply, inner: Formula) -> Iterator[Part]:
        """``F`` of some steps, ``F F q``, ``F (a & F b)``: the first a is as good as any."""
        if (depth := _next_depth(inner)) and not has_primes(body):
            seen = f.both(self._passed(depth), self._seen_from(inner, depth))
            goal = f.eventually(self._happened(seen))
            yield from self._whenever(self._back(self._present_only(when, body), depth), goal)
            return
        parts = inner.args if isinstance(inner, Apply) and inner.op is Op.AND else (inner,)
        far = [part for part in parts if is_ahead(part)]
        if len(far) != 1 or not isinstance(far[0], Apply) or far[0].op is not Op.EVENTUALLY:
            raise NotReducibleError(body)
        near = f.both(*(part for part in parts if part != far[0]))
        yield from self._in_turn(when, body, near, far[0])

    def _in_turn(self, when: Formula, body: Apply, near: Formula, far: Formula) -> Iterator[Part]:
        """First ``near``, then or later what ``far`` says."""
        off = f.negate(near)
        if has_primes(near) or has_primes(when):
            raise NotReducibleError(body)
        if near == f.TRUE:
            yield from self._whenever(when, far)
            return
        waits = self._history.since(off, f.both(when, off), self._origin)
        yield Class.LIVENESS, f.negate(waits)
        yield from self._whenever(f.both(near, f.either(when, self._previous(waits))), far)

    def _opened(self, when: Formula, body: Apply) -> Iterator[Part]:
        """Until, weak until, release, eventually: a bit tells that ``when`` still waits."""
        if any(map(has_primes, body.args)):
            raise NotReducibleError(body)
        if body.op is Op.RELEASE:
            goal, stay = body.args
            off = f.negate(goal)
            waited = self._history.since(off, f.both(when, off), self._origin)
            yield Class.SAFETY, f.implies(f.either(when, self._previous(waited)), stay)
            return
        goal = body.args[-1]
        off = f.negate(goal)
        waits = self._history.since(off, f.both(when, off), self._origin)
        if body.op is not Op.EVENTUALLY:
            yield Class.SAFETY, f.implies(waits, body.args[0])
        if body.op is not Op.WEAK_UNTIL:
            yield Class.LIVENESS, f.negate(waits)

    def _dual(self, body: Formula) -> Formula:
        """What ``not body`` says, without the not in front."""
        if not isinstance(body, Apply) or body.op not in _DUAL:
            raise NotReducibleError(body)
        negated = tuple(map(f.negate, body.args))
        match body.op:
            case Op.IMPLIES:
                return f.both(body.args[0], negated[1])
            case Op.UNTIL:
                return Apply(Op.RELEASE, negated)
            case Op.RELEASE:
                return Apply(Op.UNTIL, negated)
            case Op.WEAK_UNTIL:
                left, right = negated
                return Apply(Op.UNTIL, (right, f.both(left, right)))
            case op:
                return rebuilt(_DUAL[op], negated)

    def _present_only(self, when: Formula, body: Formula) -> Formula:
        if has_primes(when):
            raise NotReducibleError(body)
        return when

    def _steps(self, when: Formula, body: Formula) -> Formula | None:
        """Conditions on some steps ahead: looked at from the last of them, bits tell the rest."""
        depth = _next_depth(body)
        if depth is None or has_primes(body) or has_primes(when):
            return None
        return f.implies(self._passed(depth), self._seen_from(f.implies(when, body), depth))

    def _passed(self, depth: int) -> Formula:
        """That a step lies ``depth - 1`` steps back."""
        if depth > DEEPEST_NEXT:
            raise NotReducibleError(f.TRUE)
        passed: Formula = f.TRUE
        for _ in range(depth - 1):
            passed = self._previous(passed)
        return passed

    def _seen_from(self, formula: Formula, ahead: int) -> Formula:
        """A formula about a step that lies ``ahead - 1`` steps back."""
        match formula:
            case Apply(Op.NEXT, (inner,)):
                return self._seen_from(inner, ahead - 1)
            case Apply(op, args) if _next_depth(formula):
                return rebuilt(op, tuple(self._seen_from(arg, ahead) for arg in args))
            case _:
                return self._back(formula, ahead - 1)

    def _back(self, formula: Formula, steps: int) -> Formula:
        if steps < 0:
            return f.primed(formula)
        for _ in range(steps):
            formula = self._previous(formula)
        return formula


_OPEN = (Op.EVENTUALLY, Op.UNTIL, Op.WEAK_UNTIL, Op.RELEASE)
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


def rebuilt(op: Op, args: tuple[Formula, ...]) -> Formula:
    """An operator applied, flat and without constants that say nothing."""
    match op:
        case Op.AND:
            return f.both(*args)
        case Op.OR:
            return f.either(*args)
        case Op.NOT:
            return f.negate(args[0])
        case Op.IMPLIES:
            return f.implies(*args)
        case _:
            return Apply(op, args)


def is_ahead(formula: Formula) -> bool:
    """Whether the formula has temporal operators of the future."""
    if not isinstance(formula, Apply):
        return False
    return formula.op in TEMPORAL or any(map(is_ahead, formula.args))


def _next_depth(formula: Formula) -> int | None:
    """How many steps ahead a formula looks that has no other temporal operator than next."""
    if not isinstance(formula, Apply):
        return 0
    if formula.op in TEMPORAL and formula.op is not Op.NEXT:
        return None
    depths = [_next_depth(arg) for arg in formula.args]
    known = [depth for depth in depths if depth is not None]
    if len(known) < len(depths):
        return None
    return max(known, default=0) + (formula.op is Op.NEXT)


def has_past(formula: Formula) -> bool:
    """Whether the formula has operators of the past."""
    if not isinstance(formula, Apply):
        return False
    return formula.op in PAST or any(map(has_past, formula.args))
