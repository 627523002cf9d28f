"""Text that PlantUML displays as written: escaped characters, wrapped lines, safe comments."""

import re
import textwrap
import unicodedata
from collections.abc import Iterable
from functools import lru_cache

from sysmlc.support.escapes import escape_invisible

WIDTH = 36
"""Characters in one line of a name before it is broken."""

_LONGEST = 4_000
"""Characters of a text that a diagram shows; nobody reads more in a box."""

_REMEMBERED = 1 << 12
"""Texts whose spelling is kept: ports and values of many blocks read the same."""
_BREAK = "\\n"
_BACKSLASH_BEFORE_T = "<U+005C><U+200B>"
"""PlantUML 1.2026.2 reads ``<U+005C>t`` as a tab, unless something stands between."""
_ALWAYS = frozenset('"\\<>~%$&{')
_TRAPS = re.compile(
    r'["\\<>~%$&{]|^[^A-Za-z0-9]|(?<=\*)\*|(?<=/)/|(?<=_)_|(?<=-)-|(?<=\[)\[|(?<=/)\'|(?<=\')[/\']|[^\x00-\x7f]'
)
"""Markup, what a line may not begin with, second characters of pairs, what may not be seen."""
_HARMLESS_FIRST = frozenset("«([:/≤≥→←…✕⚡")
_UNSEEN = frozenset(["Cf", "Zl", "Zp", "Co", "Cn"])
_HARMLESS = re.compile(r"[A-Za-z0-9](?:[A-Za-z0-9.,:;()=+]|[ _-](?=[A-Za-z0-9.,:;()=+]))*")
"""Text that stays as it is; most names are such, and to look at each character takes long."""
_BLANKS = re.compile(r"[\t\n\x0b\x0c\r]|  |^ | $|^$")
"""Blanks other than one between two words."""
_JOINT = re.compile(r"(?<=[a-z0-9])(?=[A-Z])|(?<=[_:./\-,;])(?=\w)")


@lru_cache(_REMEMBERED)
def escape_line(text: str) -> str:
    """Return one line that PlantUML displays as written.

    Markup, preprocessor directives and Unicode traps are escaped.
    """
    if len(text) <= _LONGEST and _HARMLESS.fullmatch(text):
        return text
    line = " ".join(_replace_invalid(_truncate(text)).split())
    return _TRAPS.sub(_escape_trap, line)


@lru_cache(_REMEMBERED)
def wrap_lines(text: str, width: int = WIDTH) -> tuple[str, ...]:
    """Return the text in escaped lines of at most *width* characters; its own line ends are
    preserved.
    """
    if len(text) <= width and _HARMLESS.fullmatch(text):
        return (text,)
    rows = [row for part in _truncate(text).splitlines() for row in _wrap(part, width)]
    return tuple(escape_line(row) for row in rows if row.strip())


def format_label(text: str, width: int = WIDTH) -> str:
    """Return the text for a label between quotes or after a colon: lines joined by ``\\n``."""
    return _BREAK.join(wrap_lines(text, width))


def join_rows(rows: Iterable[str]) -> str:
    """Join rows that are already escaped, one above the other in one label."""
    return _BREAK.join(row for row in rows if row)


def shrink(text: str) -> str:
    """Return escaped text in the smaller size of keywords; empty text stays empty."""
    return f"<size:10>{text}</size>" if text else ""


def format_keyword_label(text: str) -> str:
    """Return the label of a line; a label of only a keyword, ``«copy»``, would lose its
    guillemets.
    """
    rows = wrap_lines(text)
    return join_rows(map(shrink, rows)) if text.startswith("«") else join_rows(rows)


def pad_label(text: str) -> str:
    """Return the text for the end of a line, with a blank on each side between it and the arrow
    head.
    """
    return join_rows(f"<U+00A0>{row}<U+00A0>" for row in wrap_lines(text))


def format_comment(text: str) -> str:
    """Return the text for a line comment that ends with its line.

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
    """Return the replacement of a character that PlantUML may interpret."""
    char = match[0]
    if char == "\\":
        return _BACKSLASH_BEFORE_T if match.string.startswith("t", match.end()) else _escape(char)
    if match.start() == 0 and char not in _ALWAYS:
        is_shown = char.isalnum() or char in _HARMLESS_FIRST or char > "\u02ff"
    else:
        is_shown = not char.isascii()
    return char if is_shown and unicodedata.category(char) not in _UNSEEN else _escape(char)


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
    """Break a row that is one long word at its joints (camelCase, ``_``, ``::``), else anywhere."""
    if len(row) <= width:
        return [row]
    pieces, current = [], ""
    for word in _JOINT.split(row):
        if current and len(current) + len(word) > width:
            pieces.append(current)
            current = ""
        current += word
        while len(current) > width:
            pieces.append(current[:width])
            current = current[width:]
    return [*pieces, current] if current else pieces
