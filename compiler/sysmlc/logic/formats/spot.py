"""Spot: one LTL formula over Booleans, and who decides them (``.inputs``, ``.outputs``).

The lines below the formula are those of ltlsynt's ``--part-file``.
"""

import re
from collections.abc import Iterable
from pathlib import PurePath

from sysmlc.logic import formula as f
from sysmlc.logic.contract import BooleanDomain, Class, Conjunct, Contract, Owner
from sysmlc.logic.formats import rules
from sysmlc.logic.formats.base import lowered, said_ltl
from sysmlc.logic.formats.counting import in_bits
from sysmlc.logic.formats.draft import Draft
from sysmlc.logic.formats.file import File
from sysmlc.logic.formats.lower import renamed
from sysmlc.logic.formats.spelt import LTL, Spelling, next_of
from sysmlc.logic.formula import Op, Var
from sysmlc.logic.infix import TRUTH, Part, Reader
from sysmlc.logic.spelling import (
    CONNECTIVES,
    STRENGTH,
    TEMPORAL_SIGNS,
    TEMPORAL_WORDS,
    UNTIL_WORDS,
    Cursor,
    FormulaError,
    Syntax,
    Token,
    tokens,
)

SYNTAX = Syntax(
    {"!": Op.NOT, "~": Op.NOT, **TEMPORAL_WORDS, **TEMPORAL_SIGNS},
    {
        **CONNECTIVES,
        **UNTIL_WORDS,
        "/\\": Op.AND,
        "\\/": Op.OR,
        "=>": Op.IMPLIES,
        "<=>": Op.IFF,
    },
    {"true": True, "false": False, "1": True, "0": False},
    {"(": ")"},
    STRENGTH,
    ("-",),
)
PARTS = re.compile(r"^[ \t]*\.(inputs|outputs)\b[ \t:]*([^\n]*)$", re.MULTILINE)
_SPELLING = Spelling(LTL, next_of)
OWNERS = {"inputs": Owner.ENVIRONMENT, "outputs": Owner.SYSTEM}


def read(file: File) -> tuple[Contract, ...]:
    """The contract of the file: of ``a -> g`` the assumptions and guarantees."""
    draft = Draft(file, "Spot")
    for match in PARTS.finditer(file.text):
        for word in re.finditer(r"[^\s,]+", match.group(2)):
            at = match.start(2) + word.start()
            if word.group().isidentifier():
                draft.declare(word.group(), at, OWNERS[match.group(1)], BooleanDomain())
            else:
                reason = f"'{word.group()}' is no name that formulas can have"
                draft.fault(rules.NOT_UNDERSTOOD, at, form="Spot", reason=reason)
    text = PARTS.sub(lambda match: " " * len(match.group()), file.text)
    read_implication(draft, text, SYNTAX, Atoms)
    return draft.contracts(PurePath(file.path).stem.removesuffix(".spot"))


def read_implication(draft: Draft, text: str, syntax: Syntax, reader: type[Reader]) -> None:
    """Read ``assumptions -> guarantees``, or guarantees alone, into the draft."""
    cursor = Cursor(tokens(text, syntax))
    reading = reader(cursor, syntax, draft.domains)

    def read_all() -> None:
        sides(draft, reading)
        if cursor.next.kind != "end":
            cursor.fail()

    draft.formula(Owner.SYSTEM, Class.OTHER, read_all)


def sides(draft: Draft, reading: Reader) -> None:
    """Read ``assumptions -> guarantees``, or guarantees alone, up to what is no formula.

    The arrow is not an operator here: its sides stay two, even if one of them is false.
    """
    at = reading.cursor.next.at
    first = reading.formula(STRENGTH[Op.IMPLIES] + 1)
    if not reading.cursor.took("->"):
        draft.add_ltl(Owner.SYSTEM, first, at)
        return
    behind = reading.cursor.next.at
    promised = reading.formula()
    draft.add_ltl(Owner.ENVIRONMENT, first, at)
    draft.add_ltl(Owner.SYSTEM, promised, behind)


class Atoms(Reader):
    """Spot's atoms: names, quoted or not; 0 and 1 are truths."""

    def operand(self) -> Part:
        token = self.cursor.next
        if token.kind == "number" and token.text in self._syntax.truths:
            self.cursor.take()
            return Part(f.const(self._syntax.truths[token.text]), TRUTH, token.at)
        if token.kind == "string":
            self.cursor.take()
            return self.word(Token("name", token.text[1:-1], token.at))
        return super().operand()

    def word(self, token: Token) -> Part:
        if token.text in self.variables:
            return Part(Var(token.text), TRUTH, token.at)
        where = "lines below it, or in the .part file beside it"
        reason = f"'{token.text}' is among neither the .inputs nor the .outputs ({where})"
        raise FormulaError(reason, token.at)


def plain(contract: Contract, form: str) -> Contract:
    """The contract over Booleans. Raises NotExpressibleError."""
    return lowered(renamed(contract, _RESERVED), form, in_bits)


def write(contract: Contract, form: str) -> str:
    """The contract over bits as one formula, and below it who decides them."""
    made = plain(contract, form)
    return "\n".join([implication(made, _SPELLING, "Spot"), *parts(made), ""])


def parts(contract: Contract) -> list[str]:
    """The lines that say who decides the variables."""
    owned = {
        title: [one.name for one in contract.variables if one.owner is owner]
        for title, owner in OWNERS.items()
    }
    return [" ".join([f".{title}", *names]) for title, names in owned.items()]


def implication(contract: Contract, spelling: Spelling, form: str) -> str:
    """``(assumptions) -> (guarantees)``; the guarantees alone when nothing is assumed."""
    assumed, promised = (
        _joined(side, spelling, form) for side in (contract.assumptions, contract.guarantees)
    )
    return f"({assumed}) {spelling.words[Op.IMPLIES]} ({promised})"


def _joined(conjuncts: Iterable[Conjunct], spelling: Spelling, form: str) -> str:
    texts = [f"({said_ltl(form, spelling, one)})" for one in conjuncts]
    return f" {spelling.words[Op.AND]} ".join(texts) or "true"


_RESERVED = frozenset({*SYNTAX.prefix, *SYNTAX.infix, *SYNTAX.truths, "M", "xor"})
