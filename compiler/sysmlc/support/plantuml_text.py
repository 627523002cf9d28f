"""Escapes, wraps and formats texts, so that PlantUML displays them as written."""

import re
import textwrap
import unicodedata
from collections.abc import Iterable
from functools import lru_cache

from sysmlc.support.escapes import escape_invisible

WIDTH = 36
"""Characters of a line of a name; longer names are broken."""

_LONGEST = 4_000
"""Characters of a text that a diagram shows; longer texts are cut."""

_CACHE_SIZE = 1 << 12
"""Texts whose escaped form is cached: ports and values of many blocks have the same names."""
_BREAK = "\\n"
_BACKSLASH_BEFORE_T = "<U+005C><U+200B>"
"""A backslash before ``t``, and a zero-width space: alone, PlantUML 1.2026.2 reads it as a tab."""
_ALWAYS_ESCAPED = frozenset('"\\<>~%$&{')
_TRAPS = re.compile(
    r'["\\<>~%$&{]|^[^A-Za-z0-9]|(?<=\*)\*|(?<=/)/|(?<=_)_|(?<=-)-|(?<=\[)\[|(?<=/)\'|(?<=\')[/\']|[^\x00-\x7f]'
)
"""Characters that may need an escape.

They are markup, the first character of a line unless it is a letter or digit, the second character
of a pair such as ``**``, and characters beyond ASCII, which may be invisible.
"""
_HARMLESS_FIRST = frozenset("«([:/≤≥→←…✕⚡")
"""Characters with which a line may start, in addition to letters and digits."""
_INVISIBLE = frozenset(["Cf", "Zl", "Zp", "Co", "Cn"])
"""Unicode categories of characters that are displayed as nothing or as a box."""
_HARMLESS = re.compile(r"[A-Za-z0-9](?:[A-Za-z0-9.,:;()=+]|[ _-](?=[A-Za-z0-9.,:;()=+]))*")
"""Text without any character that may need an escape: a fast path for most names."""
_BLANKS = re.compile(r"[\t\n\x0b\x0c\r]|  |^ | $|^$")
"""White space other than one blank between two words."""
_WORD_BREAK = re.compile(r"(?<=[a-z0-9])(?=[A-Z])|(?<=[_:./\-,;])(?=\w)")


@lru_cache(_CACHE_SIZE)
def escape_line(text: str) -> str:
    """Return *text* as one line in which PlantUML interprets nothing.

    Markup, preprocessor directives and invisible characters are escaped.
    """
    if len(text) <= _LONGEST and _HARMLESS.fullmatch(text):
        return text
    line = " ".join(_replace_invalid(_truncate(text)).split())
    return _TRAPS.sub(_escape_trap, line)


@lru_cache(_CACHE_SIZE)
def wrap_lines(text: str, width: int = WIDTH) -> tuple[str, ...]:
    """Return *text* in escaped lines of at most *width* characters.

    A line end in the text ends a line; empty lines are dropped.
    """
    if len(text) <= width and _HARMLESS.fullmatch(text):
        return (text,)
    rows = [row for part in _truncate(text).splitlines() for row in _wrap(part, width)]
    return tuple(escape_line(row) for row in rows if row.strip())


def format_label(text: str, width: int = WIDTH) -> str:
    """Return *text* as a label, between quotes or after a colon: lines joined by ``\\n``."""
    return _BREAK.join(wrap_lines(text, width))


def join_rows(rows: Iterable[str]) -> str:
    """Join escaped rows to one label, one above the other; empty rows are dropped."""
    return _BREAK.join(row for row in rows if row)


def shrink(text: str) -> str:
    """Return escaped text in the smaller size of keywords; empty text stays empty."""
    return f"<size:10>{text}</size>" if text else ""


def format_keyword_label(text: str) -> str:
    """Return *text* as the label of a line, a keyword such as ``«copy»`` in smaller size.

    Without the size, PlantUML would drop the guillemets of a label that is only a keyword.
    """
    rows = wrap_lines(text)
    return join_rows(map(shrink, rows)) if text.startswith("«") else join_rows(rows)


def pad_label(text: str) -> str:
    """Return *text* as the label at an end of a line, with a blank before and after each row."""
    return join_rows(f"<U+00A0>{row}<U+00A0>" for row in wrap_lines(text))


def format_comment(text: str) -> str:
    """Return *text* for a line comment that cannot extend beyond its line.

    PlantUML joins a line that ends with a backslash with the next one, and starts a block comment
    at a slash with a quote.
    """
    line = escape_invisible(" ".join(_truncate(text).split()))
    line = line.replace("/'", "/ '").replace("'/", "' /")
    return f"{line} ." if line.endswith("\\") else line


def _truncate(text: str) -> str:
    return text if len(text) <= _LONGEST else text[:_LONGEST] + "…"


def _replace_invalid(text: str) -> str:
    if text.isprintable():
        return text
    return "".join("\ufffd" if _is_invalid(char) else char for char in text)


def _is_invalid(char: str) -> bool:
    if char.isspace():
        return False
    return unicodedata.category(char) in ("Cc", "Cs") or ord(char) & 0xFFFE == 0xFFFE


def _escape_trap(match: re.Match[str]) -> str:
    """Return the character of *match*, or its escape if PlantUML would interpret it."""
    char = match[0]
    if char == "\\":
        return _BACKSLASH_BEFORE_T if match.string.startswith("t", match.end()) else _escape(char)
    if match.start() == 0 and char not in _ALWAYS_ESCAPED:
        is_shown = char.isalnum() or char in _HARMLESS_FIRST or char > "\u02ff"
    else:
        is_shown = not char.isascii()
    return char if is_shown and unicodedata.category(char) not in _INVISIBLE else _escape(char)


def _escape(char: str) -> str:
    return f"<U+{ord(char):04X}>" if ord(char) <= 0xFFFFF else char


def _wrap(text: str, width: int) -> list[str]:
    if _BLANKS.search(text):
        rows = textwrap.wrap(text, width, break_long_words=False, break_on_hyphens=False)
    else:
        rows = _fill_rows(text.split(" "), width)
    return [piece for row in rows for piece in _break_word(row, width)]


def _fill_rows(words: list[str], width: int) -> list[str]:
    """Return rows of words with one blank between them, each as full as possible."""
    rows, row = [], words[0]
    for word in words[1:]:
        if len(row) + 1 + len(word) <= width:
            row = f"{row} {word}"
        else:
            rows.append(row)
            row = word
    return [*rows, row]


def _break_word(row: str, width: int) -> list[str]:
    """Break a row that is one long word between its parts (camelCase, ``_``, ``::``).

    A part that is longer than *width* is broken anywhere.
    """
    if len(row) <= width:
        return [row]
    pieces, current = [], ""
    for word in _WORD_BREAK.split(row):
        if current and len(current) + len(word) > width:
            pieces.append(current)
            current = ""
        current += word
        while len(current) > width:
            pieces.append(current[:width])
            current = current[width:]
    return [*pieces, current] if current else pieces
