"""Events that are lost because something inside the state happens in the same step."""

from collections.abc import Iterator

from sysmlc.diagnostics import Severity, Sink, rule
from sysmlc.ir import Graph
from sysmlc.logic.machines.competition import compatible
from sysmlc.logic.machines.machine import Machine, OnEvent, Transition, element_id
from sysmlc.logic.samples import arrow, machine_of, region, state


def _nested(inner: str) -> str:
    inside = region("s", state("d"), state("e"), arrow("si", "d"), inner)
    outer = (state("a", inside), state("b"), arrow("i", "a"), arrow("a", "b", "stop"))
    return machine_of(region("r", *outer))


OVERRIDDEN = rule(
    "SM434",
    "event-can-be-lost",
    Severity.WARNING,
    "the event of transition {transition} is lost when it comes in the step in which {inner} "
    "is taken",
    why="One step takes one transition from nested states, the innermost. What time, a change or "
    "a completion triggers inside can come with the event, and events are not kept for later.",
    help="if the event must never be lost, let it be repeated until it is answered, or trigger "
    "the inner transition by an event as well",
    wrong=_nested(arrow("d", "e", after="after 2 s")),
    right=_nested(arrow("d", "e", "start")),
)


def report_overrides(graph: Graph, machine: Machine, sink: Sink) -> None:
    """Report each transition that waits for an event and can be passed over without a trace."""
    for outer in machine.transitions():
        inner = list(_before(machine, outer))
        if inner:
            named = ", ".join(f"'{one.words}'" for one in inner)
            subject = graph.subject(graph[element_id(outer.id)])
            sink.report(OVERRIDDEN, subject, transition=f"'{outer.words}'", inner=named)


def _before(machine: Machine, outer: Transition) -> Iterator[Transition]:
    """Transitions from inside its source that something other than an event triggers."""
    if not any(isinstance(one, OnEvent) for one in outer.occurrences):
        return
    for inner in machine.transitions():
        source = machine.vertices[inner.source]
        if source.kind != "state" or not machine.contains(outer.source, inner.source):
            continue
        without_event = [one for one in inner.occurrences if not isinstance(one, OnEvent)]
        is_unasked = bool(without_event) or not inner.occurrences
        if is_unasked and compatible(outer, inner, machine.scope):
            yield inner
