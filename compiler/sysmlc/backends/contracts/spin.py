"""A contract as one formula in SPIN's spelling of LTL.

Tools read ``{x==3}`` as an opaque proposition, so that comparisons and arithmetic are written
out over the values of the variables, and a primed variable as X before its propositions.
"""

import re
from collections.abc import Iterable, Mapping
from functools import lru_cache

from sysmlc.logic import domains
from sysmlc.logic import formula as f
from sysmlc.logic.contract import BooleanDomain, Class, Conjunct, Contract, Domain
from sysmlc.logic.evaluate import is_true
from sysmlc.logic.formula import Apply, Const, Formula, Literal, Op, Var
from sysmlc.logic.printing import print_literal

_COMPARISONS = (Op.EQ, Op.NE, Op.LT, Op.LE, Op.GT, Op.GE)
_INFIX = {
    Op.AND: "&&",
    Op.OR: "||",
    Op.IMPLIES: "->",
    Op.IFF: "<->",
    Op.UNTIL: "U",
    Op.RELEASE: "V",
    Op.WEAK_UNTIL: "W",
}
_PREFIX = {Op.NOT: "!", Op.NEXT: "X ", Op.ALWAYS: "[]", Op.EVENTUALLY: "<>"}
_ATOM = re.compile(r"!?(X )?(\{[^{}]*\}|\w+)")
_NAME = re.compile(r"[a-z_]\w*")
LIMIT = 20_000
"""Most propositions that one comparison may be written out to."""


class TooLargeError(Exception):
    """A comparison over so many values that its formula would be of no use."""


_REMEMBERED = 1 << 14
"""Comparisons whose cases are kept: machines of one kind have the same."""


def spin(contract: Contract) -> str:
    """``(A) -> (G)``. Raises TooLargeError."""
    known = {variable.name: variable.domain for variable in contract.variables}
    sides = (_side(contract.assumptions, known), _side(contract.guarantees, known))
    return "({}) -> ({})\n".format(*sides)


def spin_conjunct(conjunct: Conjunct, known: Mapping[str, Domain]) -> str:
    """One conjunct with the temporal operators that its class implies."""
    body = _text(conjunct.formula, known)
    match conjunct.class_:
        case Class.SAFETY:
            return f"[]({body})"
        case Class.LIVENESS:
            return f"[]<>({body})"
        case _:
            return f"({body})"


def _side(conjuncts: Iterable[Conjunct], known: Mapping[str, Domain]) -> str:
    return " && ".join(spin_conjunct(one, known) for one in conjuncts) or "true"


def _text(formula: Formula, known: Mapping[str, Domain]) -> str:
    match formula:
        case Const(value):
            return print_literal(value)
        case Var(name, primed):
            return _proposition(name, primed, True, known)
        case Apply(op, args) if op in _COMPARISONS:
            return _written_out(formula, known)
        case Apply(op, args) if op in _PREFIX:
            return f"{_PREFIX[op]}{_operand(args[0], known)}"
        case Apply(op, args):
            return f" {_INFIX[op]} ".join(_operand(arg, known) for arg in args)


def _operand(formula: Formula, known: Mapping[str, Domain]) -> str:
    text = _text(formula, known)
    is_infix = isinstance(formula, Apply) and (formula.op in _INFIX or formula.op in _COMPARISONS)
    return f"({text})" if is_infix and not _ATOM.fullmatch(text) else text


def _written_out(formula: Formula, known: Mapping[str, Domain]) -> str:
    names = dict.fromkeys(variable.name for variable in f.variables(formula))
    return _spelt(formula, tuple((name, known[name]) for name in names))


@lru_cache(_REMEMBERED)
def _spelt(formula: Formula, found: tuple[tuple[str, Domain], ...]) -> str:
    """A comparison written out. Raises TooLargeError."""
    known = dict(found)
    variables = list(dict.fromkeys(f.variables(formula)))
    number = 1
    for variable in variables:
        number *= domains.size(known[variable.name])
    if number > LIMIT:
        raise TooLargeError
    match formula:
        case Apply(Op.NE, (Var(name, primed), Const(value))) if value in domains.values(
            known[name]
        ):
            return f"!{_atom(name, primed, value, known)}"
        case _:
            return _cases(formula, variables, {}, {}, known)


def _atom(name: str, primed: bool, value: Literal, known: Mapping[str, Domain]) -> str:
    text = _proposition(name, primed, value, known)
    return f"({text})" if " " in text else text


def _cases(
    formula: Formula,
    variables: list[Var],
    now: dict[str, Literal],
    then: dict[str, Literal],
    known: Mapping[str, Domain],
) -> str:
    """The values that make the comparison true, one variable after the other."""
    if not variables:
        return print_literal(is_true(formula, now, then))
    first, *rest = variables
    parts: list[str] = []
    values = domains.values(known[first.name])
    for value in values:
        chosen = {first.name: value}
        before, after = (now, then | chosen) if first.primed else (now | chosen, then)
        inner = _cases(formula, rest, before, after, known)
        if inner != "false":
            atom = _proposition(first.name, first.primed, value, known)
            parts.append(atom if inner == "true" else f"({atom} && {_wrapped(inner)})")
    if not parts:
        return "false"
    is_certain = len(parts) == len(values) and not any("&&" in part for part in parts)
    return "true" if is_certain else " || ".join(parts)


def _wrapped(text: str) -> str:
    return f"({text})" if " || " in text else text


def _proposition(name: str, primed: bool, value: Literal, known: Mapping[str, Domain]) -> str:
    if isinstance(known[name], BooleanDomain):
        text = name if _NAME.fullmatch(name) else f"{{{name}==1}}"
        text = text if value else f"!{text}"
    else:
        text = f"{{{name}=={print_literal(value)}}}"
    return f"X {text}" if primed else text
