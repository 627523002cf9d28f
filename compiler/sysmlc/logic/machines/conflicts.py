"""Transitions that can be enabled in the same step, and the conflicts between them.

Two transitions can be enabled at once if their triggers can occur together and some values satisfy
both guards. Such a pair is a conflict if it leaves orthogonal regions that assign the same property
or leave their common state, or if one transition is nested in the source of the other and so takes
precedence.
"""

from collections.abc import Iterator
from itertools import combinations

from sysmlc.diagnostics import Severity, Sink, rule
from sysmlc.ir import Graph
from sysmlc.logic import domains
from sysmlc.logic import formula as f
from sysmlc.logic.contract import Domain
from sysmlc.logic.evaluate import evaluation
from sysmlc.logic.expressions.elaborate import Scope, condition
from sysmlc.logic.expressions.expression import Expression, name_of
from sysmlc.logic.formula import Formula
from sysmlc.logic.machines.actions import walk
from sysmlc.logic.machines.machine import (
    Action,
    AfterTicks,
    Assign,
    Machine,
    OnEvent,
    Transition,
    Vertex,
    element_id,
)
from sysmlc.logic.machines.well_formedness import common_state, segments

_LIMIT = 4096
"""Valuations tried to see whether two guards exclude one another; more count as possible."""
MAX_VALUATIONS = 2_000_000
"""Valuations tried for all guards of a machine, about 2 s of work: every transition may have to be
compared with every other."""


class TooManyValuationsError(Exception):
    """The guards of a machine have too many combinations of values to be compared."""


class GuardComparison:
    """Compares guards of the transitions of one machine, with a bound on the work in all."""

    def __init__(self, scope: Scope) -> None:
        self._scope = scope
        self._remaining = MAX_VALUATIONS
        self._guards: dict[str, tuple[Formula, dict[str, Domain]]] = {}
        """The guard of each transition, by its id, and the domains of the variables in it."""

    def are_compatible(self, left: Transition, right: Transition) -> bool:
        """Return whether some values of the variables satisfy both guards.

        If one comparison has more than ``_LIMIT`` valuations, the answer is yes. Raises
        TooManyValuationsError beyond the bound for the machine.
        """
        left_guard, left_domains = self._read_guard(left)
        right_guard, right_domains = self._read_guard(right)
        formula = f.both(left_guard, right_guard)
        if formula == f.FALSE:
            return False
        variables = left_domains | right_domains
        count = domains.count(variables)
        if count > _LIMIT:
            return True
        self._remaining -= count
        if self._remaining < 0:
            raise TooManyValuationsError
        is_true = evaluation(formula)
        return any(is_true(values, None) for values in domains.valuations(variables))

    def _read_guard(self, transition: Transition) -> tuple[Formula, dict[str, Domain]]:
        guard = transition.guard
        if guard is None:
            return f.TRUE, {}
        if transition.id not in self._guards:
            variables = dict(_find_domains(guard, self._scope))
            self._guards[transition.id] = condition(guard, self._scope), variables
        return self._guards[transition.id]


def may_compete(
    outgoing: tuple[Transition, ...], vertex: Vertex, comparison: GuardComparison
) -> bool:
    """Return whether two transitions that leave the vertex can be enabled at once."""
    if vertex.kind == "initial":
        return False
    is_state = vertex.kind == "state"
    return any(
        (not is_state or coincide(one, other)) and comparison.are_compatible(one, other)
        for one, other in combinations(outgoing, 2)
    )


def have_common_cause(
    outgoing: tuple[Transition, ...], vertex: Vertex, comparison: GuardComparison
) -> bool:
    """Return whether two of the transitions can be enabled by one and the same occurrence."""
    return any(
        (vertex.kind != "state" or _have_same_trigger(one, other))
        and comparison.are_compatible(one, other)
        for one, other in combinations(outgoing, 2)
    )


def _have_same_trigger(one: Transition, other: Transition) -> bool:
    if not one.occurrences or not other.occurrences:
        return not one.occurrences and not other.occurrences
    pairs = [(left, right) for left in one.occurrences for right in other.occurrences]
    return any(type(a) is type(b) and _same_step(a, b) for a, b in pairs)


def coincide(one: Transition, other: Transition) -> bool:
    """Whether both can have an occurrence in one step; completion goes before the rest."""
    if not one.occurrences or not other.occurrences:
        return not one.occurrences and not other.occurrences
    return any(_same_step(left, right) for left in one.occurrences for right in other.occurrences)


def _same_step(left: object, right: object) -> bool:
    if isinstance(left, OnEvent) and isinstance(right, OnEvent):
        return left.literal is None or right.literal is None or left.literal == right.literal
    if isinstance(left, AfterTicks) and isinstance(right, AfterTicks):
        return left.count == right.count
    return True


def simultaneous(one: Transition, other: Transition) -> bool:
    """As ``coincide``, for sources that can be active at the same time."""
    if not one.occurrences or not other.occurrences:
        return True
    events = [
        occurrence
        for occurrence in (*one.occurrences, *other.occurrences)
        if not isinstance(occurrence, OnEvent)
    ]
    return bool(events) or coincide(one, other)


def _find_domains(source: Expression, scope: Scope) -> Iterator[tuple[str, Domain]]:
    for part in walk(source):
        name = name_of(part)
        symbol = None if name is None else scope(name)
        if symbol is not None and symbol.domain is not None:
            yield from ((v.name, symbol.domain) for v in f.variables(symbol.formula))


RACE = rule(
    "SM426",
    "race",
    Severity.WARNING,
    "'{first}' and '{second}' of orthogonal regions can both assign '{variable}' in one step; "
    "the component gets no contract",
    help="assign the property in one region only, or on different events",
)
CROSSING = rule(
    "SM427",
    "exit-from-orthogonal-state",
    Severity.WARNING,
    "'{first}' leaves an orthogonal state while '{second}' can be taken in another of its "
    "regions; the component gets no contract",
    help="draw the transition from the border of the orthogonal state, or use another event",
)


# -- orthogonal regions ------------------------------------------------------------------------


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


OVERRIDDEN = rule(
    "SM434",
    "event-can-be-lost",
    Severity.WARNING,
    "the event of transition {transition} is lost when it comes in the step in which {inner} "
    "is taken",
    help=(
        "if the event must never be lost, let it be repeated until it is answered (a change that "
        "lasts as a guard, a time-out as a transition of the inner states), or trigger the inner "
        "transition by an event as well"
    ),
)


# -- nested states -----------------------------------------------------------------------------


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
