"""Contracts of state machines, derived from the drawing (design, section 7).

``step`` says what a step is; each conjunct here says one thing about it. The reaction to a
step is seen in the next, so that guarantees prime what the system decides.
"""

from collections.abc import Callable, Iterator

from sysmlc.diagnostics import Sink
from sysmlc.ir import Graph
from sysmlc.logic import formula as f
from sysmlc.logic.contract import (
    BooleanDomain,
    Class,
    Conjunct,
    Contract,
    IntegerDomain,
)
from sysmlc.logic.expressions.elaborate import condition
from sysmlc.logic.formula import Const, Formula, Op
from sysmlc.logic.machines import descriptions as words
from sysmlc.logic.machines.machine import (
    INACTIVE,
    NO_EVENT,
    Machine,
    Region,
    Vertex,
    element_id,
)
from sysmlc.logic.machines.moves import Derivation, Move, active, explore, is_picked
from sysmlc.logic.machines.paths import Path
from sysmlc.logic.simplify import is_satisfiable, tidy

_Touches = Callable[[Path, str], bool]


def derive(graph: Graph, machine: Machine, component: str, sink: Sink) -> Contract | None:
    """The contract of a state machine; None, reported, when it would be too large."""
    work = explore(graph, machine, sink)
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


# -- initial states ----------------------------------------------------------------------------


def _initial(work: Derivation) -> Iterator[Conjunct]:
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


def _alternative_starts(work: Derivation, rows: list[dict[str, Formula]]) -> Iterator[Conjunct]:
    differing = [name for name in rows[0] if any(row[name] != rows[0][name] for row in rows)]
    ways = [
        f.both(path.when, *(row[name] for name in differing))
        for path, row in zip(work.starts, rows, strict=True)
    ]
    formula = f.either(*ways)
    if formula != f.TRUE:
        yield Conjunct(formula, Class.INIT, work.machine.id, words.INITIAL_WAYS)


def _start_row(work: Derivation, path: Path) -> dict[str, Formula]:
    """What the first step says of each variable on one path."""
    machine = work.machine
    row: dict[str, Formula] = {}
    for region in machine.regions.values():
        literal = path.entered.get(region.variable, INACTIVE)
        row[region.variable] = f.eq(f.var(region.variable), Const(literal))
        if region.memory:
            row[region.memory] = f.eq(f.var(region.memory), Const(INACTIVE))
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


def _start_value(work: Derivation, path: Path, name: str) -> Formula:
    value = path.values.get(name)
    return f.TRUE if value is None else _equal(work, name, value, is_primed=False)


def _equal(work: Derivation, name: str, value: Formula, is_primed: bool) -> Formula:
    variable = f.primed(f.var(name)) if is_primed else f.var(name)
    if isinstance(value, Const) and isinstance(value.value, bool):
        return variable if value.value else f.negate(variable)
    if _is_boolean(work, name):
        return f.iff(variable, value)
    return f.eq(variable, value)


def _is_boolean(work: Derivation, name: str) -> bool:
    return isinstance(work.domains[name], BooleanDomain)


def _origin(work: Derivation, name: str) -> str:
    return work.machine.variable(name).origin or work.machine.id


# -- transitions -------------------------------------------------------------------------------


def _transition(work: Derivation, move: Move) -> Iterator[Conjunct]:
    origin = element_id(move.transition.id)
    for path in move.paths:
        chosen = [is_picked(p, literal) for p, literal in _passed_picks(work, move, path)]
        taken = tidy(f.both(move.fires, path.when, *chosen), work.domains)
        formula = f.implies(taken, f.both(*_effects(work, path)))
        if formula != f.TRUE:
            way = tidy(path.when, work.domains, _conjuncts(move.fires))
            first = [one.transition for one in _overtaking(work, move, path)]
            text = words.transition(work.machine, move.transition, path, way, first)
            yield Conjunct(formula, Class.SAFETY, origin, text)
    if any(list(_passed_picks(work, move, path)) for path in move.paths):
        ways = [
            f.both(path.when, *(is_picked(*p) for p in _passed_picks(work, move, path)))
            for path in move.paths
        ]
        formula = f.implies(move.fires, f.either(*ways))
        yield Conjunct(formula, Class.SAFETY, origin, words.some_way(move.transition))


def _overtaking(work: Derivation, move: Move, path: Path) -> Iterator[Move]:
    """What may be taken first where the transition could be taken along the path."""
    for other in move.before:
        if is_satisfiable(f.both(move.enabled, path.when, other.enabled), work.domains):
            yield other


def _passed_picks(work: Derivation, move: Move, path: Path) -> Iterator[tuple[str, str]]:
    """Choices made at pseudostates on the way."""
    own = work.machine.vertices[move.transition.source].pick
    yield from ((pick, literal) for pick, literal in path.picked.items() if pick != own)


def _effects(work: Derivation, path: Path) -> Iterator[Formula]:
    for variable, literal in path.entered.items():
        yield f.primed(f.eq(f.var(variable), Const(literal)))
    for name, value in path.values.items():
        yield _equal(work, name, value, is_primed=True)
    for name in path.raised:
        yield f.primed(f.var(name))


def _choices(work: Derivation) -> Iterator[Conjunct]:
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
        origin = element_id(state.id)
        yield Conjunct(formula, Class.SAFETY, origin, words.choice(machine, state))


def _conjuncts(formula: Formula) -> tuple[Formula, ...]:
    is_and = isinstance(formula, f.Apply) and formula.op is Op.AND
    return formula.args if is_and and isinstance(formula, f.Apply) else (formula,)


def _is_prime(formula: Formula) -> bool:
    return any(one.primed for one in f.variables(formula))


# -- frames ------------------------------------------------------------------------------------


def _frames(work: Derivation) -> Iterator[Conjunct]:
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


def _frame(work: Derivation, name: str, touches: _Touches) -> Conjunct:
    """What no transition changes keeps its value; what none does is not done."""
    changes = [change for move in work.moves for change in _changes(work, move, name, touches)]
    formula = f.either(*changes, _rest(work, name))
    if changes:
        formula = f.implies(f.negate(f.either(*changes)), _rest(work, name))
    return Conjunct(formula, Class.SAFETY, _origin(work, name), words.frame(work.machine, name))


def _rest(work: Derivation, name: str) -> Formula:
    machine = work.machine
    if name in machine.outputs:
        return f.negate(f.primed(f.var(name)))
    if any(vertex.pick == name for vertex in machine.vertices.values()):
        return f.primed(f.eq(f.var(name), Const(NO_EVENT)))
    return _equal(work, name, f.var(name), is_primed=True)


def _changes(work: Derivation, move: Move, name: str, touches: _Touches) -> Iterator[Formula]:
    touching = [path for path in move.paths if touches(path, name)]
    if touching and len(touching) == len(move.paths):
        yield move.fires
        return
    for path in touching:
        picks = [is_picked(*pick) for pick in _passed_picks(work, move, path)]
        yield tidy(f.both(move.fires, path.when, *picks), work.domains)


# -- clocks, memories, activities --------------------------------------------------------------


def _clocks(work: Derivation) -> Iterator[Conjunct]:
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
            yield Conjunct(formula, Class.SAFETY, element_id(state.id), text)


def _stays(work: Derivation, state: Vertex) -> Formula:
    leaving = [
        change
        for move in work.moves
        for change in _changes(work, move, state.id, lambda path, id: id in path.left)
    ]
    stays = f.both(active(work.machine, state.id), *(f.negate(one) for one in leaving))
    return tidy(stays, work.domains)


def _derived_values(work: Derivation) -> Iterator[Conjunct]:
    machine = work.machine
    for name, expression in machine.memories.items():
        truth = condition(expression, machine.scope)
        formula = f.iff(f.primed(f.var(name)), truth)
        yield Conjunct(formula, Class.SAFETY, _origin(work, name), words.memory(name, truth))
    for region in machine.regions.values():
        if region.memory:
            yield from _history(work, region)
    for state in machine.states():
        if state.do:
            formula = f.iff(f.var(state.do), active(machine, state.id))
            text = words.activity(state)
            yield Conjunct(formula, Class.SAFETY, _origin(work, state.do), text)


def _history(work: Derivation, region: Region) -> Iterator[Conjunct]:
    """What a region was when it was last active."""
    origin, after = _origin(work, region.memory), f.primed(f.var(region.memory))
    is_off = f.eq(f.var(region.variable), Const(INACTIVE))
    state = work.machine.vertices[region.state].literal
    now = f.implies(f.negate(is_off), f.eq(after, f.var(region.variable)))
    text = words.REMEMBERS.format(memory=region.memory, region=region.variable)
    yield Conjunct(tidy(now, work.domains), Class.SAFETY, origin, text)
    kept = f.implies(is_off, f.eq(after, f.var(region.memory)))
    text = words.KEEPS.format(memory=region.memory, state=state)
    yield Conjunct(kept, Class.SAFETY, origin, text)


def _assumptions(work: Derivation) -> Iterator[Conjunct]:
    for state in work.machine.states():
        if state.done:
            formula = f.either(f.negate(f.var(state.do)), f.var(state.done))
            origin = element_id(state.id)
            yield Conjunct(formula, Class.LIVENESS, origin, words.ends(state))
