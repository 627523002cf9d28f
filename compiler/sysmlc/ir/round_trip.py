"""The comment in which a saved UML model stores facts that UML cannot express.

The back end ``uml`` writes the comment, and the pass ``kept`` restores the facts.
"""

import json
from typing import Any, NamedTuple

from msgspec import Struct, convert
from msgspec.structs import asdict, replace

from sysmlc.ir.element import AttrValue
from sysmlc.ir.kinds import Edge, Kind
from sysmlc.support.escapes import parse_json

PREFIX = "sysmlc-kept/1 "
"""Start of the body; JSON follows (metamodels/sysmlc-kept.schema.json)."""


class StoredElement(NamedTuple):
    """An element that UML cannot express.

    In the UML model, references to it lead to the external element ``href`` instead.
    """

    id: str
    kind: Kind
    name: str
    owner: str | None
    href: str | None


class Record(Struct, frozen=True):
    """The content of the comment; ids are those of the saved file.

    ``made`` are the ids of elements that were added only because UML requires them, so that the
    reader removes them. ``applied`` are the ids of packages to which profiles were applied for the
    roles of their elements.
    """

    elements: list[StoredElement]
    attributes: dict[str, dict[str, Any]]
    """Values of attributes (AttrValue) by the id of the element."""
    names: dict[str, str]
    owners: dict[str, str | None]
    edges: list[tuple[Edge, str, str]]
    made: list[str]
    applied: list[str]


def encode_record(record: Record) -> str:
    """Return the body of the comment."""
    return PREFIX + json.dumps(asdict(record), ensure_ascii=True, separators=(",", ":"))


def decode_record(body: str) -> Record:
    """Return the record in the body of a comment that starts with ``PREFIX``.

    Raises ValueError for a text that is not such a record.
    """
    record = convert(parse_json(body.removeprefix(PREFIX)), Record)
    attributes = {
        id: {name: _read_value(value) for name, value in attrs.items()}
        for id, attrs in record.attributes.items()
    }
    return replace(record, attributes=attributes)


def _read_value(value: object) -> AttrValue:
    if isinstance(value, list):
        return tuple(_read_value(item) for item in value)
    if value is None or isinstance(value, str | int | float):
        return value
    raise ValueError(value)
