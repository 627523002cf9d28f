"""Triggers of a state machine: events, times and changes, with the variables that they need."""

import re
from math import ceil

from sysmlc.diagnostics import Severity, rule
from sysmlc.ir import Edge, Element
from sysmlc.logic.contract import (
    BooleanDomain,
    Owner,
)
from sysmlc.logic.machines.actions import (
    ReadingContext,
    read_condition,
)
from sysmlc.logic.machines.machine import (
    NO_EVENT,
    AfterTicks,
    Occurrence,
    OnEvent,
    OnInput,
    OnRise,
    Vertex,
)
from sysmlc.logic.machines.vertices import MachineDraft
from sysmlc.logic.names import unique


def read_occurrence(parts: MachineDraft, trigger: Element, vertex: Vertex) -> Occurrence:
    """Return the occurrence that makes *trigger* fire; create its variables on first use."""
    kind = trigger.subkind
    if kind == "time" or (not kind and "when" in trigger.attrs):
        return _read_time(parts, trigger, vertex)
    if kind == "change" or (not kind and "condition" in trigger.attrs):
        return _read_change(parts, trigger)
    if kind == "any":
        parts.events.setdefault("any", unique([*parts.events.values(), "other"], "", NO_EVENT)[-1])
        return OnEvent(None)
    return OnEvent(_read_event(parts, trigger))


def _read_event(parts: MachineDraft, trigger: Element) -> str:
    """Return the literal of ``event`` for a signal or operation; triggers of one type share it."""
    graph = parts.reading.graph
    type_ = graph.target(trigger, Edge.TYPED_BY)
    key = trigger.name if type_ is None else type_.id
    name = (type_.name if type_ is not None else "") or trigger.name or "event"
    if key not in parts.events:
        literals = unique([*parts.events.values(), name], "event", NO_EVENT)
        parts.events[key] = literals[-1]
    return parts.events[key]


def _read_time(parts: MachineDraft, trigger: Element, vertex: Vertex) -> Occurrence:
    """Return the number of steps, or an input if the time is not a constant."""
    count = count_ticks(parts.reading, trigger)
    if count is None:
        return OnInput(make_time_input(parts.reading, trigger))
    parts.bounds[vertex.id] = max(count, parts.bounds.get(vertex.id, 0))
    return AfterTicks(count)


def _read_change(parts: MachineDraft, trigger: Element) -> Occurrence:
    text = str(trigger.attrs.get("condition", "")).strip() or trigger.name
    condition = read_condition(parts.reading, text, "change condition", trigger)
    key = f"memory {text}"
    memory = parts.reading.variable_for(
        key, f"was_{text}", Owner.SYSTEM, BooleanDomain(), trigger.id
    )
    parts.memories[memory] = condition
    return OnRise(memory, condition)


# -- time ----------------------------------------------------------------------------------------


OPAQUE_TIME = rule(
    "SM417",
    "opaque-time",
    Severity.WARNING,
    "time '{text}' is no constant relative time; the environment says when it comes, as "
    "'{variable}'",
    help="write a number, or a number with a unit (after 5 s), and mark the event as relative",
)
_SECONDS = {
    "ms": 0.001,
    "msec": 0.001,
    "millisecond": 0.001,
    "milliseconds": 0.001,
    "s": 1.0,
    "sec": 1.0,
    "second": 1.0,
    "seconds": 1.0,
    "min": 60.0,
    "minute": 60.0,
    "minutes": 60.0,
    "m": 60.0,
    "h": 3600.0,
    "hour": 3600.0,
    "hours": 3600.0,
}
_TIME = re.compile(r"^\s*(?:after\b)?\s*\(?\s*(\d+(?:\.\d+)?)\s*([A-Za-z]*)\s*\)?\s*$")


def count_ticks(reading: ReadingContext, trigger: Element) -> int | None:
    """Return the number of steps after which a time trigger occurs, at least 1.

    The result is None if the time is not constant. A number without a unit counts steps; with a
    unit, a step lasts ``tick_seconds``.
    """
    text = str(trigger.attrs.get("when", ""))
    is_relative = trigger.attrs.get("relative") is True or text.strip().startswith("after")
    match = _TIME.match(text)
    if not is_relative or match is None or (match[2] and match[2].lower() not in _SECONDS):
        return None
    number = float(match[1])
    if match[2]:
        number = number * _SECONDS[match[2].lower()] / reading.tick_seconds
    return max(1, ceil(number))


def parse_milliseconds(text: str) -> int | None:
    """Return a duration with a unit, such as ``5 s``, in milliseconds; None for any other text."""
    match = _TIME.match(text)
    if match is None or match[2].lower() not in _SECONDS:
        return None
    return round(float(match[1]) * _SECONDS[match[2].lower()] * 1000)


def make_time_input(reading: ReadingContext, trigger: Element) -> str:
    """Report a time that is not constant and return the Boolean input that replaces it."""
    text = str(trigger.attrs.get("when", "")) or trigger.name
    variable = reading.input_for(f"time {text}", f"time_{text}", trigger.id)
    subject = reading.graph.subject(trigger)
    reading.sink.report(OPAQUE_TIME, subject, text=text, variable=variable)
    return variable
