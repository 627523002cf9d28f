"""Transitions that can be enabled in the same step, and the conflicts between them.

Two transitions can be enabled at once if their triggers can occur in one step and some values
satisfy both guards. There are three kinds of conflict:

- transitions of orthogonal regions assign the same property;
- a transition of an orthogonal region leaves the state that contains the regions;
- a transition is nested in the source of the other, so that it preempts the other.
"""

from collections.abc import Iterator, Mapping, Sequence
from itertools import combinations

from sysmlc.diagnostics import Severity, Sink, rule
from sysmlc.ir import Graph
from sysmlc.ir.expressions import Expression
from sysmlc.logic import domains
from sysmlc.logic import formula as f
from sysmlc.logic.cells import Fact, find_cells
from sysmlc.logic.contract import Owner, Variable
from sysmlc.logic.evaluate import compile_evaluation
from sysmlc.logic.expressions.elaboration import elaborate_condition, list_read
from sysmlc.logic.expressions.parsing import GuardTerms
from sysmlc.logic.expressions.symbols import Scope
from sysmlc.logic.formula import Formula
from sysmlc.logic.machines.machine import (
    Action,
    AfterTicks,
    Assign,
    Machine,
    OnChange,
    OnEvent,
    Transition,
    Vertex,
    element_id,
)
from sysmlc.logic.machines.well_formedness import collect_segments, find_common_state

_MAX_VALUATIONS_OF_PAIR = 4096
"""Valuations tried to decide whether two guards exclude one another; beyond it, they do not."""
MAX_VALUATIONS = 2_000_000
"""Valuations tried for all guards of a machine, about 2 s of work.

The number of comparisons may be quadratic in the number of transitions."""


class TooManyValuationsError(Exception):
    """The guards of a machine have too many combinations of values to be compared."""


class GuardComparison:
    """Compares guards of the transitions of one machine, with a bound on the total work."""

    def __init__(self, scope: Scope, facts: Sequence[Fact] = ()) -> None:
        """Compare guards with names in *scope*; *facts* are what constraints say about numbers."""
        self._scope = scope
        self._facts = facts
        self._remaining = MAX_VALUATIONS
        self._guards: dict[str, tuple[Formula, dict[str, Variable]]] = {}
        """The guard and change conditions of each transition, by its id, and their variables."""

    def are_compatible(self, left: Transition, right: Transition) -> bool:
        """Whether some values of the variables satisfy both guards, and the changes waited for.

        The answer is yes if the comparison has more than ``_MAX_VALUATIONS_OF_PAIR`` valuations.
        Raises TooManyValuationsError beyond the bound for the machine.
        """
        left_guard, left_variables = self._read_guard(left)
        right_guard, right_variables = self._read_guard(right)
        formula = f.both(left_guard, right_guard)
        if formula == f.FALSE:
            return False
        variables = left_variables | right_variables
        cells = find_cells(variables.values(), self._facts)
        formula = f.both(formula, *cells.possible)
        values_by_name = {v.name: v.domain for v in (*variables.values(), *cells.orders)}
        count = domains.count(values_by_name)
        if count > _MAX_VALUATIONS_OF_PAIR:
            return True
        self._remaining -= count
        if self._remaining < 0:
            raise TooManyValuationsError
        is_true = compile_evaluation(formula)
        return any(is_true(values, None) for values in domains.valuations(values_by_name))

    def _read_guard(self, transition: Transition) -> tuple[Formula, dict[str, Variable]]:
        if transition.id not in self._guards:
            guards = [] if transition.guard is None else [transition.guard]
            changes = [o.condition for o in transition.occurrences if isinstance(o, OnChange)]
            # Any other trigger enables the transition while the conditions are false.
            if len(changes) < len(transition.occurrences):
                changes = []
            formula = f.both(*(elaborate_condition(guard, self._scope) for guard in guards))
            if changes:
                holds = (elaborate_condition(change, self._scope) for change in changes)
                formula = f.both(f.either(*holds), formula)
            variables: dict[str, Variable] = {}
            for condition in (*guards, *changes):
                variables |= {v.name: v for v in _find_variables(condition, self._scope)}
            self._guards[transition.id] = formula, variables
        return self._guards[transition.id]


def may_compete(
    outgoing: tuple[Transition, ...], vertex: Vertex, comparison: GuardComparison
) -> bool:
    """Whether two transitions that leave the vertex can be enabled at once."""
    if vertex.kind == "initial":
        return False
    is_state = vertex.kind == "state"
    return any(
        (not is_state or _can_coincide(left, right)) and comparison.are_compatible(left, right)
        for left, right in combinations(outgoing, 2)
    )


def list_competing(
    outgoing: tuple[Transition, ...],
    vertex: Vertex,
    comparison: GuardComparison,
    *,
    terms: Mapping[str, GuardTerms],
    by_one_occurrence: bool,
) -> list[Transition]:
    """Return the *outgoing* transitions that can be enabled together with another of them.

    With *by_one_occurrence*, the same occurrence of a trigger has to enable both. *terms* are those
    of the guards as written, by transition: the contract may treat each of them as an input.
    """
    is_state = vertex.kind == "state"
    competing: dict[str, Transition] = {}
    for left, right in combinations(outgoing, 2):
        if left.id in competing and right.id in competing:
            continue
        are_excluded = is_state and not _can_coincide(left, right, by_one_occurrence)
        if are_excluded or terms[left.id].excludes(terms[right.id]):
            continue
        if comparison.are_compatible(left, right):
            competing |= {left.id: left, right.id: right}
    return [transition for transition in outgoing if transition.id in competing]


def _can_coincide(
    left_transition: Transition, right_transition: Transition, by_one_occurrence: bool = False
) -> bool:
    """Whether two transitions with the same source can be triggered in one step.

    A completion transition and a triggered transition never compete: the completion goes first.
    With *by_one_occurrence*, a single occurrence has to trigger both.
    """
    if not left_transition.occurrences or not right_transition.occurrences:
        return not left_transition.occurrences and not right_transition.occurrences
    return any(
        _can_share_step(left, right) and not (by_one_occurrence and type(left) is not type(right))
        for left in left_transition.occurrences
        for right in right_transition.occurrences
    )


def _can_share_step(left: object, right: object) -> bool:
    """Whether two occurrences of triggers can happen in one step."""
    if isinstance(left, OnEvent) and isinstance(right, OnEvent):
        return left.literal is None or right.literal is None or left.literal == right.literal
    # Both count the steps since their common source was entered.
    if isinstance(left, AfterTicks) and isinstance(right, AfterTicks):
        return left.count == right.count
    return True


def can_be_simultaneous(left: Transition, right: Transition) -> bool:
    """Whether two transitions with different sources can be triggered in one step."""
    if not left.occurrences or not right.occurrences:
        return True
    # A step has at most one event, but times and changes coincide with any other occurrence. The
    # sources may have been entered at different times, so that equal counts prove nothing.
    other_occurrences = [
        occurrence
        for occurrence in (*left.occurrences, *right.occurrences)
        if not isinstance(occurrence, OnEvent)
    ]
    return bool(other_occurrences) or _can_coincide(left, right)


def _find_variables(source: Expression, scope: Scope) -> Iterator[Variable]:
    """Yield the variables in the expression."""
    for _, symbol in list_read(source, scope):
        if symbol is not None and symbol.domain is not None:
            for variable in f.variables(symbol.formula):
                yield Variable(variable.name, Owner.ENVIRONMENT, symbol.domain, term=symbol.term)


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
    "'{first}' leaves an orthogonal state while {others} can be taken in another of its "
    "regions; the component gets no contract",
    help="draw the transition from the border of the orthogonal state, or use another event",
)


# -- orthogonal regions ------------------------------------------------------------------------


def are_regions_independent(
    graph: Graph, machine: Machine, comparison: GuardComparison, sink: Sink
) -> bool:
    """Whether orthogonal regions react independently; report the transitions if not."""
    is_orthogonal = len(machine.top) > 1 or any(
        len(vertex.regions) > 1 for vertex in machine.vertices.values()
    )
    if not is_orthogonal:
        return True
    races = _report_races(graph, machine, comparison, sink)
    return not [*races, *_report_crossings(graph, machine, comparison, sink)]


def _orthogonal_pairs(machine: Machine) -> Iterator[tuple[Transition, Transition, str]]:
    """Yield pairs of transitions whose sources can be active at once.

    Each pair comes with the state that contains both sources; the state is empty for regions of the
    machine.
    """
    transitions = [
        transition
        for transition in machine.list_transitions()
        if machine.vertices[transition.source].kind == "state"
    ]
    for left, right in combinations(transitions, 2):
        state = _common_state_of_sources(machine, left, right)
        if state is not None and can_be_simultaneous(left, right):
            yield left, right, state


def _common_state_of_sources(machine: Machine, left: Transition, right: Transition) -> str | None:
    """Return the state whose orthogonal regions separate the sources of both, or None."""
    states = [find_common_state(machine, a, b) for a in left.sources for b in right.sources]
    return None if None in states else states[0]


def _report_races(
    graph: Graph, machine: Machine, comparison: GuardComparison, sink: Sink
) -> Iterator[str]:
    """Report pairs of transitions that can assign the same property in one step.

    Yield the id of the first transition of each pair.
    """
    assigned = {
        transition.id: _list_assigned(machine, transition)
        for transition in machine.list_transitions()
    }
    for left, right, _ in _orthogonal_pairs(machine):
        variables = [variable for variable in assigned[left.id] if variable in assigned[right.id]]
        if variables and comparison.are_compatible(left, right):
            subject = graph.subject(graph[element_id(left.id)])
            sink.report(RACE, subject, first=left.words, second=right.words, variable=variables[0])
            yield left.id


def _list_assigned(machine: Machine, transition: Transition) -> dict[str, None]:
    """Return an overapproximation of the properties that the compound transition assigns."""
    segments = collect_segments(machine, transition)
    actions = [action for segment in segments for action in segment.effect]
    regions = {machine.find_main_region(segment) for segment in segments}
    for state in machine.list_states():
        if not regions.isdisjoint(machine.list_enclosing_regions(state.id)):
            actions += [*state.entry, *state.exit]
            actions += _list_initial_effects(machine, state.regions)
    return dict.fromkeys(action.variable for action in actions if isinstance(action, Assign))


def _list_initial_effects(machine: Machine, regions: tuple[str, ...]) -> list[Action]:
    """List the effects of the initial transitions of *regions*."""
    initials = [machine.regions[item].initial for item in regions]
    transitions = [item for start in initials for item in machine.outgoing.get(start, ())]
    return [
        action
        for item in transitions
        for segment in collect_segments(machine, item)
        for action in segment.effect
    ]


def _report_crossings(
    graph: Graph, machine: Machine, comparison: GuardComparison, sink: Sink
) -> Iterator[str]:
    """Report exits from an orthogonal state that compete with a transition in another region.

    Yield the ids of the exits.
    """
    crossings: dict[str, tuple[Transition, list[str]]] = {}
    for left, right, state in _orthogonal_pairs(machine):
        for leaver, stayer in ((left, right), (right, left)):
            if _can_leave(machine, leaver, state) and comparison.are_compatible(left, right):
                _, stayers = crossings.setdefault(leaver.id, (leaver, []))
                stayers.append(f"'{stayer.words}'")
    for id, (leaver, stayers) in crossings.items():
        names = " or ".join(dict.fromkeys(stayers))
        sink.report(
            CROSSING, graph.subject(graph[element_id(id)]), first=leaver.words, others=names
        )
        yield id


def _can_leave(machine: Machine, transition: Transition, state: str) -> bool:
    """Whether the transition can leave *state*."""
    if not state or transition.kind == "internal":
        return False
    regions = [
        machine.find_main_region(segment) for segment in collect_segments(machine, transition)
    ]
    owners = [machine.regions[region].state for region in regions if region]
    return any(
        owner != state and not (owner and machine.contains(state, owner)) for owner in owners
    )


OVERRIDDEN = rule(
    "SM434",
    "event-can-be-lost",
    Severity.WARNING,
    "the event of transition {transition} is lost when it occurs in the step that takes {inner}",
    help=(
        "if the event must never be lost, repeat it until it is answered (write a "
        "lasting change as a guard, and a time-out as a transition of the inner states), "
        "or trigger the inner transition by an event as well"
    ),
)


# -- nested states -----------------------------------------------------------------------------


def report_lost_events(
    graph: Graph, machine: Machine, comparison: GuardComparison, sink: Sink
) -> None:
    """Report each transition whose event is lost when an inner transition preempts it."""
    for outer in machine.list_transitions():
        inner = list(_find_preempting(machine, outer, comparison))
        if inner:
            names = ", ".join(f"'{transition.words}'" for transition in inner)
            subject = graph.subject(graph[element_id(outer.id)])
            sink.report(OVERRIDDEN, subject, transition=f"'{outer.words}'", inner=names)


def _find_preempting(
    machine: Machine, outer: Transition, comparison: GuardComparison
) -> Iterator[Transition]:
    """Yield transitions inside the source of *outer* that can be taken in the step of its trigger.

    A step has only one event, but times and changes can coincide with any other occurrence.
    """
    waits_for_event = any(isinstance(occurrence, OnEvent) for occurrence in outer.occurrences)
    has_other_occurrence = not all(
        isinstance(occurrence, OnEvent) for occurrence in outer.occurrences
    )
    for inner in machine.list_transitions():
        source = machine.vertices[inner.source]
        if source.kind != "state" or not machine.contains(outer.source, inner.source):
            continue
        other_occurrences = [
            occurrence for occurrence in inner.occurrences if not isinstance(occurrence, OnEvent)
        ]
        needs_no_event = bool(other_occurrences) or not inner.occurrences
        can_meet = has_other_occurrence or (waits_for_event and needs_no_event)
        if can_meet and comparison.are_compatible(outer, inner):
            yield inner
