"""Reads YAML as a tree of values; tags that would create objects are refused.

The tree is built from events (YAML 1.2, chapter 3), without recursion. An alias shares the value of
its anchor, so that aliases of aliases take no memory; their sizes are counted and limited.
"""

import re
from typing import TYPE_CHECKING

from sysmlc.documents.values import DocumentError, Locator, Scalar, Spot, TreeBuilder, Value

if TYPE_CHECKING:
    from ruamel.yaml.error import StreamMark
    from ruamel.yaml.events import CollectionStartEvent, Event, ScalarEvent

_MAX_BYTES = 4 << 20
_MAX_DEPTH = 20
_MAX_VALUES = 50_000
_STRING = "tag:yaml.org,2002:str"
_CONSTANTS: dict[str, Scalar] = {
    **dict.fromkeys(("", "~", "null", "Null", "NULL"), None),
    **dict.fromkeys(("true", "True", "TRUE"), True),
    **dict.fromkeys(("false", "False", "FALSE"), False),
}
_INTEGER = re.compile(r"[-+]?[0-9]{1,15}")
_REAL = re.compile(r"[-+]?(\.[0-9]+|[0-9]+(\.[0-9]*)?)([eE][-+]?[0-9]{1,3})?")


def parse_yaml(data: bytes) -> Value:
    """Return the top value of a file; an empty file is an empty mapping. Raises DocumentError."""
    if len(data) > _MAX_BYTES:
        raise DocumentError(f"it is larger than {_MAX_BYTES >> 20} MB", Spot())
    try:
        text = data.decode("utf-8-sig")
    except UnicodeDecodeError as error:
        before = data[: error.start].decode("utf-8", "replace")
        spot = Locator(before).find_spot(len(before))
        raise DocumentError("it is not UTF-8 here", spot) from None
    return _Reader(text, len(data) - len(text.encode())).read_document()


class _Reader:
    """Builds the tree from the events of the YAML parser."""

    def __init__(self, text: str, mark: int) -> None:
        self._text = text
        self._locator = Locator(text, mark)
        self._builder = TreeBuilder(max_depth=_MAX_DEPTH, max_size=_MAX_VALUES)
        self._anchors: dict[str, Value] = {}

    def read_document(self) -> Value:
        from ruamel.yaml import YAML
        from ruamel.yaml.error import MarkedYAMLError, YAMLError
        from ruamel.yaml.reader import ReaderError

        try:
            for number, event in enumerate(YAML(typ="rt", pure=True).parse(self._text)):
                if number > _MAX_VALUES:
                    raise DocumentError("it has too many values", self._spot(event.start_mark))
                self._handle_event(event)
        except MarkedYAMLError as error:
            mark = error.problem_mark or error.context_mark
            raise DocumentError(_first_line(error.problem or error), self._spot(mark)) from None
        except ReaderError as error:
            problem = f"the character #x{error.character:04x} is not allowed"
            raise DocumentError(problem, self._locator.find_spot(error.position)) from None
        except (YAMLError, ValueError) as error:
            raise DocumentError(_first_line(error), Spot()) from None
        return self._builder.top or Value(Spot(), entries={})

    def _spot(self, mark: "StreamMark | None") -> Spot:
        return Spot() if mark is None else self._locator.find_spot(mark.index)

    def _handle_event(self, event: "Event") -> None:
        from ruamel.yaml import events

        spot = self._spot(event.start_mark)
        match event:
            case events.AliasEvent():
                self._builder.add(self._resolve_alias(str(event.anchor), spot))
            case events.ScalarEvent():
                scalar = event.value if event.style else _resolve_scalar(event.value)
                value = self._anchor(event, Value(spot, scalar, event.value))
                self._builder.add(value)
            case events.MappingStartEvent():
                self._builder.open(self._anchor(event, Value(spot, entries={})))
            case events.SequenceStartEvent():
                self._builder.open(self._anchor(event, Value(spot, items=[])))
            case events.MappingEndEvent():
                _merge_entries(self._builder.close())
            case events.SequenceEndEvent():
                self._builder.close()
            case events.DocumentStartEvent() if self._builder.top is not None:
                raise DocumentError("a second document begins", spot)

    def _resolve_alias(self, name: str, spot: Spot) -> Value:
        if name not in self._anchors:
            raise DocumentError(f"there is no anchor '{name}' before this", spot)
        if self._builder.is_open(self._anchors[name]):
            raise DocumentError(f"'{name}' contains itself", spot)
        return self._anchors[name]

    def _anchor(self, event: "ScalarEvent | CollectionStartEvent", value: Value) -> Value:
        """Return the value, whose anchor is recorded. Raises DocumentError for a tag."""
        if event.tag is not None and str(event.tag) not in ("!", _STRING):
            raise DocumentError(f"the tag {event.tag} is not read", value.spot)
        if event.anchor:
            self._anchors[event.anchor] = value
        return value


def _merge_entries(mapping: Value) -> None:
    """Replace the key ``<<`` by the entries of the mapping, or the mappings in a list, below it.

    The first entry of a key counts (YAML 1.1, type merge).
    """
    merged = mapping.get("<<")
    if mapping.entries is None or merged is None:
        return
    sources = [merged] if merged.items is None else merged.items
    if any(source.entries is None for source in sources):
        return
    del mapping.entries["<<"]
    for source in sources:
        for key, value in (source.entries or {}).items():
            if key not in mapping.entries:
                mapping.add_entry(key, source.keys[key], value)


def _resolve_scalar(text: str) -> Scalar:
    """Return the value of a plain scalar in the core schema (YAML 1.2.2 clause 10.3.2)."""
    if text in _CONSTANTS:
        return _CONSTANTS[text]
    if _INTEGER.fullmatch(text):
        return int(text)
    return float(text) if _REAL.fullmatch(text) else text


def _first_line(problem: object) -> str:
    return (str(problem).strip().splitlines() or ["it cannot be read"])[0]
