"""The comment in which a saved UML model stores facts that UML cannot express.

The back end ``uml`` writes the comment, and the pass ``kept`` restores the facts.
"""

import json
from typing import Any, NamedTuple

from msgspec import Struct
from msgspec.structs import asdict

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
    attributes: dict[str, dict[str, AttrValue]]
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
    try:
        return _read_record(parse_json(body.removeprefix(PREFIX)))
    except (TypeError, KeyError, AttributeError) as problem:
        raise ValueError(str(problem)) from problem


def _read_record(data: Any) -> Record:  # noqa: ANN401 - JSON
    """Return the record of the JSON data.

    Raises ValueError, TypeError, KeyError or AttributeError for data of another form.
    """
    return Record(
        elements=[
            StoredElement(
                _require_text(id),
                Kind(kind),
                _require_text(name),
                _read_optional_text(owner),
                _read_optional_text(href),
            )
            for id, kind, name, owner, href in data["elements"]
        ],
        attributes={
            id: {_require_text(name): _read_value(value) for name, value in attrs.items()}
            for id, attrs in data["attributes"].items()
        },
        names={id: _require_text(name) for id, name in data["names"].items()},
        owners={id: _read_optional_text(owner) for id, owner in data["owners"].items()},
        edges=[(Edge(edge), _require_text(a), _require_text(b)) for edge, a, b in data["edges"]],
        made=[_require_text(id) for id in data["made"]],
        applied=[_require_text(id) for id in data["applied"]],
    )


def _require_text(value: object) -> str:
    if isinstance(value, str):
        return value
    raise TypeError(value)


def _read_optional_text(value: object) -> str | None:
    return None if value is None else _require_text(value)


def _read_value(value: object) -> AttrValue:
    if isinstance(value, list):
        return tuple(_read_value(item) for item in value)
    if value is None or isinstance(value, str | int | float):
        return value
    raise TypeError(value)
