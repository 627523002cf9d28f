"""Pairs of equivalent formulas: random ones, rewritten by random laws of temporal logic."""

import random
from collections.abc import Callable, Iterator

from sysmlc.logic import formula as f
from sysmlc.logic.formula import FUTURE, Apply, Formula, Op, Var, has_future

Law = Callable[[Formula], Formula | None]
"""Returns an equivalent formula, or None if the law does not apply to the formula."""

TEMPORAL = (Op.NEXT, Op.ALWAYS, Op.EVENTUALLY, Op.UNTIL, Op.WEAK_UNTIL, Op.RELEASE)


def apply(op: Op, *args: Formula) -> Formula:
    return Apply(op, args)


def negate(formula: Formula) -> Formula:
    """Return the negation as it is written, without removing a double one."""
    return Apply(Op.NOT, (formula,))


# -- random formulas -------------------------------------------------------------------------------


def draw_state(die: random.Random, names: str, past: bool, depth: int = 2) -> Formula:
    """Return a formula about the present and, if *past*, about the past."""
    kind = die.random()
    if depth == 0 or kind < 0.4:
        return Var(die.choice(names))

    def draw() -> Formula:
        return draw_state(die, names, past, depth - 1)

    if kind < 0.6:
        return negate(draw())
    if past and kind < 0.8:
        op = die.choice((Op.PREVIOUS, Op.ONCE, Op.HISTORICALLY, Op.SINCE))
        return apply(op, draw(), draw()) if op is Op.SINCE else apply(op, draw())
    return apply(die.choice((Op.AND, Op.OR, Op.IMPLIES)), draw(), draw())


def draw_body(die: random.Random, names: str, past: bool, depth: int = 3) -> Formula:
    """Return what must hold from some step on; most of these formulas have a form in GR(1)."""
    kind = die.random()

    def draw() -> Formula:
        return draw_body(die, names, past, depth - 1)

    def draw_present() -> Formula:
        return draw_state(die, names, past, 1)

    if depth == 0 or kind < 0.15:
        return draw_present()
    if kind < 0.5:
        return apply(Op.NEXT, draw())
    if kind < 0.65:
        return apply(die.choice((Op.AND, Op.OR)), draw(), draw())
    if kind < 0.75:
        return apply(Op.IMPLIES, draw_present(), draw())
    if kind < 0.8:
        return negate(draw())
    op = die.choice((Op.EVENTUALLY, Op.ALWAYS, Op.UNTIL, Op.WEAK_UNTIL, Op.RELEASE))
    if op in (Op.EVENTUALLY, Op.ALWAYS):
        return apply(op, draw_present())
    return apply(op, draw_present(), draw_present())


def draw_formula(die: random.Random, names: str, past: bool) -> Formula:
    """Return a formula about the first step."""
    kind = die.random()
    if kind < 0.1:
        return draw_body(die, names, past)
    if kind < 0.2:
        return apply(Op.ALWAYS, apply(Op.EVENTUALLY, draw_state(die, names, past)))
    body = draw_body(die, names, past)
    if kind < 0.8:
        body = apply(Op.IMPLIES, draw_state(die, names, past, 1), body)
    return apply(Op.ALWAYS, body)


# -- laws ------------------------------------------------------------------------------------------


def _for(op: Op, rewrite: Callable[..., Formula | None]) -> Law:
    def apply_law(formula: Formula) -> Formula | None:
        if not isinstance(formula, Apply) or formula.op is not op:
            return None
        return rewrite(*formula.args)

    return apply_law


def _both(left: Formula, right: Formula) -> Formula:
    return apply(Op.AND, left, right)


def _either(left: Formula, right: Formula) -> Formula:
    return apply(Op.OR, left, right)


def _distribute(outer: Op) -> Law:
    """X and Y distribute over connectives, X over every temporal operator of the future."""

    def rewrite(inner: Formula) -> Formula | None:
        if not isinstance(inner, Apply):
            return None
        if outer is Op.PREVIOUS:
            # In the first step, Y p is false for every p.
            return (
                Apply(inner.op, tuple(apply(outer, arg) for arg in inner.args))
                if inner.op in (Op.AND, Op.OR)
                else None
            )
        if inner.op in (Op.AND, Op.OR, Op.IMPLIES, Op.NOT) or inner.op in FUTURE:
            return Apply(inner.op, tuple(apply(outer, arg) for arg in inner.args))
        return None

    return _for(outer, rewrite)


def _collect(outer: Op) -> Law:
    """The converse of ``_distribute``, and of the distribution of G over conjunctions."""

    def apply_law(formula: Formula) -> Formula | None:
        if not isinstance(formula, Apply) or formula.op not in (Op.AND, Op.OR):
            return None
        if outer is Op.ALWAYS and formula.op is Op.OR:
            return None
        args = formula.args
        if not all(isinstance(arg, Apply) and arg.op is outer for arg in args):
            return None
        return apply(outer, Apply(formula.op, tuple(arg.args[0] for arg in args)))

    return apply_law


def _swap(*args: Formula) -> Formula:
    return Apply(Op.AND, args[::-1])


def _spread(op: Op, other: Op) -> Law:
    """A connective distributes over the other one."""

    def rewrite(*args: Formula) -> Formula | None:
        for index, arg in enumerate(args):
            if isinstance(arg, Apply) and arg.op is other:
                rest = (*args[:index], *args[index + 1 :])
                return Apply(other, tuple(Apply(op, (*rest, part)) for part in arg.args))
        return None

    return _for(op, rewrite)


def _always_both(inner: Formula) -> Formula | None:
    if isinstance(inner, Apply) and inner.op is Op.AND:
        return Apply(Op.AND, tuple(apply(Op.ALWAYS, arg) for arg in inner.args))
    return None


X, G, F, U, W, R = TEMPORAL
Y, ONCE, H, S = Op.PREVIOUS, Op.ONCE, Op.HISTORICALLY, Op.SINCE
LAWS: tuple[Law, ...] = (
    # Distribution.
    *map(_distribute, (X, X, Y)),
    *map(_collect, (X, Y, G)),
    _for(G, _always_both),
    _spread(Op.AND, Op.OR),
    _spread(Op.OR, Op.AND),
    # Duals.
    _for(Op.AND, lambda *args: negate(Apply(Op.OR, tuple(map(negate, args))))),
    _for(Op.OR, lambda *args: negate(Apply(Op.AND, tuple(map(negate, args))))),
    _for(Op.IMPLIES, lambda p, q: _either(negate(p), q)),
    _for(Op.IMPLIES, lambda p, q: apply(Op.IMPLIES, negate(q), negate(p))),
    _for(X, lambda p: negate(apply(X, negate(p)))),
    _for(G, lambda p: negate(apply(F, negate(p)))),
    _for(F, lambda p: negate(apply(G, negate(p)))),
    _for(U, lambda p, q: negate(apply(R, negate(p), negate(q)))),
    _for(R, lambda p, q: negate(apply(U, negate(p), negate(q)))),
    _for(W, lambda p, q: negate(apply(U, negate(q), _both(negate(p), negate(q))))),
    _for(ONCE, lambda p: negate(apply(H, negate(p)))),
    _for(H, lambda p: negate(apply(ONCE, negate(p)))),
    lambda p: negate(negate(p)),
    # Expansion.
    _for(G, lambda p: _both(p, apply(X, apply(G, p)))),
    _for(F, lambda p: _either(p, apply(X, apply(F, p)))),
    _for(U, lambda p, q: _either(q, _both(p, apply(X, apply(U, p, q))))),
    _for(W, lambda p, q: _either(q, _both(p, apply(X, apply(W, p, q))))),
    _for(R, lambda p, q: _both(q, _either(p, apply(X, apply(R, p, q))))),
    _for(S, lambda p, q: _either(q, _both(p, apply(Y, apply(S, p, q))))),
    _for(ONCE, lambda p: _either(p, apply(Y, apply(ONCE, p)))),
    _for(H, lambda p: _both(p, negate(apply(Y, negate(apply(H, p)))))),
    # One operator by others.
    _for(U, lambda p, q: _both(apply(W, p, q), apply(F, q))),
    _for(W, lambda p, q: apply(R, q, _either(p, q))),
    _for(R, lambda p, q: apply(W, q, _both(p, q))),
    _for(W, lambda p, q: _either(apply(G, p), apply(U, p, q))),
    _for(F, lambda p: apply(U, f.TRUE, p)),
    _for(G, lambda p: apply(R, f.FALSE, p)),
    _for(G, lambda p: apply(W, p, f.FALSE)),
    _for(ONCE, lambda p: apply(S, f.TRUE, p)),
    _for(G, lambda p: apply(G, apply(G, p))),
    lambda p: None if has_future(p) else apply(X, apply(Y, p)),
    _for(Op.AND, _swap),
)


def rewrite(die: random.Random, formula: Formula, count: int) -> Formula:
    """Return the formula after *count* laws, each applied to a random part."""
    for _ in range(count):
        position = die.randrange(_size(formula))
        formula = _rewrite_part(die, formula, position, has_past_above=False)
    return formula


def _size(formula: Formula) -> int:
    return 1 + sum(map(_size, formula.args)) if isinstance(formula, Apply) else 1


def _rewrite_part(
    die: random.Random, formula: Formula, position: int, has_past_above: bool
) -> Formula:
    if position == 0:
        results = list(_list_results(formula, has_past_above))
        return die.choice(results) if results else formula
    assert isinstance(formula, Apply)
    position -= 1
    args = list(formula.args)
    below_past = has_past_above or formula.op in (Y, ONCE, H, S)
    for index, arg in enumerate(args):
        if position < _size(arg):
            args[index] = _rewrite_part(die, arg, position, below_past)
            break
        position -= _size(arg)
    return Apply(formula.op, tuple(args))


def _list_results(formula: Formula, has_past_above: bool) -> Iterator[Formula]:
    for law in LAWS:
        result = law(formula)
        # Operators of the past are about the past only.
        if result is not None and not (has_past_above and has_future(result)):
            yield result
