"""Triggers of a state machine, and the variables that they need."""

import re
from math import ceil

from sysmlc.diagnostics import Severity, rule
from sysmlc.ir import Edge, Element
from sysmlc.logic.contract import (
    BooleanDomain,
    Owner,
)
from sysmlc.logic.machines.actions import (
    Reading,
    read_condition,
)
from sysmlc.logic.machines.machine import (
    NO_EVENT,
    AfterTicks,
    Occurrence,
    OnEvent,
    OnRise,
    Vertex,
    WhenTold,
)
from sysmlc.logic.machines.vertices import Parts
from sysmlc.logic.names import unique


def occurrence_of(parts: Parts, trigger: Element, vertex: Vertex) -> Occurrence:
    """What makes the trigger occur; its variables are made when they are needed first."""
    kind = trigger.subkind
    if kind == "time" or (not kind and "when" in trigger.attrs):
        return _time(parts, trigger, vertex)
    if kind == "change" or (not kind and "condition" in trigger.attrs):
        return _change(parts, trigger)
    if kind == "any":
        parts.events.setdefault("any", unique([*parts.events.values(), "other"], "", NO_EVENT)[-1])
        return OnEvent(None)
    return OnEvent(_event(parts, trigger))


def _event(parts: Parts, trigger: Element) -> str:
    graph = parts.reading.graph
    type_ = graph.target(trigger, Edge.TYPED_BY)
    key = trigger.name if type_ is None else type_.id
    name = (type_.name if type_ is not None else "") or trigger.name or "event"
    if key not in parts.events:
        taken = unique([*parts.events.values(), name], "event", NO_EVENT)
        parts.events[key] = taken[-1]
    return parts.events[key]


def _time(parts: Parts, trigger: Element, vertex: Vertex) -> Occurrence:
    count = ticks_of(parts.reading, trigger)
    if count is None:
        return WhenTold(told_time(parts.reading, trigger))
    parts.bounds[vertex.id] = max(count, parts.bounds.get(vertex.id, 0))
    return AfterTicks(count)


def _change(parts: Parts, trigger: Element) -> Occurrence:
    text = str(trigger.attrs.get("condition", "")).strip() or trigger.name
    condition = read_condition(parts.reading, text, "change condition", trigger)
    key = f"memory {text}"
    memory = parts.reading.make(key, f"was_{text}", Owner.SYSTEM, BooleanDomain(), trigger.id)
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


def ticks_of(reading: Reading, trigger: Element) -> int | None:
    """Steps after which a time trigger occurs, at least 1; None when it is no constant.

    A number without unit counts steps; with a unit, steps last ``tick_seconds``.
    """
    text = str(trigger.attrs.get("when", ""))
    relative = trigger.attrs.get("relative") is True or text.strip().startswith("after")
    found = _TIME.match(text)
    if not relative or found is None or (found[2] and found[2].lower() not in _SECONDS):
        return None
    number = float(found[1])
    if found[2]:
        number = number * _SECONDS[found[2].lower()] / reading.tick_seconds
    return max(1, ceil(number))


def milliseconds(text: str) -> int | None:
    """A duration with a unit, ``5 s``, in milliseconds; None for any other text."""
    found = _TIME.match(text)
    if found is None or found[2].lower() not in _SECONDS:
        return None
    return round(float(found[1]) * _SECONDS[found[2].lower()] * 1000)


def told_time(reading: Reading, trigger: Element) -> str:
    """The Boolean by which the environment says that a time has come."""
    text = str(trigger.attrs.get("when", "")) or trigger.name
    variable = reading.told(f"time {text}", f"time_{text}", trigger.id)
    subject = reading.graph.subject(trigger)
    reading.sink.report(OPAQUE_TIME, subject, text=text, variable=variable)
    return variable
