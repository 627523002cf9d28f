"""Reads scenarios from YAML, validates them, and records the location of every value."""

import json
import warnings
from collections.abc import Mapping, Sequence
from typing import TYPE_CHECKING

from msgspec import Struct

from sysmlc.diagnostics import Place, Severity, Sink, Subject, rule
from sysmlc.logic.formula import Literal
from sysmlc.sources import Source
from sysmlc.support import resources
from sysmlc.support.counts import count

if TYPE_CHECKING:
    from jsonschema.exceptions import ValidationError
    from ruamel.yaml.error import MarkedYAMLError

SYNTAX = rule(
    "SM550",
    "scenario-not-yaml",
    Severity.ERROR,
    "the scenario is not YAML: {problem}",
    help="check the indentation, and put texts with special characters in quotes",
)
SHAPE = rule(
    "SM551",
    "scenario-not-valid",
    Severity.ERROR,
    "{where} of the scenario: {problem}",
    help="a scenario has a component, steps with inputs and expect, and perhaps a trace",
)
COMPONENT = rule(
    "SM552",
    "unknown-component",
    Severity.ERROR,
    "there is no component '{name}' that can be simulated; known are: {known}",
    help=(
        "use one of the known names, or read the diagnostics of the model: they explain "
        "why an activity or a state machine cannot be simulated"
    ),
)
VARIABLE = rule(
    "SM553",
    "unknown-variable",
    Severity.ERROR,
    "'{component}' has no variable '{name}'; {advice}",
    help="the contract of the component lists its variables",
)
VALUE = rule(
    "SM554",
    "value-outside-domain",
    Severity.ERROR,
    "{value} is not a value of '{name}', which takes {domain}",
    help="use a value of the domain",
)
NOT_INPUT = rule(
    "SM555",
    "output-as-input",
    Severity.ERROR,
    "'{name}' is decided by '{component}' and can't be an input",
    help="write it under expect",
)
LONG_TRACE = rule(
    "SM556",
    "trace-longer-than-steps",
    Severity.ERROR,
    "the expected trace has {lines}, but there are only {steps}",
    help="add steps (a step may be empty: {{}}), or use repeat",
)
TOO_MANY_RUNS = rule(
    "SM578",
    "too-many-runs",
    Severity.ERROR,
    "whether '{name}' can have this value is not decided: '{component}' has more than {limit} "
    "possible runs, and not all were followed",
    help="give its features initial values, or expect more values in earlier steps",
)

Values = Mapping[str, Literal]


class Location(Struct, frozen=True):
    """Line and column in the scenario, from 1."""

    line: int = 0
    column: int = 0


class Entry(Struct, frozen=True):
    """One value that a step sets or expects."""

    name: str
    value: Literal
    location: Location


class Step(Struct, frozen=True):
    """The inputs of one step, and the values expected in it."""

    inputs: tuple[Entry, ...]
    expect: tuple[Entry, ...]
    location: Location


class Scenario(Struct, frozen=True):
    """One scenario, with its steps as they are played.

    A step with ``repeat`` occurs that many times, and each step also expects the values that
    ``trace`` lists for it.
    """

    name: str
    component: str
    steps: tuple[Step, ...]
    file: str
    location: Location

    def subject(self, location: Location) -> Subject:
        """Return a location in the scenario as the subject of a diagnostic."""
        place = Place(self.file, line=location.line, column=location.column)
        return Subject(self.component, place=place)


def read_scenarios(source: Source, sink: Sink) -> list[Scenario]:
    """Return the scenarios of a file; a file that cannot be read is reported and has none."""
    try:
        return _read_document(source, sink)
    except RecursionError:
        _report_syntax(source, sink, Location(), "it is nested too deeply, or contains itself")
        return []


def _read_document(source: Source, sink: Sink) -> list[Scenario]:
    document = _load_yaml(source, sink)
    if document is None or not _is_valid(document, source, sink):
        return []
    items = document.get("scenarios")
    documents = [document] if items is None else _list_items(items)
    scenarios = [
        _read_scenario(part, number, source, sink) for number, part in enumerate(documents, 1)
    ]
    return [scenario for scenario in scenarios if scenario is not None]


def _load_yaml(source: Source, sink: Sink) -> "Mapping[str, object] | None":
    from ruamel.yaml import YAML
    from ruamel.yaml.error import MarkedYAMLError, YAMLError

    try:
        with warnings.catch_warnings():
            # ruamel warns about anchors that are defined twice, which YAML allows.
            warnings.simplefilter("ignore")
            document = YAML(typ="rt").load(source.data.decode("utf-8-sig"))
    except MarkedYAMLError as error:
        _report_syntax(source, sink, _location_of(error), str(error.problem or error).strip())
        return None
    except (YAMLError, UnicodeDecodeError, ValueError) as error:
        _report_syntax(source, sink, Location(), str(error).splitlines()[0])
        return None
    if not isinstance(document, Mapping):
        subject = _subject_at(source, Location(1, 1))
        problem = "it has no component and no steps"
        sink.report(SHAPE, subject, where="the top", problem=problem)
        return None
    return document


def _report_syntax(source: Source, sink: Sink, location: Location, problem: str) -> None:
    sink.report(SYNTAX, _subject_at(source, location), problem=problem)


def _location_of(error: "MarkedYAMLError") -> Location:
    mark = error.problem_mark
    return Location() if mark is None else Location(mark.line + 1, mark.column + 1)


def _subject_at(source: Source, location: Location) -> Subject:
    place = Place(source.name, line=location.line, column=location.column)
    return Subject(source.name, place=place)


# -- schema ------------------------------------------------------------------------------------


def _is_valid(document: Mapping[str, object], source: Source, sink: Sink) -> bool:
    from jsonschema import Draft202012Validator
    from jsonschema.exceptions import best_match

    schema = json.loads(resources.read_text("metamodels", "sysmlc-scenario.schema.json"))
    # One alternative of the schema gives better messages than ``oneOf``.
    definition = schema["oneOf"][1] if "scenarios" in document else schema["oneOf"][0]
    validator = Draft202012Validator({**definition, "$defs": schema["$defs"]})
    error = best_match(validator.iter_errors(document))
    if error is None:
        return True
    where = "/".join(map(str, error.absolute_path)) or "the top"
    location = _locate_path(document, list(error.absolute_path))
    sink.report(SHAPE, _subject_at(source, location), where=where, problem=_shorten_message(error))
    return False


def _shorten_message(error: "ValidationError") -> str:
    return error.message if len(error.message) <= 200 else error.message[:200] + "..."


def _locate_path(node: object, path: Sequence[str | int]) -> Location:
    location = Location(1, 1)
    for key in path:
        location = _locate_item(node, key) or location
        node = node[key] if isinstance(node, Mapping | list) else None  # type: ignore[index]
    return location


def _locate_item(node: object, key: str | int) -> Location | None:
    """Return where the value of a key, or an item of a list, starts; None if it is unknown."""
    position = getattr(node, "lc", None)
    data = getattr(position, "data", None) or {}
    if key not in data:
        return None
    # ruamel counts lines and columns from 0.
    line, column = data[key][0], data[key][1]
    return Location(line + 1, column + 1)


# -- values ------------------------------------------------------------------------------------


def _read_scenario(
    part: Mapping[str, object], number: int, source: Source, sink: Sink
) -> Scenario | None:
    steps: list[Step] = []
    for index, item in enumerate(_list_items(part["steps"])):
        inputs, expect = _read_entries(item, "inputs"), _read_entries(item, "expect")
        location = _locate_item(part["steps"], index) or Location()
        steps += [Step(inputs, expect, location)] * int(str(item.get("repeat", 1)))
    trace = _list_items(part.get("trace") or [])
    location = _locate_item(part, "component") or Location()
    if len(trace) > len(steps):
        subject = _subject_at(source, _locate_item(part, "trace") or location)
        sink.report(
            LONG_TRACE, subject, lines=count(len(trace), "entry"), steps=count(len(steps), "step")
        )
        return None
    for index, item in enumerate(trace):
        step = steps[index]
        steps[index] = Step(step.inputs, (*step.expect, *_read_values(item)), step.location)
    name = str(part.get("name") or f"scenario {number}")
    return Scenario(name, str(part["component"]), tuple(steps), source.name, location)


def _list_items(value: object) -> list[Mapping[str, object]]:
    return list(value) if isinstance(value, list) else []


def _read_entries(step: Mapping[str, object], key: str) -> tuple[Entry, ...]:
    return _read_values(step.get(key) or {})


def _read_values(mapping: object) -> tuple[Entry, ...]:
    if not isinstance(mapping, Mapping):
        return ()
    return tuple(
        Entry(str(name), _as_literal(value), _locate_item(mapping, name) or Location())
        for name, value in mapping.items()
    )


def _as_literal(value: object) -> Literal:
    """Return a scalar of YAML as a plain Python value."""
    # The scalars of ruamel are subclasses that carry comments and formatting.
    if isinstance(value, bool):
        return value
    return int(value) if isinstance(value, int) else str(value)
