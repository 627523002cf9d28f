"""Tokens of a text with the notes and blank lines before them, which no parser sees."""

import re
from collections.abc import Iterator
from enum import Enum

from msgspec import Struct

from sysmlc.language.text.scan import Types, scan

_TAB = 4
_THING = re.compile(r"//\*(?s:.)*?\*/|//[^\n]*|\n")


class Sort(Enum):
    """What a token is, as far as the layout cares."""

    KEYWORD = "keyword"
    NAME = "name"
    LITERAL = "literal"
    COMMENT = "comment"
    SYMBOL = "symbol"
    END = "end"


class Note(Struct, frozen=True):
    """A note (KerML 8.2.2.2): its text, the column it starts in, and what is before it."""

    text: str
    column: int
    is_trailing: bool
    """Whether it stands on the line of what is before it."""
    after_blank: bool


class Token(Struct, frozen=True):
    """A token: its text and sort, its column in the original, what stands before it."""

    text: str
    sort: Sort
    column: int = 0
    notes: tuple[Note, ...] = ()
    after_blank: bool = False

    @property
    def is_operand(self) -> bool:
        """Whether an expression can end with it."""
        return self.sort in (Sort.NAME, Sort.LITERAL) or self.text in _OPERANDS


_OPERANDS = {")", "]", "}", "true", "false", "null", "*"}


def tokens(text: str, types: Types) -> list[Token]:
    """The tokens of a text whose lines end with line feeds; the last one is its end."""
    scanned = scan(text, types)
    found = []
    before = 0
    for index, kind in enumerate(scanned.types):
        start, end = scanned.starts[index], scanned.ends[index]
        notes, blank = _gap(text, before, start)
        written = text[start:end]
        found.append(
            Token(written, _sort(written, kind, types), _column(text, start), notes, blank)
        )
        before = end
    return found


def _sort(written: str, kind: int, types: Types) -> Sort:
    by_kind = {
        types.end: Sort.END,
        types.name: Sort.NAME,
        types.string: Sort.LITERAL,
        types.number: Sort.LITERAL,
        types.body: Sort.COMMENT,
    }
    if kind in by_kind:
        return by_kind[kind]
    return Sort.KEYWORD if written.isidentifier() else Sort.SYMBOL


def _gap(text: str, start: int, end: int) -> tuple[tuple[Note, ...], bool]:
    """The notes between two tokens, and whether a blank line is before the second."""
    notes: list[Note] = []
    lines = 0
    for found in _THING.finditer(text, start, end):
        if found[0] == "\n":
            lines += 1
        else:
            is_trailing = lines == 0 and start > 0 and "\n" not in found[0]
            column = _column(text, found.start())
            notes.append(Note(found[0].rstrip(), column, is_trailing, lines > 1))
            lines = 0
    return tuple(notes), lines > 1


def _column(text: str, offset: int) -> int:
    """Columns to the left of the place, tabs counting to the next multiple of four."""
    return len(text[text.rfind("\n", 0, offset) + 1 : offset].expandtabs(_TAB))


def words(found: list[Token]) -> Iterator[str]:
    """The texts of the tokens, comments without what indentation changes: the meaning."""
    for token in found:
        if token.sort is Sort.COMMENT:
            yield "\n".join(line.strip(" \t") for line in token.text.split("\n"))
        else:
            yield token.text
        yield from ("\n".join(map(str.strip, note.text.split("\n"))) for note in token.notes)
