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
  (outermost first) in sequence. Guards behind a choice read the values reached there, other
  guards those before the transition. Values that would leave a range stop at its bound.
- An event that enables nothing is lost. So is one that comes with a completion.

UML 2.5.1 clauses 14.2.3.8 and 14.2.3.9; one step a run to completion.
"""

from collections.abc import Callable, Iterator, Mapping, Sequence
from dataclasses import field
from itertools import product

from sysmlc.logic.contract import IntegerDomain, Owner, Variable
from sysmlc.logic.domains import values
from sysmlc.logic.formula import Literal
from sysmlc.logic.machines.machine import (
    INACTIVE,
    NO_EVENT,
    Action,
    AfterTicks,
    Assign,
    Machine,
    Occurrence,
    OnEvent,
    OnRise,
    Raise,
    Transition,
    Vertex,
    WhenTold,
)
from sysmlc.logic.machines.step_values import value_of
from sysmlc.values import dataclass, replace

Valuation = dict[str, Literal]


@dataclass(frozen=True, slots=True)
class _Run:
    """How far the reaction has come; ``store`` has the values reached, regions included."""

    store: Mapping[str, Literal]
    raised: frozenset[str] = frozenset()
    picked: Mapping[str, str] = field(default_factory=dict)
    left: frozenset[str] = frozenset()

    def put(self, name: str, value: Literal) -> "_Run":
        return replace(self, store={**self.store, name: value})

    def pick(self, name: str, literal: str) -> "_Run":
        return replace(self, picked={**self.picked, name: literal})


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
        runs = [_Run(before)]
        for region in machine.top:
            runs = [after for run in runs for after in _enter_default(machine, run, region)]
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
    run: _Run,
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
            after[state.do] = _is_active(machine, after, state.id)
        if state.timer:
            after[state.timer] = 0 if first else _ticks(machine, now, after, run, state)
    for name, condition in machine.memories.items():
        after[name] = bool(value_of(machine, condition, after if first else now))
    return after


def _ticks(
    machine: Machine,
    now: Mapping[str, Literal],
    after: Mapping[str, Literal],
    run: _Run,
    state: Vertex,
) -> int:
    stays = _is_active(machine, now, state.id) and state.id not in run.left
    if not stays or not _is_active(machine, after, state.id):
        return 0
    domain = machine.variable(state.timer).domain
    return _bounded(int(now[state.timer]) + 1, domain) if isinstance(domain, IntegerDomain) else 0


def _is_active(machine: Machine, store: Mapping[str, Literal], vertex: str) -> bool:
    one = machine.vertices[vertex]
    return store[machine.regions[one.region].variable] == one.literal and one.is_stable


def _distinct(found: list[Valuation]) -> list[Valuation]:
    kept: list[Valuation] = []
    for one in found:
        if one not in kept:
            kept.append(one)
    return kept


# -- which transitions -------------------------------------------------------------------------


def _reactions(machine: Machine, now: Mapping[str, Literal]) -> list[_Run]:
    enabled = {
        state.id: options
        for state in machine.states()
        if _is_active(machine, now, state.id)
        for options in [_options(machine, now, state)]
        if options
    }
    sources = [one for one in enabled if not any(machine.contains(one, other) for other in enabled)]
    combined = [_Run(now)]
    for source in sources:
        combined = [_merge(now, one, two) for one in combined for two in enabled[source]]
    return combined


def _merge(before: Mapping[str, Literal], one: _Run, two: _Run) -> _Run:
    changed = {name: value for name, value in two.store.items() if value != before[name]}
    return _Run(
        {**one.store, **changed},
        one.raised | two.raised,
        {**one.picked, **two.picked},
        one.left | two.left,
    )


def _options(machine: Machine, now: Mapping[str, Literal], state: Vertex) -> list[_Run]:
    """All ways to take a transition that leaves the state."""
    outgoing = machine.outgoing.get(state.id, ())
    completing = [one for one in outgoing if not one.occurrences]
    if _is_complete(machine, now, state):
        found = [run for one in completing for run in _take(machine, now, one)]
        if found:
            return found
    triggered = [one for one in outgoing if _occurs(machine, now, state, one.occurrences)]
    return [run for one in triggered for run in _take(machine, now, one)]


def _is_complete(machine: Machine, now: Mapping[str, Literal], state: Vertex) -> bool:
    ended = not state.done or bool(now[state.done])
    return ended and all(_is_final(machine, now, region) for region in state.regions)


def _is_final(machine: Machine, now: Mapping[str, Literal], region: str) -> bool:
    return any(one.kind == "final" for one in _active(machine, now, region))


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


# -- taking a transition -----------------------------------------------------------------------


def _take(machine: Machine, now: Mapping[str, Literal], first: Transition) -> list[_Run]:
    found: list[_Run] = []
    for trail in _trails(machine, first):
        end = trail[-1].target
        region = machine.main_region(first.source, end, first.kind)
        begun = _Run(now) if not region else _leave(machine, _Run(now), region)
        passed = _pass(machine, begun, trail, now)
        if passed is None:
            continue
        found += [passed] if not region else _enter(machine, passed, region, end)
    return found


def _trails(machine: Machine, first: Transition) -> Iterator[tuple[Transition, ...]]:
    """All ways on from a transition, through pseudostates, to a stable vertex."""
    if first.kind == "internal" or machine.vertices[first.target].is_stable:
        yield (first,)
        return
    for following in machine.outgoing[first.target]:
        for rest in _trails(machine, following):
            yield (first, *rest)


def _pass(
    machine: Machine, run: _Run, trail: tuple[Transition, ...], now: Mapping[str, Literal]
) -> _Run | None:
    """The run after the effects of a trail, or None when a guard on the way is false."""
    seen = now
    for one in trail:
        source = machine.vertices[one.source]
        if source.kind == "choice":
            seen = run.store
        if one.guard is not None and not value_of(machine, one.guard, seen):
            return None
        if source.pick:
            run = run.pick(source.pick, one.literal)
        run = _act(machine, run, one.effect)
    return run


def _leave(machine: Machine, run: _Run, region: str) -> _Run:
    """Leave what is active in a region, innermost first."""
    for vertex in _active(machine, run.store, region):
        for inner in vertex.regions:
            run = _leave(machine, run, inner)
        run = _act(machine, run, vertex.exit)
        run = replace(run, left=run.left | {vertex.id})
    return run.put(machine.regions[region].variable, INACTIVE)


def _active(machine: Machine, store: Mapping[str, Literal], region: str) -> list[Vertex]:
    literal = store[machine.regions[region].variable]
    inside = [one for one in machine.vertices.values() if one.region == region]
    return [one for one in inside if one.is_stable and one.literal == literal]


def _enter(machine: Machine, run: _Run, region: str, target: str) -> list[_Run]:
    """Enter states from the region down to the target, outermost first, then what is in it."""
    chain = [target, *machine.above(target)]
    state = machine.vertices[next(one for one in chain if machine.vertices[one].region == region)]
    entered = run.put(machine.regions[region].variable, state.literal)
    runs = [_act(machine, entered, state.entry)]
    for inner in state.regions:
        holds_target = any(machine.vertices[one].region == inner for one in chain)
        runs = [
            after
            for one in runs
            for after in (
                _enter(machine, one, inner, target)
                if holds_target
                else _enter_default(machine, one, inner)
            )
        ]
    return runs


def _enter_default(machine: Machine, run: _Run, region: str) -> list[_Run]:
    found: list[_Run] = []
    for first in machine.outgoing[machine.regions[region].initial]:
        for trail in _trails(machine, first):
            passed = _pass(machine, run, trail, run.store)
            if passed is not None:
                found += _enter(machine, passed, region, trail[-1].target)
    return found


def _act(machine: Machine, run: _Run, actions: tuple[Action, ...]) -> _Run:
    for action in actions:
        match action:
            case Raise(output):
                run = replace(run, raised=run.raised | {output})
            case Assign(variable, expression):
                value = value_of(machine, expression, run.store)
                domain = machine.variable(variable).domain
                if isinstance(domain, IntegerDomain):
                    value = _bounded(int(value), domain)
                run = run.put(variable, value)
    return run


def _bounded(value: int, domain: IntegerDomain) -> int:
    return max(domain.low, min(domain.high, value))
