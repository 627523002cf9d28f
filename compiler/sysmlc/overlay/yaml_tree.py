"""YAML as a tree of values with their positions; tags that would create objects are refused.

The tree is built from events (YAML 1.2, chapter 3), without recursion. An alias shares the value of
its anchor, so that aliases of aliases take no memory; their sizes are counted and limited.
"""

import re
from bisect import bisect_right
from dataclasses import dataclass, field
from typing import TYPE_CHECKING

from sysmlc.overlay.model import Spot
from sysmlc.support.escapes import HALF_CHARACTER, has_surrogate

if TYPE_CHECKING:
    from ruamel.yaml.error import StreamMark
    from ruamel.yaml.events import CollectionStartEvent, Event

Scalar = str | int | float | bool | None

_MAX_BYTES = 4 << 20
_MAX_DEPTH = 20
_MAX_VALUES = 50_000
_NEWLINE = re.compile("\r\n|\r|\n")
_STRING = "tag:yaml.org,2002:str"
_CONSTANTS: dict[str, Scalar] = {
    **dict.fromkeys(("", "~", "null", "Null", "NULL"), None),
    **dict.fromkeys(("true", "True", "TRUE"), True),
    **dict.fromkeys(("false", "False", "FALSE"), False),
}
_INTEGER = re.compile(r"[-+]?[0-9]{1,15}")
_REAL = re.compile(r"[-+]?(\.[0-9]+|[0-9]+(\.[0-9]*)?)([eE][-+]?[0-9]{1,3})?")


class TreeError(Exception):
    """The text is not YAML, exceeds a limit or has a tag; ``spot`` is the position of the fault."""

    def __init__(self, problem: str, spot: Spot) -> None:
        super().__init__(problem)
        self.problem = problem
        self.spot = spot


@dataclass(slots=True)
class Value:
    """A scalar, a list (``items``) or a mapping (``entries``).

    ``size`` is the number of values in it, where the values of an alias count at every use.
    """

    spot: Spot
    scalar: Scalar = None
    text: str = ""
    """The text of a scalar as it is written."""
    items: "list[Value] | None" = None
    entries: "dict[str, Value] | None" = None
    keys: dict[str, Spot] = field(default_factory=dict)
    """The positions of the keys of a mapping."""
    repeated: list[tuple[str, Spot]] = field(default_factory=list)
    """Keys that occur again in a mapping; the first entry counts."""
    size: int = 1

    def as_json(self) -> object:
        """Return the value as lists, dictionaries and scalars."""
        if self.items is not None:
            return [value.as_json() for value in self.items]
        if self.entries is not None:
            return {key: value.as_json() for key, value in self.entries.items()}
        return self.scalar


def parse_yaml(data: bytes) -> Value:
    """Return the top value of a file; an empty file is an empty mapping. Raises TreeError."""
    if len(data) > _MAX_BYTES:
        raise TreeError(f"it is larger than {_MAX_BYTES >> 20} MB", Spot())
    try:
        text = data.decode("utf-8-sig")
    except UnicodeDecodeError as error:
        before = data[: error.start].decode("utf-8", "replace")
        spot = _Lines(before, 0).find_spot(len(before))
        raise TreeError("it is not UTF-8 here", spot) from None
    return _Builder(text, len(data) - len(text.encode())).build_document()


class _Lines:
    """Converts indices of characters to positions; *mark* is the length of the byte order mark."""

    def __init__(self, text: str, mark: int) -> None:
        self._text = text
        self._starts = [0, *(match.end() for match in _NEWLINE.finditer(text))]
        self._bytes = [mark]
        for start, end in zip(self._starts, self._starts[1:], strict=False):
            self._bytes.append(self._bytes[-1] + len(text[start:end].encode()))

    def find_spot(self, index: int) -> Spot:
        """Return the position of the character with an index from 0."""
        line = bisect_right(self._starts, index) - 1
        start = self._starts[line]
        offset = self._bytes[line] + len(self._text[start:index].encode())
        return Spot(line + 1, index - start + 1, offset)


class _Builder:
    """Builds the tree from the events of the YAML parser."""

    def __init__(self, text: str, mark: int) -> None:
        self._text = text
        self._lines = _Lines(text, mark)
        self._open: list[_OpenCollection] = []
        self._anchors: dict[str, Value | None] = {}
        self._top: Value | None = None

    def build_document(self) -> Value:
        from ruamel.yaml import YAML
        from ruamel.yaml.error import MarkedYAMLError, YAMLError
        from ruamel.yaml.reader import ReaderError

        try:
            for number, event in enumerate(YAML(typ="rt", pure=True).parse(self._text)):
                if number > _MAX_VALUES:
                    raise TreeError("it has too many values", self._spot(event.start_mark))
                self._handle_event(event)
        except MarkedYAMLError as error:
            mark = error.problem_mark or error.context_mark
            raise TreeError(_first_line(error.problem or error), self._spot(mark)) from None
        except ReaderError as error:
            spot = self._lines.find_spot(error.position)
            raise TreeError(f"the character #x{error.character:04x} is not allowed", spot) from None
        except (YAMLError, ValueError) as error:
            raise TreeError(_first_line(error), Spot()) from None
        return self._top or Value(Spot(), entries={})

    def _spot(self, mark: "StreamMark | None") -> Spot:
        return Spot() if mark is None else self._lines.find_spot(mark.index)

    def _handle_event(self, event: "Event") -> None:
        from ruamel.yaml import events

        spot = self._spot(event.start_mark)
        match event:
            case events.AliasEvent():
                self._add_value(self._resolve_alias(str(event.anchor), spot), "")
            case events.ScalarEvent():
                _refuse_tag(event.tag, spot)
                if has_surrogate(event.value):
                    raise TreeError(HALF_CHARACTER, spot)
                scalar = event.value if event.style else _resolve_scalar(event.value)
                self._add_value(Value(spot, scalar, event.value), event.anchor or "")
            case events.MappingStartEvent():
                self._open_collection(event, Value(spot, entries={}))
            case events.SequenceStartEvent():
                self._open_collection(event, Value(spot, items=[]))
            case events.MappingEndEvent() | events.SequenceEndEvent():
                closed = self._open.pop()
                self._add_value(closed.value, closed.anchor)
            case events.DocumentStartEvent() if self._top is not None:
                raise TreeError("a second document begins", spot)

    def _resolve_alias(self, name: str, spot: Spot) -> Value:
        if name not in self._anchors:
            raise TreeError(f"there is no anchor '{name}' before this", spot)
        anchored = self._anchors[name]
        if anchored is None:
            raise TreeError(f"'{name}' contains itself", spot)
        return anchored

    def _open_collection(self, event: "CollectionStartEvent", collection: Value) -> None:
        _refuse_tag(event.tag, collection.spot)
        if len(self._open) == _MAX_DEPTH:
            raise TreeError("it is nested too deeply", collection.spot)
        if event.anchor:
            self._anchors[event.anchor] = None
        self._open.append(_OpenCollection(collection, event.anchor or ""))

    def _add_value(self, value: Value, anchor: str) -> None:
        if anchor:
            self._anchors[anchor] = value
        if not self._open:
            self._top = value
            return
        self._open[-1].add(value)
        if self._open[-1].value.size > _MAX_VALUES:
            raise TreeError("its aliases make it too large", value.spot)


@dataclass(slots=True)
class _OpenCollection:
    """A list or mapping that has not ended; ``key`` is a key whose value has not been read."""

    value: Value
    anchor: str
    key: tuple[str, Spot] | None = None

    def add(self, value: Value) -> None:
        self.value.size += value.size
        if self.value.items is not None:
            self.value.items.append(value)
        elif self.key is None:
            self.key = (_key_text(value), value.spot)
        else:
            self._add_entry(*self.key, value)
            self.key = None

    def _add_entry(self, key: str, spot: Spot, value: Value) -> None:
        if self.value.entries is None or key in self.value.entries:
            self.value.repeated.append((key, spot))
            return
        self.value.entries[key] = value
        self.value.keys[key] = spot


def _key_text(value: Value) -> str:
    if value.items is not None or value.entries is not None:
        raise TreeError("a key is a word, not a list or a mapping", value.spot)
    return value.text


def _refuse_tag(tag: object, spot: Spot) -> None:
    if tag is not None and str(tag) not in ("!", _STRING):
        raise TreeError(f"the tag {tag} is not read", spot)


def _resolve_scalar(text: str) -> Scalar:
    """Return the value of a plain scalar in the core schema (YAML 1.2.2 clause 10.3.2)."""
    if text in _CONSTANTS:
        return _CONSTANTS[text]
    if _INTEGER.fullmatch(text):
        return int(text)
    return float(text) if _REAL.fullmatch(text) else text


def _first_line(problem: object) -> str:
    return (str(problem).strip().splitlines() or ["it cannot be read"])[0]
