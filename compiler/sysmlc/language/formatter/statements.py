"""Tokens with the notes before them, which the parser skips, grouped into statements and bodies."""

import re
from collections.abc import Iterator, Sequence
from dataclasses import dataclass, field
from enum import Enum

from msgspec import Struct

from sysmlc.language.text.lexer import TokenTypes, tokenize

_TAB_WIDTH = 4
_NOTE_OR_LINE_END = re.compile(r"//\*(?s:.)*?\*/|//[^\n]*|\n")


class Sort(Enum):
    """Sorts of tokens, as far as the layout depends on them."""

    KEYWORD = "keyword"
    NAME = "name"
    LITERAL = "literal"
    COMMENT = "comment"
    SYMBOL = "symbol"
    END = "end"


class Note(Struct, frozen=True):
    """A note (KerML 8.2.2.2): its text, its column, and its distance to the text before it."""

    text: str
    column: int
    is_trailing: bool
    """Whether it is on the line of the token before it."""
    after_blank: bool


class Token(Struct, frozen=True):
    """A token: its text and sort, its column in the original, and the notes before it."""

    text: str
    sort: Sort
    column: int = 0
    notes: tuple[Note, ...] = ()
    after_blank: bool = False

    @property
    def is_operand(self) -> bool:
        """Whether an expression can end with the token."""
        return self.sort in (Sort.NAME, Sort.LITERAL) or self.text in _OPERANDS


_OPERANDS = {")", "]", "}", "true", "false", "null", "*"}


def read_tokens(text: str, types: TokenTypes) -> list[Token]:
    """Return the tokens of a text whose lines end with line feeds; the last one is its end."""
    scanned = tokenize(text, types)
    tokens = []
    end_before = 0
    for index, kind in enumerate(scanned.types):
        start, end = scanned.starts[index], scanned.ends[index]
        notes, blank = _read_gap(text, end_before, start)
        written = text[start:end]
        tokens.append(
            Token(written, _classify(written, kind, types), _find_column(text, start), notes, blank)
        )
        end_before = end
    return tokens


def _classify(written: str, kind: int, types: TokenTypes) -> Sort:
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


def _read_gap(text: str, start: int, end: int) -> tuple[tuple[Note, ...], bool]:
    """Return the notes between two tokens, and whether a blank line is before the second."""
    notes: list[Note] = []
    line_ends = 0
    for match in _NOTE_OR_LINE_END.finditer(text, start, end):
        if match[0] == "\n":
            line_ends += 1
        else:
            is_trailing = line_ends == 0 and start > 0 and "\n" not in match[0]
            column = _find_column(text, match.start())
            notes.append(Note(match[0].rstrip(), column, is_trailing, line_ends > 1))
            line_ends = 0
    return tuple(notes), line_ends > 1


def _find_column(text: str, offset: int) -> int:
    """Return the number of columns before an offset; a tab extends to a multiple of four."""
    return len(text[text.rfind("\n", 0, offset) + 1 : offset].expandtabs(_TAB_WIDTH))


def iter_meaning(tokens: list[Token]) -> Iterator[str]:
    """Yield the texts of tokens and notes without what indentation changes."""
    for token in tokens:
        if token.sort is Sort.COMMENT:
            yield "\n".join(line.strip(" \t") for line in token.text.split("\n"))
        else:
            yield token.text
        yield from ("\n".join(map(str.strip, note.text.split("\n"))) for note in token.notes)


_BEFORE_EXPRESSION = (
    ". .? = := ( , ? ?? == != === !== < > <= >= + - * / % ^ ** & | default and or xor implies not"
)
"""Tokens after which a brace begins an expression instead of a body."""
_CONTINUATIONS = {"else", "until"}


@dataclass(slots=True)
class Block:
    """Everything between braces, with the braces; ``is_expression`` marks a body expression."""

    opening: Token
    is_expression: bool
    statements: "list[Statement]" = field(default_factory=list)
    closing: Token = field(default_factory=lambda: Token("}", Sort.SYMBOL))


Statement = list[Token | Block]
"""A member, a result expression, or another entry of a body."""


def group_statements(tokens: Sequence[Token]) -> tuple[list[Statement], Token]:
    """Return the statements of a text, and its last token with the notes before it."""
    reader = _StatementReader(tokens)
    statements = reader.read_body()
    return statements, tokens[reader.position]


class _StatementReader:
    """A recursive-descent reader of statements."""

    def __init__(self, tokens: Sequence[Token]) -> None:
        self._tokens = tokens
        self.position = 0

    def read_body(self) -> list[Statement]:
        """Read statements up to a closing brace or the end."""
        statements: list[Statement] = []
        while not self._is_at_end():
            statements.append(self._read_statement())
        return statements

    def _is_at_end(self) -> bool:
        token = self._tokens[self.position]
        return token.sort is Sort.END or token.text == "}"

    def _read_statement(self) -> Statement:
        statement: Statement = []
        while not self._is_at_end():
            token = self._tokens[self.position]
            if token.text == "{":
                block = self._read_block(statement)
                statement.append(block)
                if not (block.is_expression or self._continues(statement)):
                    break
                continue
            statement.append(token)
            self.position += 1
            if token.text == ";" or token.sort is Sort.COMMENT:
                break
        return statement

    def _read_block(self, statement: Statement) -> Block:
        opening = self._tokens[self.position]
        self.position += 1
        block = Block(opening, _begins_body_expression(statement), self.read_body())
        block.closing = self._tokens[self.position]
        if block.closing.sort is not Sort.END:
            self.position += 1
        return block

    def _continues(self, statement: Statement) -> bool:
        """Whether a statement continues after a body: else, until, the target of a transition."""
        following = self._tokens[self.position].text
        words = [item.text for item in statement[1:] if isinstance(item, Token)]
        is_transition = isinstance(statement[0], Token) and statement[0].text == "transition"
        return following in _CONTINUATIONS or (
            following == "then" and (is_transition or "do" in words)
        )


def _begins_body_expression(statement: Statement) -> bool:
    """Whether a brace after these tokens begins a body expression (KerML 8.2.5.8.3)."""
    if not statement or isinstance(statement[-1], Block):
        return False
    if statement[-1].text in _BEFORE_EXPRESSION.split():
        return True
    texts = [item.text if isinstance(item, Token) else "{}" for item in statement]
    if texts[-1] == "else":
        return "?" in texts
    position = len(texts) - 1
    # Skip back over a qualified name: `a->Pkg::select {`.
    while position > 1 and texts[position - 1] == "::":
        position -= 2
    return position > 0 and texts[position - 1] == "->"
