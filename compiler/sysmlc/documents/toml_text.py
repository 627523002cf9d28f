"""Reads TOML as a tree of values: tomllib parses, a scan of the tokens locates.

Text that would exhaust the stack or take minutes is refused with its position.
"""

import re
import tomllib
from typing import Any

from sysmlc.documents.values import DocumentError, Locator, Spot, Value

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


_Path = tuple[str | int, ...]
_Spots = dict[_Path, tuple[Spot, Spot]]
"""The positions of keys and of their values, by the path of the value."""


def parse_toml(text: str) -> Value:
    """Return the table that *text* defines. Raises DocumentError."""
    if len(text) > _MAX_CHARACTERS:
        raise DocumentError(f"the file has more than {_MAX_CHARACTERS:,} characters", Spot())
    _check_limits(text)
    try:
        table = tomllib.loads(text)
    except tomllib.TOMLDecodeError as problem:
        raise _make_located_error(str(problem), text) from problem
    return _build_value(table, (), _locate_keys(text), Spot())


def _make_located_error(message: str, text: str) -> DocumentError:
    """Return the error for a message of tomllib, which ends with the position."""
    match = _POSITION.fullmatch(message)
    if match is None:
        return DocumentError(message, Spot())
    if match[2] is None:
        return DocumentError(match[1], Locator(text).find_spot(len(text)))
    return DocumentError(match[1], Spot(int(match[2]), int(match[3])))


def _build_value(
    data: Any,  # noqa: ANN401
    path: _Path,
    spots: _Spots,
    spot: Spot,
) -> Value:
    """Return data of tomllib with positions; what is in an inline value has that of the value."""
    if isinstance(data, dict):
        table = Value(spot, entries={})
        for key, inner in data.items():
            key_spot, inner_spot = spots.get((*path, key), (spot, spot))
            table.add_entry(key, key_spot, _build_value(inner, (*path, key), spots, inner_spot))
        return table
    if isinstance(data, list):
        items = [(inner, (*path, index)) for index, inner in enumerate(data)]
        return Value(
            spot,
            items=[
                _build_value(inner, inner_path, spots, spots.get(inner_path, (spot, spot))[1])
                for inner, inner_path in items
            ],
        )
    return Value(spot, data)


def _locate_keys(text: str) -> _Spots:
    """Return the positions of the keys in statements and headers of a text that tomllib reads."""
    locator, spots = Locator(text), _Spots()
    lengths: dict[_Path, int] = {}
    table: _Path = ()
    keys: list[tuple[str, Spot]] = []
    brackets = depth = 0
    path: _Path | None = None
    """The path of the statement whose value follows."""
    for match in _TOKEN.finditer(text):
        token = match[0]
        if token == "\n" and depth == 0:
            keys, brackets, path = [], 0, None
        elif path is not None:
            if path not in spots:
                spots[path] = (keys[-1][1], locator.find_spot(match.start()))
            depth += (token in "[{") - (token in "]}")
        elif token == "[":
            brackets += 1
        elif token == "]" and keys:
            table = _enter_table(keys, brackets == 2, lengths, spots)
            keys = []
        elif token == "=":
            path = _add_prefixes(table, keys, spots)
        elif token[0] not in "#.]\n":
            key = next(iter(tomllib.loads(f"{token} = 0")))
            keys.append((key, locator.find_spot(match.start())))
    return spots


def _enter_table(
    keys: list[tuple[str, Spot]], is_array: bool, lengths: dict[_Path, int], spots: _Spots
) -> _Path:
    """Return the path of the table that a header begins; *lengths* counts the items of arrays."""
    path: _Path = ()
    for number, (key, spot) in enumerate(keys, 1):
        path = (*path, key)
        spots.setdefault(path, (spot, spot))
        if is_array and number == len(keys):
            lengths[path] = lengths.get(path, 0) + 1
        if path in lengths:
            path = (*path, lengths[path] - 1)
            spots.setdefault(path, (spot, spot))
    return path


def _add_prefixes(table: _Path, keys: list[tuple[str, Spot]], spots: _Spots) -> _Path:
    """Return the path of a key in a table; the parts before its last dot are tables."""
    path = table
    for key, spot in keys[:-1]:
        path = (*path, key)
        spots.setdefault(path, (spot, spot))
    return (*path, keys[-1][0])


def _check_limits(text: str) -> None:
    """Raise DocumentError at the first token that exceeds a limit."""
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
            raise DocumentError(problem, Locator(text).find_spot(match.start()))
