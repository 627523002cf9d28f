"""Parses TOML; text that would exhaust the stack or take minutes is refused with its position."""

import re
import tomllib
from typing import Any

_MAX_CHARACTERS = 1_000_000
_MAX_DEPTH = 50
"""Nested brackets, for which the parser recurses, and parts of a dotted key, for which its time is
quadratic."""
_MAX_WORD = 1_000
"""Characters of a number or a bare key; Python refuses integers of more than 4,300 digits."""

_TOKEN = re.compile(
    r'"""(?:\\.|[^\\])*?"""' + r"|'''.*?'''" + r'|"(?:\\.|[^"\\\n])*"' + r"|'[^'\n]*'"
    r"|\#[^\n]*|[A-Za-z0-9_+-]+|[\[\]{}.,=\n]",
    re.DOTALL,
)
_POSITION = re.compile(r"(.*) \(at (?:line (\d+), column (\d+)|end of document)\)", re.DOTALL)


class TomlError(Exception):
    """The text is not TOML or exceeds a limit; line and column count characters from 1."""

    def __init__(self, message: str, line: int, column: int = 1) -> None:
        super().__init__(message)
        self.line = line
        self.column = column


def parse_toml(text: str) -> dict[str, Any]:
    """Return the table that *text* defines. Raises TomlError."""
    if len(text) > _MAX_CHARACTERS:
        raise TomlError(f"the file has more than {_MAX_CHARACTERS:,} characters", 1)
    _check_limits(text)
    try:
        return tomllib.loads(text)
    except tomllib.TOMLDecodeError as problem:
        raise _make_located_error(str(problem), text) from problem


def _make_located_error(message: str, text: str) -> TomlError:
    """Return the error for a message of tomllib, which ends with the position."""
    match = _POSITION.fullmatch(message)
    if match is None:
        return TomlError(message, 1)
    if match[2] is None:
        return TomlError(match[1], text.count("\n") + 1, len(text) - text.rfind("\n"))
    return TomlError(match[1], int(match[2]), int(match[3]))


def _check_limits(text: str) -> None:
    """Raise TomlError at the first token that exceeds a limit."""
    depth = dots = 0
    for match in _TOKEN.finditer(text):
        token = match[0]
        if token in "[{":
            depth += 1
        elif token in "]}":
            depth = max(depth - 1, 0)
        if token == ".":
            dots += 1
        elif token in "[]{},=\n":
            dots = 0
        problem = ""
        if depth > _MAX_DEPTH:
            problem = f"more than {_MAX_DEPTH} nested brackets"
        elif dots >= _MAX_DEPTH:
            problem = f"a dotted key of more than {_MAX_DEPTH} parts"
        elif len(token) > _MAX_WORD and token[0] not in "\"'#":
            problem = f"a number or key of more than {_MAX_WORD:,} characters"
        if problem:
            start = match.start()
            line, column = text.count("\n", 0, start) + 1, start - text.rfind("\n", 0, start)
            raise TomlError(problem, line, column)
