"""What is wrong with the shape of a state machine: ends, ways without end, forks and joins."""

from collections.abc import Iterator
from itertools import combinations

from sysmlc.diagnostics import Severity, Sink, rule
from sysmlc.ir import Graph
from sysmlc.logic.machines.machine import HISTORIES, Machine, Transition, element_id

PSEUDO_CYCLE = rule(
    "SM424",
    "pseudostate-cycle",
    Severity.ERROR,
    "pseudostate '{vertex}' leads back to itself without a state between",
    help="put a state into the cycle",
)
DEAD_END = rule(
    "SM425",
    "pseudostate-without-exit",
    Severity.ERROR,
    "{kind} '{vertex}' has no outgoing transition",
)
STRAY = rule(
    "SM431",
    "transition-out-of-reach",
    Severity.WARNING,
    "transition '{transition}' leads {where}; the component gets no contract",
    help="let the transition end at a vertex that it may reach",
)


MALFORMED = rule(
    "SM504",
    "malformed-fork-or-join",
    Severity.ERROR,
    "{kind} '{vertex}': {reason}",
    help=(
        "let its transitions lead to, or from, states in different regions of one state, "
        "without guards and triggers"
    ),
)


def has_ends(graph: Graph, machine: Machine, sink: Sink) -> bool:
    """Whether every transition leads to a vertex of the machine; those that do not are told."""
    return not list(_strangers(graph, machine, sink))


def is_well_formed(graph: Graph, machine: Machine, sink: Sink) -> bool:
    """Whether every way ends in a state, as it may; what stands against it is reported."""
    if [*_dead_ends(graph, machine, sink), *_cycles(graph, machine, sink)]:
        return False
    return not [*_strays(graph, machine, sink), *_malformed(graph, machine, sink)]


def _strangers(graph: Graph, machine: Machine, sink: Sink) -> Iterator[str]:
    """Transitions to what is no vertex of a region of this machine."""
    for one in machine.transitions():
        if one.target not in machine.vertices:
            where = "to what is in no region of this machine"
            yield _report_stray(graph, one, where, sink)


def _report_stray(graph: Graph, one: Transition, where: str, sink: Sink) -> str:
    subject = graph.subject(graph[element_id(one.id)])
    sink.report(STRAY, subject, transition=one.words, where=where)
    return one.id


def _strays(graph: Graph, machine: Machine, sink: Sink) -> Iterator[str]:
    """Transitions between regions of the machine; initial ones, and those of a history
    pseudostate, out of their region.
    """
    for one in machine.transitions():
        source = machine.vertices[one.source]
        if machine.main_region(one) is None:
            yield _report_stray(graph, one, "out of its region", sink)
        elif source.kind == "initial" or source.kind in HISTORIES:
            ends = ends_of(machine, one)
            if not all(source.region in machine.around(end) for end in ends):
                yield _report_stray(graph, one, "out of its region", sink)


def _dead_ends(graph: Graph, machine: Machine, sink: Sink) -> Iterator[str]:
    for vertex in machine.vertices.values():
        is_passed = not vertex.is_stable and vertex.kind not in HISTORIES
        if is_passed and not machine.outgoing.get(vertex.id):
            element = graph[element_id(vertex.id)]
            name = element.name or vertex.kind
            sink.report(DEAD_END, graph.subject(element), kind=vertex.kind, vertex=name)
            yield vertex.id


def _cycles(graph: Graph, machine: Machine, sink: Sink) -> Iterator[str]:
    for vertex in machine.vertices.values():
        if not vertex.is_stable and vertex.id in _beyond(machine, vertex.id):
            element = graph[element_id(vertex.id)]
            name = element.name or vertex.kind
            sink.report(PSEUDO_CYCLE, graph.subject(element), vertex=name)
            yield vertex.id


def _beyond(machine: Machine, start: str) -> dict[str, None]:
    """Pseudostates that can be reached through pseudostates."""
    found: dict[str, None] = {}
    waiting = [start]
    while waiting:
        for one in machine.outgoing.get(waiting.pop(), ()):
            target = machine.vertices.get(one.target)
            if target is not None and not target.is_stable and target.id not in found:
                found[target.id] = None
                waiting.append(target.id)
    return found


def segments(machine: Machine, first: Transition) -> list[Transition]:
    """The transition, those taken with it, and all to which it leads on through pseudostates."""
    found = [first, *first.also]
    if first.kind == "internal" or machine.vertices[first.target].is_stable:
        return found
    for id in (first.target, *_beyond(machine, first.target)):
        found += (one for one in machine.outgoing.get(id, ()) if one not in found)
    return found


def ends_of(machine: Machine, transition: Transition) -> list[str]:
    """Stable vertices to which a transition can lead, through pseudostates."""
    targets = (one.target for one in segments(machine, transition))
    return [one for one in dict.fromkeys(targets) if machine.vertices[one].is_stable]


# -- forks and joins -----------------------------------------------------------------------------


def _malformed(graph: Graph, machine: Machine, sink: Sink) -> Iterator[str]:
    for vertex in machine.vertices.values():
        reason = ""
        if vertex.kind == "fork":
            reason = _bad_fork(machine, machine.outgoing[vertex.id])
        elif vertex.kind == "join":
            into = [one for one in machine.transitions() if one.target == vertex.id]
            reason = _bad_join(machine, into) or _open_end(machine.outgoing[vertex.id])
        if reason:
            element = graph[element_id(vertex.id)]
            name = element.name or vertex.kind
            sink.report(
                MALFORMED, graph.subject(element), kind=vertex.kind, vertex=name, reason=reason
            )
            yield vertex.id


def _bad_fork(machine: Machine, outgoing: tuple[Transition, ...]) -> str:
    if any(one.guard is not None for one in outgoing):
        return "a transition that leaves it has a guard"
    if not _are_orthogonal(machine, [one.target for one in outgoing]):
        return "its transitions do not lead to different regions of one state"
    return ""


def _bad_join(machine: Machine, into: list[Transition]) -> str:
    if any(machine.vertices[one.source].kind != "state" for one in into):
        return "a transition leads to it from what is no state"
    if any(one.guard is not None or one.occurrences for one in into):
        return "a transition that leads to it has a guard or a trigger"
    if not _are_orthogonal(machine, [one.source for one in into]):
        return "its transitions do not come from different regions of one state"
    return ""


def _open_end(outgoing: tuple[Transition, ...]) -> str:
    return "" if len(outgoing) == 1 else "more than one transition leaves it"


def _are_orthogonal(machine: Machine, vertices: list[str]) -> bool:
    states = [common_state(machine, *pair) for pair in combinations(vertices, 2)]
    return None not in states and len(set(states)) <= 1


def common_state(machine: Machine, one: str, other: str) -> str | None:
    """The state (empty: the machine) in different regions of which the two lie, else None."""
    if machine.contains(one, other) or machine.contains(other, one):
        return None
    chains = [
        {machine.regions[region].state: region for region in reversed(machine.around(start))}
        for start in (one, other)
    ]
    for region in machine.around(one):
        state = machine.regions[region].state
        if state in chains[1]:
            return state if chains[1][state] != region else None
    return None
