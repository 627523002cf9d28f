"""Start tags as they are written, read once each: what they state, apart from IDs, comes again."""

import re
from sys import intern
from typing import TypeVar

from sysmlc.frontends.caex.vocabulary import STRUCTURE

Tag = tuple[str, dict[str, str], bool, bool, int]
"""Local name; attributes; whether it has an end tag of its own; whether text of the element is
listened to; the first row that said it."""

_Shape = tuple[str, tuple[str, ...], bool, bool, bool]
"""What tags have in common that differ in values only: name, names of attributes, as above, and
whether all values stand before the end of the tag, and none of them is a namespace."""

_K = TypeVar("_K")
_V = TypeVar("_V")

UNLIKE = "I"
"""What tags start with of which hardly two are alike: those of internal elements and links."""

WITH_ID = "E"
"""What tags start with that are alike but for their ID: those of interfaces."""

_REMEMBERED = 1 << 14
"""So many tags are remembered: a file whose tags all differ must not fill the memory."""

_TAG = re.compile(r'([^\s/>"\'=!?]+)((?:\s+[^\s=>"\']+\s*=\s*"[^"]*")*)\s*(/?)>(.*)', re.DOTALL)
_SOUND = re.compile(
    r'N(?:[ \t\n]+N[ \t\n]*=[ \t\n]*"[^"]*")*[ \t\n]*/?>.*'.replace(
        "N", r"[A-Za-z_][A-Za-z0-9_.-]*"
    ),
    re.DOTALL,
)
"""Tags that are well-formed beyond doubt, if no attribute comes twice."""
_NAME = re.compile(r'([^\s=>"\']+)\s*=\s*"[^"]*"')
_REFERENCE = re.compile(r"&(?:#x([0-9a-fA-F]+)|#([0-9]+)|(\w+));")
_NAMED = {"amp": "&", "lt": "<", "gt": ">", "quot": '"', "apos": "'"}
_SPACES = str.maketrans("\t\n", "  ")


class NotPlainError(Exception):
    """The file says what this way of reading does not know."""


class Reader:
    """Reads start tags that are not known yet."""

    def __init__(self) -> None:
        self.known: dict[str, Tag] = {}
        """Tags without an ID, by their text."""
        self.with_id: dict[tuple[str, str], Tag] = {}
        """Tags with an ID, by their text before it and behind it."""
        self._shapes: dict[tuple[str, ...], _Shape] = {}
        self.beside: dict[str, Tag] = {}
        """Tags by what stands between the value of an element of their name and their own value."""
        self.has_changes = False
        self.has_stray = False
        self.is_sound = True
        """Whether all tags are well-formed, characters and references aside."""
        self.shapes: set[tuple[str, tuple[str, ...]]] = set()
        """Tags with the names of their attributes, as they occur."""

    def read(self, piece: str, row: int) -> tuple[Tag, str]:
        """What a tag says and its ID, which is empty in attributes that several rows share.

        The caller has to see that the IDs are plain.

        Raises NotPlainError.
        """
        head, sign, rest = piece.partition(' ID="')
        id, _, tail = rest.partition('"')
        known = self.with_id.get((head, tail)) if sign else self.known.get(piece)
        if known is not None:
            return known, id
        tag = self.parsed(piece, row)
        values = tag[1]
        found = values.get("ID", "")
        if tag[3]:
            return tag, found
        if "ID" not in values:
            _remember(self.known, piece, tag)
        elif sign and found == id and not head.count('"') % 2:
            values["ID"] = ""
            _remember(self.with_id, (head, tail), tag)
        return tag, found

    def learn(self, between: str, pieces: list[str], ended: dict[str, str]) -> None:
        """Remember what stands between two values when it is an end tag and a start tag.

        ``ended`` are the names of elements by their end tags.
        """
        _, end, start = pieces
        tag = self.known.get(start)
        # What is known has neither text nor an ID.
        if tag is not None and not tag[2] and end[:1] == "/" and ended[end] == tag[0]:
            _remember(self.beside, between, tag)

    def parsed(self, piece: str, row: int) -> Tag:
        """What a tag says, as others of its shape do.

        Raises NotPlainError.
        """
        parts = piece.split('"')
        key = (*parts[::2],)
        shape = self._shapes.get(key)
        if shape is None:
            shape = self._shape(piece)
            _remember(self._shapes, key, shape)
        name, names, is_empty, has_text, is_usual = shape
        said = piece[: -len(parts[-1])]
        if not is_usual or "&" in said or "\n" in said or "\t" in said:
            return name, self._values(names, parts), is_empty, has_text, row
        # Most have two or three attributes: three times as fast as a loop.
        if len(parts) == 7:
            one, two, three = names
            values = {one: parts[1], two: parts[3], three: parts[5]}
        elif len(parts) == 5:
            one, two = names
            values = {one: parts[1], two: parts[3]}
        else:
            values = self._values(names, parts)
        return name, values, is_empty, has_text, row

    def _values(self, names: tuple[str, ...], parts: list[str]) -> dict[str, str]:
        """The attributes of any tag."""
        if not len(parts) % 2:
            # A quote behind the tag: all others come in pairs.
            self.has_stray = True
        values = dict(zip(names, map(_value, parts[1::2]), strict=False))
        values.pop("xmlns", None)
        return values

    def _shape(self, piece: str) -> _Shape:
        """The shape of a tag."""
        found = _TAG.fullmatch(piece)
        if found is None:
            raise NotPlainError
        names = tuple(_NAME.findall(found[2]))
        if any(":" in name for name in names):
            raise NotPlainError
        self.is_sound = self.is_sound and _is_sound(piece, names)
        self.has_changes = self.has_changes or "ChangeMode" in names
        name = intern(found[1].rpartition(":")[2])
        is_over = bool(found[3]) or name in STRUCTURE
        self.has_stray = self.has_stray or (is_over and bool(found[4].strip()))
        self.shapes.add((name, names))
        is_usual = '"' not in found[4] and "xmlns" not in names
        return name, names, bool(found[3]), name not in STRUCTURE, is_usual


def _is_sound(piece: str, names: tuple[str, ...]) -> bool:
    """Whether a tag is well-formed beyond doubt, and declares no namespace."""
    has_each_once = len(set(names)) == len(names) and "xmlns" not in names
    return has_each_once and _SOUND.fullmatch(piece) is not None


def text_in(piece: str) -> str:
    """The text behind a start tag."""
    head, _, text = piece.partition(">")
    if '"' in head:
        found = _TAG.fullmatch(piece)
        text = found[4] if found else ""
    return without_references(text)


def without_references(text: str) -> str:
    """The text with the characters that are referred to."""
    return _REFERENCE.sub(_character, text) if "&" in text else text


def _character(reference: re.Match[str]) -> str:
    hexadecimal, decimal, name = reference.groups()
    if name:
        return _NAMED[name]
    return chr(int(hexadecimal, 16) if hexadecimal else int(decimal))


def is_plain(value: str) -> bool:
    """Whether the value of an attribute means what is written: no reference, no line end."""
    return "&" not in value and "\n" not in value and "\t" not in value


def _value(text: str) -> str:
    """What the text of an attribute means: white space is blanks, unless it is referred to."""
    return text if is_plain(text) else without_references(text.translate(_SPACES))


def _remember(known: dict[_K, _V], key: _K, value: _V) -> None:
    if len(known) >= _REMEMBERED:
        known.clear()
    known[key] = value
