"""An MTIP file as records: one ``<data>`` an element of the model, read in one pass.

MTIP (Model Transformation Integration Plug-in) writes a flat list; ownership and all other
relations are pairs of a name and an id inside the record.
"""

from collections.abc import Iterator
from typing import NamedTuple

from sysmlc.sources import DEFAULT_LIMITS, Source
from sysmlc.sources.xml import Parser, parse, parser, too_deep

_KEPT = frozenset({"value", "stereotypeName", "profileName", "taggedValueName"})
"""Of the parts of an attribute; the others repeat types and ids of the exporting tool."""
_Part = tuple[str, str]


class Record(NamedTuple):
    """One element: place in document order, type (``sysml.Block``), id, attributes, relations."""

    ordinal: int
    type: str
    id: str
    attributes: list[tuple[str, list[_Part]]]
    relations: list[_Part]

    def values(self, key: str) -> list[str]:
        """Texts of an attribute, in order."""
        return [
            text
            for name, parts in self.attributes
            if name == key
            for part, text in parts
            if part == "value"
        ]

    def value(self, key: str) -> str:
        """First text of an attribute, or the empty string."""
        return next(iter(self.values(key)), "")

    def related(self, name: str) -> list[str]:
        """Ids that a relation leads to, in order."""
        return [id for relation, id in self.relations if relation == name]

    def first(self, name: str) -> str:
        """First id that a relation leads to, or the empty string."""
        return next((id for relation, id in self.relations if relation == name), "")


def read(source: Source) -> list[Record]:
    """The records of a file, in document order. Raises SourceError."""
    made = parser()
    reader = _Reader(source, made)
    made.StartElementHandler = reader.start
    made.EndElementHandler = reader.end
    made.CharacterDataHandler = reader.texts.append
    parse(source, made)
    return reader.records


class _Reader:
    """Handlers that fill the records; they are called for every XML element."""

    def __init__(self, source: Source, made: Parser) -> None:
        self.records: list[Record] = []
        self.texts: list[str] = []
        self._source, self._made = source, made
        self._depth = self._count = self._ordinal = 0
        self._section = self._relation = self._type = self._id = ""
        self._keys: list[str] = []
        self._attributes: list[tuple[str, list[_Part]]] = []
        self._parts: list[_Part] = []
        self._relations: list[_Part] = []

    def start(self, tag: str, values: dict[str, str]) -> None:
        """An XML element begins."""
        self._depth = depth = self._depth + 1
        self._count += 1
        self.texts.clear()
        if depth > 4:
            if self._section == "attributes":
                self._keys.append(values.get("key", ""))
            if depth > DEFAULT_LIMITS.depth:
                too_deep(self._source, self._made)
        elif depth == 4:
            self._fourth(tag, values)
        elif depth == 3:
            self._section = tag
        elif depth == 2:
            self._begin()

    def _fourth(self, tag: str, values: dict[str, str]) -> None:
        self._relation = tag
        if self._section == "attributes":
            self._parts = []
            self._attributes.append((values.get("key", ""), self._parts))

    def _begin(self) -> None:
        self._ordinal = self._count - 1
        self._type = self._id = ""
        self._attributes, self._relations = [], []

    def end(self, tag: str) -> None:
        """An XML element ends."""
        depth, section = self._depth, self._section
        self._depth = depth - 1
        if depth > 4 and section == "attributes":
            key = self._keys.pop()
            if key in _KEPT and self.texts:
                self._parts.append((key, "".join(self.texts)))
        elif depth > 4 and tag == "id":
            self._relations.append((self._relation, "".join(self.texts)))
        elif depth == 4 and section == "id":
            self._id = "".join(self.texts)
        elif depth == 3 and tag == "type":
            self._type = "".join(self.texts)
        elif depth == 2 and tag == "data":
            self.records.append(
                Record(self._ordinal, self._type, self._id, self._attributes, self._relations)
            )
        self.texts.clear()


def stereotypes(record: Record) -> Iterator[tuple[str, str]]:
    """Name and profile of each stereotype that is applied, each once."""
    found = {
        (parts.get("stereotypeName", ""), parts.get("profileName", ""))
        for parts in (dict(p) for key, p in record.attributes if key == "stereotype")
    }
    yield from sorted(found)


def tagged_values(record: Record, stereotype: str) -> Iterator[tuple[str, tuple[str, ...]]]:
    """Tags of a stereotype and their values; tags without a value are left out."""
    for key, parts in record.attributes:
        known = dict(parts)
        if key == "stereotypeTaggedValue" and known.get("stereotypeName") == stereotype:
            values = tuple(text for part, text in parts if part == "value" and text.strip())
            if values and known.get("taggedValueName"):
                yield known["taggedValueName"], values
