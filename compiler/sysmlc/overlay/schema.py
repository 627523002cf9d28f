"""Validation of an overlay against its schema; every fault is reported at its position."""

import json
from collections.abc import Iterator, Sequence
from functools import cache
from typing import TYPE_CHECKING

from sysmlc.diagnostics import Severity, Sink, Subject, rule
from sysmlc.overlay.model import Spot, place_of
from sysmlc.overlay.yaml_tree import Value
from sysmlc.support import resources
from sysmlc.support.suggestions import did_you_mean

if TYPE_CHECKING:
    from jsonschema import Draft202012Validator
    from jsonschema.exceptions import ValidationError


SYNTAX = rule(
    "SM320",
    "overlay-syntax",
    Severity.ERROR,
    "the overlay cannot be read: {problem}",
    help="an overlay is one YAML document in UTF-8 without tags",
)
SHAPE = rule(
    "SM321",
    "overlay-shape",
    Severity.ERROR,
    "in the overlay {where}: {problem}",
    help="metamodels/sysmlc-overlay.schema.json has every entry; editors can check it too",
)
UNKNOWN_KEY = rule(
    "SM322",
    "overlay-unknown-key",
    Severity.ERROR,
    "in the overlay {where}: unknown key '{key}'",
    help="{advice}",
)
KEY_TWICE = rule(
    "SM323",
    "overlay-key-twice",
    Severity.ERROR,
    "in the overlay {where}: the key '{key}' occurs twice",
    help="merge the two entries, or rename one of them",
)


_MAX_MESSAGE = 200
_MAX_FAULTS = 100
"""Faults that are reported for one overlay; a file that is no overlay has thousands."""


def check_schema(top: Value, file: str, sink: Sink) -> bool:
    """Return whether the overlay is valid, and report its faults."""
    repeated = list(_find_repeated_keys(top))
    for where, key, spot in repeated[:_MAX_FAULTS]:
        subject = Subject(place=place_of(file, spot))
        sink.report(KEY_TWICE, subject, where=where, key=key)
    errors = sorted(_load_validator().iter_errors(top.as_json()), key=_list_path)
    for error in errors[:_MAX_FAULTS]:
        _report_error(error, top, file, sink)
    return not errors and not repeated


@cache
def _load_validator() -> "Draft202012Validator":
    from jsonschema import Draft202012Validator

    schema = resources.read_text("metamodels", "sysmlc-overlay.schema.json")
    return Draft202012Validator(json.loads(schema))


def _list_path(error: "ValidationError") -> list[str]:
    return [str(step) for step in error.absolute_path]


def _find_repeated_keys(top: Value) -> Iterator[tuple[str, str, Spot]]:
    """Yield the path of the mapping, the key and its position for every key that occurs twice.

    A mapping that is used several times, through an alias, is visited once.
    """
    worklist: list[tuple[Value, tuple[str | int, ...]]] = [(top, ())]
    visited: set[int] = set()
    for value, path in worklist:
        if id(value) in visited:
            continue
        visited.add(id(value))
        yield from ((_describe_path(path), key, spot) for key, spot in value.repeated)
        worklist += [(inner, (*path, key)) for key, inner in (value.entries or {}).items()]
        worklist += [(inner, (*path, index)) for index, inner in enumerate(value.items or [])]


def _report_error(error: "ValidationError", top: Value, file: str, sink: Sink) -> None:
    path = list(error.absolute_path)
    value = _find_value(top, path)
    where = _describe_path(path)
    if error.validator == "additionalProperties" and value.entries is not None:
        allowed = list(error.schema.get("properties", {})) if isinstance(error.schema, dict) else []
        for key in value.entries:
            if key not in allowed:
                subject = Subject(place=place_of(file, value.keys[key]))
                advice = did_you_mean(key, allowed)
                sink.report(UNKNOWN_KEY, subject, where=where, key=key, advice=advice)
        return
    subject = Subject(place=place_of(file, value.spot))
    sink.report(SHAPE, subject, where=where, problem=_describe_problem(error))


def _describe_path(path: Sequence[str | int]) -> str:
    text = "/".join(str(step + 1) if isinstance(step, int) else step for step in path)
    return f"at '{text}'" if text else "at the top"


def _find_value(top: Value, path: Sequence[str | int]) -> Value:
    for step in path:
        inner = (top.entries or {}).get(step) if isinstance(step, str) else (top.items or [])[step]
        top = inner or top
    return top


def _describe_problem(error: "ValidationError") -> str:
    if error.validator == "not":
        return "what flows both ways has no 'from' and no 'to'"
    if error.validator == "minProperties":
        return "it needs a 'from', a 'to' or 'both-ways: true'"
    if error.validator == "type" and error.instance is None:
        return f"it is empty, but should be of type {error.validator_value}"
    text = error.message
    return text if len(text) <= _MAX_MESSAGE else f"{text[:_MAX_MESSAGE]}..."
