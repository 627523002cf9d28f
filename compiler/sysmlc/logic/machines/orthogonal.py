"""Transitions of orthogonal regions that get into one another's way."""

from collections.abc import Iterator
from itertools import combinations

from sysmlc.diagnostics import Severity, Sink, rule
from sysmlc.ir import Graph
from sysmlc.logic import samples
from sysmlc.logic.machines.conflicts import GuardComparison, simultaneous
from sysmlc.logic.machines.machine import Action, Assign, Machine, Transition, element_id
from sysmlc.logic.machines.well_formedness import common_state, segments
from sysmlc.logic.samples import arrow, machine_of


def _two_regions(first: str, second: str) -> str:
    return machine_of(
        samples.region(
            "r", samples.state("a"), arrow("i", "a"), arrow("a", "a", first, effect="level := 1")
        ),
        samples.region(
            "q", samples.state("b"), arrow("qi", "b"), arrow("b", "b", second, effect="level := 2")
        ),
    )


def _leaving(on: str) -> str:
    inner = (
        samples.region("s", samples.state("d"), arrow("si", "d"), arrow("d", "b", on)),
        samples.region(
            "t", samples.state("e"), arrow("ti", "e"), arrow("e", "e", "start", "ready")
        ),
    )
    return machine_of(
        samples.region("r", samples.state("a", *inner), samples.state("b"), arrow("i", "a"))
    )


RACE = rule(
    "SM426",
    "race",
    Severity.WARNING,
    "'{first}' and '{second}' of orthogonal regions can both assign '{variable}' in one step; "
    "the component gets no contract",
    why="Nothing in the diagram orders the two assignments.",
    help="assign the property in one region only, or on different events",
    wrong=_two_regions("start", "start"),
    right=_two_regions("start", "stop"),
)
CROSSING = rule(
    "SM427",
    "exit-from-orthogonal-state",
    Severity.WARNING,
    "'{first}' leaves an orthogonal state while '{second}' can be taken in another of its "
    "regions; the component gets no contract",
    why="Nothing in the diagram says which of the two is taken.",
    help="draw the transition from the border of the orthogonal state, or use another event",
    wrong=_leaving("start"),
    right=_leaving("stop"),
)


def is_undisturbed(graph: Graph, machine: Machine, comparison: GuardComparison, sink: Sink) -> bool:
    """Return whether orthogonal regions react independently; report the transitions if not."""
    is_orthogonal = len(machine.top) > 1 or any(
        len(one.regions) > 1 for one in machine.vertices.values()
    )
    if not is_orthogonal:
        return True
    races = _races(graph, machine, comparison, sink)
    return not [*races, *_crossings(graph, machine, comparison, sink)]


def _orthogonal_pairs(machine: Machine) -> Iterator[tuple[Transition, Transition, str]]:
    """Pairs whose sources can be active at once, with the state above both (or empty)."""
    sources = [one for one in machine.transitions() if machine.vertices[one.source].kind == "state"]
    for one, other in combinations(sources, 2):
        common = _common_state(machine, one, other)
        if common is not None and simultaneous(one, other):
            yield one, other, common


def _common_state(machine: Machine, one: Transition, other: Transition) -> str | None:
    """The state in different regions of which all their sources lie, None when there is none."""
    found = [common_state(machine, a, b) for a in one.sources for b in other.sources]
    return None if None in found else found[0]


def _races(
    graph: Graph, machine: Machine, comparison: GuardComparison, sink: Sink
) -> Iterator[str]:
    assigned = {one.id: _touched(machine, one) for one in machine.transitions()}
    for one, other, _ in _orthogonal_pairs(machine):
        shared = [variable for variable in assigned[one.id] if variable in assigned[other.id]]
        if shared and comparison.are_compatible(one, other):
            subject = graph.subject(graph[element_id(one.id)])
            sink.report(RACE, subject, first=one.words, second=other.words, variable=shared[0])
            yield one.id


def _touched(machine: Machine, transition: Transition) -> dict[str, None]:
    """Properties that may be assigned when the transition is taken; no less, maybe more."""
    ways = segments(machine, transition)
    actions = [action for one in ways for action in one.effect]
    changed = {machine.main_region(one) for one in ways}
    for state in machine.states():
        if not changed.isdisjoint(machine.around(state.id)):
            actions += [*state.entry, *state.exit]
            actions += _on_start(machine, state.regions)
    return dict.fromkeys(action.variable for action in actions if isinstance(action, Assign))


def _on_start(machine: Machine, regions: tuple[str, ...]) -> list[Action]:
    starts = [machine.regions[one].initial for one in regions]
    begun = [one for start in starts for one in machine.outgoing.get(start, ())]
    return [action for one in begun for each in segments(machine, one) for action in each.effect]


def _crossings(
    graph: Graph, machine: Machine, comparison: GuardComparison, sink: Sink
) -> Iterator[str]:
    for one, other, state in _orthogonal_pairs(machine):
        for leaver, stayer in ((one, other), (other, one)):
            if _leaves(machine, leaver, state) and comparison.are_compatible(one, other):
                subject = graph.subject(graph[element_id(leaver.id)])
                sink.report(CROSSING, subject, first=leaver.words, second=stayer.words)
                yield leaver.id


def _leaves(machine: Machine, transition: Transition, state: str) -> bool:
    """Whether taking the transition can leave the state, that is, change what is around it."""
    if not state or transition.kind == "internal":
        return False
    changed = [machine.main_region(one) for one in segments(machine, transition)]
    owners = [machine.regions[region].state for region in changed if region]
    return any(
        owner != state and not (owner and machine.contains(state, owner)) for owner in owners
    )
