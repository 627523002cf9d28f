"""Whether an overlay has the shape of its schema; every fault is told at its place."""

import json
from collections.abc import Iterator, Sequence
from functools import cache
from typing import TYPE_CHECKING

from sysmlc.diagnostics import Sink, Subject
from sysmlc.overlay import rules
from sysmlc.overlay.model import Spot, place_of
from sysmlc.overlay.yaml_tree import Value
from sysmlc.support import resources
from sysmlc.support.suggestions import did_you_mean

if TYPE_CHECKING:
    from jsonschema import Draft202012Validator
    from jsonschema.exceptions import ValidationError

_LONGEST = 200
_MOST = 100
"""Faults that are told of one overlay; a file of another kind has thousands."""


def check(top: Value, file: str, sink: Sink) -> bool:
    """Whether the overlay can be used; what is wrong with it is reported."""
    twice = list(_twice(top))
    for where, key, spot in twice[:_MOST]:
        subject = Subject(place=place_of(file, spot))
        sink.report(rules.KEY_TWICE, subject, where=where, key=key)
    errors = sorted(_validator().iter_errors(top.plain()), key=_order)
    for error in errors[:_MOST]:
        _report(error, top, file, sink)
    return not errors and not twice


@cache
def _validator() -> "Draft202012Validator":
    from jsonschema import Draft202012Validator

    schema = resources.read_text("metamodels", "sysmlc-overlay.schema.json")
    return Draft202012Validator(json.loads(schema))


def _order(error: "ValidationError") -> list[str]:
    return [str(step) for step in error.absolute_path]


def _twice(top: Value) -> Iterator[tuple[str, str, Spot]]:
    """Keys that stand twice in a mapping; a mapping with an anchor is looked at once."""
    waiting: list[tuple[Value, tuple[str | int, ...]]] = [(top, ())]
    seen: set[int] = set()
    for value, path in waiting:
        if id(value) in seen:
            continue
        seen.add(id(value))
        yield from ((_where(path), key, spot) for key, spot in value.again)
        waiting += [(one, (*path, key)) for key, one in (value.entries or {}).items()]
        waiting += [(one, (*path, index)) for index, one in enumerate(value.items or [])]


def _report(error: "ValidationError", top: Value, file: str, sink: Sink) -> None:
    path = list(error.absolute_path)
    value = _at(top, path)
    where = _where(path)
    if error.validator == "additionalProperties" and value.entries is not None:
        known = list(error.schema.get("properties", {})) if isinstance(error.schema, dict) else []
        for key in value.entries:
            if key not in known:
                subject = Subject(place=place_of(file, value.keys[key]))
                advice = did_you_mean(key, known)
                sink.report(rules.UNKNOWN_KEY, subject, where=where, key=key, advice=advice)
        return
    subject = Subject(place=place_of(file, value.spot))
    sink.report(rules.SHAPE, subject, where=where, problem=_problem(error))


def _where(path: Sequence[str | int]) -> str:
    shown = "/".join(str(step + 1) if isinstance(step, int) else step for step in path)
    return f"at '{shown}'" if shown else "at the top"


def _at(top: Value, path: Sequence[str | int]) -> Value:
    for step in path:
        inside = (top.entries or {}).get(step) if isinstance(step, str) else (top.items or [])[step]
        top = inside or top
    return top


def _problem(error: "ValidationError") -> str:
    if error.validator == "not":
        return "what flows both ways has no 'from' and no 'to'"
    if error.validator == "minProperties":
        return "it needs a 'from', a 'to' or 'both-ways: true'"
    if error.validator == "type" and error.instance is None:
        return f"it is empty, but should be of type {error.validator_value}"
    text = error.message
    return text if len(text) <= _LONGEST else f"{text[:_LONGEST]}..."
