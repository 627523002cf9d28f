"""Reference interpreter of state machines; this docstring defines what one step is.

The interpreter executes the diagram and reads no formulas, so that tests can compare the derived
contracts with it. A trace is a list of valuations. The reaction to the inputs of one step is
visible in the next step:

- In a step the environment provides at most one event (``event``), the values of the properties
  that the machine does not assign, and the Booleans that only it knows. All occurrences of a
  step (event, time, rising condition, completion) are simultaneous.
- A transition is enabled if its source is active, one of its triggers occurs, its guard is
  true, and its path through pseudostates ends in a state. A completion transition is enabled
  while its source is complete: inner regions in final states, do behaviour finished. It goes
  before the triggered transitions of the same source. Inner transitions go before outer ones;
  orthogonal regions react independently, each reading the values before the step.
- Do behaviours assign values before transitions are taken. The guard of a completion transition
  reads these values in the step in which the do behaviour of its source ends.
- The machine's own entry behaviour runs before its first states are entered.
- Taking a transition runs exit behaviours (innermost first), effects and entry behaviours
  (outermost first) in sequence, for each transition on the path: a state is left if the path
  leads out of it, and entered if it leads in. Regions of entered states that the path does not
  enter start with their initial transitions. Guards behind a choice read the values reached
  there, other guards the values before the step. A value outside a range is clamped.
- All transitions that leave a fork are taken, in their order. The transitions that lead to a
  join are one transition: it is enabled if all their sources are complete and nothing inside
  the sources is enabled.
- A history pseudostate leads to the state in which its region was last active; deep history
  restores all states inside it too. If the region was never active, or ended in a final state,
  the pseudostate's own transition is taken, else the region starts.
- A change trigger of UML occurs in a step in which its condition is true and was false in the step
  before. That of SysML v2 also occurs if its condition is true in the first step of each stay in
  its source (``Observation::ObserveChange``), or in the first after an entry that takes time.
- An event that enables nothing is lost. So is an event that coincides with a completion.

UML 2.5.1 clauses 14.2.3.8 and 14.2.3.9; a step is a run-to-completion step.
"""

from collections.abc import Iterator, Mapping
from itertools import product

from sysmlc.logic.contract import IntegerDomain, Owner, Variable
from sysmlc.logic.domains import values
from sysmlc.logic.formula import Literal
from sysmlc.logic.machines.machine import (
    INACTIVE,
    NO_EVENT,
    AfterTicks,
    Machine,
    Occurrence,
    OnChange,
    OnEvent,
    OnInput,
    Transition,
    Vertex,
)
from sysmlc.logic.machines.reaction import (
    Reaction,
    clamp,
    evaluate_expression,
    find_active_vertices,
    is_active,
    last_literal,
    run_actions,
    start_open_regions,
    start_region,
    take_transition,
)

Valuation = dict[str, Literal]


def list_inputs(machine: Machine) -> list[Variable]:
    """List the variables that the environment decides."""
    return [variable for variable in machine.variables if variable.owner is Owner.ENVIRONMENT]


def initial_steps(machine: Machine, inputs: Mapping[str, Literal]) -> list[Valuation]:
    """Return all first steps with these inputs: the initial states are entered.

    A property without a default starts with any value of its domain.
    """
    valuations = [
        complete_valuation(machine, start, reaction, inputs, is_first=True)
        for start in _initial_valuations(machine, inputs)
        for reaction in list_first_reactions(machine, start)
    ]
    return _drop_duplicates(valuations)


def list_first_reactions(machine: Machine, values: Mapping[str, Literal]) -> list[Reaction]:
    """Return the ways to enter the initial states; *values* are those of the properties."""
    inactive = {region.variable: INACTIVE for region in machine.regions.values()}
    runs = [run_actions(machine, Reaction({**inactive, **values}), machine.entry)]
    for region in machine.top:
        started = [
            after for reaction in runs for after in start_region(machine, reaction, None, region)
        ]
        runs = [
            after for reaction in started for after in start_open_regions(machine, reaction, None)
        ]
    return runs


def next_steps(
    machine: Machine, now: Mapping[str, Literal], inputs: Mapping[str, Literal]
) -> list[Valuation]:
    """Return all steps that may follow *now* if the next step has the given inputs."""
    valuations = [
        complete_valuation(machine, now, reaction, inputs, is_first=False)
        for reaction in list_reactions(machine, now, {})
    ]
    return _drop_duplicates(valuations)


# -- before and after --------------------------------------------------------------------------


def _initial_valuations(machine: Machine, inputs: Mapping[str, Literal]) -> Iterator[Valuation]:
    unset_names = [name for name in machine.assigned if name not in machine.initial]
    choices = [values(machine.find_variable(name).domain) for name in unset_names]
    for row in product(*choices):
        yield {**inputs, **machine.initial, **dict(zip(unset_names, row, strict=True))}


def complete_valuation(
    machine: Machine,
    now: Mapping[str, Literal],
    reaction: Reaction,
    inputs: Mapping[str, Literal],
    is_first: bool,
) -> Valuation:
    """Return the valuation after a reaction, with outputs, choices, timers and memories."""
    names = [region.variable for region in machine.regions.values()] + list(machine.assigned)
    after: Valuation = {**inputs, **{name: reaction.store[name] for name in names}}
    after |= {name: name in reaction.raised for name in machine.outputs}
    for state in machine.vertices.values():
        if state.pick:
            after[state.pick] = reaction.picked.get(state.pick, NO_EVENT)
        if state.do:
            after[state.do] = is_active(machine, after, state.id)
        if state.timer:
            after[state.timer] = (
                0 if is_first else _count_ticks(machine, now, after, reaction, state)
            )
    for name, memory in machine.memories.items():
        if memory.state:
            has_waited = not is_first and _has_waited(machine, now, reaction, memory.state)
            after[name] = has_waited and bool(evaluate_expression(machine, memory.condition, now))
            continue
        # The first step has no previous step, and a condition that is true from the start does
        # not rise.
        values = after if is_first else now
        after[name] = bool(evaluate_expression(machine, memory.condition, values))
    for region in machine.regions.values():
        if region.memory:
            after[region.memory] = INACTIVE if is_first else last_literal(now, region)
    return after


def _has_waited(
    machine: Machine, now: Mapping[str, Literal], reaction: Reaction, state_id: str
) -> bool:
    """Whether a state was active before the reaction, has ended its entry, and is not left."""
    state = machine.vertices[state_id]
    is_entering = bool(state.opening and now[state.opening])
    has_stayed = is_active(machine, now, state_id) and state_id not in reaction.left_states
    return has_stayed and not is_entering


def _count_ticks(
    machine: Machine,
    now: Mapping[str, Literal],
    after: Mapping[str, Literal],
    reaction: Reaction,
    state: Vertex,
) -> int:
    """Return the value of the timer of *state* after the reaction."""
    has_stayed = is_active(machine, now, state.id) and state.id not in reaction.left_states
    if not has_stayed or not is_active(machine, after, state.id):
        return 0
    domain = machine.find_variable(state.timer).domain
    return clamp(int(now[state.timer]) + 1, domain) if isinstance(domain, IntegerDomain) else 0


def _drop_duplicates(valuations: list[Valuation]) -> list[Valuation]:
    distinct: list[Valuation] = []
    for valuation in valuations:
        if valuation not in distinct:
            distinct.append(valuation)
    return distinct


# -- which transitions -------------------------------------------------------------------------


def list_reactions(
    machine: Machine, now: Mapping[str, Literal], written: Mapping[str, Literal]
) -> list[Reaction]:
    """Return all combinations of the reactions of active states.

    Orthogonal regions react in the same step, so each combination has one reaction of each.
    *written* are the values that do behaviours assign in this step: effects read them, and guards
    behind a choice or of a completion transition whose do behaviour ends.
    """
    enabled = {
        state.id: options
        for state in machine.list_states()
        if is_active(machine, now, state.id)
        for options in [_list_options(machine, now, state, written)]
        if options
    }
    _apply_joins(machine, now, enabled, written)
    # Inner transitions go before outer ones (UML 2.5.1, 14.2.3.9).
    sources = [
        source
        for source in enabled
        if not any(machine.contains(source, outer) for outer in enabled)
    ]
    before = {**now, **written}
    combined = [Reaction(before)]
    for source in sources:
        combined = [
            _merge_reactions(before, reaction, option)
            for reaction in combined
            for option in enabled[source]
        ]
    return combined


def _apply_joins(
    machine: Machine,
    now: Mapping[str, Literal],
    enabled: dict[str, list[Reaction]],
    written: Mapping[str, Literal],
) -> None:
    """Add the enabled joins to *enabled*.

    A join goes before other transitions that leave its sources or the states around them.
    """
    # Inner joins first: a join that fires disables the joins around it.
    joins = [join for join in machine.list_transitions() if join.join_partners]
    for join in sorted(joins, key=lambda join: -len(machine.list_enclosing_states(join.source))):
        states = [machine.vertices[source] for source in join.sources]
        is_ready = all(
            is_active(machine, now, state.id) and _is_complete(machine, now, state)
            for state in states
        ) and not _is_blocked(machine, now, join)
        inner_sources = [
            inner for inner in enabled for state in states if machine.contains(state.id, inner)
        ]
        options = (
            take_transition(machine, now, join, written) if is_ready and not inner_sources else []
        )
        if options:
            overridden = {
                state_id
                for source in join.sources
                for state_id in (source, *machine.list_enclosing_states(source))
            }
            for state_id in overridden.intersection(enabled):
                del enabled[state_id]
            enabled[join.source] = options


def _merge_reactions(before: Mapping[str, Literal], left: Reaction, right: Reaction) -> Reaction:
    # No variable changes in both: a machine whose orthogonal regions assign the same property is
    # not read (SM426).
    changed = {name: value for name, value in right.store.items() if value != before[name]}
    return Reaction(
        {**left.store, **changed},
        left.raised | right.raised,
        {**left.picked, **right.picked},
        left.left_states | right.left_states,
        (*left.opened, *right.opened),
        assigned=left.assigned | right.assigned,
    )


def _list_options(
    machine: Machine, now: Mapping[str, Literal], state: Vertex, written: Mapping[str, Literal]
) -> list[Reaction]:
    """Return all ways to take a transition that leaves the state."""
    outgoing = [
        transition
        for transition in machine.outgoing.get(state.id, ())
        if not transition.join_partners and not _is_blocked(machine, now, transition)
    ]
    completing = [transition for transition in outgoing if not transition.occurrences]
    if _is_complete(machine, now, state):
        runs = [
            run
            for transition in completing
            for run in take_transition(machine, now, transition, written)
        ]
        if runs:
            return runs
    triggered = [
        transition
        for transition in outgoing
        if _has_occurrence(machine, now, state, transition.occurrences)
    ]
    return [
        run
        for transition in triggered
        for run in take_transition(machine, now, transition, written)
    ]


def _is_blocked(machine: Machine, now: Mapping[str, Literal], transition: Transition) -> bool:
    """Whether an entry or exit behaviour that takes time disables the transition."""
    return any(now[name] for name in machine.list_blockers(transition))


def _is_complete(machine: Machine, now: Mapping[str, Literal], state: Vertex) -> bool:
    has_ended = not state.done or bool(now[state.done])
    return has_ended and all(
        any(vertex.kind == "final" for vertex in find_active_vertices(machine, now, region))
        for region in state.regions
    )


def _has_occurrence(
    machine: Machine,
    now: Mapping[str, Literal],
    state: Vertex,
    occurrences: tuple[Occurrence, ...],
) -> bool:
    for occurrence in occurrences:
        match occurrence:
            case OnEvent(None):
                happens = now["event"] != NO_EVENT
            case OnEvent(literal):
                happens = now["event"] == literal
            case AfterTicks(count):
                # The step that takes the transition is the last tick.
                happens = now[state.timer] == count - 1
            case OnChange(memory, condition):
                is_new = not memory or not now[memory]
                happens = is_new and bool(evaluate_expression(machine, condition, now))
            case OnInput(variable):
                happens = bool(now[variable])
        if happens:
            return True
    return False
