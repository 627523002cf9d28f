"""Formulas in LTL, and as texts for Spot."""

from collections.abc import Iterable

from sysmlc.logic import formula as f
from sysmlc.logic.contract import Class, Conjunct
from sysmlc.logic.formula import Apply, Const, Formula, Op, Var

_WORDS = {
    Op.NOT: "!",
    Op.AND: "&",
    Op.OR: "|",
    Op.IMPLIES: "->",
    Op.IFF: "<->",
    Op.NEXT: "X",
    Op.ALWAYS: "G",
    Op.EVENTUALLY: "F",
    Op.UNTIL: "U",
    Op.RELEASE: "R",
    Op.WEAK_UNTIL: "W",
}


def print_for_spot(formula: Formula) -> str:
    """Return the formula in Spot's words, with all parentheses."""
    match formula:
        case Const(value):
            return "1" if value else "0"
        case Var(name, primed):
            return f"(X {name})" if primed else name
        case Apply(op, (operand,)):
            return f"({_WORDS[op]} {print_for_spot(operand)})"
        case Apply(op, args):
            return f"({f' {_WORDS[op]} '.join(map(print_for_spot, args))})"


def add_temporal_operators(class_: Class, formula: Formula) -> Formula:
    """Return the formula in LTL, with the operators that its class implies."""
    if class_ is Class.LIVENESS:
        formula = f.eventually(formula)
    return f.always(formula) if class_ in (Class.SAFETY, Class.LIVENESS) else formula


def conjoin(conjuncts: Iterable[Conjunct]) -> Formula:
    """Return the conjunction in LTL."""
    return conjoin_parts((conjunct.class_, conjunct.formula) for conjunct in conjuncts)


def conjoin_parts(parts: Iterable[tuple[Class, Formula]]) -> Formula:
    """Return the conjunction of formulas with their classes, in LTL."""
    return f.both(*(add_temporal_operators(class_, formula) for class_, formula in parts))
