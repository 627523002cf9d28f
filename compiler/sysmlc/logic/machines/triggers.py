"""Triggers of a state machine, and the variables that they need."""

from dataclasses import dataclass, field

from sysmlc.ir import Edge, Element
from sysmlc.logic.contract import (
    BooleanDomain,
    Owner,
)
from sysmlc.logic.expressions.expression import Expression
from sysmlc.logic.machines.actions import (
    Reading,
    read_condition,
)
from sysmlc.logic.machines.clock import ticks_of, told_time
from sysmlc.logic.machines.machine import (
    NO_EVENT,
    AfterTicks,
    Occurrence,
    OnEvent,
    OnRise,
    Region,
    Transition,
    Vertex,
    WhenTold,
    element_id,
    id_within,
)
from sysmlc.logic.names import unique


@dataclass(slots=True)
class Parts:
    """The machine while it grows."""

    reading: Reading
    machine: Element
    vertices: dict[str, Vertex] = field(default_factory=dict)
    regions: dict[str, Region] = field(default_factory=dict)
    outgoing: dict[str, tuple[Transition, ...]] = field(default_factory=dict)
    events: dict[str, str] = field(default_factory=dict)
    bounds: dict[str, int] = field(default_factory=dict)
    memories: dict[str, Expression] = field(default_factory=dict)
    within: str = ""
    """The state whose submachine is read, as id of the machine; empty outside submachines."""
    aliases: dict[str, list[str]] = field(default_factory=dict)
    """Entry and exit points of a submachine by what stands for them at the submachine state."""

    def key(self, element: Element) -> str:
        """The id that an element has in the machine."""
        return id_within(self.within, element.id)

    def element(self, key: str) -> Element:
        """What is drawn with an id of the machine."""
        return self.reading.graph[element_id(key)]

    def state_of(self, key: str) -> str:
        """The submachine state in whose submachine something with this id is; empty in none."""
        return key[: -len(element_id(key)) - 1] if key != element_id(key) else ""


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
