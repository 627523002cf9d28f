"""Reads JSON as a tree of values: the standard library parses, a scan of the tokens locates."""

import json
import re

from sysmlc.documents.values import DocumentError, Locator, Spot, TreeBuilder, Value

_MAX_DEPTH = 100
_TOKEN = re.compile(r'[\[\]{}]|"(?:[^"\\]|\\.)*"|[^\s:,\[\]{}"]+')


def parse_json(text: str) -> Value:
    """Return the top value of a JSON text. Raises DocumentError."""
    locator, builder = Locator(text), TreeBuilder(max_depth=_MAX_DEPTH)
    try:
        json.loads(text)
        for match in _TOKEN.finditer(text):
            _add_token(builder, match[0], locator.find_spot(match.start()))
    except json.JSONDecodeError as error:
        spot = locator.find_spot(error.pos)
        raise DocumentError(f"it is not JSON: {error.msg}", spot) from None
    except ValueError as error:  # a number with more digits than Python converts
        raise DocumentError(f"it is not JSON: {error}", Spot()) from None
    except RecursionError:
        raise DocumentError("it is nested too deeply", Spot()) from None
    assert builder.top is not None
    return builder.top


def _add_token(builder: TreeBuilder, token: str, spot: Spot) -> None:
    if token in "[{":
        is_list = token == "["
        builder.open(Value(spot, items=[] if is_list else None, entries=None if is_list else {}))
    elif token in "]}":
        builder.close()
    else:
        text = token[1:-1] if token[0] == '"' else token
        builder.add(Value(spot, json.loads(token), text))


def find_in_string(value: Value, index: int) -> int:
    """Return how many characters after its quote a string spells its character of that index."""
    if len(value.text) == len(str(value.scalar)):
        return index
    length = 0
    for _ in range(index):
        length += _measure_character(value.text, length)
    return min(length, len(value.text))


def _measure_character(text: str, index: int) -> int:
    """Return the length of the spelling of one character."""
    if text[index : index + 1] != "\\":
        return 1
    if text[index + 1 : index + 2] != "u":
        return 2
    # JSON escapes a character beyond U+FFFF as two surrogates of six characters each.
    is_high_surrogate = text[index + 2 : index + 4].lower() in ("d8", "d9", "da", "db")
    return 12 if is_high_surrogate and text[index + 6 :][:2] == "\\u" else 6
