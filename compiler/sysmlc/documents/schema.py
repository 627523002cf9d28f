"""Validation of a document against a JSON Schema of ``metamodels``."""

import json
from collections.abc import Iterator, Sequence
from enum import StrEnum
from functools import cache
from typing import TYPE_CHECKING, NamedTuple, cast

from sysmlc.documents.values import Spot, Value
from sysmlc.support import resources
from sysmlc.support.suggestions import did_you_mean

if TYPE_CHECKING:
    from jsonschema import Draft202012Validator
    from jsonschema.exceptions import ValidationError

_MAX_MESSAGE = 200
_EXCERPT = 100
"""Characters of a longer message that are shown from its start and from its end."""
_MAX_VIOLATIONS = 100
"""Violations of one document that are returned; a file of another kind has thousands."""
_EXPLAINED = ("anyOf", "maxItems", "minProperties", "not", "oneOf", "pattern")
"""Keywords whose violation the schema explains by ``errorMessage``, as editors read it, too."""


class ViolationKind(StrEnum):
    """What is wrong with a part of a document."""

    SHAPE = "shape"
    UNKNOWN_KEY = "unknown key"
    KEY_TWICE = "key twice"


class Violation(NamedTuple):
    """A part of a document that its schema forbids, and what to do about it."""

    kind: ViolationKind
    where: str
    """The part of the document: ``at 'steps[1].inputs'``, in which items are counted from 1."""
    problem: str
    advice: str
    """Empty if the problem says what to do."""
    spot: Spot

    def __str__(self) -> str:
        """Return the violation as one sentence."""
        advice = f"; {self.advice}" if self.advice else ""
        return f"{self.where}: {self.problem}{advice}"


def list_violations(document: Value, schema: str) -> list[Violation]:
    """Return the first faults of a document: keys that occur twice, then what *schema* forbids.

    *schema* is the name of a file in ``metamodels``.
    """
    violations = [*_find_repeated_keys(document)]
    errors = _load_validator(schema).iter_errors(document.as_json())
    for error in sorted(errors, key=lambda error: [str(step) for step in error.absolute_path]):
        violations += _describe_error(error, document)
    return violations[:_MAX_VIOLATIONS]


def format_path(path: Sequence[str | int]) -> str:
    """Return the path of keys and indices to a value; items of lists are counted from 1."""
    text = "".join(f"[{step + 1}]" if isinstance(step, int) else f".{step}" for step in path)
    return text.removeprefix(".")


@cache
def _load_validator(schema: str) -> "Draft202012Validator":
    from jsonschema import Draft202012Validator

    return Draft202012Validator(json.loads(resources.read_text("metamodels", schema)))


def _find_repeated_keys(document: Value) -> Iterator[Violation]:
    """Yield a violation for every key that occurs twice in a mapping.

    A mapping that is used several times, through an alias, is visited once.
    """
    worklist: list[tuple[Value, tuple[str | int, ...]]] = [(document, ())]
    visited: set[int] = set()
    for value, path in worklist:
        if id(value) in visited:
            continue
        visited.add(id(value))
        for key, spot in value.repeated:
            problem = f"the key '{key}' occurs twice"
            advice = "merge the two entries, or rename one of them"
            yield Violation(ViolationKind.KEY_TWICE, _describe_path(path), problem, advice, spot)
        worklist += [(inner, (*path, key)) for key, inner in (value.entries or {}).items()]
        worklist += [(inner, (*path, index)) for index, inner in enumerate(value.items or [])]


def _describe_error(error: "ValidationError", document: Value) -> Iterator[Violation]:
    path = list(error.absolute_path)
    value, where = document.find(path), _describe_path(path)
    if error.validator == "additionalProperties" and isinstance(error.schema, dict):
        allowed = [str(key) for key in error.schema.get("properties", {})]
        for key in (key for key in value.keys if key not in allowed):
            problem, advice = f"unknown key '{key}'", did_you_mean(key, allowed)
            yield Violation(ViolationKind.UNKNOWN_KEY, where, problem, advice, value.keys[key])
        return
    spot = value.spot
    if "propertyNames" in error.absolute_schema_path:
        spot = value.keys.get(str(error.instance), spot)
    problem, advice = _describe_problem(error)
    yield Violation(ViolationKind.SHAPE, where, problem, advice, spot)


def _describe_path(path: Sequence[str | int]) -> str:
    return f"at '{format_path(path)}'" if path else "at the top"


def _describe_problem(error: "ValidationError") -> tuple[str, str]:
    """Return what is wrong, and advice."""
    value, limit = cast("object", error.instance), cast("object", error.validator_value)
    if error.validator == "enum" and isinstance(value, str) and isinstance(limit, list):
        return f"unknown value '{value}'", did_you_mean(value, map(str, limit))
    if error.validator == "required":
        return f"lacks {error.message.partition(' ')[0]}", ""
    if error.validator in _EXPLAINED and isinstance(error.schema, dict):
        explanation = error.schema.get("errorMessage")
        if explanation:
            shown = f"'{value}': " if isinstance(value, str) else ""
            return f"{shown}{explanation}", ""
    if error.validator == "type" and value is None:
        return f"it is empty, but should be of type {limit}", ""
    message = error.message
    # The message quotes the value, which can be long, and gives the reason at its end.
    if len(message) > _MAX_MESSAGE:
        message = f"{message[:_EXCERPT]} ... {message[-_EXCERPT:]}"
    return message, ""
