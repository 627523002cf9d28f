"""gr1c's .spc: Booleans and ranges from 0, comparisons with constants, sections that end in ``;``.

Source: the examples and the manual of gr1c 0.13.
"""

from collections.abc import Iterator
from pathlib import PurePath

from sysmlc.logic.contract import BooleanDomain, Class, Contract, IntegerDomain, Owner, Variable
from sysmlc.logic.formats.base import conjuncts_of, game, lowered, said
from sysmlc.logic.formats.counting import counted
from sysmlc.logic.formats.draft import Draft, joined
from sysmlc.logic.formats.file import File
from sysmlc.logic.formats.lower import renamed
from sysmlc.logic.formats.spelt import LTL, Spelling, primed
from sysmlc.logic.formula import Op
from sysmlc.logic.infix import Reader
from sysmlc.logic.spelling import (
    COMPARING,
    CONNECTIVES,
    STRENGTH,
    TEMPORAL_SIGNS,
    TRUTHS,
    Cursor,
    Syntax,
    tokens,
)

SYNTAX = Syntax(
    {"!": Op.NOT, **TEMPORAL_SIGNS},
    {**CONNECTIVES, **COMPARING},
    TRUTHS | {"True": True, "False": False},
    {"(": ")"},
    STRENGTH,
    (":", ";", "[", "]", ",", "-"),
    r"\#[^\n]*",
)
_DECLARING = {"ENV": Owner.ENVIRONMENT, "SYS": Owner.SYSTEM}
_SECTIONS = {
    "ENVINIT": (Owner.ENVIRONMENT, Class.INIT),
    "ENVTRANS": (Owner.ENVIRONMENT, Class.SAFETY),
    "ENVGOAL": (Owner.ENVIRONMENT, Class.LIVENESS),
    "SYSINIT": (Owner.SYSTEM, Class.INIT),
    "SYSTRANS": (Owner.SYSTEM, Class.SAFETY),
    "SYSGOAL": (Owner.SYSTEM, Class.LIVENESS),
}
_BEFORE = {Class.INIT: "", Class.SAFETY: "[]", Class.LIVENESS: "[]<>"}
_SPELLING = Spelling(LTL, primed, str)


def read(file: File) -> tuple[Contract, ...]:
    """The contract of the file, whose name it has."""
    draft = Draft(file, "gr1c")
    cursor = Cursor(tokens(file.text, SYNTAX))
    while cursor.next.kind != "end":
        draft.statement(cursor, lambda: _section(draft, cursor), ";")
    return draft.contracts(PurePath(file.path).stem)


def _section(draft: Draft, cursor: Cursor) -> None:
    title = cursor.expect(*_DECLARING, *_SECTIONS).text
    cursor.expect(":")
    if title in _DECLARING:
        while cursor.next.kind == "name":
            _declared(draft, cursor, _DECLARING[title])
    elif not cursor.has(";"):
        reader = Reader(cursor, SYNTAX, draft.domains)
        _conjuncts(draft, reader, *_SECTIONS[title])
    cursor.expect(";")


def _declared(draft: Draft, cursor: Cursor, owner: Owner) -> None:
    name = cursor.take()
    if not cursor.took("["):
        draft.declare(name.text, name.at, owner, BooleanDomain())
        return
    low = cursor.integer()
    cursor.expect(",")
    high = cursor.integer()
    cursor.expect("]")
    draft.declare(name.text, name.at, owner, IntegerDomain(min(low, high), high))


def _conjuncts(draft: Draft, reader: Reader, owner: Owner, class_: Class) -> None:
    def read_all() -> None:
        for formula, at in joined(reader, SYNTAX, ";"):
            draft.add_classified(owner, class_, formula, at)

    if not draft.formula(owner, class_, read_all):
        reader.cursor.skip_to(";")


def plain(contract: Contract, form: str) -> Contract:
    """The contract as gr1c has words for it. Raises NotExpressibleError."""
    made = game(contract, form, apart=True)
    return lowered(renamed(made, _RESERVED), form, lambda one: counted(one, is_flat=True))


def write(contract: Contract, form: str) -> str:
    """The contract; enumerations are counted, and arithmetic is written out over the values."""
    made = plain(contract, form)
    owned = [
        f"{title}:{''.join(f' {_declaration(v)}' for v in made.variables if v.owner is owner)};"
        for title, owner in _DECLARING.items()
    ]
    sections = [f"{title}:{''.join(_lines(made, *key))};" for title, key in _SECTIONS.items()]
    return "\n".join([*owned, "", *sections, ""])


def _declaration(variable: Variable) -> str:
    domain = variable.domain
    return (
        f"{variable.name} [0,{domain.high}]" if isinstance(domain, IntegerDomain) else variable.name
    )


def _lines(contract: Contract, owner: Owner, class_: Class) -> Iterator[str]:
    for index, one in enumerate(conjuncts_of(contract, owner, class_)):
        text = said("gr1c", _SPELLING.text, one)
        yield f"\n{'& ' if index else '  '}{_BEFORE[class_]}({text})"


_RESERVED = frozenset({*_DECLARING, *_SECTIONS, *SYNTAX.truths})
