"""What the drawing of a state machine says before anything runs: competition, races, cycles."""

from collections.abc import Iterator
from itertools import combinations

from sysmlc.diagnostics import Severity, Sink, rule
from sysmlc.ir import Graph
from sysmlc.logic import domains, samples
from sysmlc.logic import formula as f
from sysmlc.logic.contract import Domain
from sysmlc.logic.evaluate import is_true
from sysmlc.logic.expressions.elaborate import Scope, condition
from sysmlc.logic.expressions.expression import Expression, name_of
from sysmlc.logic.formula import Formula
from sysmlc.logic.machines.actions import walk
from sysmlc.logic.machines.machine import AfterTicks, Assign, Machine, OnEvent, Transition, Vertex
from sysmlc.logic.samples import arrow, choice, machine, machine_of


def _two_regions(first: str, second: str) -> str:
    return machine_of(
        samples.region(
            "r", samples.state("a"), arrow("i", "a"), arrow("a", "a", first, effect="level := 1")
        ),
        samples.region(
            "q", samples.state("b"), arrow("qi", "b"), arrow("b", "b", second, effect="level := 2")
        ),
    )


def _leaving(on: str) -> str:
    inner = (
        samples.region("s", samples.state("d"), arrow("si", "d"), arrow("d", "b", on)),
        samples.region(
            "t", samples.state("e"), arrow("ti", "e"), arrow("e", "e", "start", "ready")
        ),
    )
    return machine_of(
        samples.region("r", samples.state("a", *inner), samples.state("b"), arrow("i", "a"))
    )


PSEUDO_CYCLE = rule(
    "SM424",
    "pseudostate-cycle",
    Severity.ERROR,
    "pseudostate '{vertex}' leads back to itself without a state between",
    why="A step would never end.",
    help="put a state into the cycle",
    wrong=machine(
        *(choice("x"), choice("y")),
        *(arrow("a", "x", "start"), arrow("x", "y"), arrow("y", "x", guard="ready")),
        arrow("y", "b", guard="else"),
    ),
    right=machine(
        *(choice("x"), choice("y")),
        *(arrow("a", "x", "start"), arrow("x", "y"), arrow("y", "a", guard="ready")),
        arrow("y", "b", guard="else"),
    ),
)
DEAD_END = rule(
    "SM425",
    "pseudostate-without-exit",
    Severity.ERROR,
    "{kind} '{vertex}' has no outgoing transition",
    why="A step cannot end in a pseudostate.",
    wrong=machine(choice("x"), arrow("a", "x", "start")),
    right=machine(choice("x"), arrow("a", "x", "start"), arrow("x", "b")),
)
RACE = rule(
    "SM426",
    "race",
    Severity.WARNING,
    "'{first}' and '{second}' of orthogonal regions can both assign '{variable}' in one step; "
    "the component gets no contract",
    why="Nothing in the diagram orders the two assignments.",
    help="assign the property in one region only, or on different events",
    wrong=_two_regions("start", "start"),
    right=_two_regions("start", "stop"),
)
CROSSING = rule(
    "SM427",
    "exit-from-orthogonal-state",
    Severity.WARNING,
    "'{first}' leaves an orthogonal state while '{second}' can be taken in another of its "
    "regions; the component gets no contract",
    why="Nothing in the diagram says which of the two is taken.",
    help="draw the transition from the border of the orthogonal state, or use another event",
    wrong=_leaving("start"),
    right=_leaving("stop"),
)

STRAY = rule(
    "SM431",
    "transition-out-of-reach",
    Severity.WARNING,
    "transition '{transition}' leads {where}; the component gets no contract",
    why="A transition stays in its machine and does not jump between regions of the machine; "
    "an initial transition stays in its region (UML 2.5.1, 14.5.8 and 14.5.11).",
    help="let the transition end at a vertex that it may reach",
    wrong=machine_of(
        samples.region("r", samples.state("a"), arrow("i", "a"), arrow("a", "b", "start")),
        samples.region("q", samples.state("b"), arrow("qi", "b")),
    ),
    right=machine_of(
        samples.region("r", samples.state("a"), arrow("i", "a"), arrow("a", "a", "start")),
        samples.region("q", samples.state("b"), arrow("qi", "b")),
    ),
)

_LIMIT = 4096
"""Valuations tried to see whether two guards exclude one another; more count as possible."""


def may_compete(outgoing: tuple[Transition, ...], vertex: Vertex, scope: Scope) -> bool:
    """Whether two transitions that leave the vertex can be enabled at once."""
    if vertex.kind == "initial":
        return False
    is_state = vertex.kind == "state"
    return any(
        (not is_state or coincide(one, other)) and compatible(one, other, scope)
        for one, other in combinations(outgoing, 2)
    )


def have_common_cause(outgoing: tuple[Transition, ...], vertex: Vertex, scope: Scope) -> bool:
    """Whether two of them can be enabled by one and the same occurrence."""
    return any(
        (vertex.kind != "state" or _have_same_trigger(one, other)) and compatible(one, other, scope)
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


def compatible(one: Transition, other: Transition, scope: Scope) -> bool:
    """Whether some values of the variables satisfy both guards."""
    guards = [guard for guard in (one.guard, other.guard) if guard is not None]
    return is_satisfiable(f.both(*(condition(guard, scope) for guard in guards)), guards, scope)


def is_satisfiable(formula: Formula, sources: list[Expression], scope: Scope) -> bool:
    """Whether some values make it true; beyond the limit of valuations the answer is yes."""
    if formula == f.FALSE:
        return False
    found = dict(_domains(sources, scope))
    if domains.count(found) > _LIMIT:
        return True
    return any(is_true(formula, values) for values in domains.valuations(found))


def _domains(sources: list[Expression], scope: Scope) -> Iterator[tuple[str, Domain]]:
    for source in sources:
        for part in walk(source):
            name = name_of(part)
            symbol = None if name is None else scope(name)
            if symbol is not None and symbol.domain is not None:
                yield from ((v.name, symbol.domain) for v in f.variables(symbol.formula))


def is_derivable(graph: Graph, machine: Machine, sink: Sink) -> bool:
    """Whether every step has a meaning; what stands against it is reported."""
    if list(_strangers(graph, machine, sink)):
        return False
    if [*_dead_ends(graph, machine, sink), *_cycles(graph, machine, sink)]:
        return False
    if list(_strays(graph, machine, sink)):
        return False
    return not [*_races(graph, machine, sink), *_crossings(graph, machine, sink)]


def _strangers(graph: Graph, machine: Machine, sink: Sink) -> Iterator[str]:
    """Transitions to what is no vertex of a region of this machine."""
    for one in machine.transitions():
        if one.target not in machine.vertices:
            subject = graph.subject(graph[one.id])
            where = "to what is in no region of this machine"
            sink.report(STRAY, subject, transition=one.words, where=where)
            yield one.id


def _strays(graph: Graph, machine: Machine, sink: Sink) -> Iterator[str]:
    """Transitions between regions of the machine, and initial ones out of their region."""
    for one in machine.transitions():
        source = machine.vertices[one.source]
        if source.is_stable or source.kind == "initial":
            ends = [one.source] if one.kind == "internal" else ends_of(machine, one)
            if not all(_may_reach(machine, source, end) for end in ends):
                subject = graph.subject(graph[one.id])
                where = "out of its region"
                sink.report(STRAY, subject, transition=one.words, where=where)
                yield one.id


def _may_reach(machine: Machine, source: Vertex, end: str) -> bool:
    inside = {machine.vertices[one].region for one in [end, *machine.above(end)]}
    if source.kind == "initial":
        return source.region in inside
    around = [machine.vertices[one].region for one in [source.id, *machine.above(source.id)]]
    return not inside.isdisjoint(around)


def _dead_ends(graph: Graph, machine: Machine, sink: Sink) -> Iterator[str]:
    for vertex in machine.vertices.values():
        if not vertex.is_stable and not machine.outgoing.get(vertex.id):
            element = graph[vertex.id]
            name = element.name or vertex.kind
            sink.report(DEAD_END, graph.subject(element), kind=vertex.kind, vertex=name)
            yield vertex.id


def _cycles(graph: Graph, machine: Machine, sink: Sink) -> Iterator[str]:
    for vertex in machine.vertices.values():
        if not vertex.is_stable and vertex.id in _beyond(machine, vertex.id):
            element = graph[vertex.id]
            name = element.name or vertex.kind
            sink.report(PSEUDO_CYCLE, graph.subject(element), vertex=name)
            yield vertex.id


def _beyond(machine: Machine, start: str) -> set[str]:
    """Pseudostates that can be reached through pseudostates."""
    found: set[str] = set()
    waiting = [start]
    while waiting:
        for one in machine.outgoing.get(waiting.pop(), ()):
            target = machine.vertices.get(one.target)
            if target is not None and not target.is_stable and target.id not in found:
                found.add(target.id)
                waiting.append(target.id)
    return found


def ends_of(machine: Machine, transition: Transition) -> list[str]:
    """Stable vertices to which a transition can lead, through pseudostates."""
    reached = [transition.target, *sorted(_beyond(machine, transition.target))]
    stops: dict[str, None] = {}
    for id in reached:
        if machine.vertices[id].is_stable:
            stops[id] = None
        else:
            targets = (one.target for one in machine.outgoing.get(id, ()))
            stops.update(dict.fromkeys(t for t in targets if machine.vertices[t].is_stable))
    return list(stops)


# -- orthogonal regions ------------------------------------------------------------------------


def _orthogonal_pairs(machine: Machine) -> Iterator[tuple[Transition, Transition, str]]:
    """Pairs whose sources can be active at once, with the state above both (or empty)."""
    sources = [one for one in machine.transitions() if machine.vertices[one.source].kind == "state"]
    for one, other in combinations(sources, 2):
        common = _common_state(machine, one.source, other.source)
        if common is not None and simultaneous(one, other):
            yield one, other, common


def _common_state(machine: Machine, one: str, other: str) -> str | None:
    """The state (empty: the machine) in different regions of which the two lie, else None."""
    if machine.contains(one, other) or machine.contains(other, one):
        return None
    chains = [
        {
            machine.regions[machine.vertices[v].region].state: machine.vertices[v].region
            for v in [start, *machine.above(start)]
        }
        for start in (one, other)
    ]
    for state, region in chains[0].items():
        if state in chains[1]:
            return state if chains[1][state] != region else None
    return None


def _races(graph: Graph, machine: Machine, sink: Sink) -> Iterator[str]:
    for one, other, _ in _orthogonal_pairs(machine):
        shared = [v for v in _touched(machine, one) if v in _touched(machine, other)]
        if shared and compatible(one, other, machine.scope):
            subject = graph.subject(graph[one.id])
            sink.report(RACE, subject, first=one.words, second=other.words, variable=shared[0])
            yield one.id


def _touched(machine: Machine, transition: Transition) -> dict[str, None]:
    """Properties that may be assigned when the transition is taken; no less, maybe more."""
    actions = list(transition.effect)
    reach = [transition.target, *sorted(_beyond(machine, transition.target))]
    for id in reach:
        if not machine.vertices[id].is_stable:
            actions += [a for one in machine.outgoing.get(id, ()) for a in one.effect]
    region = machine.vertices[transition.source].region
    for state in machine.states():
        if state.region == region or region in _regions_above(machine, state.id):
            actions += [*state.entry, *state.exit]
    return dict.fromkeys(action.variable for action in actions if isinstance(action, Assign))


def _regions_above(machine: Machine, vertex: str) -> list[str]:
    return [machine.vertices[one].region for one in machine.above(vertex)]


def _crossings(graph: Graph, machine: Machine, sink: Sink) -> Iterator[str]:
    for one, other, state in _orthogonal_pairs(machine):
        for leaver, stayer in ((one, other), (other, one)):
            if _leaves(machine, leaver, state) and compatible(one, other, machine.scope):
                subject = graph.subject(graph[leaver.id])
                sink.report(CROSSING, subject, first=leaver.words, second=stayer.words)
                yield leaver.id


def _leaves(machine: Machine, transition: Transition, state: str) -> bool:
    """Whether taking the transition can leave the state, that is, change what is around it."""
    if not state or transition.kind == "internal":
        return False
    changed = [
        machine.main_region(transition.source, end, transition.kind)
        for end in ends_of(machine, transition)
    ]
    owners = [machine.regions[region].state for region in changed]
    return any(
        owner != state and not (owner and machine.contains(state, owner)) for owner in owners
    )
