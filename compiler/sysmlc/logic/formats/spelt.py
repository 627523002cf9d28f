"""Formulas in the spelling of a language, with parentheses around every operand that is joined."""

from collections.abc import Callable, Mapping

from msgspec import Struct

from sysmlc.logic.contract import Class
from sysmlc.logic.formula import Apply, Const, Formula, Literal, Op, Var
from sysmlc.logic.printing import print_literal
from sysmlc.logic.spelling import ARITHMETIC, COMPARISONS

_PREFIX = (Op.NOT, Op.NEXT, Op.ALWAYS, Op.EVENTUALLY)
LTL = {op: str(op) for op in Op}


class Spelling(Struct, frozen=True):
    """Words for operators, for the next value of a variable and for values."""

    words: Mapping[Op, str]
    next: Callable[[str], str]
    literal: Callable[[Literal], str] = print_literal

    def text(self, formula: Formula) -> str:
        """The formula. Raises KeyError for an operator that the language has no word for."""
        match formula:
            case Const(value):
                return self.literal(value)
            case Var(name, primed):
                return self.next(name) if primed else name
            case Apply(op, (only,)) if op in _PREFIX:
                space = "" if op is Op.NOT else " "
                return f"{self.words[op]}{space}{self._operand(op, only)}"
            case Apply(op, args):
                space = "" if op in COMPARISONS else " "
                word = f"{space}{self.words[op]}{space}"
                return word.join(self._operand(op, arg) for arg in args)

    def ltl(self, formula: Formula, class_: Class) -> str:
        """The formula with the temporal operators that its class stands for."""
        before = {Class.SAFETY: (Op.ALWAYS,), Class.LIVENESS: (Op.ALWAYS, Op.EVENTUALLY)}
        words = " ".join(self.words[op] for op in before.get(class_, ()))
        return f"{words}({self.text(formula)})" if words else self.text(formula)

    def _operand(self, op: Op, formula: Formula) -> str:
        text = self.text(formula)
        if not isinstance(formula, Apply):
            return f"({text})" if " " in text and formula.__class__ is Var else text
        if formula.op in _PREFIX:
            is_plain = op not in COMPARISONS
        elif formula.op in ARITHMETIC:
            is_plain = op in COMPARISONS
        else:
            is_plain = formula.op in COMPARISONS and op not in (*_PREFIX, *COMPARISONS)
        return text if is_plain else f"({text})"


def primed(name: str) -> str:
    """``x'``."""
    return f"{name}'"


def next_of(name: str) -> str:
    """``X x``."""
    return f"X {name}"
