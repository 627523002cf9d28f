"""SPIN's LTL: one formula with ``[]``, ``<>`` and propositions like ``{state==Idle}``.

SPIN 6 takes && || -> <-> from left to right, with one strength: formulas that mix them without
parentheses are refused. A file may end in Spot's lines ``.inputs`` and ``.outputs``; without them
all variables are taken as outputs, which is said.
"""

import re
from pathlib import PurePath

from msgspec.structs import replace

from sysmlc.logic.contract import (
    BooleanDomain,
    Contract,
    Domain,
    EnumerationDomain,
    IntegerDomain,
    Owner,
)
from sysmlc.logic.formats import rules
from sysmlc.logic.formats.base import lowered
from sysmlc.logic.formats.draft import Draft
from sysmlc.logic.formats.file import File
from sysmlc.logic.formats.lower import TooManyValuesError, unambiguous, without_arithmetic
from sysmlc.logic.formats.spin_text import TooLargeError, spin
from sysmlc.logic.formats.spot import OWNERS, PARTS, parts, read_implication
from sysmlc.logic.formula import Op
from sysmlc.logic.infix import Part, Reader
from sysmlc.logic.spelling import NEUTRAL, FormulaError

SYNTAX = replace(NEUTRAL, comment=r"/\*[\s\S]*?\*/|//[^\n]*")
_MIXED = frozenset([Op.AND, Op.OR, Op.IMPLIES, Op.IFF])
_COMPARED = re.compile(r"\{\s*([^\W\d]\w*)\s*==\s*(-?\w+)\s*\}")
_NAME = re.compile(r"\{[^{}]*\}|[^\W\d]\w*|[\s\S]")


def read(file: File) -> tuple[Contract, ...]:
    """The contract of the file; values are those that are named, and another for a single one."""
    draft = Draft(file, "SPIN")
    text = PARTS.sub(lambda match: " " * len(match.group()), file.text)
    owners = _owners(file.text)
    unsaid = []
    for name, domain in _domains(text).items():
        if name not in owners:
            unsaid.append(name)
        draft.declare(name, 0, owners.get(name, Owner.SYSTEM), domain)
    if unsaid:
        file.report(rules.OWNER_NOT_SAID, 0, names=", ".join(unsaid[:8]))
    read_implication(draft, text, SYNTAX, _Reader)
    return draft.contracts(PurePath(file.path).stem.removesuffix(".spin"))


def _owners(text: str) -> dict[str, Owner]:
    return {
        word: OWNERS[match.group(1)]
        for match in PARTS.finditer(text)
        for word in re.findall(r"[^\s,]+", match.group(2))
    }


def _domains(text: str) -> dict[str, Domain]:
    """The variables that the formula names, with the values that it compares them with."""
    values: dict[str, dict[str, None]] = {}
    for match in _COMPARED.finditer(text):
        values.setdefault(match.group(1), {})[match.group(2)] = None
    plain = re.sub(SYNTAX.comment, " ", text)
    names = dict.fromkeys(
        word
        for word in _NAME.findall(plain)
        if word[0].isidentifier() and word not in (*SYNTAX.prefix, *SYNTAX.infix, *SYNTAX.truths)
    )
    found: dict[str, Domain] = {name: _domain(list(given)) for name, given in values.items()}
    return found | {name: BooleanDomain() for name in names if name not in found}


def _domain(given: list[str]) -> Domain:
    """Numbers from 0 to the largest, or names; a value that is the only one says nothing."""
    numbers = [int(one) for one in given if re.fullmatch(r"-?\d{1,18}", one)]
    if len(numbers) == len(given):
        return IntegerDomain(min(0, *numbers), max(1, *numbers))
    others = () if len(given) > 1 else (f"not_{given[0]}".replace("-", "_"),)
    return EnumerationDomain((*given, *others))


class _Reader(Reader):
    """Refuses what SPIN and everybody else read differently."""

    _seen: tuple[Op, ...] = ()

    def _bracketed(self) -> Part:
        outer, self._seen = self._seen, ()
        made = super()._bracketed()
        self._seen = outer
        return made

    def _applied(self, op: Op, left: Part) -> Part:
        at = self.cursor.next.at
        if op in _MIXED:
            if any(seen is not op for seen in self._seen):
                raise FormulaError("parentheses must say what belongs together here", at)
            self._seen = (op,)
        return super()._applied(op, left)


def plain(contract: Contract, form: str) -> Contract:
    """The contract without arithmetic. Raises NotExpressibleError."""
    return lowered(unambiguous(contract), form, without_arithmetic)


def write(contract: Contract, form: str) -> str:
    """``(assumptions) -> (guarantees)``, and below it who decides the variables."""

    def text(one: Contract) -> Contract:
        try:
            found.append(spin(one))
        except TooLargeError:
            raise TooManyValuesError from None
        return one

    found: list[str] = []
    made = lowered(unambiguous(contract), form, text)
    return "\n".join([found[0].rstrip("\n"), *parts(made), ""])
