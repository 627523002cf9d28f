"""Computes line, column, excerpt and XPath of places in inputs, only when they are shown.

A path has the file's own prefixes and the position of each element among its siblings of the
same name: ``/xmi:XMI/uml:Model[1]/packagedElement[3]``. XPath 1.0 can name neither an element in a
default namespace nor a prefix with two meanings in one file; such a step compares the local name
and the namespace instead.
"""

import re
from bisect import bisect_right
from collections.abc import Collection, Iterable, Iterator, Mapping, Sequence
from contextlib import suppress
from dataclasses import dataclass, field
from itertools import accumulate
from operator import itemgetter
from typing import NamedTuple

from msgspec import Struct

from sysmlc.diagnostics.diagnostic import Place
from sysmlc.sources import Source, SourceError
from sysmlc.sources.xml import SEPARATOR, find_codec, make_parser, parse


class ElementPosition(NamedTuple):
    """The first byte of an element, and its XPath."""

    offset: int
    xpath: str


@dataclass(slots=True)
class XPaths:
    """The XPaths that ``find_xpaths`` found."""

    by_ordinal: dict[int, ElementPosition] = field(default_factory=dict)
    by_offset: dict[int, str] = field(default_factory=dict)
    """XPath of the innermost element that is open at an offset; ``/`` outside the root."""


def is_xml(data: bytes) -> bool:
    """Whether the bytes start as XML does, in any encoding that expat reads."""
    return data[:64].lstrip(b"\xef\xbb\xbf\xff\xfe\0 \t\r\n").startswith(b"<")


def find_xpaths(source: Source, ordinals: Collection[int], offsets: Collection[int]) -> XPaths:
    """Return the XPaths of the elements with these ordinals, and of those around these offsets.

    In a damaged file, only elements before the damage have XPaths. A file that is not XML has none.
    """
    if not is_xml(source.data):
        return XPaths()
    search = _Search(frozenset(ordinals), sorted(offsets, reverse=True))
    with suppress(SourceError, _DoneError):
        search.run(source)
    search.resolve_offsets(len(source.data) + 1)
    return search.xpaths


class _DoneError(Exception):
    """The search has found everything and can stop."""


@dataclass(slots=True)
class _OpenElement:
    """An open element: its step in the path, and the number of its children by name so far."""

    step: str
    children: dict[str, int] = field(default_factory=dict)


class _Search:
    """Handlers of a parser that find the XPaths in one pass over a file.

    ``offsets`` are in descending order, so that the next one is taken from the end of the list.
    """

    def __init__(self, ordinals: frozenset[int], offsets: list[int]) -> None:
        self.xpaths = XPaths()
        self._ordinals = ordinals
        self._offsets = offsets
        self._open = [_OpenElement("")]
        self._ordinal = 0
        self._namespaces: dict[str, str] = {}
        self._steps: dict[str, tuple[str, str]] = {}
        self._parser = make_parser()
        self._parser.namespace_prefixes = True
        self._parser.StartNamespaceDeclHandler = self._declare_namespace
        self._parser.StartElementHandler = self._start_element
        self._parser.EndElementHandler = self._end_element

    def run(self, source: Source) -> None:
        """Search a file; raise ``_DoneError`` as soon as everything is found."""
        parse(source, self._parser)

    def resolve_offsets(self, limit: int) -> None:
        """Set the XPath of every offset below *limit* to the path of the open element."""
        while self._offsets and self._offsets[-1] < limit:
            self.xpaths.by_offset[self._offsets.pop()] = self._join_steps()

    def _declare_namespace(self, prefix: str | None, uri: str | None) -> None:
        self._namespaces.setdefault(prefix or "", uri or "")

    def _start_element(self, name: str, _attributes: dict[str, str]) -> None:
        offset = self._parser.CurrentByteIndex
        self.resolve_offsets(offset)
        self._open_element(name)
        if self._ordinal in self._ordinals:
            position = ElementPosition(offset, self._join_steps())
            self.xpaths.by_ordinal[self._ordinal] = position
        self._ordinal += 1
        if len(self.xpaths.by_ordinal) == len(self._ordinals) and not self._offsets:
            raise _DoneError

    def _open_element(self, name: str) -> None:
        step, key = self._steps.get(name) or self._make_step(name)
        children = self._open[-1].children
        children[key] = number = children.get(key, 0) + 1
        self._open.append(_OpenElement(f"{step}[{number}]" if len(self._open) > 1 else step))

    def _end_element(self, _name: str) -> None:
        self.resolve_offsets(self._parser.CurrentByteIndex)
        self._open.pop()

    def _join_steps(self) -> str:
        return "/".join(element.step for element in self._open) or "/"

    def _make_step(self, name: str) -> tuple[str, str]:
        """Return the step for a name, and the key by which siblings are counted."""
        uri, local, prefix = _split_name(name)
        if not uri:
            step = local
        elif prefix and self._namespaces.get(prefix) == uri:
            step = f"{prefix}:{local}"
        else:
            step = f"*[local-name()='{local}' and namespace-uri()={_quote(uri)}]"
        self._steps[name] = step, f"{uri}{SEPARATOR}{local}"
        return self._steps[name]


def _split_name(name: str) -> tuple[str, str, str]:
    """Return namespace, local name and prefix of a name as expat writes it.

    Expat writes ``namespace}local}prefix``, ``namespace}local`` or ``local``.
    """
    parts = name.split(SEPARATOR)
    if len(parts) == 1:
        return "", name, ""
    return parts[0], parts[1], parts[2] if len(parts) > 2 else ""


def _quote(text: str) -> str:
    """Return an XPath string; no URI has both kinds of quotes."""
    return f'"{text}"' if "'" in text else f"'{text}'"


# -- locations -------------------------------------------------------------------------------------


_EXCERPT = 200
"""Characters of a long line that an excerpt has on each side of the column."""
_TOKEN = re.compile(r"""<(?:"[^"]*"|'[^']*'|[^<>"'])*>|'(?:[^'\\\r\n]|\\.)*'|\w+|[^\w\s]""")
"""A start tag of XML, or a name, a number or one other character of a text."""
_MAX_TAG = 10_000
"""Characters of a start tag; without a limit, a file with many faults would be read often."""
_NEWLINE = re.compile("\r\n|\r|\n")
_START_TAG = re.compile(rb"<[^/]")
_LIKE_ASCII = frozenset({"utf-8", "ascii", "latin-1", "iso8859-1", "cp1252"})
"""Codecs in which every byte below 128 is the ASCII character."""


class Location(Struct, frozen=True):
    """Line and column, counted in characters from 1, and the ``text`` of the line.

    ``end_line`` and ``end_column`` are those of the character behind the start tag, or behind the
    word of a text, that stands at the location.

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
    end_line: int = 0
    end_column: int = 0


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
        stop = start + column - 1
        token = _TOKEN.match(self._text, stop, stop + _MAX_TAG)
        stop = token.end() if token else stop
        end_line = bisect_right(self._line_starts, stop)
        end_column = stop - self._line_starts[end_line - 1] + 1
        return Location(line, column, text, xpath, shift, end_line, end_column)

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
