"""Values of documents with their positions, and the builder that makes trees of them."""

import math
import re
from bisect import bisect_right
from collections.abc import Iterable, Iterator, Sequence
from dataclasses import dataclass, field
from typing import NamedTuple

from sysmlc.support.escapes import HALF_CHARACTER, has_surrogate

Scalar = str | int | float | bool | None

_NEWLINE = re.compile("\r\n|\r|\n")


class Spot(NamedTuple):
    """A position in a file: line and column from 1, byte and character of its text from 0."""

    line: int = 1
    column: int = 1
    offset: int = 0
    character: int = 0


class DocumentError(Exception):
    """The text is not a document that is read; ``spot`` is the position of the fault."""

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
    """The text of a scalar as it is written, in JSON with the escapes of a string."""
    items: "list[Value] | None" = None
    entries: "dict[str, Value] | None" = None
    keys: dict[str, Spot] = field(default_factory=dict)
    """The positions of the keys of a mapping."""
    repeated: list[tuple[str, Spot]] = field(default_factory=list)
    """Keys that occur again in a mapping; the first entry counts."""
    size: int = 1

    def add_entry(self, key: str, spot: Spot, value: "Value") -> None:
        """Add an entry to a mapping; the first entry of a key counts."""
        if self.entries is None or key in self.entries:
            self.repeated.append((key, spot))
        else:
            self.entries[key], self.keys[key] = value, spot

    def get(self, key: str) -> "Value | None":
        """Return the entry of a mapping with this key, None if there is none."""
        return (self.entries or {}).get(key)

    def list_items(self, key: str) -> "list[Value]":
        """Return the items of the list in the entry *key*, none if there is no list."""
        entry = self.get(key)
        return (entry.items if entry else None) or []

    def iter_entries(self, key: str) -> "Iterator[tuple[str, Value]]":
        """Yield keys and values of the mapping in the entry *key*, none if there is no mapping."""
        entry = self.get(key)
        yield from ((entry.entries if entry else None) or {}).items()

    def get_text(self, key: str) -> str:
        """Return the scalar in the entry *key* as a text, empty if there is none."""
        entry = self.get(key)
        return str(entry.scalar) if entry else ""

    def as_json(self) -> object:
        """Return the value as lists, dictionaries and scalars."""
        if self.items is not None:
            return [value.as_json() for value in self.items]
        if self.entries is not None:
            return {key: value.as_json() for key, value in self.entries.items()}
        return self.scalar

    def find(self, path: Iterable[str | int]) -> "Value":
        """Return the value that a path of keys and indices leads to, as far as it exists."""
        value = self
        for step in path:
            items = value.items or []
            if isinstance(step, str):
                inner = value.get(step)
            else:
                inner = items[step] if step < len(items) else None
            if inner is None:
                break
            value = inner
        return value

    def find_key(self, path: Sequence[str | int]) -> Spot:
        """Return the position of the last key in a path, as far as the path exists."""
        if not path:
            return self.spot
        *owners, last = path
        owner = self.find(owners)
        return owner.keys.get(str(last), owner.find([last]).spot)


class Locator:
    """Finds the positions of characters in a text behind a byte order mark of *mark* bytes."""

    def __init__(self, text: str, mark: int = 0) -> None:
        self._text = text
        self._mark = mark
        self._line_starts = [0, *(match.end() for match in _NEWLINE.finditer(text))]
        self._index = self._offset = 0
        """A character and its offset in bytes, from which those of later characters are counted."""

    def find_spot(self, index: int) -> Spot:
        """Return the position of the character with an index from 0."""
        if index < self._index:
            self._index = self._offset = 0
        self._offset += len(self._text[self._index : index].encode("utf-8", "surrogatepass"))
        self._index = index
        line = bisect_right(self._line_starts, index)
        column = index - self._line_starts[line - 1] + 1
        return Spot(line, column, self._mark + self._offset, index)


class TreeBuilder:
    """Builds the tree of a document from the values of its text, in their order.

    Raises DocumentError for collections that are nested too deeply, and when aliases make a
    collection larger than *max_size* values.
    """

    def __init__(self, *, max_depth: int, max_size: float = math.inf) -> None:
        self.top: Value | None = None
        self._max_depth = max_depth
        self._max_size = max_size
        self._open: list[Value] = []
        self._open_keys: list[tuple[str, Spot] | None] = []
        """For each open collection a key whose value has not been read."""

    def open(self, collection: Value) -> None:
        """Begin a list or a mapping; the values that are added up to ``close`` belong to it."""
        if len(self._open) == self._max_depth:
            raise DocumentError("it is nested too deeply", collection.spot)
        self._open.append(collection)
        self._open_keys.append(None)

    def close(self) -> Value:
        """End the list or mapping that was begun last, add it to the one around it, return it."""
        self._open_keys.pop()
        collection = self._open.pop()
        self.add(collection)
        return collection

    def is_open(self, collection: Value) -> bool:
        """Return whether a list or mapping has begun and not ended."""
        return any(value is collection for value in self._open)

    def add(self, value: Value) -> None:
        """Add a value to the collection that is open, in a mapping as a key or below its key."""
        if isinstance(value.scalar, str) and has_surrogate(value.scalar):
            raise DocumentError(HALF_CHARACTER, value.spot)
        if not self._open:
            self.top = value
            return
        owner, key = self._open[-1], self._open_keys[-1]
        owner.size += value.size
        if owner.size > self._max_size:
            raise DocumentError("its aliases make it too large", value.spot)
        if owner.items is not None:
            owner.items.append(value)
        elif key is None:
            self._open_keys[-1] = (_read_key(value), value.spot)
        else:
            self._open_keys[-1] = None
            owner.add_entry(*key, value)


def _read_key(value: Value) -> str:
    if value.items is not None or value.entries is not None:
        raise DocumentError("a key is a word, not a list or a mapping", value.spot)
    return value.scalar if isinstance(value.scalar, str) else value.text
