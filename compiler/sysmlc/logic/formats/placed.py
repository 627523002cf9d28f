"""JSON whose texts, lists and objects know where they stand in the file."""

import json
from collections.abc import Callable
from json.decoder import scanstring  # type: ignore[attr-defined]
from json.scanner import py_make_scanner  # type: ignore[attr-defined]
from typing import Any


class PlacedText(str):
    """A string of the file; ``at`` is where its first character stands, behind the quote."""

    __slots__ = ("at", "raw")

    at: int
    raw: str
    """How it is written in the file, with escapes."""

    def offset(self, index: int) -> int:
        """Where the character ``index`` of the string stands in the file."""
        if len(self.raw) == len(self):
            return self.at + index
        written = 0
        for _ in range(index):
            written += _length(self.raw, written)
        return self.at + min(written, len(self.raw))


def _length(raw: str, at: int) -> int:
    """Characters that one character is written with; a pair of surrogates is one."""
    if raw[at : at + 1] != "\\":
        return 1
    if raw[at + 1 : at + 2] != "u":
        return 2
    is_pair = (
        raw[at + 2 : at + 4].lower() in ("d8", "d9", "da", "db") and raw[at + 6 :][:2] == "\\u"
    )
    return 12 if is_pair else 6


class PlacedList(list[Any]):
    """A list of the file; ``at`` is where it begins."""

    __slots__ = ("at",)
    at: int


class PlacedObject(dict[str, Any]):
    """An object of the file; ``at`` is where it begins, ``again`` names that it has twice."""

    __slots__ = ("again", "at")
    at: int
    again: tuple[str, ...]


def loads(text: str) -> object:
    """The value that the text is.

    Raises ValueError (json.JSONDecodeError knows the place), and RecursionError when it is
    nested too deeply.
    """
    return _Decoder().decode(text)


class _Decoder(json.JSONDecoder):
    """Python's decoder, whose pieces are replaced by those that keep places."""

    parse_string: Callable[..., Any]
    parse_object: Callable[..., Any]
    parse_array: Callable[..., Any]

    def __init__(self) -> None:
        super().__init__(object_pairs_hook=_object)
        own_object, own_array = self.parse_object, self.parse_array
        self.parse_string = _string
        self.parse_object = lambda *given: _placed(own_object, *given)
        self.parse_array = lambda *given: _placed_list(own_array, *given)
        self.scan_once = py_make_scanner(self)


def _string(text: str, begin: int, strict: bool = True) -> tuple[PlacedText, int]:
    value, end = scanstring(text, begin, strict)
    found = PlacedText(value)
    found.at, found.raw = begin, text[begin : end - 1]
    return found, end


def _object(pairs: list[tuple[str, Any]]) -> PlacedObject:
    made = PlacedObject(pairs)
    made.again = ()
    if len(made) < len(pairs):
        names = [name for name, _ in pairs]
        made.again = tuple(dict.fromkeys(name for name in names if names.count(name) > 1))
    return made


def _placed(own: Callable[..., Any], given: tuple[str, int], *more: Any) -> Any:  # noqa: ANN401
    made, end = own(given, *more)
    made.at = given[1] - 1
    return made, end


def _placed_list(own: Callable[..., Any], given: tuple[str, int], *more: Any) -> Any:  # noqa: ANN401
    values, end = own(given, *more)
    made = PlacedList(values)
    made.at = given[1] - 1
    return made, end
