"""JSON whose strings, lists and objects know their offsets in the file."""

import json
from collections.abc import Callable
from json.decoder import scanstring  # type: ignore[attr-defined]
from json.scanner import py_make_scanner  # type: ignore[attr-defined]
from typing import Any


class LocatedText(str):
    """A string of the file; ``offset`` is that of its first character, behind the quote."""

    __slots__ = ("offset", "source")

    offset: int
    source: str
    """The string as the file spells it, with escapes."""

    def offset_of(self, index: int) -> int:
        """Return the offset in the file of the character at an index of the string."""
        if len(self.source) == len(self):
            return self.offset + index
        length = 0
        for _ in range(index):
            length += _measure_character(self.source, length)
        return self.offset + min(length, len(self.source))


def _measure_character(source: str, index: int) -> int:
    """Return the length of the spelling of one character."""
    if source[index : index + 1] != "\\":
        return 1
    if source[index + 1 : index + 2] != "u":
        return 2
    # JSON escapes a character beyond U+FFFF as two surrogates of six characters each.
    is_high_surrogate = source[index + 2 : index + 4].lower() in ("d8", "d9", "da", "db")
    return 12 if is_high_surrogate and source[index + 6 :][:2] == "\\u" else 6


class LocatedList(list[Any]):
    """A list of the file; ``offset`` is that of its opening bracket."""

    __slots__ = ("offset",)
    offset: int


class LocatedObject(dict[str, Any]):
    """An object of the file; ``offset`` is that of its opening brace."""

    __slots__ = ("duplicates", "offset")
    offset: int
    duplicates: tuple[str, ...]
    """Names that occur more than once."""


def parse_json(text: str) -> object:
    """Parse a JSON text.

    Raises ValueError (json.JSONDecodeError has the offset), and RecursionError when the text is
    nested too deeply.
    """
    return _LocatingDecoder().decode(text)


class _LocatingDecoder(json.JSONDecoder):
    """Python's decoder with parsers that record offsets.

    The three attributes are not documented. The scanner of the standard library that is written in
    Python calls all of them; the default scanner, written in C, does not.
    """

    parse_string: Callable[..., Any]
    parse_object: Callable[..., Any]
    parse_array: Callable[..., Any]

    def __init__(self) -> None:
        super().__init__(object_pairs_hook=_build_object)
        parse_object, parse_array = self.parse_object, self.parse_array
        self.parse_string = _parse_string
        self.parse_object = lambda *arguments: _locate_object(parse_object, *arguments)
        self.parse_array = lambda *arguments: _locate_list(parse_array, *arguments)
        self.scan_once = py_make_scanner(self)


def _parse_string(text: str, begin: int, strict: bool = True) -> tuple[LocatedText, int]:
    value, end = scanstring(text, begin, strict)
    located = LocatedText(value)
    located.offset, located.source = begin, text[begin : end - 1]
    return located, end


def _build_object(pairs: list[tuple[str, Any]]) -> LocatedObject:
    located = LocatedObject(pairs)
    located.duplicates = ()
    if len(located) < len(pairs):
        names = [name for name, _ in pairs]
        duplicates = dict.fromkeys(name for name in names if names.count(name) > 1)
        located.duplicates = tuple(duplicates)
    return located


def _locate_object(
    parse: Callable[..., Any],
    text_and_begin: tuple[str, int],
    *rest: Any,  # noqa: ANN401
) -> tuple[LocatedObject, int]:
    located, end = parse(text_and_begin, *rest)
    located.offset = text_and_begin[1] - 1
    return located, end


def _locate_list(
    parse: Callable[..., Any],
    text_and_begin: tuple[str, int],
    *rest: Any,  # noqa: ANN401
) -> tuple[LocatedList, int]:
    values, end = parse(text_and_begin, *rest)
    located = LocatedList(values)
    located.offset = text_and_begin[1] - 1
    return located, end
