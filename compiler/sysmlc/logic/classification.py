"""Classes of GR(1): the class of an LTL formula, and its form in that class (thesis, 2.2.3)."""

from collections.abc import Iterator, Sequence

from msgspec.structs import replace

from sysmlc.logic import formula as f
from sysmlc.logic.contract import Class, Conjunct
from sysmlc.logic.formula import FUTURE, Apply, Formula, Op, has_future, has_past, has_primes


def classify(formula: Formula) -> Iterator[tuple[Class, Formula]]:
    """Yield the conjuncts of an LTL formula with their classes.

    ``G p`` is safety and ``G F p`` liveness (X inside p becomes primes); a formula without temporal
    operators is initial. Any other formula is ``other`` and keeps its operators.
    """
    match formula:
        case Apply(Op.AND, args):
            for arg in _join_always(args):
                yield from classify(arg)
        case Apply(Op.ALWAYS, (Apply(Op.AND, args),)):
            for arg in args:
                yield from classify(f.always(arg))
        case Apply(Op.ALWAYS, (Apply(Op.EVENTUALLY, (inner,)),)) if (
            step := _replace_next_by_primes(inner)
        ) is not None:
            yield Class.LIVENESS, step
        case Apply(Op.NOT, (Apply(Op.EVENTUALLY, (Apply(Op.ALWAYS, (inner,)),)),)) if (
            step := _replace_next_by_primes(inner)
        ) is not None:
            yield Class.LIVENESS, f.negate(step)
        case Apply(Op.ALWAYS, (inner,)) if (step := _replace_next_by_primes(inner)) is not None:
            yield Class.SAFETY, step
        case _:
            is_initial = not has_future(formula) and not has_primes(formula)
            yield (Class.INIT if is_initial else Class.OTHER), formula


def _join_always(args: tuple[Formula, ...]) -> list[Formula]:
    """Replace ``p`` and ``X G p`` by ``G p``."""
    later = {Apply(Op.NEXT, (f.always(arg),)): arg for arg in args}
    joined = {later[arg] for arg in args if arg in later}
    return [f.always(arg) if arg in joined else arg for arg in args if arg not in later]


def word_conjuncts(conjuncts: Sequence[Conjunct], wording: Formula | None) -> Iterator[Conjunct]:
    """Yield the conjuncts of a formula with the wording of the formula, or of their part of it.

    A part whose class differs in words has none, such as one that constants decide.
    """
    parts = [] if wording is None else list(classify(wording))
    if [class_ for class_, _ in parts] != [conjunct.class_ for conjunct in conjuncts]:
        yield from conjuncts
        return
    for conjunct, (class_, part) in zip(conjuncts, parts, strict=True):
        whole = wording if len(parts) == 1 else add_temporal_operators(class_, part)
        yield replace(conjunct, wording=whole)


def add_temporal_operators(class_: Class, formula: Formula) -> Formula:
    """Return the formula in LTL, with the operators that its class implies."""
    if class_ is Class.LIVENESS:
        formula = f.eventually(formula)
    return f.always(formula) if class_ in (Class.SAFETY, Class.LIVENESS) else formula


def convert_to_class(formula: Formula, class_: Class) -> Formula | None:
    """Return the formula in the form of the class, with primes for X; None if it has no such form.

    An initial condition has no next step; only ``other`` has temporal operators that reach further
    than one step.
    """
    if class_ is Class.OTHER:
        return formula
    step = _replace_next_by_primes(formula) if has_future(formula) else formula
    return None if class_ is Class.INIT and step is not None and has_primes(step) else step


def _replace_next_by_primes(formula: Formula) -> Formula | None:
    """Return the formula with primes for X, or None if it reaches further than one step."""
    match formula:
        case Apply(Op.NEXT, (inner,)):
            # The past as seen from the next step is not the past of the next values.
            is_one_step = not has_future(inner) and not has_primes(inner) and not has_past(inner)
            return f.prime(inner) if is_one_step else None
        case Apply(op, _) if op in FUTURE:
            return None
        case Apply(op, args):
            parts = [_replace_next_by_primes(arg) for arg in args]
            converted = tuple(part for part in parts if part is not None)
            return f.apply(op, converted) if len(converted) == len(parts) else None
        case _:
            return formula


def is_safety(formula: Formula, is_positive: bool = True) -> bool:
    """Whether each violation of the formula has a finite prefix, judged by its operators alone."""
    if not isinstance(formula, Apply):
        return True
    if formula.op in (_EVENTUAL_OPERATORS if is_positive else _PERPETUAL_OPERATORS):
        return False
    args = formula.args
    if formula.op is Op.IFF:
        return all(is_safety(arg, sign) for arg in args for sign in (True, False))
    negated = args[:1] if formula.op in (Op.NOT, Op.IMPLIES) else ()
    return all(is_safety(arg, not is_positive) for arg in negated) and all(
        is_safety(arg, is_positive) for arg in args[len(negated) :]
    )


_EVENTUAL_OPERATORS = (Op.EVENTUALLY, Op.UNTIL)
_PERPETUAL_OPERATORS = (Op.ALWAYS, Op.RELEASE, Op.WEAK_UNTIL)
