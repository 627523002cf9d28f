"""Which transitions of a state machine are taken, as conditions over one step.

Enabled by occurrence, guard and an open way through pseudostates; inner before outer,
completion before triggers; chosen where several compete.
"""

from collections.abc import Iterator, Mapping

from msgspec import Struct
from msgspec.structs import replace

from sysmlc.diagnostics import Severity, Sink, rule
from sysmlc.ir import Graph
from sysmlc.logic import formula as f
from sysmlc.logic.contract import (
    Domain,
)
from sysmlc.logic.domains import valuations
from sysmlc.logic.expressions.elaborate import condition
from sysmlc.logic.formula import Const, Formula, Op
from sysmlc.logic.machines import descriptions as words
from sysmlc.logic.machines.conflicts import simultaneous
from sysmlc.logic.machines.machine import (
    NO_EVENT,
    AfterTicks,
    Machine,
    Occurrence,
    OnEvent,
    OnRise,
    Transition,
    Vertex,
    WhenTold,
    element_id,
)
from sysmlc.logic.machines.paths import LIMIT, Explorer, Path, TooManyPaths
from sysmlc.logic.simplify import simplified, tidy

SATURATES = rule(
    "SM428",
    "assignment-leaves-range",
    Severity.WARNING,
    "{transition} {can} take '{variable}' out of its range; it stops at the bound",
    help="let a guard on the way there leave room, or give the property a wider range",
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
    "{transition} has more than {limit} ways through choices and inner states; the component "
    "gets no contract",
    help="split the machine",
)


class Move(Struct, frozen=True):
    """A transition with its paths and the condition under which it is taken."""

    transition: Transition
    paths: tuple[Path, ...]
    enabled: Formula
    fires: Formula = f.FALSE
    before: tuple["Move", ...] = ()
    """What goes first where both are enabled."""


class Derivation(Struct, frozen=True):
    machine: Machine
    domains: Mapping[str, Domain]
    moves: tuple[Move, ...]
    starts: tuple[Path, ...]


def explore(graph: Graph, machine: Machine, sink: Sink) -> Derivation | None:
    domains = {one.name: one.domain for one in machine.variables}
    explorer = Explorer(machine, domains)
    found: list[Move] = []
    for one in machine.transitions():
        if machine.vertices[one.source].kind != "state":
            continue
        try:
            paths = explorer.transition(one)
        except TooManyPaths:
            _give_up(graph, one.id, words.name_transition(one), sink)
            return None
        found.append(Move(one, tuple(paths), _enabled(machine, domains, one, paths)))
        _report(graph, machine, domains, one, paths, sink)
    found = _joined(machine, domains, found)
    moves = tuple(_ordered(machine, domains, move, found) for move in found)
    try:
        starts = tuple(_starts(machine, domains, explorer))
    except TooManyPaths:
        _give_up(graph, machine.id, f"the start of '{machine.name}'", sink)
        return None
    return Derivation(machine, domains, moves, starts)


def _ordered(
    machine: Machine, domains: Mapping[str, Domain], move: Move, moves: list[Move]
) -> Move:
    fires = tidy(_fires(machine, move, moves), domains)
    return replace(move, fires=fires, before=tuple(_before(machine, move, moves)))


def _joined(machine: Machine, domains: Mapping[str, Domain], moves: list[Move]) -> list[Move]:
    """The moves; of those that a join makes one, what goes before them is part of them."""
    if not any(move.transition.also for move in moves):
        return moves
    found = {move.transition.id: move for move in moves}
    joined = [move for move in moves if move.transition.also]
    for move in sorted(joined, key=lambda one: -len(machine.above(one.transition.source))):
        inner = [one.enabled for one in found.values() if _is_inside(machine, one, move)]
        enabled = tidy(f.both(move.enabled, *map(f.negate, inner)), domains)
        found[move.transition.id] = replace(move, enabled=enabled)
    return list(found.values())


def _is_inside(machine: Machine, one: Move, other: Move) -> bool:
    """Whether the first leaves a state inside one that the other leaves."""
    if not other.transition.also and not machine.vertices[other.transition.source].regions:
        return False
    return any(
        machine.contains(outer, inner)
        for outer in other.transition.sources
        for inner in one.transition.sources
    )


def _give_up(graph: Graph, id: str, named: str, sink: Sink) -> None:
    sink.report(TOO_LARGE, graph.subject(graph[element_id(id)]), transition=named, limit=LIMIT)


def _starts(machine: Machine, domains: Mapping[str, Domain], explorer: Explorer) -> Iterator[Path]:
    """Paths into the initial states; a property without default that they read is tried with
    each of its values."""
    given = {name: Const(value) for name, value in machine.initial.items()}
    paths = explorer.start(given)
    read = {one for path in paths for one in _read_at_start(path)}
    unknown = {n: domains[n] for n in machine.assigned if n in read and n not in given}
    for values in valuations(unknown):
        chosen = {name: Const(value) for name, value in values.items()}
        yield from explorer.start(given | chosen)


def _read_at_start(path: Path) -> Iterator[str]:
    for formula in (path.branch, path.case, *path.values.values()):
        yield from (one.name for one in f.variables(formula))


def _enabled(
    machine: Machine, domains: Mapping[str, Domain], one: Transition, paths: list[Path]
) -> Formula:
    occurs = _occurrence(machine, one)
    way = _way(machine, domains, one, paths)
    leaving = (active(machine, source) for source in one.sources)
    return tidy(f.both(*leaving, occurs, way), domains)


def _way(
    machine: Machine, domains: Mapping[str, Domain], one: Transition, paths: list[Path]
) -> Formula:
    """Some way through the pseudostates is open; the guard alone when it opens one always."""
    guard = f.TRUE if one.guard is None else condition(one.guard, machine.scope)
    way = f.either(*(path.when for path in paths))
    if way == guard:
        return simplified(guard, domains)
    always_open = simplified(f.implies(guard, way), domains) == f.TRUE
    return simplified(guard if always_open else way, domains)


def active(machine: Machine, vertex: str) -> Formula:
    """The vertex is the state of its region."""
    one = machine.vertices[vertex]
    return f.eq(f.var(machine.regions[one.region].variable), Const(one.literal))


def _occurrence(machine: Machine, one: Transition) -> Formula:
    state = machine.vertices[one.source]
    if not one.occurrences:
        return f.both(*(_complete(machine, machine.vertices[each]) for each in one.sources))
    return f.either(*(_occurs(machine, state, each) for each in one.occurrences))


def _complete(machine: Machine, state: Vertex) -> Formula:
    ended = f.var(state.done) if state.done else f.TRUE
    inner = []
    for region in state.regions:
        finals = [v for v in machine.vertices.values() if v.region == region and v.kind == "final"]
        inner.append(f.either(*(active(machine, one.id) for one in finals)))
    return f.both(ended, *inner)


def _occurs(machine: Machine, state: Vertex, occurrence: Occurrence) -> Formula:
    match occurrence:
        case OnEvent(None):
            return f.compare(Op.NE, f.var("event"), Const(NO_EVENT))
        case OnEvent(literal):
            return f.eq(f.var("event"), Const(literal or ""))
        case AfterTicks(count):
            return f.eq(f.var(state.timer), Const(count - 1))
        case OnRise(memory, expression):
            truth = condition(expression, machine.scope)
            return f.both(truth, f.negate(f.var(memory)))
        case WhenTold(variable):
            return f.var(variable)


def _fires(machine: Machine, move: Move, moves: list[Move]) -> Formula:
    """Enabled, before nothing that goes first, and chosen where there is a choice."""
    source = machine.vertices[move.transition.source]
    chosen = is_picked(source.pick, move.transition.literal) if source.pick else f.TRUE
    return f.both(_eligible(machine, move, moves), chosen)


def _eligible(machine: Machine, move: Move, moves: list[Move]) -> Formula:
    return f.both(move.enabled, *(f.negate(one.enabled) for one in _before(machine, move, moves)))


def _before(machine: Machine, move: Move, moves: list[Move]) -> Iterator[Move]:
    """What goes first: transitions of inner states, and the completion of the same state."""
    mine = move.transition
    for other in moves:
        if _is_inside(machine, other, move):
            if simultaneous(mine, other.transition):
                yield other
        elif _is_later(mine, other.transition) and mine.source in other.transition.sources:
            yield other


def _is_later(one: Transition, other: Transition) -> bool:
    return bool(one.occurrences) and not other.occurrences


def is_picked(pick: str, literal: str) -> Formula:
    """A choice was made in favour of a transition; seen in the next step."""
    return f.primed(f.eq(f.var(pick), Const(literal)))


def _report(
    graph: Graph,
    machine: Machine,
    domains: Mapping[str, Domain],
    one: Transition,
    paths: list[Path],
    sink: Sink,
) -> None:
    subject = graph.subject(graph[element_id(one.id)])
    named = words.name_transition(one)
    for path in paths:
        for variable, _ in path.saturated:
            sink.report(SATURATES, subject, transition=named, can="can", variable=variable)
    target = machine.vertices[one.target] if one.target else None
    if target is None or target.is_stable or one.kind == "internal":
        return
    guard = f.TRUE if one.guard is None else condition(one.guard, machine.scope)
    way = _way(machine, domains, one, paths)
    if simplified(f.implies(guard, way), domains) != f.TRUE:
        name = graph[element_id(target.id)].name or target.kind
        sink.report(BLOCKED, subject, transition=named, vertex=name)
