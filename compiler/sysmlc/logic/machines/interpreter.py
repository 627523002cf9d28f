"""Reference interpreter of state machines: what one step of a diagram is.

It runs what is drawn and knows nothing of formulas: it is the judge of the derivation.
A trace is a list of valuations. The reaction to the inputs of one step is seen in the next:

- In a step the environment gives at most one event (``event``), the values of the properties
  that the machine does not assign, and the Booleans that only it knows. All occurrences of a
  step (event, time, rising condition, completion) are simultaneous.
- A transition is enabled when its source is active, one of its triggers occurs, its guard is
  true, and its way through pseudostates ends in a state. A completion transition is enabled
  while its source is complete: inner regions in final states, do behaviour done; it goes
  before the triggered transitions of the same source. Inner transitions go before outer ones;
  orthogonal regions react independently, each reading the values before the step.
- Taking a transition runs exit behaviours (innermost first), effects, entry behaviours
  (outermost first) in sequence, for each transition on the way: a state is left when the way
  leads out of it, and entered when it leads in. Regions of entered states to which no way leads
  start by themselves. Guards behind a choice read the values reached there, other guards those
  before the transition. Values that would leave a range stop at its bound.
- All transitions that leave a fork are taken, in their order. Those that lead to a join are one
  transition: enabled when all their sources are complete and nothing inside them is enabled.
- A history pseudostate leads to the state that its region was in when it was last active, a
  deep one to all that was active in it; where it never was, or was in a final state, its own
  transition is taken, else the region starts by itself.
- An event that enables nothing is lost. So is one that comes with a completion.

UML 2.5.1 clauses 14.2.3.8 and 14.2.3.9; one step a run to completion.
"""

from collections.abc import Callable, Iterator, Mapping, Sequence
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
    OnEvent,
    OnRise,
    Vertex,
    WhenTold,
)
from sysmlc.logic.machines.reaction import (
    Run,
    active_in,
    begin,
    bounded,
    fill,
    is_active,
    last_of,
    take,
    value_of,
)

Valuation = dict[str, Literal]


def inputs_of(machine: Machine) -> list[Variable]:
    """The variables that the environment decides."""
    return [one for one in machine.variables if one.owner is Owner.ENVIRONMENT]


def initial(machine: Machine, inputs: Mapping[str, Literal]) -> list[Valuation]:
    """All first steps with these inputs: the initial states entered.

    A property without default value starts with any value of its domain.
    """
    found: list[Valuation] = []
    for start in _starts(machine, inputs):
        before = _inactive(machine) | start
        runs = [Run(before)]
        for region in machine.top:
            begun = [after for run in runs for after in begin(machine, run, None, region)]
            runs = [after for run in begun for after in fill(machine, run, None)]
        found += [_settle(machine, before, run, inputs, first=True) for run in runs]
    return _distinct(found)


def successors(
    machine: Machine, now: Mapping[str, Literal], inputs: Mapping[str, Literal]
) -> list[Valuation]:
    """All steps that may follow ``now`` when the next step has these inputs."""
    runs = [_settle(machine, now, run, inputs, first=False) for run in _reactions(machine, now)]
    return _distinct(runs)


def run(
    machine: Machine,
    inputs: Sequence[Mapping[str, Literal]],
    choose: Callable[[list[Valuation]], Valuation] = lambda options: options[0],
) -> list[Valuation]:
    """One trace over the inputs; ``choose`` decides what the diagram leaves open."""
    trace = [choose(initial(machine, inputs[0]))] if inputs else []
    for following in inputs[1:]:
        trace.append(choose(successors(machine, trace[-1], following)))
    return trace


# -- before and after --------------------------------------------------------------------------


def _starts(machine: Machine, inputs: Mapping[str, Literal]) -> Iterator[Valuation]:
    open_names = [name for name in machine.assigned if name not in machine.initial]
    choices = [values(machine.variable(name).domain) for name in open_names]
    for row in product(*choices):
        yield {**inputs, **machine.initial, **dict(zip(open_names, row, strict=True))}


def _inactive(machine: Machine) -> Valuation:
    return {region.variable: INACTIVE for region in machine.regions.values()}


def _settle(
    machine: Machine,
    now: Mapping[str, Literal],
    run: Run,
    inputs: Mapping[str, Literal],
    first: bool,
) -> Valuation:
    """The valuation after a reaction, with outputs, choices, timers and memories."""
    names = [region.variable for region in machine.regions.values()] + list(machine.assigned)
    after: Valuation = {**inputs, **{name: run.store[name] for name in names}}
    after |= {name: name in run.raised for name in machine.outputs}
    for state in machine.vertices.values():
        if state.pick:
            after[state.pick] = run.picked.get(state.pick, NO_EVENT)
        if state.do:
            after[state.do] = is_active(machine, after, state.id)
        if state.timer:
            after[state.timer] = 0 if first else _ticks(machine, now, after, run, state)
    for name, condition in machine.memories.items():
        after[name] = bool(value_of(machine, condition, after if first else now))
    for region in machine.regions.values():
        if region.memory:
            after[region.memory] = INACTIVE if first else last_of(now, region)
    return after


def _ticks(
    machine: Machine,
    now: Mapping[str, Literal],
    after: Mapping[str, Literal],
    run: Run,
    state: Vertex,
) -> int:
    stays = is_active(machine, now, state.id) and state.id not in run.left
    if not stays or not is_active(machine, after, state.id):
        return 0
    domain = machine.variable(state.timer).domain
    return bounded(int(now[state.timer]) + 1, domain) if isinstance(domain, IntegerDomain) else 0


def _distinct(found: list[Valuation]) -> list[Valuation]:
    kept: list[Valuation] = []
    for one in found:
        if one not in kept:
            kept.append(one)
    return kept


# -- which transitions -------------------------------------------------------------------------


def _reactions(machine: Machine, now: Mapping[str, Literal]) -> list[Run]:
    enabled = {
        state.id: options
        for state in machine.states()
        if is_active(machine, now, state.id)
        for options in [_options(machine, now, state)]
        if options
    }
    _let_join(machine, now, enabled)
    sources = [one for one in enabled if not any(machine.contains(one, other) for other in enabled)]
    combined = [Run(now)]
    for source in sources:
        combined = [_merge(now, one, two) for one in combined for two in enabled[source]]
    return combined


def _let_join(machine: Machine, now: Mapping[str, Literal], enabled: dict[str, list[Run]]) -> None:
    """What is joined goes before what else leaves its sources and the states around them."""
    joined = [one for one in machine.transitions() if one.also]
    for one in sorted(joined, key=lambda each: -len(machine.above(each.source))):
        states = [machine.vertices[source] for source in one.sources]
        is_ready = all(
            is_active(machine, now, state.id) and _is_complete(machine, now, state)
            for state in states
        )
        inside = [o for o in enabled for state in states if machine.contains(state.id, o)]
        runs = take(machine, now, one) if is_ready and not inside else []
        if runs:
            later = {each for s in one.sources for each in (s, *machine.above(s))}
            for each in later.intersection(enabled):
                del enabled[each]
            enabled[one.source] = runs


def _merge(before: Mapping[str, Literal], one: Run, two: Run) -> Run:
    changed = {name: value for name, value in two.store.items() if value != before[name]}
    return Run(
        {**one.store, **changed},
        one.raised | two.raised,
        {**one.picked, **two.picked},
        one.left | two.left,
    )


def _options(machine: Machine, now: Mapping[str, Literal], state: Vertex) -> list[Run]:
    """All ways to take a transition that leaves the state."""
    outgoing = [one for one in machine.outgoing.get(state.id, ()) if not one.also]
    completing = [one for one in outgoing if not one.occurrences]
    if _is_complete(machine, now, state):
        found = [run for one in completing for run in take(machine, now, one)]
        if found:
            return found
    triggered = [one for one in outgoing if _occurs(machine, now, state, one.occurrences)]
    return [run for one in triggered for run in take(machine, now, one)]


def _is_complete(machine: Machine, now: Mapping[str, Literal], state: Vertex) -> bool:
    ended = not state.done or bool(now[state.done])
    return ended and all(_is_final(machine, now, region) for region in state.regions)


def _is_final(machine: Machine, now: Mapping[str, Literal], region: str) -> bool:
    return any(one.kind == "final" for one in active_in(machine, now, region))


def _occurs(
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
                happens = now[state.timer] == count - 1
            case OnRise(memory, condition):
                happens = bool(value_of(machine, condition, now)) and not now[memory]
            case WhenTold(variable):
                happens = bool(now[variable])
        if happens:
            return True
    return False
