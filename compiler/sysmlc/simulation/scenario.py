"""Scenarios: read from YAML, checked against their schema, with the line of every value."""

import json
import warnings
from collections.abc import Mapping, Sequence
from typing import TYPE_CHECKING

from msgspec import Struct

from sysmlc.diagnostics import Place, Sink, Subject
from sysmlc.logic.formula import Literal
from sysmlc.simulation import rules
from sysmlc.sources import Source
from sysmlc.support import resources

if TYPE_CHECKING:
    from jsonschema.exceptions import ValidationError
    from ruamel.yaml.error import MarkedYAMLError

Values = Mapping[str, Literal]


class Spot(Struct, frozen=True):
    """Line and column in the scenario, from 1."""

    line: int = 0
    column: int = 0


class Entry(Struct, frozen=True):
    """One value that a step gives or expects."""

    name: str
    value: Literal
    spot: Spot


class Step(Struct, frozen=True):
    """What the environment gives in one step, and what is expected in it."""

    inputs: tuple[Entry, ...]
    expect: tuple[Entry, ...]
    spot: Spot


class Scenario(Struct, frozen=True):
    """One scenario; steps are already repeated, ``trace`` is part of what they expect."""

    name: str
    component: str
    steps: tuple[Step, ...]
    file: str
    spot: Spot

    def subject(self, spot: Spot) -> Subject:
        """A place in the scenario as the subject of a diagnostic."""
        place = Place(self.file, line=spot.line, column=spot.column)
        return Subject(self.component, place=place)


def read(source: Source, sink: Sink) -> list[Scenario]:
    """The scenarios of a file; empty when it can't be read, which is reported."""
    try:
        return _read(source, sink)
    except RecursionError:
        _report(source, sink, Spot(), "it is nested too deeply, or contains itself")
        return []


def _read(source: Source, sink: Sink) -> list[Scenario]:
    document = _load(source, sink)
    if document is None or not _is_valid(document, source, sink):
        return []
    listed = document.get("scenarios")
    parts = [document] if listed is None else _items(listed)
    found = [_scenario(part, number, source, sink) for number, part in enumerate(parts, 1)]
    return [scenario for scenario in found if scenario is not None]


def _load(source: Source, sink: Sink) -> "Mapping[str, object] | None":
    from ruamel.yaml import YAML
    from ruamel.yaml.error import MarkedYAMLError, YAMLError

    try:
        with warnings.catch_warnings():
            warnings.simplefilter("ignore")
            document = YAML(typ="rt").load(source.data.decode("utf-8-sig"))
    except MarkedYAMLError as error:
        _report(source, sink, _mark(error), str(error.problem or error).strip())
        return None
    except (YAMLError, UnicodeDecodeError, ValueError) as error:
        _report(source, sink, Spot(), str(error).splitlines()[0])
        return None
    if not isinstance(document, Mapping):
        subject = _subject(source, Spot(1, 1))
        problem = "it has no component and no steps"
        sink.report(rules.SHAPE, subject, where="the top", problem=problem)
        return None
    return document


def _report(source: Source, sink: Sink, spot: Spot, problem: str) -> None:
    sink.report(rules.SYNTAX, _subject(source, spot), problem=problem)


def _mark(error: "MarkedYAMLError") -> Spot:
    mark = error.problem_mark
    return Spot() if mark is None else Spot(mark.line + 1, mark.column + 1)


def _subject(source: Source, spot: Spot) -> Subject:
    place = Place(source.name, line=spot.line, column=spot.column)
    return Subject(source.name, place=place)


# -- shape -------------------------------------------------------------------------------------


def _is_valid(document: Mapping[str, object], source: Source, sink: Sink) -> bool:
    from jsonschema import Draft202012Validator
    from jsonschema.exceptions import best_match

    schema = json.loads(resources.read_text("metamodels", "sysmlc-scenario.schema.json"))
    # The schema of what the document means to be gives better messages than ``oneOf``.
    chosen = schema["oneOf"][1] if "scenarios" in document else schema["oneOf"][0]
    validator = Draft202012Validator({**chosen, "$defs": schema["$defs"]})
    error = best_match(validator.iter_errors(document))
    if error is None:
        return True
    where = "/".join(map(str, error.absolute_path)) or "the top"
    spot = _spot_of(document, list(error.absolute_path))
    sink.report(rules.SHAPE, _subject(source, spot), where=where, problem=_problem(error))
    return False


def _problem(error: "ValidationError") -> str:
    return error.message if len(error.message) <= 200 else error.message[:200] + "..."


def _spot_of(node: object, path: Sequence[str | int]) -> Spot:
    spot = Spot(1, 1)
    for key in path:
        spot = _spot(node, key) or spot
        node = node[key] if isinstance(node, Mapping | list) else None  # type: ignore[index]
    return spot


def _spot(node: object, key: str | int) -> Spot | None:
    """Where the value of a key (or an item) starts; ruamel counts from 0."""
    position = getattr(node, "lc", None)
    data = getattr(position, "data", None) or {}
    if key not in data:
        return None
    line, column = data[key][0], data[key][1]
    return Spot(line + 1, column + 1)


# -- values ------------------------------------------------------------------------------------


def _scenario(
    part: Mapping[str, object], number: int, source: Source, sink: Sink
) -> Scenario | None:
    steps: list[Step] = []
    for index, raw in enumerate(_items(part["steps"])):
        inputs, expect = _entries(raw, "inputs"), _entries(raw, "expect")
        spot = _spot(part["steps"], index) or Spot()
        steps += [Step(inputs, expect, spot)] * int(str(raw.get("repeat", 1)))
    trace = _items(part.get("trace") or [])
    spot = _spot(part, "component") or Spot()
    if len(trace) > len(steps):
        where = _subject(source, _spot(part, "trace") or spot)
        sink.report(rules.LONG_TRACE, where, lines=len(trace), steps=len(steps))
        return None
    for index, raw in enumerate(trace):
        step = steps[index]
        steps[index] = Step(step.inputs, (*step.expect, *_values(raw)), step.spot)
    name = str(part.get("name") or f"scenario {number}")
    return Scenario(name, str(part["component"]), tuple(steps), source.name, spot)


def _items(value: object) -> list[Mapping[str, object]]:
    return list(value) if isinstance(value, list) else []


def _entries(step: Mapping[str, object], key: str) -> tuple[Entry, ...]:
    return _values(step.get(key) or {})


def _values(mapping: object) -> tuple[Entry, ...]:
    if not isinstance(mapping, Mapping):
        return ()
    return tuple(
        Entry(str(name), _literal(value), _spot(mapping, name) or Spot())
        for name, value in mapping.items()
    )


def _literal(value: object) -> Literal:
    """A plain value: ruamel's own scalars are subclasses of Python's."""
    if isinstance(value, bool):
        return value
    return int(value) if isinstance(value, int) else str(value)
