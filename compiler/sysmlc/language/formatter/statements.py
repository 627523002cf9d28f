"""Tokens with the notes before them, grouped into statements and bodies."""

import re
from collections.abc import Iterator, Sequence
from dataclasses import dataclass, field
from enum import Enum

from msgspec import Struct

from sysmlc.language.text.lexer import TokenTypes, tokenize

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


def tokens(text: str, types: TokenTypes) -> list[Token]:
    """The tokens of a text whose lines end with line feeds; the last one is its end."""
    scanned = tokenize(text, types)
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


def _sort(written: str, kind: int, types: TokenTypes) -> Sort:
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


_BEFORE_EXPRESSION = (
    ". .? = := ( , ? ?? == != === !== < > <= >= + - * / % ^ ** & | default and or xor implies not"
)
"""Tokens after which a brace begins an expression, not a body."""
_AFTER_BODY = {"else", "until"}


@dataclass(slots=True)
class Block:
    """What stands between braces, with them; ``is_expression`` for a body expression."""

    opening: Token
    is_expression: bool
    statements: "list[Statement]" = field(default_factory=list)
    closing: Token = field(default_factory=lambda: Token("}", Sort.SYMBOL))


Statement = list[Token | Block]
"""A member, a result expression, or what begins and ends with an entry of a body."""


def statements(found: Sequence[Token]) -> tuple[list[Statement], Token]:
    """The statements of a text, and its end with the notes before it."""
    reader = _Reader(found)
    made = reader.body()
    return made, found[reader.at]


class _Reader:
    def __init__(self, found: Sequence[Token]) -> None:
        self._found = found
        self.at = 0

    def body(self) -> list[Statement]:
        """Statements up to a closing brace or the end."""
        made: list[Statement] = []
        while not self._is_closed():
            made.append(self._statement())
        return made

    def _is_closed(self) -> bool:
        token = self._found[self.at]
        return token.sort is Sort.END or token.text == "}"

    def _statement(self) -> Statement:
        made: Statement = []
        while not self._is_closed():
            token = self._found[self.at]
            if token.text == "{":
                block = self._block(made)
                made.append(block)
                if not (block.is_expression or self._goes_on(made)):
                    break
                continue
            made.append(token)
            self.at += 1
            if token.text == ";" or token.sort is Sort.COMMENT:
                break
        return made

    def _block(self, before: Statement) -> Block:
        opening = self._found[self.at]
        self.at += 1
        made = Block(opening, _begins_expression(before), self.body())
        made.closing = self._found[self.at]
        if made.closing.sort is not Sort.END:
            self.at += 1
        return made

    def _goes_on(self, made: Statement) -> bool:
        """Whether a statement goes on after a body: else, until, the target of a transition."""
        following = self._found[self.at].text
        words = [item.text for item in made[1:] if isinstance(item, Token)]
        starts = isinstance(made[0], Token) and made[0].text == "transition"
        return following in _AFTER_BODY or (following == "then" and (starts or "do" in words))


def _begins_expression(before: Statement) -> bool:
    """Whether a brace after these tokens begins a body expression (KerML 8.2.5.8.3)."""
    if not before or isinstance(before[-1], Block):
        return False
    if before[-1].text in _BEFORE_EXPRESSION.split():
        return True
    texts = [item.text if isinstance(item, Token) else "{}" for item in before]
    if texts[-1] == "else":
        return "?" in texts
    at = len(texts) - 1
    while at > 1 and texts[at - 1] == "::":
        at -= 2
    return at > 0 and texts[at - 1] == "->"
