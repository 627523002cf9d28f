"""Contracts of state machines, derived from the drawing (design, section 7).

``step`` says what a step is; each conjunct here says one thing about it. The reaction to a
step is seen in the next, so that guarantees prime what the system decides.
"""

from collections.abc import Callable, Iterator, Mapping
from dataclasses import dataclass, replace

from sysmlc.diagnostics import Severity, Sink, rule
from sysmlc.ir import Graph
from sysmlc.logic import formula as f
from sysmlc.logic import statemachine_words as words
from sysmlc.logic.contract import (
    BooleanDomain,
    Class,
    Conjunct,
    Contract,
    Domain,
    IntegerDomain,
)
from sysmlc.logic.domains import valuations
from sysmlc.logic.elaborate import condition
from sysmlc.logic.formula import Const, Formula, Op
from sysmlc.logic.machine import (
    NO_EVENT,
    AfterTicks,
    Machine,
    Occurrence,
    OnEvent,
    OnRise,
    Transition,
    Vertex,
    WhenTold,
)
from sysmlc.logic.machine_checks import simultaneous
from sysmlc.logic.samples import arrow, choice, machine
from sysmlc.logic.simplify import simplified, tidy
from sysmlc.logic.statemachine_paths import LIMIT, Explorer, Path, TooManyPaths

SATURATES = rule(
    "SM428",
    "assignment-leaves-range",
    Severity.WARNING,
    "{transition} can take '{variable}' out of its range; it stops at the bound",
    why="The contract has finite domains: a value beyond them is taken as the nearest bound.",
    help="Guard the transition, or give the property a wider range.",
    wrong=machine(arrow("a", "b", "start", effect="level := level + 1")),
    right=machine(arrow("a", "b", "start", "level < 9", "level := level + 1")),
)
BLOCKED = rule(
    "SM429",
    "choice-without-way-out",
    Severity.WARNING,
    "{transition}: the guards of '{vertex}' do not cover all cases; in the others the "
    "transition is not taken",
    why="UML calls a choice without an enabled way out ill-formed (2.5.1, 14.2.3.7).",
    help="Add a transition with the guard else.",
    wrong=machine(choice(), arrow("a", "x", "start"), arrow("x", "b", guard="ready")),
    right=machine(
        *(choice(), arrow("a", "x", "start"), arrow("x", "b", guard="ready")),
        arrow("x", "a", guard="else"),
    ),
)
TOO_LARGE = rule(
    "SM430",
    "too-many-paths",
    Severity.WARNING,
    "{transition} has more than {limit} ways through choices and inner states; the component "
    "gets no contract",
    why="A contract of that size helps nobody.",
    help="Split the machine.",
    wrong=machine(
        *(arrow("a", "x0", "start"), *(choice(f"x{n}") for n in range(9))),
        *(arrow(f"x{n}", f"x{n + 1}", guard=g) for n in range(8) for g in ("ready", "not ready")),
        arrow("x8", "b"),
    ),
    right=machine(
        *(arrow("a", "x0", "start"), *(choice(f"x{n}") for n in range(3))),
        *(arrow(f"x{n}", f"x{n + 1}", guard=g) for n in range(2) for g in ("ready", "not ready")),
        arrow("x2", "b"),
    ),
)


_Touches = Callable[[Path, str], bool]


@dataclass(frozen=True, slots=True)
class _Move:
    """A transition with its paths and the condition under which it is taken."""

    transition: Transition
    paths: tuple[Path, ...]
    enabled: Formula
    fires: Formula = f.FALSE


@dataclass(frozen=True, slots=True)
class _Derivation:
    machine: Machine
    domains: Mapping[str, Domain]
    moves: tuple[_Move, ...]
    starts: tuple[Path, ...]


def derive(graph: Graph, machine: Machine, component: str, sink: Sink) -> Contract | None:
    """The contract of a state machine; None, reported, when it would be too large."""
    work = _explore(graph, machine, sink)
    if work is None:
        return None
    assumptions = tuple(_assumptions(work))
    guarantees = (
        *_initial(work),
        *(c for move in work.moves for c in _transition(work, move)),
        *_choices(work),
        *_frames(work),
        *_clocks(work),
        *_derived_values(work),
    )
    return Contract(component, machine.id, machine.variables, assumptions, guarantees)


# -- which transitions fire --------------------------------------------------------------------


def _explore(graph: Graph, machine: Machine, sink: Sink) -> _Derivation | None:
    domains = {one.name: one.domain for one in machine.variables}
    explorer = Explorer(machine, domains)
    found: list[_Move] = []
    for one in machine.transitions():
        if machine.vertices[one.source].kind != "state":
            continue
        try:
            paths = explorer.transition(one)
        except TooManyPaths:
            _give_up(graph, one.id, words.name_transition(one), sink)
            return None
        found.append(_Move(one, tuple(paths), _enabled(machine, domains, one, paths)))
        _report(graph, machine, domains, one, paths, sink)
    moves = tuple(replace(m, fires=tidy(_fires(machine, m, found), domains)) for m in found)
    try:
        starts = tuple(_starts(machine, domains, explorer))
    except TooManyPaths:
        _give_up(graph, machine.id, f"the start of '{machine.name}'", sink)
        return None
    return _Derivation(machine, domains, moves, starts)


def _give_up(graph: Graph, id: str, named: str, sink: Sink) -> None:
    sink.report(TOO_LARGE, graph.subject(graph[id]), transition=named, limit=LIMIT)


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
    return tidy(f.both(active(machine, one.source), occurs, way), domains)


def _way(
    machine: Machine, domains: Mapping[str, Domain], one: Transition, paths: list[Path]
) -> Formula:
    """Some way through the pseudostates is open; the guard alone when it opens one always."""
    guard = f.TRUE if one.guard is None else condition(one.guard, machine.scope)
    way = f.either(*(path.when for path in paths))
    always_open = simplified(f.implies(guard, way), domains) == f.TRUE
    return simplified(guard if always_open else way, domains)


def active(machine: Machine, vertex: str) -> Formula:
    """The vertex is the state of its region."""
    one = machine.vertices[vertex]
    return f.eq(f.var(machine.regions[one.region].variable), Const(one.literal))


def _occurrence(machine: Machine, one: Transition) -> Formula:
    state = machine.vertices[one.source]
    if not one.occurrences:
        return _complete(machine, state)
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


def _fires(machine: Machine, move: _Move, moves: list[_Move]) -> Formula:
    """Enabled, before nothing that goes first, and chosen where there is a choice."""
    source = machine.vertices[move.transition.source]
    chosen = _is_picked(source.pick, move.transition.literal) if source.pick else f.TRUE
    return f.both(_eligible(machine, move, moves), chosen)


def _eligible(machine: Machine, move: _Move, moves: list[_Move]) -> Formula:
    return f.both(move.enabled, *(f.negate(one) for one in _before(machine, move, moves)))


def _before(machine: Machine, move: _Move, moves: list[_Move]) -> Iterator[Formula]:
    """What goes first: transitions of inner states, and the completion of the same state."""
    mine = move.transition
    for other in moves:
        if machine.contains(mine.source, other.transition.source):
            if simultaneous(mine, other.transition):
                yield other.enabled
        elif other.transition.source == mine.source and _is_later(mine, other.transition):
            yield other.enabled


def _is_later(one: Transition, other: Transition) -> bool:
    return bool(one.occurrences) and not other.occurrences


def _is_picked(pick: str, literal: str) -> Formula:
    return f.primed(f.eq(f.var(pick), Const(literal)))


def _report(
    graph: Graph,
    machine: Machine,
    domains: Mapping[str, Domain],
    one: Transition,
    paths: list[Path],
    sink: Sink,
) -> None:
    subject = graph.subject(graph[one.id])
    named = words.name_transition(one)
    for path in paths:
        for variable, _ in path.saturated:
            sink.report(SATURATES, subject, transition=named, variable=variable)
    target = machine.vertices[one.target] if one.target else None
    if target is None or target.is_stable or one.kind == "internal":
        return
    guard = f.TRUE if one.guard is None else condition(one.guard, machine.scope)
    way = _way(machine, domains, one, paths)
    if simplified(f.implies(guard, way), domains) != f.TRUE:
        name = graph[target.id].name or target.kind
        sink.report(BLOCKED, subject, transition=named, vertex=name)


# -- initial states ----------------------------------------------------------------------------


def _initial(work: _Derivation) -> Iterator[Conjunct]:
    rows = [_start_row(work, path) for path in work.starts]
    if not rows:
        origin = work.machine.id
        yield Conjunct(f.FALSE, Class.INIT, origin, "No initial transition can be taken.")
        return
    for name in rows[0]:
        if all(row[name] == rows[0][name] for row in rows) and rows[0][name] != f.TRUE:
            origin = _origin(work, name)
            yield Conjunct(rows[0][name], Class.INIT, origin, words.initial(rows[0][name]))
    yield from _alternative_starts(work, rows)


def _alternative_starts(work: _Derivation, rows: list[dict[str, Formula]]) -> Iterator[Conjunct]:
    differing = [name for name in rows[0] if any(row[name] != rows[0][name] for row in rows)]
    ways = [
        f.both(path.when, *(row[name] for name in differing))
        for path, row in zip(work.starts, rows, strict=True)
    ]
    formula = f.either(*ways)
    if formula != f.TRUE:
        yield Conjunct(formula, Class.INIT, work.machine.id, words.INITIAL_WAYS)


def _start_row(work: _Derivation, path: Path) -> dict[str, Formula]:
    """What the first step says of each variable on one path."""
    machine = work.machine
    row: dict[str, Formula] = {}
    for region in machine.regions.values():
        literal = path.entered.get(region.variable, "inactive")
        row[region.variable] = f.eq(f.var(region.variable), Const(literal))
    for name in machine.assigned:
        row[name] = _start_value(work, path, name)
    for name in machine.outputs:
        row[name] = f.var(name) if name in path.raised else f.negate(f.var(name))
    for state in machine.vertices.values():
        if state.pick:
            literal = path.picked.get(state.pick, NO_EVENT)
            row[state.pick] = f.eq(f.var(state.pick), Const(literal))
        if state.timer:
            row[state.timer] = f.eq(f.var(state.timer), Const(0))
    for name, expression in machine.memories.items():
        row[name] = f.iff(f.var(name), condition(expression, machine.scope))
    return row


def _start_value(work: _Derivation, path: Path, name: str) -> Formula:
    value = path.values.get(name)
    return f.TRUE if value is None else _equal(work, name, value, is_primed=False)


def _equal(work: _Derivation, name: str, value: Formula, is_primed: bool) -> Formula:
    variable = f.primed(f.var(name)) if is_primed else f.var(name)
    if isinstance(value, Const) and isinstance(value.value, bool):
        return variable if value.value else f.negate(variable)
    if _is_boolean(work, name):
        return f.iff(variable, value)
    return f.eq(variable, value)


def _is_boolean(work: _Derivation, name: str) -> bool:
    return isinstance(work.domains[name], BooleanDomain)


def _origin(work: _Derivation, name: str) -> str:
    return work.machine.variable(name).origin or work.machine.id


# -- transitions -------------------------------------------------------------------------------


def _transition(work: _Derivation, move: _Move) -> Iterator[Conjunct]:
    origin = move.transition.id
    for path in move.paths:
        chosen = [_is_picked(p, literal) for p, literal in _passed_picks(work, move, path)]
        taken = tidy(f.both(move.fires, path.when, *chosen), work.domains)
        formula = f.implies(taken, f.both(*_effects(work, path)))
        if formula != f.TRUE:
            way = tidy(path.when, work.domains, _conjuncts(move.fires))
            text = words.transition(work.machine, move.transition, path, way)
            yield Conjunct(formula, Class.SAFETY, origin, text)
    if any(list(_passed_picks(work, move, path)) for path in move.paths):
        ways = [
            f.both(path.when, *(_is_picked(*p) for p in _passed_picks(work, move, path)))
            for path in move.paths
        ]
        formula = f.implies(move.fires, f.either(*ways))
        yield Conjunct(formula, Class.SAFETY, origin, words.some_way(move.transition))


def _passed_picks(work: _Derivation, move: _Move, path: Path) -> Iterator[tuple[str, str]]:
    """Choices made at pseudostates on the way."""
    own = work.machine.vertices[move.transition.source].pick
    yield from ((pick, literal) for pick, literal in path.picked.items() if pick != own)


def _effects(work: _Derivation, path: Path) -> Iterator[Formula]:
    for variable, literal in path.entered.items():
        yield f.primed(f.eq(f.var(variable), Const(literal)))
    for name, value in path.values.items():
        yield _equal(work, name, value, is_primed=True)
    for name in path.raised:
        yield f.primed(f.var(name))


def _choices(work: _Derivation) -> Iterator[Conjunct]:
    """A state with competing transitions takes one of those that can be taken."""
    machine = work.machine
    for state in machine.states():
        if not state.pick:
            continue
        moves = [move for move in work.moves if move.transition.source == state.id]
        eligible = [
            f.both(*(part for part in _conjuncts(move.fires) if not _is_prime(part)))
            for move in moves
        ]
        formula = f.implies(f.either(*eligible), f.either(*(move.fires for move in moves)))
        yield Conjunct(formula, Class.SAFETY, state.id, words.choice(machine, state))


def _conjuncts(formula: Formula) -> tuple[Formula, ...]:
    is_and = isinstance(formula, f.Apply) and formula.op is Op.AND
    return formula.args if is_and and isinstance(formula, f.Apply) else (formula,)


def _is_prime(formula: Formula) -> bool:
    return any(one.primed for one in f.variables(formula))


# -- frames ------------------------------------------------------------------------------------


def _frames(work: _Derivation) -> Iterator[Conjunct]:
    machine = work.machine
    for region in machine.regions.values():
        yield _frame(work, region.variable, lambda path, name: name in path.entered)
    for name in machine.assigned:
        yield _frame(work, name, lambda path, name: name in path.values)
    for name in machine.outputs:
        yield _frame(work, name, lambda path, name: name in path.raised)
    for vertex in machine.vertices.values():
        if vertex.pick:
            yield _frame(work, vertex.pick, lambda path, name: name in path.picked)


def _frame(work: _Derivation, name: str, touches: _Touches) -> Conjunct:
    """What no transition changes keeps its value; what none does is not done."""
    changes = [change for move in work.moves for change in _changes(work, move, name, touches)]
    formula = f.either(*changes, _rest(work, name))
    if changes:
        formula = f.implies(f.negate(f.either(*changes)), _rest(work, name))
    return Conjunct(formula, Class.SAFETY, _origin(work, name), words.frame(work.machine, name))


def _rest(work: _Derivation, name: str) -> Formula:
    machine = work.machine
    if name in machine.outputs:
        return f.negate(f.primed(f.var(name)))
    if any(vertex.pick == name for vertex in machine.vertices.values()):
        return f.primed(f.eq(f.var(name), Const(NO_EVENT)))
    return _equal(work, name, f.var(name), is_primed=True)


def _changes(work: _Derivation, move: _Move, name: str, touches: _Touches) -> Iterator[Formula]:
    touching = [path for path in move.paths if touches(path, name)]
    if touching and len(touching) == len(move.paths):
        yield move.fires
        return
    for path in touching:
        picks = [_is_picked(*pick) for pick in _passed_picks(work, move, path)]
        yield tidy(f.both(move.fires, path.when, *picks), work.domains)


# -- clocks, memories, activities --------------------------------------------------------------


def _clocks(work: _Derivation) -> Iterator[Conjunct]:
    for state in work.machine.states():
        if not state.timer:
            continue
        clock, stays = f.var(state.timer), _stays(work, state)
        bound = work.domains[state.timer]
        assert isinstance(bound, IntegerDomain)
        below = f.compare(Op.LT, clock, Const(bound.high))
        after = f.compare(Op.ADD, clock, Const(1))
        full = f.eq(clock, Const(bound.high))
        rows = (
            (f.both(stays, below), f.eq(f.primed(clock), after), words.CLOCK_RUNS),
            (f.both(stays, full), f.eq(f.primed(clock), Const(bound.high)), words.CLOCK_STOPS),
            (f.negate(stays), f.eq(f.primed(clock), Const(0)), words.CLOCK_RESETS),
        )
        for when, then, text in rows:
            text = text.format(clock=state.timer, state=state.literal)
            formula = tidy(f.implies(when, then), work.domains)
            yield Conjunct(formula, Class.SAFETY, state.id, text)


def _stays(work: _Derivation, state: Vertex) -> Formula:
    leaving = [
        change
        for move in work.moves
        for change in _changes(work, move, state.id, lambda path, id: id in path.left)
    ]
    stays = f.both(active(work.machine, state.id), *(f.negate(one) for one in leaving))
    return tidy(stays, work.domains)


def _derived_values(work: _Derivation) -> Iterator[Conjunct]:
    machine = work.machine
    for name, expression in machine.memories.items():
        truth = condition(expression, machine.scope)
        formula = f.iff(f.primed(f.var(name)), truth)
        yield Conjunct(formula, Class.SAFETY, _origin(work, name), words.memory(name, truth))
    for state in machine.states():
        if state.do:
            formula = f.iff(f.var(state.do), active(machine, state.id))
            text = words.activity(state)
            yield Conjunct(formula, Class.SAFETY, _origin(work, state.do), text)


def _assumptions(work: _Derivation) -> Iterator[Conjunct]:
    for state in work.machine.states():
        if state.done:
            formula = f.either(f.negate(f.var(state.do)), f.var(state.done))
            yield Conjunct(formula, Class.LIVENESS, state.id, words.ends(state))
