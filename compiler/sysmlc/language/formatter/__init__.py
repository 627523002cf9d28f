"""The formatter of KerML and SysML v2: text in canonical layout.

The printer indents and wraps statements, and moves comments and notes with them. The text of a
comment excludes the white space at the start of its lines and the asterisk there (KerML 8.2.3.3.2),
so both may be moved without changing the comment.
"""

from collections.abc import Iterator, Sequence
from itertools import pairwise

from sysmlc.language.formatter.statements import (
    Block,
    Note,
    Piece,
    Sort,
    Spacing,
    Statement,
    Token,
    group_statements,
    iter_meaning,
    read_tokens,
)
from sysmlc.language.text.lalr import load_tables
from sysmlc.language.tree import Document


def format_text(text: str, language: str) -> str:
    """Return the text in canonical layout; ``language`` is ``kerml`` or ``sysml``.

    The layout has four spaces for each body, one member a line, at most one blank line in a row,
    and lines of 100 characters where tokens allow. Comments and notes move with what they belong
    to. Tokens, comments and notes do not change, and the line ends are those of most lines.

    The text must have no syntax errors. Raises ValueError if a token would change, which is a fault
    of the formatter.
    """
    types = load_tables(language).types
    line_end = "\r\n" if 2 * text.count("\r\n") > text.count("\n") else "\n"
    plain = text.replace("\r\n", "\n").replace("\r", "\n")
    source_tokens = read_tokens(plain, types)
    printer = Printer()
    printer.print_body(*group_statements(source_tokens), "")
    formatted = "".join(f"{line}\n" for line in printer.lines)
    # A wrong space would change the model without notice, so the result is checked every time.
    if list(iter_meaning(read_tokens(formatted, types))) != list(iter_meaning(source_tokens)):
        raise ValueError("the layout would change the text")
    return formatted.replace("\n", line_end)


def add_import_visibilities(document: Document) -> str:
    """Return the text of the document with ``public`` before each import without visibility.

    That is what such an import meant in older versions of the language, and how it is read.
    """
    starts = [
        node.start
        for node in document.root.walk()
        if node.kind in ("MembershipImport", "NamespaceImport") and not node.visibility
    ]
    boundaries = [0, *starts, len(document.text)]
    return "public ".join(document.text[start:end] for start, end in pairwise(boundaries))


# -- printer -----------------------------------------------------------------------------------

_WHITE_SPACE = " \t\f\v"
_TAB_WIDTH = 4


def _reindent_comment(text: str, column: int, indent: str) -> list[str]:
    """Return the lines of a comment that is moved from ``column`` to after ``indent``."""
    first, *rest = text.split("\n")
    if not rest:
        return [indent + text]
    opening = first if first.strip("/*" + _WHITE_SPACE) else first.rstrip(_WHITE_SPACE)
    *middle, last = rest
    if all(_has_asterisk(line) for line in middle) and _has_asterisk(last.removesuffix("*/")):
        moved_lines = [_indent_starred(line, indent) for line in middle]
        closing = _indent_starred(last, indent)
    else:
        is_closing_bare = not last.removesuffix("*/").strip(_WHITE_SPACE)
        filled_lines = filter(str.strip, middle if is_closing_bare else rest)
        shift = len(indent) - min([column, *map(_count_indent, filled_lines)])
        moved_lines = [_shift_line(line, shift) for line in middle]
        closing = f"{indent} */" if is_closing_bare else _shift_line(last, shift)
    return [indent + opening, *moved_lines, closing]


def _has_asterisk(line: str) -> bool:
    stripped = line.lstrip(_WHITE_SPACE)
    return not stripped or stripped.startswith("*")


def _indent_starred(line: str, indent: str) -> str:
    stripped = line.lstrip(_WHITE_SPACE)
    if not stripped:
        return ""
    if stripped in ("*", "* "):
        return f"{indent} *"
    return f"{indent} {stripped}"


def _shift_line(line: str, shift: int) -> str:
    stripped = line.lstrip(_WHITE_SPACE)
    return " " * max(0, _count_indent(line) + shift) + stripped if stripped else ""


def _count_indent(line: str) -> int:
    """Return the number of columns before the first character of a line."""
    return len(line[: len(line) - len(line.lstrip(_WHITE_SPACE))].expandtabs(_TAB_WIDTH))


WIDTH = 100
"""Maximal length of a line, including its indentation."""


def _wrap_pieces(pieces: Sequence[Piece], first_indent: str, next_indent: str) -> list[str]:
    """Return the pieces as lines: the first with ``first_indent``, others with ``next_indent``."""
    lines: list[str] = []
    indent = first_indent
    start = 0
    while start < len(pieces):
        end = _find_line_end(pieces, start, len(indent))
        lines.append(indent + _join_pieces(pieces[start:end]))
        indent, start = next_indent, end
    return lines


def _join_pieces(pieces: Sequence[Piece]) -> str:
    """Return the pieces in one line."""
    return "".join(
        piece.space + piece.text if index else piece.text for index, piece in enumerate(pieces)
    )


def _find_line_end(pieces: Sequence[Piece], start: int, width: int) -> int:
    """Return the end of the line that begins with piece ``start``."""
    best_end, best_rank = 0, 0
    for index in range(start, len(pieces)):
        piece = pieces[index]
        space = piece.space if index > start else ""
        if (
            index > start
            and piece.rank is not None
            and width <= WIDTH
            and (not best_end or piece.rank <= best_rank)
        ):
            best_end, best_rank = index, piece.rank
        last_line = piece.text.rpartition("\n")[2]
        width += len(space) + len(last_line)
        # The best break that fits, else the first one possible.
        if width > WIDTH and best_end:
            return best_end
        if width > WIDTH and index > start and piece.rank is not None:
            return index
    return len(pieces)


_STEP = "    "


class Printer:
    """Collects the lines of a text."""

    def __init__(self) -> None:
        self.lines: list[str] = []

    def print_body(self, statements: Sequence[Statement], end: Token, indent: str) -> None:
        """Print the statements of a body, and the notes before its end."""
        is_first = True
        for statement in statements:
            first = statement[0].opening if isinstance(statement[0], Block) else statement[0]
            self._print_before(first, indent, is_first=is_first)
            _StatementPrinter(self, statement, indent).print()
            is_first = False
        self._print_notes(end.notes, indent, is_first=is_first)

    def _print_before(self, token: Token, indent: str, *, is_first: bool) -> None:
        """Print the notes and the blank line before a statement."""
        self._print_notes(token.notes, indent, is_first=is_first)
        has_own_line = any(not note.is_trailing for note in token.notes)
        if token.after_blank and (has_own_line or not is_first):
            self.lines.append("")

    def _print_notes(self, notes: Sequence[Note], indent: str, *, is_first: bool) -> None:
        for note in notes:
            if note.after_blank and not note.is_trailing and not is_first:
                self.lines.append("")
            self.print_note(note, indent)
            is_first = is_first and note.is_trailing

    def print_note(self, note: Note, indent: str) -> None:
        """Append a note to the last line, or print it on lines of its own."""
        if note.is_trailing:
            self.lines[-1] += f" {note.text}"
        else:
            self.lines += _reindent_comment(note.text, note.column, indent)


class _StatementPrinter:
    """Prints one statement."""

    def __init__(self, printer: Printer, statement: Statement, indent: str) -> None:
        self._printer = printer
        self._items = statement
        self._indent = indent
        self._first_indent = indent
        self._next_indent = indent + 2 * _STEP
        self._pieces: list[Piece] = []
        self._spacing = Spacing()
        self._keeps_expressions_on_line = _fits_on_line(statement, indent)

    def print(self) -> None:
        for index, item in enumerate(self._items):
            if isinstance(item, Token):
                self._add_token(item, is_first=index == 0)
            elif item.is_expression and self._keeps_expressions_on_line:
                for token in _iter_tokens(item):
                    self._pieces.append(self._spacing.add_token(token))
            else:
                self._print_block(item, is_first=index == 0)
        self._flush()

    def _add_token(self, token: Token, *, is_first: bool) -> None:
        if not is_first:
            self._print_notes_between(token.notes)
        if token.sort is Sort.COMMENT and "\n" in token.text:
            self._flush()
            self._printer.lines += _reindent_comment(token.text, token.column, self._indent)
        else:
            self._pieces.append(self._spacing.add_token(token))

    def _print_notes_between(self, notes: Sequence[Note]) -> None:
        """Print notes within a statement, which end the line."""
        for note in notes:
            self._flush()
            self._printer.print_note(note, self._next_indent)
            self._first_indent = self._next_indent

    def _print_block(self, block: Block, *, is_first: bool) -> None:
        self._add_token(block.opening, is_first=is_first)
        # An empty body stays on the line of its statement.
        if not block.statements and not block.closing.notes:
            self._pieces.append(Piece("}", "", None))
            self._spacing = Spacing()
            self._spacing.add_token(block.closing)
            return
        self._flush()
        self._printer.print_body(block.statements, block.closing, self._indent + _STEP)
        self._first_indent = self._indent
        self._spacing = Spacing()
        self._pieces.append(self._spacing.add_token(block.closing))

    def _flush(self) -> None:
        """Print the pieces so far; the next pieces begin a new line."""
        if self._pieces:
            self._printer.lines += _wrap_pieces(self._pieces, self._first_indent, self._next_indent)
            self._first_indent = self._next_indent
            self._pieces = []


def _fits_on_line(statement: Statement, indent: str) -> bool:
    """Whether the body expressions of a statement fit on one line with its head."""
    blocks = [item for item in statement if isinstance(item, Block) and item.is_expression]
    tokens = [token for block in blocks for token in _iter_tokens(block)]
    needs_line = any(token.notes or token.sort is Sort.COMMENT for token in tokens)
    if not blocks or needs_line:
        return False
    return len(indent) + len(_join_pieces(list(_iter_header(statement)))) <= WIDTH


def _iter_header(statement: Statement) -> Iterator[Piece]:
    """Yield the pieces of a statement in one line, up to its first body."""
    spacing = Spacing()
    for item in statement:
        if isinstance(item, Token):
            yield spacing.add_token(item)
        elif item.is_expression:
            yield from map(spacing.add_token, _iter_tokens(item))
        else:
            yield spacing.add_token(item.opening)
            return


def _iter_tokens(block: Block) -> Iterator[Token]:
    yield block.opening
    for statement in block.statements:
        for item in statement:
            if isinstance(item, Token):
                yield item
            else:
                yield from _iter_tokens(item)
    yield block.closing


__all__ = ["format_text"]
