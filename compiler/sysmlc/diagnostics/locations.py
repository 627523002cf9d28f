"""Computes line, column, excerpt and XPath of places in inputs, only when they are shown."""

import re
from bisect import bisect_right
from collections.abc import Iterable, Iterator, Mapping, Sequence
from contextlib import suppress
from itertools import accumulate
from operator import itemgetter

from msgspec import Struct

from sysmlc.diagnostics.diagnostic import Place
from sysmlc.diagnostics.xpath import find_xpaths, is_xml
from sysmlc.sources import Source, SourceError
from sysmlc.sources.xml import find_codec, make_parser, parse

_EXCERPT = 200
"""Characters of a long line that an excerpt has on each side of the column."""
_NEWLINE = re.compile("\r\n|\r|\n")
_START_TAG = re.compile(rb"<[^/]")
_LIKE_ASCII = frozenset({"utf-8", "ascii", "latin-1", "iso8859-1", "cp1252"})
"""Codecs in which every byte below 128 is the ASCII character."""


class Location(Struct, frozen=True):
    """Line and column, counted in characters from 1, and the ``text`` of the line.

    The ``text`` of a long line is an excerpt around the column, and ``shift`` is the number of
    characters before it, because a file of one line can have many diagnostics. ``xpath`` leads to
    the element, or to the innermost element that is open at the location; it is empty if it was
    not requested or the file is not XML.
    """

    line: int
    column: int
    text: str
    xpath: str = ""
    shift: int = 0


def locate(
    sources: Iterable[Source], places: Iterable[Place], *, with_xpath: bool = False
) -> dict[Place, Location]:
    """Return the locations of the places that can be found; each file is parsed at most once."""
    places_by_file: dict[str, list[Place]] = {}
    for place in places:
        places_by_file.setdefault(place.file, []).append(place)
    locations: dict[Place, Location] = {}
    for source in sources:
        if source.name in places_by_file:
            locations |= _locate_in_file(source, places_by_file[source.name], with_xpath)
    return locations


def complete_places(sources: Iterable[Source], places: Iterable[Place]) -> dict[Place, Place]:
    """Return the places that can be found, each mapped to the same place with line and column."""
    return {
        place: Place(place.file, place.ordinal, place.offset, location.line, location.column)
        for place, location in locate(sources, places).items()
    }


def find_positions(
    sources: Iterable[Source], ordinals: Mapping[str, Iterable[int]]
) -> dict[str, dict[int, tuple[int, int]]]:
    """Return line and column of the elements that can be found, by file and ordinal.

    This is faster than ``locate``, which also makes excerpts.
    """
    positions: dict[str, dict[int, tuple[int, int]]] = {}
    for source in sources:
        if source.name in ordinals:
            offsets = _find_offsets(source, set(ordinals[source.name]) - {-1})
            positions[source.name] = dict(_SourceText(source).iter_positions(offsets))
    return positions


def _locate_in_file(
    source: Source, places: Sequence[Place], with_xpath: bool
) -> dict[Place, Location]:
    find = _find_offsets_with_xpaths if with_xpath else _find_offsets_only
    offsets = find(source, places)
    text = _SourceText(source)
    by_offset = sorted(
        ((*offsets[place], place) for place in places if place in offsets), key=itemgetter(0)
    )
    locations = {place: text.locate(offset, xpath) for offset, xpath, place in by_offset}
    by_line = [place for place in places if place not in offsets and place.line > 0]
    return locations | {place: text.locate_line(place) for place in by_line}


def _find_offsets_only(source: Source, places: Sequence[Place]) -> dict[Place, tuple[int, str]]:
    """Return the offsets of the places that can be found, with empty XPaths."""
    offsets = _find_offsets(source, {place.ordinal for place in places if place.ordinal >= 0})
    offsets_by_place = (
        (place, offsets.get(place.ordinal, -1) if place.ordinal >= 0 else place.offset)
        for place in places
    )
    return {place: (offset, "") for place, offset in offsets_by_place if offset >= 0}


def _find_offsets_with_xpaths(
    source: Source, places: Sequence[Place]
) -> dict[Place, tuple[int, str]]:
    """Return the offsets and XPaths of the places that can be found."""
    if not is_xml(source.data):
        return _find_offsets_only(source, places)
    ordinals = {place.ordinal for place in places if place.ordinal >= 0}
    offsets = {place.offset for place in places if place.ordinal < 0 <= place.offset}
    xpaths = find_xpaths(source, ordinals, offsets)
    offsets_with_xpaths: dict[Place, tuple[int, str]] = {}
    for place in places:
        if place.ordinal in xpaths.by_ordinal:
            offsets_with_xpaths[place] = xpaths.by_ordinal[place.ordinal]
        elif place.ordinal < 0 <= place.offset:
            xpath = xpaths.by_offset.get(place.offset, "")
            offsets_with_xpaths[place] = place.offset, xpath
    return offsets_with_xpaths


# -- offsets of elements -----------------------------------------------------------------------


def _find_offsets(source: Source, ordinals: set[int]) -> dict[int, int]:
    """Return the offsets of elements by ordinal; in text, the ordinal is itself the offset."""
    if not ordinals:
        return {}
    if not is_xml(source.data):
        return {ordinal: ordinal for ordinal in ordinals if ordinal <= len(source.data)}
    start_tags = find_start_tags(source.data)
    if start_tags is not None:
        return {ordinal: start_tags[ordinal] for ordinal in ordinals if ordinal < len(start_tags)}
    return _parse_offsets(source, ordinals)


def find_start_tags(data: bytes) -> list[int] | None:
    """Return the offsets of all start tags of XML; None if only a parser can find them.

    Only comments, CDATA sections and processing instructions can contain a ``<`` that starts no
    tag. Without these the search takes a quarter of the time of a parser.
    """
    mark, codec = find_codec(data)
    body = data.find(b"?>", mark) if data.startswith(b"<?xml", mark) else mark
    if body < 0 or codec not in _LIKE_ASCII:
        return None
    if data.find(b"<!", body) >= 0 or data.find(b"<?", body) >= 0:
        return None
    return [match.start() for match in _START_TAG.finditer(data, body)]


def _parse_offsets(source: Source, ordinals: set[int]) -> dict[int, int]:
    offsets: dict[int, int] = {}
    parser = make_parser()
    last = max(ordinals)
    counter = iter(range(last + 1))

    def start(_name: str, _attributes: dict[str, str]) -> None:
        ordinal = next(counter, -1)
        if ordinal in ordinals:
            offsets[ordinal] = parser.CurrentByteIndex
        if ordinal == last:
            parser.StartElementHandler = None

    parser.StartElementHandler = start
    with suppress(SourceError):
        parse(source, parser)
    return offsets


# -- lines and columns -------------------------------------------------------------------------


class _SourceText:
    """The text of a source, which converts offsets to locations, in ascending order of offsets.

    To count characters, only the bytes since the previous offset are decoded.
    """

    def __init__(self, source: Source) -> None:
        mark, self._codec = find_codec(source.data)
        self._data = source.data
        self._is_ascii = self._codec in _LIKE_ASCII and source.data.isascii()
        self._offset = mark
        self._index = 0
        """Index of the character at ``_offset``."""
        self._text = self._decode(source.data[mark:])
        self._line_starts = _find_line_starts(self._text)

    def locate(self, offset: int, xpath: str) -> Location:
        """Return the location of the byte at *offset*."""
        return self._make_location(*self._find_position(offset), xpath)

    def locate_line(self, place: Place) -> Location:
        """Return the location of a place whose line is known already."""
        return self._make_location(place.line, max(place.column, 1))

    def iter_positions(self, offsets: Mapping[int, int]) -> Iterator[tuple[int, tuple[int, int]]]:
        """Yield each key of *offsets* with the line and column of its offset, in any order."""
        if not self._is_ascii:
            for key, offset in sorted(offsets.items(), key=itemgetter(1)):
                yield key, self._find_position(offset)
            return
        for key, offset in offsets.items():
            index = max(offset - self._offset, 0)
            line = bisect_right(self._line_starts, index)
            yield key, (line, index - self._line_starts[line - 1] + 1)

    def _find_position(self, offset: int) -> tuple[int, int]:
        """Return line and column of a byte."""
        if offset > self._offset:
            between = self._data[self._offset : offset]
            self._index += len(between if self._is_ascii else self._decode(between))
            self._offset = offset
        line = bisect_right(self._line_starts, self._index)
        return line, self._index - self._line_starts[line - 1] + 1

    def _make_location(self, line: int, column: int, xpath: str = "") -> Location:
        start, end = self._find_line(line)
        shift = max(column - 1 - _EXCERPT, 0) if end - start > 2 * _EXCERPT else 0
        text = self._text[start + shift : min(start + shift + 2 * _EXCERPT, end)].rstrip("\r\n")
        return Location(line, column, text, xpath, shift)

    def _decode(self, data: bytes) -> str:
        return data.decode(self._codec, "replace")

    def _find_line(self, line: int) -> tuple[int, int]:
        """Return the index at which a line starts and the next one starts, 0 and 0 for no line."""
        starts = self._line_starts
        if line > len(starts):
            return 0, 0
        return starts[line - 1], starts[line] if line < len(starts) else len(self._text)


def _find_line_starts(text: str) -> list[int]:
    """Return the indices of the characters at which the lines of a text start."""
    if "\r" in text:
        return [0, *(match.end() for match in _NEWLINE.finditer(text))]
    # Splitting takes half the time of a regular expression.
    return [0, *accumulate(len(line) + 1 for line in text.split("\n")[:-1])]
