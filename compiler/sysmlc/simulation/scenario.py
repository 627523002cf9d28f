"""Reads scenarios from YAML, with the location of every value."""

from collections.abc import Mapping

from msgspec import Struct

from sysmlc.diagnostics import Place, Severity, Sink, Subject, rule
from sysmlc.documents import DocumentError, Scalar, Spot, Value, list_violations, parse_yaml
from sysmlc.logic.formula import Literal
from sysmlc.sources import Source
from sysmlc.support.counts import count

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
    "in the scenario {where}: {problem}",
    help="{advice}a scenario has a component, steps with inputs and expect, and perhaps a trace",
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


class Entry(Struct, frozen=True):
    """One value that a step sets or expects."""

    name: str
    value: Literal
    location: Spot
    text: str = ""
    """The number that the file states for a feature whose values are regions."""


class Step(Struct, frozen=True):
    """The inputs of one step, and the values expected in it."""

    inputs: tuple[Entry, ...]
    expect: tuple[Entry, ...]
    location: Spot


class Scenario(Struct, frozen=True):
    """One scenario, with its steps as they are played.

    A step with ``repeat`` occurs that many times, and each step also expects the values that
    ``trace`` lists for it.
    """

    name: str
    component: str
    steps: tuple[Step, ...]
    file: str
    location: Spot

    def subject(self, location: Spot) -> Subject:
        """Return a location in the scenario as the subject of a diagnostic."""
        place = Place(self.file, line=location.line, column=location.column)
        return Subject(self.component, place=place)


def read_scenarios(source: Source, sink: Sink) -> list[Scenario]:
    """Return the scenarios of a file; a file that cannot be read is reported and has none."""
    try:
        document = parse_yaml(source.data)
    except DocumentError as error:
        sink.report(SYNTAX, _subject_at(source, error.spot), problem=error)
        return []
    violations = list_violations(document, "sysmlc-scenario.schema.json")
    for violation in violations:
        advice = f"{violation.advice}; " if violation.advice else ""
        subject = _subject_at(source, violation.spot)
        where, problem = violation.where, violation.problem
        sink.report(SHAPE, subject, where=where, problem=problem, advice=advice)
    if violations:
        return []
    parts = document.list_items("scenarios") or [document]
    scenarios = [_read_scenario(part, number, source, sink) for number, part in enumerate(parts, 1)]
    return [scenario for scenario in scenarios if scenario is not None]


def _subject_at(source: Source, spot: Spot) -> Subject:
    return Subject(source.name, place=Place(source.name, line=spot.line, column=spot.column))


def _read_scenario(part: Value, number: int, source: Source, sink: Sink) -> Scenario | None:
    steps: list[Step] = []
    for item in part.list_items("steps"):
        inputs, expect = _read_entries(item.get("inputs")), _read_entries(item.get("expect"))
        repeat = int(float(item.get_text("repeat") or 1))
        steps += [Step(inputs, expect, item.spot)] * repeat
    trace = part.list_items("trace")
    if len(trace) > len(steps):
        subject = _subject_at(source, part.keys["trace"])
        sink.report(
            LONG_TRACE, subject, lines=count(len(trace), "entry"), steps=count(len(steps), "step")
        )
        return None
    for index, item in enumerate(trace):
        step = steps[index]
        steps[index] = Step(step.inputs, (*step.expect, *_read_entries(item)), step.location)
    name = part.get_text("name") or f"scenario {number}"
    location = part.keys["component"]
    return Scenario(name, part.get_text("component"), tuple(steps), source.name, location)


def _read_entries(mapping: Value | None) -> tuple[Entry, ...]:
    if mapping is None or mapping.entries is None:
        return ()
    return tuple(
        Entry(name, _as_literal(value.scalar), mapping.keys[name])
        for name, value in mapping.entries.items()
    )


def _as_literal(scalar: Scalar) -> Literal:
    return scalar if isinstance(scalar, bool | int) else str(scalar)
