"""Moves: the transitions of a state machine with the conditions under which they are taken.

A transition is enabled by its occurrences, its guard, and a feasible path through pseudostates.
Inner transitions go before outer ones, and completion before triggers. If several transitions of a
state are enabled, its choice variable names the transition that is taken.
"""

from collections.abc import Iterator, Mapping

from msgspec import Struct
from msgspec.structs import replace

from sysmlc.diagnostics import Severity, Sink, rule
from sysmlc.ir import Graph
from sysmlc.logic import formula as f
from sysmlc.logic.contract import Domain, IntegerDomain
from sysmlc.logic.domains import valuations
from sysmlc.logic.expressions.context import report_assumed_range
from sysmlc.logic.expressions.elaboration import elaborate_condition
from sysmlc.logic.formula import Const, Formula, Op
from sysmlc.logic.machines import descriptions as texts
from sysmlc.logic.machines.conflicts import can_be_simultaneous
from sysmlc.logic.machines.machine import (
    NO_EVENT,
    AfterTicks,
    Machine,
    Occurrence,
    OnChange,
    OnEvent,
    OnInput,
    Transition,
    Vertex,
    element_id,
)
from sysmlc.logic.machines.paths import MAX_PATHS, Path, PathExplorer, TooManyPathsError
from sysmlc.logic.simplification import remove_redundant, simplify_constant

SATURATES = rule(
    "SM428",
    "assignment-leaves-range",
    Severity.WARNING,
    "{transition} {can} take '{variable}' out of its range; it stops at the bound",
    help="test the value before the assignment, or give the property a wider range",
)
BLOCKED = rule(
    "SM429",
    "choice-without-way-out",
    Severity.WARNING,
    "{transition}: the guards of '{vertex}' do not cover all cases; in the others the "
    "transition is not taken",
    help="add a transition with the guard else",
)
TOO_LARGE = rule(
    "SM430",
    "too-many-paths",
    Severity.WARNING,
    "{transition} has more than {limit} paths through choices and inner states, or more than "
    "{limit} choices in a row; the component gets no contract",
    help="split the machine",
)


class Move(Struct, frozen=True):
    """A transition with its paths and conditions.

    ``enabled`` is the condition that the transition is enabled. ``fires`` is the condition that it
    is taken: it is enabled, not preempted, and chosen.
    """

    transition: Transition
    paths: tuple[Path, ...]
    enabled: Formula
    fires: Formula = f.FALSE
    before: tuple["Move", ...] = ()
    """The moves that preempt this move when both are enabled."""


class Exploration(Struct, frozen=True):
    """All moves and initial paths of a machine, the input of the derivation."""

    machine: Machine
    domains: Mapping[str, Domain]
    moves: tuple[Move, ...]
    starts: tuple[Path, ...]


def explore_machine(graph: Graph, machine: Machine, sink: Sink) -> Exploration | None:
    """Explore all transitions; report a transition with too many paths and return None."""
    domains = {transition.name: transition.domain for transition in machine.variables}
    explorer = PathExplorer(machine, domains)
    moves: list[Move] = []
    for transition in machine.list_transitions():
        if machine.vertices[transition.source].kind != "state":
            continue
        try:
            paths = explorer.explore_transition(transition)
        except TooManyPathsError:
            _give_up(graph, transition.id, texts.name_transition(transition), sink)
            return None
        moves.append(
            Move(transition, tuple(paths), _enabling_condition(machine, domains, transition, paths))
        )
        _report_faults(graph, machine, domains, transition, paths, sink)
    moves = _enable_joins(machine, domains, moves)
    ordered_moves = tuple(_add_firing_condition(machine, domains, move, moves) for move in moves)
    try:
        starts = tuple(_explore_starts(machine, domains, explorer))
    except TooManyPathsError:
        _give_up(graph, machine.id, f"the start of '{machine.name}'", sink)
        return None
    return Exploration(machine, domains, ordered_moves, starts)


def _add_firing_condition(
    machine: Machine, domains: Mapping[str, Domain], move: Move, moves: list[Move]
) -> Move:
    """Add the condition that the move is enabled, not preempted, and chosen by its source."""
    source = machine.vertices[move.transition.source]
    choice = is_chosen_formula(source.pick, move.transition.literal) if source.pick else f.TRUE
    before = tuple(_find_preempting(machine, move, moves))
    fires = f.both(move.enabled, *(f.negate(other.enabled) for other in before), choice)
    return replace(move, fires=remove_redundant(fires, domains), before=before)


def _enable_joins(machine: Machine, domains: Mapping[str, Domain], moves: list[Move]) -> list[Move]:
    """Strengthen the enabling condition of each join: nothing inside its sources is enabled.

    Inner joins come first, because the condition of an outer join depends on them.
    """
    if not any(move.transition.join_partners for move in moves):
        return moves
    moves_by_id = {move.transition.id: move for move in moves}
    joins = [move for move in moves if move.transition.join_partners]
    for move in sorted(
        joins,
        key=lambda inner_move: -len(machine.list_enclosing_states(inner_move.transition.source)),
    ):
        inner = [
            inner_move.enabled
            for inner_move in moves_by_id.values()
            if _leaves_inner_state(machine, inner_move, move)
        ]
        enabled = remove_redundant(f.both(move.enabled, *map(f.negate, inner)), domains)
        moves_by_id[move.transition.id] = replace(move, enabled=enabled)
    return list(moves_by_id.values())


def _leaves_inner_state(machine: Machine, inner_move: Move, outer_move: Move) -> bool:
    """Return whether the first move leaves a state inside a source of the second."""
    if (
        not outer_move.transition.join_partners
        and not machine.vertices[outer_move.transition.source].regions
    ):
        return False
    return any(
        machine.contains(outer, inner)
        for outer in outer_move.transition.sources
        for inner in inner_move.transition.sources
    )


def _give_up(graph: Graph, id: str, name: str, sink: Sink) -> None:
    sink.report(TOO_LARGE, graph.subject(graph[element_id(id)]), transition=name, limit=MAX_PATHS)


def _explore_starts(
    machine: Machine, domains: Mapping[str, Domain], explorer: PathExplorer
) -> Iterator[Path]:
    """Yield the paths into the initial states.

    A property without a default that these paths read is tried with each of its values.
    """
    defaults = {name: Const(value) for name, value in machine.initial.items()}
    paths = explorer.explore_start(defaults)
    read_variables = {name for path in paths for name in _list_read_variables(path)}
    unknown = {
        name: domains[name]
        for name in machine.assigned
        if name in read_variables and name not in defaults
    }
    for values in valuations(unknown):
        constants = {name: Const(value) for name, value in values.items()}
        yield from explorer.explore_start(defaults | constants)


def _list_read_variables(path: Path) -> Iterator[str]:
    """Yield the names of the variables that the path reads."""
    for formula in (path.branch, path.case, *path.values.values()):
        yield from (variable.name for variable in f.variables(formula))


def _enabling_condition(
    machine: Machine, domains: Mapping[str, Domain], transition: Transition, paths: list[Path]
) -> Formula:
    """Return the condition that all sources are active, a trigger occurs and a path is feasible."""
    occurs = _occurrence_condition(machine, transition)
    path_condition = _path_condition(machine, domains, transition, paths)
    active_sources = (is_active_formula(machine, source) for source in transition.sources)
    opened = (f.negate(f.var(name)) for name in machine.list_blockers(transition))
    return remove_redundant(f.both(*active_sources, *opened, occurs, path_condition), domains)


def _path_condition(
    machine: Machine, domains: Mapping[str, Domain], transition: Transition, paths: list[Path]
) -> Formula:
    """Return the condition that some path is feasible.

    It is the guard alone if the guard implies that some path is feasible.
    """
    guard = _guard_condition(machine, transition)
    condition_of_paths = f.either(*(path.when for path in paths))
    if condition_of_paths == guard:
        return simplify_constant(guard, domains)
    is_always_open = simplify_constant(f.implies(guard, condition_of_paths), domains) == f.TRUE
    return simplify_constant(guard if is_always_open else condition_of_paths, domains)


def _guard_condition(machine: Machine, transition: Transition) -> Formula:
    guard = transition.guard
    return f.TRUE if guard is None else elaborate_condition(guard, machine.scope)


def is_active_formula(machine: Machine, vertex: str) -> Formula:
    """Return the formula that the vertex is the active state of its region."""
    state = machine.vertices[vertex]
    return f.eq(f.var(machine.regions[state.region].variable), Const(state.literal))


def _occurrence_condition(machine: Machine, transition: Transition) -> Formula:
    state = machine.vertices[transition.source]
    if not transition.occurrences:
        return f.both(
            *(_completion_condition(machine, machine.vertices[item]) for item in transition.sources)
        )
    return f.either(*(trigger_condition(machine, state, item) for item in transition.occurrences))


def _completion_condition(machine: Machine, state: Vertex) -> Formula:
    """Return the condition that the state is complete.

    Its do behaviour has ended and its regions are in final states (UML 2.5.1, 14.2.3.8.3).
    """
    end = f.var(state.done) if state.done else f.TRUE
    inner = []
    for region in state.regions:
        finals = [v for v in machine.vertices.values() if v.region == region and v.kind == "final"]
        inner.append(f.either(*(is_active_formula(machine, final.id) for final in finals)))
    return f.both(end, *inner)


def trigger_condition(machine: Machine, state: Vertex, occurrence: Occurrence) -> Formula:
    """Return the condition that an occurrence happens while *state* is active."""
    match occurrence:
        case OnEvent(None):
            return f.compare(Op.NE, f.var("event"), Const(NO_EVENT))
        case OnEvent(literal):
            return f.eq(f.var("event"), Const(literal or ""))
        case AfterTicks(count):
            # The step that takes the transition is the last tick.
            return f.eq(f.var(state.timer), Const(count - 1))
        case OnChange(memory, expression):
            truth = elaborate_condition(expression, machine.scope)
            return f.both(truth, f.negate(f.var(memory))) if memory else truth
        case OnInput(variable):
            return f.var(variable)


def _find_preempting(machine: Machine, move: Move, moves: list[Move]) -> Iterator[Move]:
    """Yield the moves that preempt *move*.

    These are moves of states inside its sources, and completions of its source.
    """
    transition = move.transition
    for other in moves:
        if _leaves_inner_state(machine, other, move):
            if can_be_simultaneous(transition, other.transition):
                yield other
        elif (
            # Completion events are dispatched before all others (UML 2.5.1, 14.2.3.8.3).
            transition.occurrences
            and not other.transition.occurrences
            and transition.source in other.transition.sources
        ):
            yield other


def is_chosen_formula(pick: str, literal: str) -> Formula:
    """Return the formula that the choice variable *pick* names a transition in the next step."""
    return f.prime(f.eq(f.var(pick), Const(literal)))


def _report_faults(
    graph: Graph,
    machine: Machine,
    domains: Mapping[str, Domain],
    transition: Transition,
    paths: list[Path],
    sink: Sink,
) -> None:
    """Report assignments that saturate, and a choice whose guards do not cover all cases."""
    subject = graph.subject(graph[element_id(transition.id)])
    name = texts.name_transition(transition)
    for variable in dict.fromkeys(name for path in paths for name, _ in path.saturated):
        domain = domains[variable]
        if variable in machine.assumed and isinstance(domain, IntegerDomain):
            # The author stated no range, so that the bound is a limit of the contract only.
            feature = graph[machine.find_variable(variable).origin]
            user = graph[element_id(transition.id)]
            note = f"{name} can take it out of this range; the contract stops at the bound"
            report_assumed_range(graph, feature, domain, sink, user, note=note)
        else:
            sink.report(SATURATES, subject, transition=name, can="can", variable=variable)
    target = machine.vertices[transition.target] if transition.target else None
    if target is None or target.is_stable or transition.kind == "internal":
        return
    path_condition = _path_condition(machine, domains, transition, paths)
    is_covered = f.implies(_guard_condition(machine, transition), path_condition)
    if simplify_constant(is_covered, domains) != f.TRUE:
        vertex_name = graph[element_id(target.id)].name or target.kind
        sink.report(BLOCKED, subject, transition=name, vertex=vertex_name)
