"""CHASE's .ltl: contracts with typed inputs and outputs, LTL assumptions and guarantees.

Source: demos and grammar of chase-cps/chase; what it has beyond (reals, probabilities) is named.
"""

import re
from collections.abc import Callable, Iterator

from sysmlc.logic import formula as f
from sysmlc.logic.contract import (
    BooleanDomain,
    Class,
    Conjunct,
    Contract,
    Domain,
    IntegerDomain,
    Owner,
    Variable,
)
from sysmlc.logic.formats import rules
from sysmlc.logic.formats.base import lowered, said_ltl
from sysmlc.logic.formats.counting import counted
from sysmlc.logic.formats.draft import Draft, joined
from sysmlc.logic.formats.file import File
from sysmlc.logic.formats.lower import each_formula, renamed, without_weak_until
from sysmlc.logic.formats.spelt import LTL, Spelling, primed
from sysmlc.logic.formula import Op
from sysmlc.logic.infix import Part, Reader
from sysmlc.logic.spelling import (
    COMPARING,
    CONNECTIVES,
    COUNTING,
    STRENGTH,
    TEMPORAL_SIGNS,
    TEMPORAL_WORDS,
    TRUTHS,
    UNTIL_WORDS,
    Cursor,
    FormulaError,
    Syntax,
    Token,
    tokens,
)

SYNTAX = Syntax(
    {"!": Op.NOT, "~": Op.NOT, **TEMPORAL_WORDS, **TEMPORAL_SIGNS},
    {**CONNECTIVES, "/\\": Op.AND, "\\/": Op.OR, **UNTIL_WORDS, **COMPARING, **COUNTING},
    TRUTHS,
    {"(": ")"},
    STRENGTH,
    (":", ";"),
    r"\#[^\n]*",
)
_BOX = re.compile(r"\[[ \t]+\]")
"""Blanks are allowed in the box of "always"."""
_OWNERS = {"input": Owner.ENVIRONMENT, "output": Owner.SYSTEM}
_SIDES = {"Assumptions": Owner.ENVIRONMENT, "Guarantees": Owner.SYSTEM}
_SPELLING = Spelling(LTL | {Op.DIV: "/"}, primed)


def read(file: File) -> tuple[Contract, ...]:
    """The contracts of the file that have nothing wrong; ``contract`` in their order."""
    text = _BOX.sub(lambda match: f"[]{' ' * (len(match.group()) - 2)}", file.text)
    cursor = Cursor(tokens(text, SYNTAX))
    head = Draft(file, "CHASE")
    names: list[str] = []
    head.statement(cursor, lambda: names.append(_title(cursor, "NAME", ";")), ";")
    found: list[Contract] = []
    while cursor.next.kind != "end":
        draft = Draft(file, "CHASE")
        found.extend(_Contract(draft, cursor).read(names[0] if names else ""))
    return tuple(found)


def _title(cursor: Cursor, word: str, end: str) -> str:
    cursor.expect(word)
    if end == ";":
        cursor.expect(":")
    name = cursor.expect_kind("name", "a name").text
    cursor.expect(end)
    return name


class _Contract:
    """Reads one contract, from ``CONTRACT`` to the next."""

    def __init__(self, draft: Draft, cursor: Cursor) -> None:
        self._draft = draft
        self._cursor = cursor
        self._owner = Owner.SYSTEM
        self._propositions: dict[str, Part] = {}

    def read(self, system: str) -> tuple[Contract, ...]:
        """The contract, unless something is wrong with it."""
        names: list[str] = []
        start = self._cursor.mark()
        self._statement(lambda: names.append(_title(self._cursor, "CONTRACT", ":")))
        while self._cursor.next.kind != "end" and not self._cursor.has("CONTRACT"):
            self._statement(self._part)
        if self._cursor.mark() == start:
            self._cursor.take()
        parts = (system, *names) if names != [system] else names
        return self._draft.contracts(".".join(filter(None, parts)))

    def _statement(self, read: Callable[[], None]) -> None:
        self._draft.statement(self._cursor, read, ";")

    def _part(self) -> None:
        cursor = self._cursor
        if cursor.has(*_SIDES):
            self._owner = _SIDES[cursor.take().text]
            cursor.expect(":")
        elif cursor.has(*_OWNERS):
            self._declaration()
        elif cursor.took("proposition"):
            self._proposition()
        else:
            self._conjuncts()

    def _declaration(self) -> None:
        owner = _OWNERS[self._cursor.take().text]
        type_ = self._cursor.expect("boolean", "integer", "real")
        domain: Domain = BooleanDomain()
        if type_.text == "real":
            what = "a variable that is a real number"
            self._draft.fault(rules.OUTSIDE, type_.at, what=what, form="CHASE")
        elif type_.text == "integer":
            domain = self._range()
        self._cursor.expect("variable")
        name = self._cursor.expect_kind("name", "a name")
        self._cursor.expect(";")
        self._draft.declare(name.text, name.at, owner, domain)

    def _range(self) -> Domain:
        at = self._cursor.expect("(").at
        low = self._cursor.integer()
        self._cursor.expect(":")
        high = self._cursor.integer()
        self._cursor.expect(")")
        if low > high:
            raise FormulaError(f"the range {low}:{high} is empty", at)
        return IntegerDomain(low, high)

    def _reader(self) -> "_Reader":
        return _Reader(self._cursor, SYNTAX, self._draft.domains, self._propositions)

    def _proposition(self) -> None:
        name = self._cursor.expect_kind("name", "a name")
        self._cursor.expect("is")
        self._propositions[name.text] = self._reader().whole()
        self._cursor.expect(";")

    def _conjuncts(self) -> None:
        def read_all() -> None:
            found = list(joined(self._reader(), SYNTAX, ";"))
            if not self._cursor.has(";"):
                self._cursor.fail("';' is expected")
            for formula, at in found:
                self._draft.add_ltl(self._owner, formula, at)

        if not self._draft.formula(self._owner, Class.OTHER, read_all):
            self._cursor.skip_to(";")
        self._cursor.took(";")


class _Reader(Reader):
    """Knows the contract's propositions."""

    def __init__(
        self,
        cursor: Cursor,
        syntax: Syntax,
        variables: dict[str, Domain],
        propositions: dict[str, Part],
    ) -> None:
        super().__init__(cursor, syntax, variables)
        self._propositions = propositions

    def whole(self) -> Part:
        """A condition, as a proposition's meaning."""
        at = self.cursor.next.at
        return Part(self.formula(), "truth", at)

    def word(self, token: Token) -> Part:
        if token.text in self._propositions:
            return self._propositions[token.text]
        if token.text == "P" and self.cursor.has("("):
            raise FormulaError("probabilities are outside what is read", token.at)
        return super().word(token)


def plain(contract: Contract, form: str) -> Contract:
    """The contract as CHASE has words for it. Raises NotExpressibleError."""
    words = each_formula(renamed(contract, _RESERVED), without_weak_until)
    return lowered(words, form, lambda one: counted(one, is_flat=False, from_zero=False))


def write(contract: Contract, form: str) -> str:
    """The contract; enumerations are counted."""
    made = plain(contract, form)
    system, _, name = contract.component.rpartition(".")
    parts = [
        f"NAME: {word(system or name)};\n",
        f"CONTRACT {word(name)}:",
        *(f"    {_declaration(one)}" for one in made.variables),
        "\n    Assumptions:",
        *_lines(made.assumptions),
        "\n    Guarantees:",
        *_lines(made.guarantees),
    ]
    return "\n".join([*parts, ""])


def word(name: str) -> str:
    """A qualified name as one word."""
    made = "".join(char if char.isascii() and char.isalnum() else "_" for char in name)
    return made if made and not made[0].isdigit() else f"_{made}"


def _declaration(variable: Variable) -> str:
    side = "input" if variable.owner is Owner.ENVIRONMENT else "output"
    type_ = "boolean"
    if isinstance(variable.domain, IntegerDomain):
        type_ = f"integer ({variable.domain.low}:{variable.domain.high})"
    return f"{side} {type_} variable {variable.name};"


def _lines(conjuncts: tuple[Conjunct, ...]) -> Iterator[str]:
    for one in conjuncts or (Conjunct(f.TRUE, Class.INIT, ""),):
        yield f"        {said_ltl('CHASE', _SPELLING, one)};"


_RESERVED = frozenset(
    {*SYNTAX.prefix, *SYNTAX.infix, *TRUTHS, *_OWNERS, *_SIDES, "P", "NAME", "CONTRACT", "is"}
    | {"boolean", "integer", "real", "variable", "proposition"}
)
