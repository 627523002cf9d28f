"""Escapes texts of models and file names, which terminals, Markdown or XML would interpret."""

import json
import re
import unicodedata
from collections.abc import Callable
from typing import Any

HALF_CHARACTER = r"an escape such as \ud800 is only half of a character"
_INVISIBLE = frozenset(["Cc", "Cf", "Cs", "Zl", "Zp"])
"""Unicode categories of controls, bidirectional and zero-width signs, surrogates, separators."""
_BLANK_LETTERS = frozenset("\u034f\u115f\u1160\u17b4\u17b5\u3164\uffa0")
"""Letters and marks that may occur in names but are displayed as nothing."""

_MARKDOWN = re.compile(
    r"[\\`*|~]|<(?=[A-Za-z/!?])|\](?=[(\[])|(?<![^\W_])_|_(?![^\W_])|&(?=#?\w+;)|(?<= )#(?=#*$)"
)
"""Characters that CommonMark interprets within a line: '<' where a tag can start, ']' where the
target of a link can follow, '_' unless it stands between letters, '#' at the end of a heading."""
_BLOCK = re.compile(r"[#=+>\[-]|([0-9]+)[.)](?=\s|$)")
"""The start of a line that CommonMark reads as a heading, rule, quotation, list item or target."""
_SURROGATE = re.compile("[\ud800-\udfff]")
_ILLEGAL_IN_XML = re.compile("[^\t\n\r\u0020-\ud7ff\ue000-\ufffd\U00010000-\U0010ffff]")
"""Characters outside the production Char (XML 1.0, 2.2)."""


def escape_invisible(text: str, allowed: str = "") -> str:
    r"""Return *text* with invisible characters as escapes such as ``\x1b`` and ``\u202e``.

    A name in a model must neither control the terminal nor change the order in which the rest of
    the line is displayed. Characters in *allowed*, such as ``\n``, are not escaped.
    """
    if text.isascii() and text.isprintable():
        return text
    return "".join(
        _escape(sign) if is_invisible(sign) and sign not in allowed else sign for sign in text
    )


def escape_markdown(text: str) -> str:
    """Return *text* as one line of Markdown that is displayed as plain text.

    The line may stand anywhere: at the start of a paragraph, in a list item or in a table cell.
    """
    line = escape_invisible(" ".join(text.split()))
    escaped = _MARKDOWN.sub(_escape_markup, line)
    start = _BLOCK.match(escaped)
    return f"{start[1] or ''}\\{escaped[start.end() - 1 :]}" if start else escaped


def escape_code(text: str, *, in_table: bool = False) -> str:
    r"""Return *text* for a Markdown code span between single backticks.

    A code span knows no escape for a backtick, which is displayed as ``\x60``. Only tables
    interpret the character '|' inside a code span.
    """
    code = escape_invisible(" ".join(text.split())).replace("`", r"\x60")
    return code.replace("|", r"\|") if in_table else code


def escape_undecodable(name: str) -> str:
    r"""Return a file name with each byte that is not UTF-8 as an escape such as ``\xff``.

    Python represents the byte 0xff by the lone surrogate U+DCFF, which no output can encode.
    """
    return _SURROGATE.sub(_escape_surrogate, name)


def has_surrogate(text: str) -> bool:
    r"""Return whether a text contains half of a character, from an escape such as ``\ud800``.

    JSON and YAML can spell it, but no output can encode it.
    """
    return not text.isascii() and _SURROGATE.search(text) is not None


def parse_json(
    text: str | bytes, object_hook: Callable[[dict[str, Any]], Any] | None = None
) -> Any:  # noqa: ANN401
    """Return the value of a JSON text. Raises ValueError, also for half of a character."""
    value = json.loads(text, object_hook=object_hook)
    if has_surrogate(json.dumps(value, ensure_ascii=False)):
        raise ValueError(HALF_CHARACTER)
    return value


def is_invisible(sign: str) -> bool:
    """Return whether a character is displayed as nothing, or controls how others are displayed."""
    return unicodedata.category(sign) in _INVISIBLE or sign in _BLANK_LETTERS


def _escape(sign: str) -> str:
    code = ord(sign)
    if code < 0x20:
        return f"\\x{code:02x}"
    return f"\\u{code:04x}" if code < 0x10000 else f"\\U{code:08x}"


def _escape_markup(match: re.Match[str]) -> str:
    return "&amp;" if match[0] == "&" else f"\\{match[0]}"


def _escape_surrogate(match: re.Match[str]) -> str:
    code = ord(match[0])
    return f"\\x{code - 0xDC00:02x}" if 0xDC80 <= code <= 0xDCFF else f"\\u{code:04x}"


def replace_illegal_in_xml(text: str) -> tuple[str, int]:
    """Return *text* with U+FFFD for each character that XML does not allow, and their number."""
    return _ILLEGAL_IN_XML.subn("\ufffd", text)
