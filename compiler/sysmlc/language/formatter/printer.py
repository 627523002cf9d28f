"""Statements as lines: indentation, wrapping, comments and notes."""

from collections.abc import Iterator, Sequence

from sysmlc.language.formatter.spacing import Piece, Spacing
from sysmlc.language.formatter.statements import Block, Note, Sort, Statement, Token

_BLANK = " \t\f\v"
_TAB = 4


def lines(text: str, column: int, indent: str) -> list[str]:
    """The lines of a comment that started in ``column`` and now starts after ``indent``."""
    first, *rest = text.split("\n")
    if not rest:
        return [indent + text]
    opening = first if first.strip("/*" + _BLANK) else first.rstrip(_BLANK)
    *middle, last = rest
    if all(_is_starred(line) for line in middle) and _is_starred(last.removesuffix("*/")):
        moved = [_starred(line, indent) for line in middle]
        closing = _starred(last, indent)
    else:
        is_bare = not last.removesuffix("*/").strip(_BLANK)
        filled = filter(str.strip, middle if is_bare else rest)
        shift = len(indent) - min([column, *map(_before, filled)])
        moved = [_shifted(line, shift) for line in middle]
        closing = f"{indent} */" if is_bare else _shifted(last, shift)
    return [indent + opening, *moved, closing]


def _is_starred(line: str) -> bool:
    bare = line.lstrip(_BLANK)
    return not bare or bare.startswith("*")


def _starred(line: str, indent: str) -> str:
    bare = line.lstrip(_BLANK)
    if not bare:
        return ""
    if bare in ("*", "* "):
        return f"{indent} *"
    return f"{indent} {bare}"


def _shifted(line: str, shift: int) -> str:
    bare = line.lstrip(_BLANK)
    return " " * max(0, _before(line) + shift) + bare if bare else ""


def _before(line: str) -> int:
    """Columns before the first character of a line."""
    return len(line[: len(line) - len(line.lstrip(_BLANK))].expandtabs(_TAB))


WIDTH = 100
"""Characters of a line, its indentation included."""


def wrapped(pieces: Sequence[Piece], first: str, rest: str) -> list[str]:
    """The pieces in lines: the first starts with ``first``, what goes on with ``rest``."""
    found: list[str] = []
    indent = first
    start = 0
    while start < len(pieces):
        end = _end(pieces, start, len(indent))
        found.append(indent + flat(pieces[start:end]))
        indent, start = rest, end
    return found


def flat(pieces: Sequence[Piece]) -> str:
    """The pieces in one line."""
    return "".join(p.space + p.text if i else p.text for i, p in enumerate(pieces))


def _end(pieces: Sequence[Piece], start: int, used: int) -> int:
    """Where the line that begins with piece ``start`` ends."""
    best, rank = 0, 0
    for index in range(start, len(pieces)):
        piece = pieces[index]
        space = piece.space if index > start else ""
        if (
            index > start
            and piece.rank is not None
            and _fits(used)
            and (not best or piece.rank <= rank)
        ):
            best, rank = index, piece.rank
        used += len(space) + _width(piece.text)
        if used > WIDTH and best:
            return best
        if used > WIDTH and index > start and piece.rank is not None:
            return index
    return len(pieces)


def _fits(used: int) -> bool:
    return used <= WIDTH


def _width(text: str) -> int:
    return len(text) - text.rfind("\n") - 1


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
        self.lines += lines(note.text, note.column, indent)


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
            self._printer.lines += lines(token.text, token.column, self._indent)
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
