"""Text that PlantUML shows as it is: escaped characters, wrapped lines, safe comments."""

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
def plain(text: str) -> str:
    """One line that PlantUML shows as written: markup, preprocessor and Unicode traps escaped."""
    if len(text) <= _LONGEST and _HARMLESS.fullmatch(text):
        return text
    line = " ".join(_visible(_shortened(text)).split())
    return _TRAPS.sub(_untrapped, line)


@lru_cache(_REMEMBERED)
def lines(text: str, width: int = WIDTH) -> tuple[str, ...]:
    """The text in escaped lines of at most ``width`` characters; its own line ends are kept."""
    if len(text) <= width and _HARMLESS.fullmatch(text):
        return (text,)
    rows = [row for part in _shortened(text).splitlines() for row in _wrapped(part, width)]
    return tuple(plain(row) for row in rows if row.strip())


def label(text: str, width: int = WIDTH) -> str:
    """The text for a label between quotes or after a colon: lines joined by ``\\n``."""
    return _BREAK.join(lines(text, width))


def stack(rows: Iterable[str]) -> str:
    """Rows that are escaped already, one above the other in one label."""
    return _BREAK.join(row for row in rows if row)


def small(text: str) -> str:
    """Escaped text in the smaller size of keywords; empty text stays empty."""
    return f"<size:10>{text}</size>" if text else ""


def keyword_label(text: str) -> str:
    """A label of a line; one that is only a keyword, ``«copy»``, would lose its guillemets."""
    rows = lines(text)
    return stack(map(small, rows)) if text.startswith("«") else stack(rows)


def padded(text: str) -> str:
    """The text for the end of a line, kept off the arrow head by a blank on each side."""
    return stack(f"<U+00A0>{row}<U+00A0>" for row in lines(text))


def comment(text: str) -> str:
    """Return the text for a line comment that ends with its line.

    PlantUML joins a line that ends with a backslash with the next one, and starts a block comment
    at a slash with a quote.
    """
    line = escape_invisible(" ".join(_shortened(text).split()))
    line = line.replace("/'", "/ '").replace("'/", "' /")
    return f"{line} ." if line.endswith("\\") else line


def _shortened(text: str) -> str:
    return text if len(text) <= _LONGEST else text[:_LONGEST] + "…"


def _visible(text: str) -> str:
    if text.isprintable():
        return text
    return "".join("\ufffd" if _is_invalid(char) else char for char in text)


def _is_invalid(char: str) -> bool:
    if char.isspace():
        return False
    return unicodedata.category(char) in ("Cc", "Cs") or ord(char) & 0xFFFE == 0xFFFE


def _untrapped(found: re.Match[str]) -> str:
    """What stands for a character that PlantUML may read as something else."""
    char = found[0]
    if char == "\\":
        return _BACKSLASH_BEFORE_T if found.string.startswith("t", found.end()) else _escaped(char)
    if found.start() == 0 and char not in _ALWAYS:
        is_shown = char.isalnum() or char in _HARMLESS_FIRST or char > "\u02ff"
    else:
        is_shown = not char.isascii()
    return char if is_shown and unicodedata.category(char) not in _UNSEEN else _escaped(char)


def _escaped(char: str) -> str:
    return f"<U+{ord(char):04X}>" if ord(char) <= 0xFFFFF else char


def _wrapped(text: str, width: int) -> list[str]:
    if _BLANKS.search(text):
        rows = textwrap.wrap(text, width, break_long_words=False, break_on_hyphens=False)
    else:
        rows = _filled(text.split(" "), width)
    return [piece for row in rows for piece in _pieces(row, width)]


def _filled(words: list[str], width: int) -> list[str]:
    """Rows of words with one blank between, each as full as it can be."""
    rows, row = [], words[0]
    for word in words[1:]:
        if len(row) + 1 + len(word) <= width:
            row = f"{row} {word}"
        else:
            rows.append(row)
            row = word
    return [*rows, row]


def _pieces(row: str, width: int) -> list[str]:
    """Break a row that is one long word at its joints (camelCase, ``_``, ``::``), else anywhere."""
    if len(row) <= width:
        return [row]
    done, current = [], ""
    for word in _JOINT.split(row):
        if current and len(current) + len(word) > width:
            done.append(current)
            current = ""
        current += word
        while len(current) > width:
            done.append(current[:width])
            current = current[width:]
    return [*done, current] if current else done
