"""Tokens of a text, grouped into statements and bodies, and the spaces between them.

A token has the notes before it, which the parser skips. The places where a long statement may be
broken have ranks.
"""

import re
from collections.abc import Iterator, Sequence
from dataclasses import dataclass, field
from enum import Enum

from msgspec import Struct

from sysmlc.language.text.lexer import TokenTypes, tokenize

_TAB_WIDTH = 4
_NOTE_OR_LINE_END = re.compile(r"//\*(?s:.)*?\*/|//[^\n]*|\n")
_OPERANDS = {")", "]", "}", "true", "false", "null", "*"}


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


def read_tokens(text: str, types: TokenTypes) -> list[Token]:
    """Return the tokens of a text whose lines end with line feeds; the last token is the end."""
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
    """Yield the texts of tokens and notes, without the white space that indentation changes."""
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
    """Return the statements of a text and its end token, which has the notes after them."""
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


# -- spaces and line breaks --------------------------------------------------------------------

_NO_SPACE_BEFORE = {";", ",", ")", "]", ".", "::", "..", ".?", "->"}
_NO_SPACE_AFTER = {"(", "[", ".", "::", "..", ".?", "->", "$", "~"}
_TIGHT_OPERATORS = {"^", "**"}
_ARITHMETIC = {"+", "-", "*", "/", "%"}
_PREFIXES = {"@", "#", "~", "-", "+"}
_BEFORE_VALUE = {"=", ":=", "default", "if", "while", "until", "when", "at", "after"} | {
    "filter",
    "assign",
}
"""Tokens that an expression follows."""
_OPERATORS = (
    {"and", "or", "xor", "implies", "??", "==", "!=", "===", "!==", "<", ">", "<=", ">="}
    | {"|", "&", "?", "else"}
    | _ARITHMETIC
)
_CLAUSE_WORDS = (
    "specializes subsets redefines references crosses conjugates chains unions intersects"
    " differences disjoint inverse featured typed defined connect to from of by via accept do"
    " then first about default allocate bind for :> :>> ::> =>"
)
_CLAUSES = _CLAUSE_WORDS.split()
_WORD_PAIRS = {(word, "by") for word in ("typed", "defined", "featured")} | {
    ("disjoint", "from"),
    ("inverse", "of"),
}
"""Keywords of two words, which stay on one line."""
_FREE, _COMMA, _OPERATION, _ARROW, _PARENTHESIS, _SPACE = range(6)
_RANKS_PER_LEVEL = 10


class Piece(Struct, frozen=True):
    """A token of a line: its text, the space before it, and the rank of a line break there.

    A lower ``rank`` is better. It is None where no break is allowed.
    """

    text: str
    space: str
    rank: int | None


class Spacing:
    """The spaces within one statement, token by token."""

    def __init__(self) -> None:
        self._before: Token | None = None
        self._is_sign = False
        self._open_brackets: list[str] = []
        self._has_value = False
        self._short_name_tokens = 0

    def add_token(self, token: Token) -> Piece:
        """Return the piece of the next token of the statement."""
        before = self._before
        space = " " if before is not None and self._is_spaced(before, token) else ""
        rank = self._rank_break(before, token, space) if before is not None else None
        self._update_state(token)
        return Piece(token.text, space, rank)

    def _update_state(self, token: Token) -> None:
        is_after_operand = self._before is not None and self._before.is_operand
        self._is_sign = token.text in _PREFIXES and not is_after_operand
        if token.text in ("(", "[", "{"):
            self._open_brackets.append(token.text)
        elif token.text in (")", "]", "}") and self._open_brackets:
            self._open_brackets.pop()
        if token.text in _BEFORE_VALUE:
            self._has_value = True
        elif token.text in (";", "{"):
            self._has_value = False
        if self._short_name_tokens:
            self._short_name_tokens -= 1
        elif token.text == "<" and not is_after_operand:
            self._short_name_tokens = 2
        self._before = token

    def _is_spaced(self, before: Token, token: Token) -> bool:
        # In ``<name>`` two tokens follow the bracket without a space.
        if self._is_sign or self._short_name_tokens > 0:
            return False
        if token.text in _NO_SPACE_BEFORE:
            return token.text in ("->", "..") and before.text == ","
        if before.text in _NO_SPACE_AFTER:
            return before.text == "~" and before.sort is Sort.KEYWORD
        return self._is_spaced_by_context(before, token)

    def _is_spaced_by_context(self, before: Token, token: Token) -> bool:
        if token.text == "(":
            return before.sort is not Sort.NAME and before.text not in (")", "]", "#")
        # `x[4]` is a multiplicity or an index, `5 [kg]` a quantity.
        if token.text == "[":
            is_bound = before.sort is Sort.NAME or before.text in ("]", "*", "**")
            return self._has_value or not is_bound
        if token.text == "#" and (before.sort is Sort.NAME or before.text in (")", "]")):
            return False
        if before.text == "{" or token.text == "}":
            return False
        # `**` would be another token.
        if before.text == "*" and token.text == "*":
            return True
        is_tight = self._is_tight(token) or self._is_tight(before)
        return not is_tight or (before.sort in _WORD_SORTS and token.sort in _WORD_SORTS)

    def _is_tight(self, token: Token) -> bool:
        if token.text in _TIGHT_OPERATORS:
            return True
        is_in_brackets = bool(self._open_brackets) and self._open_brackets[-1] == "["
        return is_in_brackets and token.text in _ARITHMETIC

    def _rank_break(self, before: Token, token: Token, space: str) -> int | None:
        """Return the rank of a line break before the token; None if it is not allowed."""
        depth = len(self._open_brackets) * _RANKS_PER_LEVEL
        if token.text == "->":
            return depth + _ARROW
        if before.text == "(" and token.text != ")":
            return depth + _PARENTHESIS
        if not space or token.text == "{" or (before.text, token.text) in _WORD_PAIRS:
            return None
        return depth + (_COMMA if before.text == "," else self._rank_by_token(token))

    def _rank_by_token(self, token: Token) -> int:
        """Return the rank of a break before a token that has a space before it."""
        if token.text in ("=", ":="):
            return _PARENTHESIS
        if token.text in _CLAUSES:
            return _OPERATION if self._has_value and self._open_brackets else _FREE
        return _OPERATION if token.text in _OPERATORS else _SPACE


_WORD_SORTS = (Sort.KEYWORD, Sort.NAME, Sort.LITERAL)
