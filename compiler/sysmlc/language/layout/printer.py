"""Statements as lines: one member a line, bodies indented, notes and comments where they were."""

from collections.abc import Iterator, Sequence

from sysmlc.language.layout import comments
from sysmlc.language.layout.spacing import Piece, Spacing
from sysmlc.language.layout.statements import Block, Statement
from sysmlc.language.layout.tokens import Note, Sort, Token
from sysmlc.language.layout.wrapping import WIDTH, flat, wrapped

_STEP = "    "


class Printer:
    """Collects the lines of a text."""

    def __init__(self) -> None:
        self.lines: list[str] = []

    def body(self, found: Sequence[Statement], end: Token, indent: str) -> None:
        """The statements of a body, and the notes before its end."""
        is_first = True
        for statement in found:
            self._before(_opening(statement), indent, is_first=is_first)
            _Statement(self, statement, indent).print()
            is_first = False
        self._notes(end.notes, indent, is_first=is_first)

    def _before(self, token: Token, indent: str, *, is_first: bool) -> None:
        """Notes and the blank line before a statement."""
        self._notes(token.notes, indent, is_first=is_first)
        own = any(not note.is_trailing for note in token.notes)
        if token.after_blank and (own or not is_first):
            self.lines.append("")

    def _notes(self, notes: Sequence[Note], indent: str, *, is_first: bool) -> None:
        for note in notes:
            if note.is_trailing:
                self.trail(note)
                continue
            if note.after_blank and not is_first:
                self.lines.append("")
            self.own_line(note, indent)
            is_first = False

    def trail(self, note: Note) -> None:
        """Put a note at the end of the last line."""
        self.lines[-1] += f" {note.text}"

    def own_line(self, note: Note, indent: str) -> None:
        """Put a note on lines of its own."""
        self.lines += comments.lines(note.text, note.column, indent)


class _Statement:
    """Prints one statement."""

    def __init__(self, printer: Printer, statement: Statement, indent: str) -> None:
        self._printer = printer
        self._items = statement
        self._indent = indent
        self._first = indent
        self._rest = indent + 2 * _STEP
        self._pieces: list[Piece] = []
        self._spacing = Spacing()
        self._is_flat = _is_flat(statement, indent)

    def print(self) -> None:
        for index, item in enumerate(self._items):
            if isinstance(item, Token):
                self._token(item, is_first=index == 0)
            elif item.is_expression and self._is_flat:
                for token in _flattened(item):
                    self._pieces.append(self._spacing.piece(token))
            else:
                self._block(item, is_first=index == 0)
        self._flush()

    def _token(self, token: Token, *, is_first: bool) -> None:
        if not is_first:
            self._between(token.notes)
        if token.sort is Sort.COMMENT and "\n" in token.text:
            self._flush()
            self._printer.lines += comments.lines(token.text, token.column, self._indent)
        else:
            self._pieces.append(self._spacing.piece(token))

    def _between(self, notes: Sequence[Note]) -> None:
        """Notes within a statement end the line."""
        for note in notes:
            self._flush()
            if note.is_trailing:
                self._printer.trail(note)
            else:
                self._printer.own_line(note, self._rest)
            self._first = self._rest

    def _block(self, block: Block, *, is_first: bool) -> None:
        self._token(block.opening, is_first=is_first)
        if not block.statements and not block.closing.notes:
            self._pieces.append(Piece("}", "", None))
            self._spacing = Spacing()
            self._spacing.piece(block.closing)
            return
        self._flush()
        self._printer.body(block.statements, block.closing, self._indent + _STEP)
        self._first = self._indent
        self._spacing = Spacing()
        self._pieces.append(self._spacing.piece(block.closing))

    def _flush(self) -> None:
        """Print the pieces so far; what follows goes on in another line."""
        if self._pieces:
            self._printer.lines += wrapped(self._pieces, self._first, self._rest)
            self._first = self._rest
            self._pieces = []


def _opening(statement: Statement) -> Token:
    first = statement[0]
    return first.opening if isinstance(first, Block) else first


def _is_flat(statement: Statement, indent: str) -> bool:
    """Whether the body expressions of a statement stand on one line with the rest of it."""
    blocks = [item for item in statement if isinstance(item, Block) and item.is_expression]
    if not blocks or not all(_has_no_lines(block) for block in blocks):
        return False
    return len(indent) + len(flat(list(_header(statement)))) <= WIDTH


def _header(statement: Statement) -> Iterator[Piece]:
    """A statement in one line, up to its first body."""
    spacing = Spacing()
    for item in statement:
        if isinstance(item, Token):
            yield spacing.piece(item)
        elif item.is_expression:
            yield from map(spacing.piece, _flattened(item))
        else:
            yield spacing.piece(item.opening)
            return


def _has_no_lines(block: Block) -> bool:
    """Whether nothing in a body expression needs a line of its own."""
    tokens = list(_flattened(block))
    has_comment = any(token.sort is Sort.COMMENT for token in tokens)
    return not has_comment and not any(token.notes for token in tokens)


def _flattened(block: Block) -> Iterator[Token]:
    yield block.opening
    for statement in block.statements:
        for item in statement:
            if isinstance(item, Token):
                yield item
            else:
                yield from _flattened(item)
    yield block.closing
