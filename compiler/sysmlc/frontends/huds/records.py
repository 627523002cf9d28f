"""Reads an MTIP file into records, one for each ``<data>``, in one pass.

MTIP (Model Transformation Integration Plug-in) writes a flat list; ownership and all other
relations are pairs of a name and an id inside the record.
"""

import re
from collections.abc import Iterator
from math import isfinite
from sys import intern
from typing import NamedTuple

from sysmlc.ir import AttrValue
from sysmlc.sources import DEFAULT_LIMITS, Source
from sysmlc.sources.xml import Parser, make_parser, parse, refuse_depth

_READ_PARTS = frozenset({"value", "stereotypeName", "profileName", "taggedValueName"})
"""Parts of an attribute that are read; the others repeat types and ids of the exporting tool."""
_INTEGER = re.compile(r"[+-]?[0-9]{1,4000}$")
_REAL = re.compile(r"[+-]?([0-9]+\.?[0-9]*|\.[0-9]+)([eE][+-]?[0-9]+)?$")


class _Part(NamedTuple):
    """A part of an attribute: its key, its text and the type that MTIP states (``_dtype``)."""

    key: str
    text: str
    type: str


class Relation(NamedTuple):
    """A relation of an element: its name, and the id and the type of its target."""

    name: str
    id: str
    type: str


class Record(NamedTuple):
    """The entry ``<data>`` of one element of the model."""

    ordinal: int
    type: str
    """The type with its prefix, as in ``sysml.Block``."""
    id: str
    attributes: list[tuple[str, list[_Part]]]
    """Names of attributes with their parts."""
    relations: list[Relation]

    @property
    def local_type(self) -> str:
        """The type without its prefix."""
        return self.type.rpartition(".")[2]

    def values(self, key: str) -> list[str]:
        """Return the texts of an attribute, in order."""
        return [part.text for part in self._iter_values(key)]

    def literals(self, key: str) -> list[AttrValue]:
        """Return the values of an attribute, in order: numbers, Booleans and texts."""
        return [_read_literal(part) for part in self._iter_values(key)]

    def _iter_values(self, key: str) -> Iterator[_Part]:
        for name, parts in self.attributes:
            if name == key:
                yield from (part for part in parts if part.key == "value")

    def value(self, key: str) -> str:
        """Return the first text of an attribute, or the empty string."""
        return next(iter(self.values(key)), "")

    def targets(self, name: str) -> list[str]:
        """Return the ids to which a relation leads, in order."""
        return [relation.id for relation in self.relations if relation.name == name]

    def find_target(self, name: str) -> str:
        """Return the first id to which a relation leads, or the empty string."""
        return next((relation.id for relation in self.relations if relation.name == name), "")

    def list_stereotypes(self) -> list[tuple[str, str]]:
        """Return name and profile of the stereotypes that are applied, sorted."""
        applied = (
            {part.key: part.text for part in parts}
            for key, parts in self.attributes
            if key == "stereotype"
        )
        return sorted(
            {(parts.get("stereotypeName", ""), parts.get("profileName", "")) for parts in applied}
        )

    def iter_tagged_values(self, stereotype: str) -> Iterator[tuple[str, tuple[str, ...]]]:
        """Yield the tags of a stereotype and their values, without tags that have none."""
        for key, parts in self.attributes:
            texts = {part.key: part.text for part in parts}
            if key == "stereotypeTaggedValue" and texts.get("stereotypeName") == stereotype:
                values = tuple(p.text for p in parts if p.key == "value" and p.text.strip())
                if values and texts.get("taggedValueName"):
                    yield texts["taggedValueName"], values


def _read_literal(part: _Part) -> AttrValue:
    """Return the value of a part, or its text if JSON has no such number (``INF``)."""
    if part.type == "boolean" and part.text in ("true", "false"):
        return part.text == "true"
    if part.type == "int" and _INTEGER.match(part.text):
        return int(part.text)
    if part.type == "float":
        try:
            number = float(part.text)
        except ValueError:
            return part.text
        return number if isfinite(number) else part.text
    return part.text


def parse_literal(text: str) -> AttrValue:
    """Return the truth value or finite number that a text denotes; None for another text."""
    if text in ("true", "false"):
        return text == "true"
    if _INTEGER.match(text):
        return int(text)
    return float(text) if _REAL.match(text) and isfinite(float(text)) else None


def read_records(source: Source) -> list[Record]:
    """Return the records of a file, in document order. Raises SourceError."""
    xml_parser = make_parser()
    reader = _RecordReader(source, xml_parser)
    xml_parser.StartElementHandler = reader.start
    xml_parser.EndElementHandler = reader.end
    xml_parser.CharacterDataHandler = reader.texts.append
    parse(source, xml_parser)
    return reader.records


class _RecordReader:
    """Parser handlers that collect the records.

    A record is an element at depth 2, its sections (``type``, ``id``, ``attributes``,
    ``relationships``) are at depth 3, single attributes and relations at depth 4.
    """

    def __init__(self, source: Source, xml_parser: Parser) -> None:
        self.records: list[Record] = []
        self.texts: list[str] = []
        self._source, self._parser = source, xml_parser
        self._depth = self._count = self._ordinal = 0
        self._section = self._relation = self._type = self._id = self._target_type = ""
        self._keys: list[tuple[str, str]] = []
        """Keys and types of the open parts of an attribute."""
        self._attributes: list[tuple[str, list[_Part]]] = []
        self._parts: list[_Part] = []
        self._relations: list[Relation] = []

    def start(self, tag: str, values: dict[str, str]) -> None:
        """Handle the start of an XML element."""
        self._depth = depth = self._depth + 1
        self._count += 1
        self.texts.clear()
        if depth > 4:
            if self._section == "attributes":
                self._keys.append((values.get("key", ""), values.get("_dtype", "")))
            if depth > DEFAULT_LIMITS.depth:
                refuse_depth(self._source, self._parser)
        elif depth == 4:
            self._relation, self._target_type = tag, ""
            if self._section == "attributes":
                self._parts = []
                self._attributes.append((values.get("key", ""), self._parts))
        elif depth == 3:
            self._section = tag
        elif depth == 2:
            self._ordinal = self._count - 1
            self._type = self._id = ""
            self._attributes, self._relations = [], []

    def end(self, tag: str) -> None:
        """Handle the end of an XML element."""
        depth, section = self._depth, self._section
        self._depth = depth - 1
        if depth > 4 and section == "attributes":
            key, type = self._keys.pop()
            if key in _READ_PARTS and self.texts:
                self._parts.append(_Part(key, "".join(self.texts), type))
        elif depth > 4 and tag == "id":
            target = "".join(self.texts), intern(self._target_type)
            self._relations.append(Relation(self._relation, *target))
        elif depth > 4 and tag == "type":
            self._target_type = "".join(self.texts)
        elif depth == 4 and section == "id":
            self._id = "".join(self.texts)
        elif depth == 3 and tag == "type":
            self._type = "".join(self.texts)
        elif depth == 2 and tag == "data":
            self.records.append(
                Record(self._ordinal, self._type, self._id, self._attributes, self._relations)
            )
        self.texts.clear()
