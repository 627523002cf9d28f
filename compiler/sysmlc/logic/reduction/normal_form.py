"""Normal form of formulas that no reduction to GR(1) fits as they are written.

Negations stand before formulas about the present and the past, implications are disjunctions, and
operators have one spelling: ``p W false`` is ``G p``, ``X p U X q`` is ``X (p U q)``, ``p U X q``
is ``X (Y p U q)``, and ``G p | p U q`` is ``p W q``.
"""

from collections.abc import Callable

from sysmlc.logic import formula as f
from sysmlc.logic.formula import FUTURE, Apply, Const, Formula, Op, has_future


def normalise(formula: Formula, *, is_negated: bool = False) -> Formula:
    """Return a formula in normal form that is equivalent to *formula*, or to its negation."""
    if not isinstance(formula, Apply) or not has_future(formula):
        return f.negate(formula) if is_negated else formula
    op, args = formula.op, formula.args
    match op:
        case Op.NOT:
            return normalise(args[0], is_negated=not is_negated)
        case Op.IMPLIES:
            return normalise(f.either(f.negate(args[0]), args[1]), is_negated=is_negated)
        case Op.IFF:
            left, right = args
            both_ways = f.both(f.implies(left, right), f.implies(right, left))
            return normalise(both_ways, is_negated=is_negated)
        case Op.WEAK_UNTIL if is_negated:
            left, right = args
            return normalise(Apply(Op.UNTIL, (f.negate(right), f.negate(f.either(left, right)))))
        case _:
            parts = tuple(normalise(arg, is_negated=is_negated) for arg in args)
            return _apply(_DUALS[op] if is_negated else op, parts)


def _apply(op: Op, args: tuple[Formula, ...]) -> Formula:
    """Apply an operator to operands in normal form."""
    if op is Op.AND:
        return f.both(*args)
    if op is Op.OR:
        return _join_next(_weaken_until(f.either(*args)))
    if all(isinstance(arg, Const) for arg in args):
        return args[-1]
    if op in FUTURE and op is not Op.NEXT:
        stripped = [_strip_next(arg) for arg in args]
        if any(arg is not None and not isinstance(arg, Const) for arg in stripped):
            shifted = [
                _shift_back(arg) if inner is None else inner
                for arg, inner in zip(args, stripped, strict=True)
            ]
            if None not in shifted:
                return Apply(
                    Op.NEXT, (_apply(op, tuple(arg for arg in shifted if arg is not None)),)
                )
    return _REWRITTEN[op](args) if op in _REWRITTEN else Apply(op, args)


def _strip_next(formula: Formula) -> Formula | None:
    """Return the formula whose next is *formula*, or None."""
    match formula:
        case Const():
            return formula
        case Apply(Op.NEXT, (inner,)):
            return inner
        case Apply(op, args) if op in FUTURE or op in (Op.AND, Op.OR):
            stripped = tuple(part for arg in args if (part := _strip_next(arg)) is not None)
            return _apply(op, stripped) if len(stripped) == len(args) else None
        case _:
            return None


def _shift_back(formula: Formula) -> Formula | None:
    """Return the formula as seen from the next step, if it has no future."""
    return None if has_future(formula) else Apply(Op.PREVIOUS, (formula,))


def _join_next(disjunction: Formula) -> Formula:
    """Replace ``X p | X q`` by ``X (p | q)``."""
    if not isinstance(disjunction, Apply) or disjunction.op is not Op.OR:
        return disjunction
    inner = [
        arg.args[0] for arg in disjunction.args if isinstance(arg, Apply) and arg.op is Op.NEXT
    ]
    if len(inner) < 2:
        return disjunction
    rest = [arg for arg in disjunction.args if not (isinstance(arg, Apply) and arg.op is Op.NEXT)]
    return f.either(*rest, Apply(Op.NEXT, (_apply(Op.OR, tuple(inner)),)))


def _weaken_until(disjunction: Formula) -> Formula:
    """Replace ``G p | p U q`` by ``p W q``."""
    if not isinstance(disjunction, Apply) or disjunction.op is not Op.OR:
        return disjunction
    args = disjunction.args
    always = {arg.args[0] for arg in args if isinstance(arg, Apply) and arg.op is Op.ALWAYS}
    weakened: dict[Formula, Formula] = {}
    for arg in args:
        if isinstance(arg, Apply) and arg.op is Op.UNTIL and arg.args[0] in always:
            weakened[arg] = Apply(Op.WEAK_UNTIL, arg.args)
            weakened[f.always(arg.args[0])] = f.FALSE
    return f.either(*(weakened.get(arg, arg) for arg in args))


def _rewrite_until(args: tuple[Formula, ...]) -> Formula:
    return _rewrite_eventually(args[1:]) if args[0] == f.TRUE else Apply(Op.UNTIL, args)


def _rewrite_weak_until(args: tuple[Formula, ...]) -> Formula:
    return _rewrite_always(args[:1]) if args[1] == f.FALSE else Apply(Op.WEAK_UNTIL, args)


def _rewrite_release(args: tuple[Formula, ...]) -> Formula:
    return _rewrite_always(args[1:]) if args[0] == f.FALSE else Apply(Op.RELEASE, args)


def _rewrite_always(args: tuple[Formula, ...]) -> Formula:
    (inner,) = args
    is_repeated = isinstance(inner, Apply) and inner.op is Op.ALWAYS
    return inner if is_repeated else f.always(inner)


def _rewrite_eventually(args: tuple[Formula, ...]) -> Formula:
    (inner,) = args
    is_repeated = isinstance(inner, Apply) and inner.op is Op.EVENTUALLY
    return inner if is_repeated else f.eventually(inner)


_DUALS = {
    Op.AND: Op.OR,
    Op.OR: Op.AND,
    Op.NEXT: Op.NEXT,
    Op.ALWAYS: Op.EVENTUALLY,
    Op.EVENTUALLY: Op.ALWAYS,
    Op.UNTIL: Op.RELEASE,
    Op.RELEASE: Op.UNTIL,
}
_REWRITTEN: dict[Op, Callable[[tuple[Formula, ...]], Formula]] = {
    Op.UNTIL: _rewrite_until,
    Op.WEAK_UNTIL: _rewrite_weak_until,
    Op.RELEASE: _rewrite_release,
    Op.ALWAYS: _rewrite_always,
    Op.EVENTUALLY: _rewrite_eventually,
}
