"""Events that are lost because something inside the state happens in the same step."""

from collections.abc import Iterator

from sysmlc.diagnostics import Severity, Sink, rule
from sysmlc.ir import Graph
from sysmlc.logic.machines.conflicts import GuardComparison
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
    "a completion triggers can come with an event or with one another, and nothing is kept for "
    "later: a time-out of the outer state that comes in such a step does not come again.",
    help="if the event must never be lost, let it be repeated until it is answered (a change that "
    "lasts as a guard, a time-out as a transition of the inner states), or trigger the inner "
    "transition by an event as well",
    wrong=_nested(arrow("d", "e", after="after 2 s")),
    right=_nested(arrow("d", "e", "start")),
)


def report_overrides(
    graph: Graph, machine: Machine, comparison: GuardComparison, sink: Sink
) -> None:
    """Report each transition whose event can be passed over without a trace."""
    for outer in machine.transitions():
        inner = list(_before(machine, outer, comparison))
        if inner:
            named = ", ".join(f"'{one.words}'" for one in inner)
            subject = graph.subject(graph[element_id(outer.id)])
            sink.report(OVERRIDDEN, subject, transition=f"'{outer.words}'", inner=named)


def _before(
    machine: Machine, outer: Transition, comparison: GuardComparison
) -> Iterator[Transition]:
    """Transitions from inside its source that can come in one step with what triggers it.

    Of two events only one comes in a step; times and changes come with anything.
    """
    waits_for_event = any(isinstance(one, OnEvent) for one in outer.occurrences)
    waits_for_more = not all(isinstance(one, OnEvent) for one in outer.occurrences)
    for inner in machine.transitions():
        source = machine.vertices[inner.source]
        if source.kind != "state" or not machine.contains(outer.source, inner.source):
            continue
        without_event = [one for one in inner.occurrences if not isinstance(one, OnEvent)]
        is_unasked = bool(without_event) or not inner.occurrences
        can_meet = waits_for_more or (waits_for_event and is_unasked)
        if can_meet and comparison.are_compatible(outer, inner):
            yield inner
