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
from sysmlc.logic.evaluate import Evaluation, compile_evaluation
from sysmlc.logic.formula import Apply, Const, Formula, Literal, Op, Var
from sysmlc.logic.printing import print_literal

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
_WORDS = ("false", "true")
LIMIT = 20_000
"""Most propositions that one comparison may be written out to."""


class TooLargeError(Exception):
    """A comparison over so many values that its formula would be of no use."""


_REMEMBERED = 1 << 14
"""Comparisons whose cases are kept: machines of one kind have the same."""
_MACHINES = 64
"""Sets of variables whose formulas are kept, for the same reason."""


def spin(contract: Contract) -> str:
    """``(A) -> (G)``. Raises TooLargeError."""
    spelling = _spelling(tuple((one.name, one.domain) for one in contract.variables))
    sides = (_side(contract.assumptions, spelling), _side(contract.guarantees, spelling))
    return "({}) -> ({})\n".format(*sides)


def spin_conjunct(conjunct: Conjunct, known: Mapping[str, Domain]) -> str:
    """One conjunct with the temporal operators that its class implies."""
    return _conjunct(conjunct, Spelling(known))


def _side(conjuncts: Iterable[Conjunct], spelling: "Spelling") -> str:
    return " && ".join(_conjunct(one, spelling) for one in conjuncts) or "true"


def _conjunct(conjunct: Conjunct, spelling: "Spelling") -> str:
    body = spelling.text(conjunct.formula)
    match conjunct.class_:
        case Class.SAFETY:
            return f"[]({body})"
        case Class.LIVENESS:
            return f"[]<>({body})"
        case _:
            return f"({body})"


class Spelling:
    """How formulas over some variables are spelt; each is spelt once."""

    def __init__(self, known: Mapping[str, Domain]) -> None:
        self._known = known
        self._texts: dict[Formula, str] = {}

    def text(self, formula: Formula) -> str:
        """The formula in SPIN's spelling. Raises TooLargeError."""
        text = self._texts.get(formula)
        if text is None:
            text = self._texts[formula] = self._text(formula)
        return text

    def _text(self, formula: Formula) -> str:
        match formula:
            case Const(value):
                return print_literal(value)
            case Var(name, primed):
                return _proposition(name, primed, True, self._known)
            case Apply(op, args):
                return self._applied(formula, op, args)

    def _applied(self, formula: Formula, op: Op, args: tuple[Formula, ...]) -> str:
        infix = _INFIX.get(op)
        if infix:
            return f" {infix} ".join(map(self._operand, args))
        if op in _PREFIX:
            return f"{_PREFIX[op]}{self._operand(args[0])}"
        return self._written_out(formula)

    def _operand(self, formula: Formula) -> str:
        text = self.text(formula)
        if not isinstance(formula, Apply) or formula.op in _PREFIX:
            return text
        return text if _ATOM.fullmatch(text) else f"({text})"

    def _written_out(self, formula: Formula) -> str:
        names = dict.fromkeys(variable.name for variable in f.variables(formula))
        return _spelt(formula, tuple((name, self._known[name]) for name in names))


@lru_cache(_MACHINES)
def _spelling(variables: tuple[tuple[str, Domain], ...]) -> Spelling:
    return Spelling(dict(variables))


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
            return _cases(compile_evaluation(formula), variables, {}, {}, known)


def _atom(name: str, primed: bool, value: Literal, known: Mapping[str, Domain]) -> str:
    text = _proposition(name, primed, value, known)
    return f"({text})" if " " in text else text


def _cases(
    truth: Evaluation,
    variables: list[Var],
    now: dict[str, Literal],
    then: dict[str, Literal],
    known: Mapping[str, Domain],
) -> str:
    """The values that make the comparison true, one variable after the other."""
    if not variables:
        return print_literal(bool(truth(now, then)))
    first, *rest = variables
    parts: list[str] = []
    values = domains.values(known[first.name])
    for value in values:
        chosen = {first.name: value}
        before, after = (now, then | chosen) if first.primed else (now | chosen, then)
        inner = (
            _cases(truth, rest, before, after, known)
            if rest
            else _WORDS[bool(truth(before, after))]
        )
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
