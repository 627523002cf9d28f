"""Lines, columns and XPaths of places, found only when something is to be shown."""

import re
from bisect import bisect_right
from collections.abc import Iterable, Iterator, Mapping, Sequence
from contextlib import suppress
from itertools import accumulate
from operator import itemgetter

from msgspec import Struct

from sysmlc.diagnostics import xpath
from sysmlc.diagnostics.diagnostic import Place
from sysmlc.sources import Source, SourceError
from sysmlc.sources.encoding import codec
from sysmlc.sources.xml import parse, parser

_AROUND = 200
"""Characters of a long line that are kept on each side of a place."""
_NEWLINE = re.compile("\r\n|\r|\n")
_START_TAG = re.compile(rb"<[^/]")
_LIKE_ASCII = frozenset({"utf-8", "ascii", "latin-1", "iso8859-1", "cp1252"})
"""Codecs in which a byte below 128 is always the character of ASCII."""


class Location(Struct, frozen=True):
    """Where something stands: line and column count characters from 1; ``text`` is the line.

    Of a line that is longer than an excerpt needs, ``text`` is the part around the column, and
    ``shift`` the number of characters before it: files of one line can have many findings.
    ``xpath`` leads to the element, or to the innermost one that is open there; it is empty
    when it was not asked for or the file is not XML.
    """

    line: int
    column: int
    text: str
    xpath: str = ""
    shift: int = 0


def locate(
    sources: Iterable[Source], places: Iterable[Place], *, with_xpath: bool = False
) -> dict[Place, Location]:
    """Locations of the places that can be found; each file is parsed at most once."""
    wanted: dict[str, list[Place]] = {}
    for place in places:
        wanted.setdefault(place.file, []).append(place)
    found: dict[Place, Location] = {}
    for source in sources:
        if source.name in wanted:
            found.update(_in_file(source, wanted[source.name], with_xpath))
    return found


def positions(
    sources: Iterable[Source], ordinals: Mapping[str, Iterable[int]]
) -> dict[str, dict[int, tuple[int, int]]]:
    """Line and column of elements by file and ordinal, as far as they can be found.

    Excerpts take longer; see ``locate`` for them.
    """
    return {
        source.name: dict(
            _Text(source).positions(_offsets(source, {*ordinals[source.name]} - {-1}))
        )
        for source in sources
        if source.name in ordinals
    }


def _offset(place: Place, offsets: Mapping[int, int]) -> int:
    return offsets.get(place.ordinal, -1) if place.ordinal >= 0 else place.offset


def _in_file(source: Source, places: Sequence[Place], with_xpath: bool) -> dict[Place, Location]:
    offsets = (_spots if with_xpath else _plain)(source, places)
    exact = [(offsets.get(place, (-1, ""))[0], place) for place in places]
    known = sorted(((o, p) for o, p in exact if o >= 0), key=lambda pair: pair[0])
    text = _Text(source)
    found = {place: text.location(offset, offsets[place][1]) for offset, place in known}
    return found | {p: text.line(p) for o, p in exact if o < 0 and p.line > 0}


def _plain(source: Source, places: Sequence[Place]) -> dict[Place, tuple[int, str]]:
    """Offsets of the places that can be found."""
    offsets = _offsets(source, {place.ordinal for place in places if place.ordinal >= 0})
    return {place: (_offset(place, offsets), "") for place in places}


def _spots(source: Source, places: Sequence[Place]) -> dict[Place, tuple[int, str]]:
    """Offsets and XPaths of the places that can be found."""
    if not xpath.is_xml(source.data):
        return _plain(source, places)
    ordinals = {place.ordinal for place in places if place.ordinal >= 0}
    offsets = {place.offset for place in places if place.ordinal < 0 <= place.offset}
    spots = xpath.find(source, ordinals, offsets)
    return {
        place: spots.by_ordinal.get(place.ordinal, (-1, ""))
        if place.ordinal >= 0
        else (place.offset, spots.around.get(place.offset, ""))
        for place in places
    }


def _offsets(source: Source, ordinals: set[int]) -> dict[int, int]:
    if not ordinals:
        return {}
    if not xpath.is_xml(source.data):
        return {ordinal: ordinal for ordinal in ordinals if ordinal <= len(source.data)}
    scanned = start_tags(source.data)
    if scanned is not None:
        return {ordinal: scanned[ordinal] for ordinal in ordinals if ordinal < len(scanned)}
    return _compute_offsets(source, ordinals)


def start_tags(data: bytes) -> list[int] | None:
    """Offsets of all start tags of XML; None where only a parser can tell.

    Nothing but comments, CDATA and instructions may hold a ``<`` that starts no tag.
    """
    mark, encoding = codec(data)
    body = data.find(b"?>", mark) if data.startswith(b"<?xml", mark) else mark
    is_plain = body >= 0 and encoding in _LIKE_ASCII
    if not is_plain or data.find(b"<!", body) >= 0 or data.find(b"<?", body) >= 0:
        return None
    return [found.start() for found in _START_TAG.finditer(data, body)]


def _compute_offsets(source: Source, ordinals: set[int]) -> dict[int, int]:
    offsets: dict[int, int] = {}
    xml_parser = parser()
    last = max(ordinals)
    counter = iter(range(last + 1))

    def start(_name: str, _attributes: dict[str, str]) -> None:
        ordinal = next(counter, -1)
        if ordinal in ordinals:
            offsets[ordinal] = xml_parser.CurrentByteIndex
        if ordinal == last:
            xml_parser.StartElementHandler = None

    xml_parser.StartElementHandler = start
    with suppress(SourceError):
        parse(source, xml_parser)
    return offsets


class _Text:
    """The source's text; offsets must be asked for in ascending order."""

    def __init__(self, source: Source) -> None:
        mark, self._encoding = codec(source.data)
        self._data = source.data
        self._is_ascii = self._encoding in _LIKE_ASCII and source.data.isascii()
        self._offset = mark
        self._before = 0
        self._text = self._decode(source.data[mark:])
        self._starts = line_starts(self._text)

    def location(self, offset: int, path: str = "") -> Location:
        """Location of a byte."""
        return self._make_location(*self.position(offset), path)

    def positions(self, offsets: Mapping[int, int]) -> Iterator[tuple[int, tuple[int, int]]]:
        """Line and column of many bytes, each with what stands for it."""
        lines, mark = self._starts, self._offset
        if not self._is_ascii:
            for name, offset in sorted(offsets.items(), key=itemgetter(1)):
                yield name, self.position(offset)
            return
        for name, offset in offsets.items():
            at = max(offset - mark, 0)
            line = bisect_right(lines, at)
            yield name, (line, at - lines[line - 1] + 1)

    def position(self, offset: int) -> tuple[int, int]:
        """Line and column of a byte."""
        if offset > self._offset:
            between = self._data[self._offset : offset]
            self._before += len(between if self._is_ascii else self._decode(between))
            self._offset = offset
        line = bisect_right(self._starts, self._before)
        return line, self._before - self._starts[line - 1] + 1

    def line(self, place: Place) -> Location:
        """Location of a place whose line is known already."""
        return self._make_location(place.line, max(place.column, 1))

    def _make_location(self, line: int, column: int, path: str = "") -> Location:
        start, end = self._bounds(line)
        shift = max(column - 1 - _AROUND, 0) if end - start > 2 * _AROUND else 0
        text = self._text[start + shift : min(start + shift + 2 * _AROUND, end)].rstrip("\r\n")
        return Location(line, column, text, path, shift)

    def _decode(self, data: bytes) -> str:
        return data.decode(self._encoding, "replace")

    def _bounds(self, line: int) -> tuple[int, int]:
        """Where a line starts and where the next one does; nothing for one that is not there."""
        if line > len(self._starts):
            return 0, 0
        end = self._starts[line] if line < len(self._starts) else len(self._text)
        return self._starts[line - 1], end


def line_starts(text: str) -> list[int]:
    """The characters at which the lines of a text start."""
    if "\r" in text:
        return [0, *(found.end() for found in _NEWLINE.finditer(text))]
    return [0, *accumulate(len(line) + 1 for line in text.split("\n")[:-1])]
