"""Contracts of state machines, derived from the diagram.

Each conjunct states one fact about a step, as ``interpreter`` defines it. The reaction to a step
becomes visible in the next step, so guarantees prime the variables of the system.
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
    drop_trivial,
    name_variables,
)
from sysmlc.logic.expressions.elaboration import elaborate_condition
from sysmlc.logic.formula import Const, Formula, Op
from sysmlc.logic.machines import descriptions as texts
from sysmlc.logic.machines.machine import (
    INACTIVE,
    NO_EVENT,
    Machine,
    Region,
    Vertex,
    element_id,
)
from sysmlc.logic.machines.moves import (
    Exploration,
    Move,
    explore_machine,
    is_active_formula,
    is_chosen_formula,
)
from sysmlc.logic.machines.paths import Path
from sysmlc.logic.region_formulas import word_regions
from sysmlc.logic.simplification import is_satisfiable, remove_redundant

Touches = Callable[[Path, str], bool]
"""Whether a path changes a variable or leaves, enters or passes what an id denotes."""


def derive_contract(graph: Graph, machine: Machine, component: str, sink: Sink) -> Contract | None:
    """Return the contract of a state machine; report and return None if it would be too large."""
    exploration = explore_machine(graph, machine, sink)
    return None if exploration is None else describe_exploration(exploration, component)


def describe_exploration(exploration: Exploration, component: str) -> Contract:
    """Return the contract of a state machine with known moves."""
    machine = exploration.machine
    assumptions = tuple(_derive_assumptions(exploration))
    guarantees = (
        *_derive_start(exploration),
        *(
            conjunct
            for move in exploration.moves
            for conjunct in _derive_transition(exploration, move)
        ),
        *_derive_choices(exploration),
        *_derive_frames(exploration),
        *_derive_clocks(exploration),
        *_derive_memories(exploration),
    )
    contract = Contract(
        component, machine.id, machine.variables, assumptions, drop_trivial(guarantees)
    )
    return name_variables(contract, machine.wordings)


# -- initial states ----------------------------------------------------------------------------


def _derive_start(exploration: Exploration) -> Iterator[Conjunct]:
    """Yield the initial conditions.

    Each fact that all initial paths share is one conjunct; a disjunction of the others follows.
    """
    alternatives = [_initial_facts(exploration, path) for path in exploration.starts]
    if not alternatives:
        origin = exploration.machine.id
        yield Conjunct(f.FALSE, Class.INIT, origin, "No initial transition can be taken.")
        return
    for name in alternatives[0]:
        if (
            all(facts[name] == alternatives[0][name] for facts in alternatives)
            and alternatives[0][name] != f.TRUE
        ):
            origin = _origin_of(exploration, name)
            yield Conjunct(
                alternatives[0][name],
                Class.INIT,
                origin,
                texts.describe_start(exploration.machine, alternatives[0][name]),
            )
    yield from _derive_start_alternatives(exploration, alternatives)


def _derive_start_alternatives(
    exploration: Exploration, alternatives: list[dict[str, Formula]]
) -> Iterator[Conjunct]:
    """Yield a disjunction over the initial paths of the facts in which these paths differ."""
    differing = [
        name
        for name in alternatives[0]
        if any(facts[name] != alternatives[0][name] for facts in alternatives)
    ]
    formulas = [
        f.both(path.when, *(facts[name] for name in differing))
        for path, facts in zip(exploration.starts, alternatives, strict=True)
    ]
    formula = f.either(*formulas)
    if formula != f.TRUE:
        yield Conjunct(formula, Class.INIT, exploration.machine.id, texts.INITIAL_ALTERNATIVES)


def _initial_facts(exploration: Exploration, path: Path) -> dict[str, Formula]:
    """Return the formula about each variable in the first step of one initial path."""
    machine = exploration.machine
    facts: dict[str, Formula] = {}
    for region in machine.regions.values():
        literal = path.entered.get(region.variable, INACTIVE)
        facts[region.variable] = f.eq(f.var(region.variable), Const(literal))
        if region.memory:
            facts[region.memory] = f.eq(f.var(region.memory), Const(INACTIVE))
    for name in machine.assigned:
        facts[name] = _initial_value_fact(exploration, path, name)
    for name in machine.outputs:
        facts[name] = f.var(name) if name in path.raised else f.negate(f.var(name))
    for state in machine.vertices.values():
        if state.pick:
            literal = path.picked.get(state.pick, NO_EVENT)
            facts[state.pick] = f.eq(f.var(state.pick), Const(literal))
        if state.timer:
            facts[state.timer] = f.eq(f.var(state.timer), Const(0))
    for name, memory in machine.memories.items():
        was_true: Formula = f.FALSE
        if not memory.state:
            was_true = elaborate_condition(memory.condition, machine.scope)
        facts[name] = f.fold_iff(f.var(name), was_true)
    return facts


def _initial_value_fact(exploration: Exploration, path: Path, name: str) -> Formula:
    value = path.values.get(name)
    return f.TRUE if value is None else _equality(exploration, name, value, is_primed=False)


def _equality(exploration: Exploration, name: str, value: Formula, is_primed: bool) -> Formula:
    variable = f.prime(f.var(name)) if is_primed else f.var(name)
    if isinstance(value, Const) and isinstance(value.value, bool):
        return variable if value.value else f.negate(variable)
    if _is_boolean(exploration, name):
        return f.fold_iff(variable, value)
    return f.eq(variable, value)


def _is_boolean(exploration: Exploration, name: str) -> bool:
    return isinstance(exploration.domains[name], BooleanDomain)


def _origin_of(exploration: Exploration, name: str) -> str:
    return exploration.machine.find_variable(name).origin or exploration.machine.id


# -- transitions -------------------------------------------------------------------------------


def _derive_transition(exploration: Exploration, move: Move) -> Iterator[Conjunct]:
    """Yield a conjunct for the effects of each path, and one that some path is taken."""
    origin = element_id(move.transition.id)
    for path in move.paths:
        taken = taken_formula(exploration, move, path)
        formula = f.implies(taken, f.both(*_effect_formulas(exploration, path)))
        if formula != f.TRUE:
            known = f.split_conjunction(move.fires)
            # The text shows the guard, which compares the numbers.
            shown = exploration.machine.variables
            when = f.both(
                *(
                    part
                    for part in f.split_conjunction(path.when)
                    if part not in known or word_regions(part, shown) == part
                )
            )
            branch = remove_redundant(when, exploration.domains, known)
            preempting = [item.transition for item in _find_overtaking(exploration, move, path)]
            text = texts.describe_transition(
                exploration.machine, move.transition, path, branch, preempting
            )
            yield Conjunct(formula, Class.SAFETY, origin, text)
    # The conjuncts above apply only if a choice variable names their branch. This conjunct excludes
    # a step that names no branch and therefore has no effect.
    choices = [choice_formula(exploration, move, path) for path in move.paths]
    if any(choice != f.TRUE for choice in choices):
        branches = (f.both(path.when, c) for path, c in zip(move.paths, choices, strict=True))
        formula = f.implies(move.fires, f.either(*branches))
        yield Conjunct(formula, Class.SAFETY, origin, texts.describe_branches(move.transition))


def _find_overtaking(exploration: Exploration, move: Move, path: Path) -> Iterator[Move]:
    """Yield the moves that may preempt the transition where *path* is feasible."""
    for other in move.before:
        if is_satisfiable(f.both(move.enabled, path.when, other.enabled), exploration.domains):
            yield other


def choice_formula(exploration: Exploration, move: Move, path: Path) -> Formula:
    """Return the formula that the choices at pseudostates lead along the path."""
    source_pick = exploration.machine.vertices[move.transition.source].pick
    picks = (pick for pick in path.picked.items() if pick[0] != source_pick)
    return f.both(*(is_chosen_formula(*pick) for pick in picks))


def taken_formula(exploration: Exploration, move: Move, path: Path) -> Formula:
    """Return the formula that the move takes the path in this step."""
    choices = choice_formula(exploration, move, path)
    return remove_redundant(f.both(move.fires, path.when, choices), exploration.domains)


def _effect_formulas(exploration: Exploration, path: Path) -> Iterator[Formula]:
    """Yield the formulas about the next step if the path is taken."""
    for variable, literal in path.entered.items():
        yield f.prime(f.eq(f.var(variable), Const(literal)))
    for name, value in path.values.items():
        yield _equality(exploration, name, value, is_primed=True)
    for name in path.raised:
        yield f.prime(f.var(name))


def _derive_choices(exploration: Exploration) -> Iterator[Conjunct]:
    """Yield, for each state with competing transitions, that an enabled transition is taken."""
    machine = exploration.machine
    for state in machine.list_states():
        if not state.pick:
            continue
        moves = [move for move in exploration.moves if move.transition.source == state.id]
        # ``fires`` contains the primed choice variable. As a premise it would make the conjunct
        # trivially true, so only its unprimed part is used.
        eligibility = [
            f.both(
                *(
                    conjunct
                    for conjunct in f.split_conjunction(move.fires)
                    if not f.has_primes(conjunct)
                )
            )
            for move in moves
        ]
        formula = f.implies(f.either(*eligibility), f.either(*(move.fires for move in moves)))
        origin = element_id(state.id)
        yield Conjunct(formula, Class.SAFETY, origin, texts.describe_choice(machine, state))


# -- frames ------------------------------------------------------------------------------------


def _derive_frames(exploration: Exploration) -> Iterator[Conjunct]:
    machine = exploration.machine
    for region in machine.regions.values():
        yield _derive_frame(exploration, region.variable, lambda path, name: name in path.entered)
    for name in machine.assigned:
        yield _derive_frame(exploration, name, lambda path, name: name in path.values)
    for name in machine.outputs:
        yield _derive_frame(exploration, name, lambda path, name: name in path.raised)
    for vertex in machine.vertices.values():
        if vertex.pick:
            yield _derive_frame(exploration, vertex.pick, lambda path, name: name in path.picked)


def _derive_frame(exploration: Exploration, name: str, touches: Touches) -> Conjunct:
    """Return the frame condition of a variable: what it equals unless a move changes it."""
    change = f.either(*list_changes(exploration, name, touches))
    formula = f.implies(f.negate(change), _frame_formula(exploration, name))
    return Conjunct(
        formula,
        Class.SAFETY,
        _origin_of(exploration, name),
        texts.describe_frame(exploration.machine, name),
    )


def _frame_formula(exploration: Exploration, name: str) -> Formula:
    """Return the formula about the next step if no move changes the variable.

    An output is then false and a choice variable "none"; other variables do not change.
    """
    machine = exploration.machine
    if name in machine.outputs:
        return f.negate(f.prime(f.var(name)))
    if any(vertex.pick == name for vertex in machine.vertices.values()):
        return f.prime(f.eq(f.var(name), Const(NO_EVENT)))
    return _equality(exploration, name, f.var(name), is_primed=True)


def list_changes(exploration: Exploration, name: str, touches: Touches) -> list[Formula]:
    """Return the formulas that a move changes *name*, a variable or an id, in this step."""
    changes: list[Formula] = []
    for move in exploration.moves:
        touching = [path for path in move.paths if touches(path, name)]
        if len(touching) == len(move.paths):
            changes += [move.fires] if touching else []
        else:
            changes += (taken_formula(exploration, move, path) for path in touching)
    return changes


# -- clocks, memories, activities --------------------------------------------------------------


def _derive_clocks(exploration: Exploration) -> Iterator[Conjunct]:
    """Yield the conjuncts about timers.

    A timer counts while its state stays active, up to its bound, and else is 0.
    """
    for state in exploration.machine.list_states():
        if not state.timer:
            continue
        clock, stay = f.var(state.timer), _stay_condition(exploration, state)
        # The bound is the largest time that a transition of the state waits for. Counting further
        # would add states to the contract that no transition distinguishes.
        bound = exploration.domains[state.timer]
        assert isinstance(bound, IntegerDomain)
        is_below = f.compare(Op.LT, clock, Const(bound.high))
        incremented = f.compare(Op.ADD, clock, Const(1))
        is_full = f.eq(clock, Const(bound.high))
        cases = (
            (f.both(stay, is_below), f.eq(f.prime(clock), incremented), texts.CLOCK_RUNS),
            (f.both(stay, is_full), f.eq(f.prime(clock), Const(bound.high)), texts.CLOCK_STOPS),
            (f.negate(stay), f.eq(f.prime(clock), Const(0)), texts.CLOCK_RESETS),
        )
        for case, update, text in cases:
            text = text.format(clock=state.timer, state=state.literal)
            formula = remove_redundant(f.implies(case, update), exploration.domains)
            yield Conjunct(formula, Class.SAFETY, element_id(state.id), text)


def _stay_condition(exploration: Exploration, state: Vertex) -> Formula:
    """Return the condition that a state is active and the step does not leave it."""
    exits = list_changes(exploration, state.id, lambda path, id: id in path.left_states)
    is_active = is_active_formula(exploration.machine, state.id)
    formula = f.both(is_active, *map(f.negate, exits))
    return remove_redundant(formula, exploration.domains)


def _derive_memories(exploration: Exploration) -> Iterator[Conjunct]:
    """Yield the values of memories, history variables and do behaviours."""
    machine = exploration.machine
    for name, memory in machine.memories.items():
        truth = elaborate_condition(memory.condition, machine.scope)
        state = machine.vertices.get(memory.state)
        text = texts.describe_memory(machine, name, truth, state)
        if state is not None:
            has_entered = f.negate(f.var(state.opening)) if state.opening else f.TRUE
            truth = f.both(truth, has_entered, _stay_condition(exploration, state))
            truth = remove_redundant(truth, exploration.domains)
        formula = f.fold_iff(f.prime(f.var(name)), truth)
        yield Conjunct(formula, Class.SAFETY, _origin_of(exploration, name), text)
    for region in machine.regions.values():
        if region.memory:
            yield from _derive_history(exploration, region)
    for state in machine.list_states():
        if state.do:
            formula = f.fold_iff(f.var(state.do), is_active_formula(machine, state.id))
            text = texts.describe_do_behaviour(state)
            yield Conjunct(formula, Class.SAFETY, _origin_of(exploration, state.do), text)


def _derive_history(exploration: Exploration, region: Region) -> Iterator[Conjunct]:
    """Yield the update and the frame condition of the memory of a history pseudostate."""
    origin, next_memory = _origin_of(exploration, region.memory), f.prime(f.var(region.memory))
    is_inactive = f.eq(f.var(region.variable), Const(INACTIVE))
    state = exploration.machine.vertices[region.state].literal
    update = f.implies(f.negate(is_inactive), f.eq(next_memory, f.var(region.variable)))
    text = texts.UPDATES_MEMORY.format(memory=region.memory, region=region.variable)
    yield Conjunct(remove_redundant(update, exploration.domains), Class.SAFETY, origin, text)
    frame = f.implies(is_inactive, f.eq(next_memory, f.var(region.memory)))
    text = texts.KEEPS_MEMORY.format(memory=region.memory, state=state)
    yield Conjunct(frame, Class.SAFETY, origin, text)


def _derive_assumptions(exploration: Exploration) -> Iterator[Conjunct]:
    """Yield the fairness assumption that each running do behaviour ends eventually."""
    for state in exploration.machine.list_states():
        if state.done:
            formula = f.either(f.negate(f.var(state.do)), f.var(state.done))
            origin = element_id(state.id)
            yield Conjunct(formula, Class.LIVENESS, origin, texts.describe_end(state))
