"""From the graph to ``Machine``: vertices, regions, transitions and their variables."""

from sysmlc.diagnostics import Severity, Sink, rule
from sysmlc.ir import Edge, Element, Graph, Kind, query
from sysmlc.logic.contract import (
    BooleanDomain,
    EnumerationDomain,
    IntegerDomain,
    Owner,
    Variable,
)
from sysmlc.logic.expressions.context import context_of
from sysmlc.logic.expressions.expression import Binary, Expression, Unary
from sysmlc.logic.expressions.expression import Literal as Written
from sysmlc.logic.machines.actions import (
    Reading,
    read_behaviours,
    read_condition,
)
from sysmlc.logic.machines.checks import have_common_cause, is_derivable, may_compete
from sysmlc.logic.machines.machine import (
    INACTIVE,
    NO_EVENT,
    Machine,
    Region,
    Transition,
    Vertex,
)
from sysmlc.logic.machines.overrides import report_overrides
from sysmlc.logic.machines.support import initial_of, is_supported
from sysmlc.logic.machines.triggers import Parts, occurrence_of
from sysmlc.logic.names import Names, identifier, unique
from sysmlc.logic.samples import arrow, machine
from sysmlc.values import dataclass, replace

NONDETERMINISTIC = rule(
    "SM422",
    "competing-transitions",
    Severity.WARNING,
    "transitions {transitions} that leave '{vertex}' can be enabled at once",
    why="The diagram leaves open which one is taken; the contract keeps that open, and "
    "output '{pick}' says what was chosen.",
    help="make the guards exclude one another",
    wrong=machine(arrow("a", "b", "start", "ready"), arrow("a", "a", "start", "level > 2")),
    right=machine(arrow("a", "b", "start", "ready"), arrow("a", "a", "start", "not ready")),
)
COINCIDING = rule(
    "SM432",
    "coinciding-triggers",
    Severity.INFO,
    "transitions {transitions} that leave '{vertex}' have triggers that can occur in one step",
    why="Nothing orders what happens within a step; the contract keeps open which transition is "
    "taken, and output '{pick}' says what was chosen.",
    wrong=machine(arrow("a", "b", "start"), arrow("a", "a", after="after 2 s")),
    right=machine(arrow("a", "b", "start"), arrow("a", "a", "stop")),
)


@dataclass(frozen=True, slots=True)
class MachineOptions:
    """Length of a step in seconds, and the range of Integers that have none."""

    tick_seconds: float = 1.0
    assumed_range: tuple[int, int] = (0, 15)


def context_classifier(graph: Graph, behaviour: Element) -> Element | None:
    """The classifier in which a behaviour's names are resolved: the nearest that is none."""
    for above in graph.ancestors(behaviour):
        if above.kind in query.CLASSIFIERS and above.kind not in query.BEHAVIORS:
            return above
    return behaviour if behaviour.kind in query.BEHAVIORS else None


def read_machine(
    graph: Graph, machine: Element, sink: Sink, options: MachineOptions | None = None
) -> Machine | None:
    """The state machine as values, or None when something in it is not derived.

    Everything that is missing or wrong is reported.
    """
    options = options or MachineOptions()
    if not is_supported(graph, machine, sink):
        return None
    parts = _start(graph, machine, sink, options)
    top = _read_regions(parts, machine, "")
    _read_transitions(parts)
    _complete_states(parts)
    made = _assemble(parts, top)
    if not is_derivable(graph, made, sink):
        return None
    report_overrides(graph, made, sink)
    return made


def _start(graph: Graph, machine: Element, sink: Sink, options: MachineOptions) -> Parts:
    found = context_classifier(graph, machine)
    context = context_of(graph, found, options.assumed_range, machine)
    taken = [one.variable for one in context.features.values()] + list(context.features)
    names = Names("event", NO_EVENT, *taken)
    return Parts(Reading(graph, sink, context, names, options.tick_seconds), machine)


# -- vertices ----------------------------------------------------------------------------------


def _read_regions(parts: Parts, owner: Element, state: str) -> tuple[str, ...]:
    graph = parts.reading.graph
    found = [
        one
        for one in graph.owned(owner)
        if one.kind is Kind.REGION and initial_of(graph, one) is not None
    ]
    for region in found:
        alone = len(found) == 1
        _read_region(parts, region, state, _region_name(owner, region, state, alone))
    return tuple(region.id for region in found)


def _region_name(owner: Element, region: Element, state: str, alone: bool) -> str:
    own = "state" if alone else region.name or "state"
    return f"{identifier(owner.name)}_{own}" if state else own


def _read_region(parts: Parts, region: Element, state: str, name: str) -> None:
    graph = parts.reading.graph
    kinds = (Kind.STATE, Kind.FINAL_STATE, Kind.PSEUDOSTATE)
    vertices = [one for one in graph.owned(region) if one.kind in kinds]
    stable = [one for one in vertices if one.kind is not Kind.PSEUDOSTATE]
    fallbacks = [
        one.name or ("final" if one.kind is Kind.FINAL_STATE else "state") for one in stable
    ]
    literals = unique(fallbacks, "state", INACTIVE)
    domain = EnumerationDomain((*((INACTIVE,) if state else ()), *literals))
    variable = parts.reading.make(f"region {region.id}", name, Owner.SYSTEM, domain, region.id)
    initial = initial_of(graph, region)
    parts.regions[region.id] = Region(
        region.id, variable, state, initial.id if initial else "", tuple(v.id for v in vertices)
    )
    names = dict(zip((one.id for one in stable), literals, strict=True))
    for vertex in vertices:
        _read_vertex(parts, vertex, region.id, names.get(vertex.id, ""))


def _read_vertex(parts: Parts, element: Element, region: str, literal: str) -> None:
    if element.kind is not Kind.STATE:
        kind = "final" if element.kind is Kind.FINAL_STATE else element.subkind
        parts.vertices[element.id] = Vertex(element.id, kind, literal, region)
        return
    parts.vertices[element.id] = Vertex(
        element.id,
        "state",
        literal,
        region,
        entry=read_behaviours(parts.reading, element, Edge.ENTRY),
        exit=read_behaviours(parts.reading, element, Edge.EXIT),
        do=_read_do(parts, element),
    )
    for one in parts.reading.graph.owned(element):
        if one.kind is Kind.PSEUDOSTATE:
            parts.vertices[one.id] = Vertex(one.id, one.subkind, "", region)
    inner = _read_regions(parts, element, element.id)
    parts.vertices[element.id] = replace(parts.vertices[element.id], regions=inner)


def _read_do(parts: Parts, state: Element) -> str:
    behaviour = parts.reading.graph.target(state, Edge.DO)
    if behaviour is None:
        return ""
    name = behaviour.name or str(behaviour.attrs.get("body", "")) or state.name
    key, domain = f"do {state.id}", BooleanDomain()
    return parts.reading.make(key, f"do_{name}", Owner.SYSTEM, domain, behaviour.id)


# -- transitions -------------------------------------------------------------------------------


def _read_transitions(parts: Parts) -> None:
    graph = parts.reading.graph
    for vertex in tuple(parts.vertices.values()):
        element = graph[vertex.id]
        drawn = graph.sources(element, Edge.FLOW_SOURCE)
        drawn = [one for one in drawn if one.kind is Kind.TRANSITION]
        literals = unique([_label(graph, one) for one in drawn], "transition", NO_EVENT)
        read = [
            _read_transition(parts, one, vertex, literal)
            for one, literal in zip(drawn, literals, strict=True)
        ]
        if read:
            parts.outgoing[vertex.id] = _without_else(graph, read)


def _label(graph: Graph, transition: Element) -> str:
    target = graph.target(transition, Edge.FLOW_TARGET)
    return transition.name or f"to_{target.name if target and target.name else 'next'}"


def _read_transition(parts: Parts, element: Element, vertex: Vertex, literal: str) -> Transition:
    graph = parts.reading.graph
    text = _guard_text(graph, element)
    guard = None
    if text and text.strip() != "else":
        guard = read_condition(parts.reading, text.strip(), "guard", element)
    triggers = graph.targets(element, Edge.TRIGGER) if vertex.kind == "state" else []
    target = graph.target(element, Edge.FLOW_TARGET)
    return Transition(
        element.id,
        literal,
        _words(graph, element, text),
        vertex.id,
        target.id if target else "",
        element.subkind or "external",
        tuple(occurrence_of(parts, trigger, vertex) for trigger in triggers),
        guard,
        read_behaviours(parts.reading, element, Edge.EFFECT),
    )


def _guard_text(graph: Graph, transition: Element) -> str:
    text = transition.attrs.get("guard")
    if isinstance(text, str) and text.strip():
        return text
    constraint = graph.target(transition, Edge.GUARD)
    return "" if constraint is None else str(constraint.attrs.get("body", ""))


def _words(graph: Graph, transition: Element, guard: str) -> str:
    ends = [graph.target(transition, edge) for edge in (Edge.FLOW_SOURCE, Edge.FLOW_TARGET)]
    names = [end.name or end.subkind or str(end.kind) for end in ends if end is not None]
    condition = f" [{guard.strip()}]" if guard.strip() else ""
    return " to ".join(names) + condition


def _without_else(graph: Graph, drawn: list[Transition]) -> tuple[Transition, ...]:
    """The same with ``else`` written out as the negation of the other guards."""
    return tuple(
        replace(one, guard=_negated(one, drawn)) if _is_else(graph, one) else one for one in drawn
    )


def _is_else(graph: Graph, transition: Transition) -> bool:
    return _guard_text(graph, graph[transition.id]).strip() == "else"


def _negated(transition: Transition, drawn: list[Transition]) -> Expression | None:
    guards: list[Expression] = [
        one.guard or Written(True)
        for one in drawn
        if one is not transition and _share_occurrence(one, transition)
    ]
    if not guards:
        return None
    joined = guards[0]
    for guard in guards[1:]:
        joined = Binary("or", joined, guard)
    return Unary("not", joined)


def _share_occurrence(left: Transition, right: Transition) -> bool:
    same = set(left.occurrences) & set(right.occurrences)
    return bool(same) or (not left.occurrences and not right.occurrences)


# -- the whole ---------------------------------------------------------------------------------


def _complete_states(parts: Parts) -> None:
    """Give states and branching pseudostates the variables that their transitions need."""
    graph, reading = parts.reading.graph, parts.reading
    for id, vertex in tuple(parts.vertices.items()):
        outgoing = parts.outgoing.get(id, ())
        name = graph[id].name or vertex.kind
        changes: dict[str, str] = {}
        if id in parts.bounds:
            domain = IntegerDomain(0, parts.bounds[id])
            changes["timer"] = reading.make(
                f"timer {id}", f"ticks_{name}", Owner.SYSTEM, domain, id
            )
        if vertex.do and any(not one.occurrences for one in outgoing):
            changes["done"] = reading.told(f"end {id}", vertex.do.replace("do_", "done_", 1), id)
        if may_compete(outgoing, vertex, reading.scope):
            changes["pick"] = _pick(parts, id, name, outgoing)
        parts.vertices[id] = _with(vertex, changes)


def _with(vertex: Vertex, changes: dict[str, str]) -> Vertex:
    return Vertex(
        vertex.id,
        vertex.kind,
        vertex.literal,
        vertex.region,
        vertex.regions,
        vertex.entry,
        vertex.exit,
        vertex.do,
        changes.get("done", ""),
        changes.get("timer", ""),
        changes.get("pick", ""),
    )


def _pick(parts: Parts, id: str, name: str, outgoing: tuple[Transition, ...]) -> str:
    reading = parts.reading
    literals = tuple(one.literal for one in outgoing)
    domain = EnumerationDomain((NO_EVENT, *literals))
    pick = reading.make(f"pick {id}", f"taken_{name}", Owner.SYSTEM, domain, id)
    named = ", ".join(f"'{one.words}'" for one in outgoing)
    subject = reading.graph.subject(reading.graph[id])
    same = have_common_cause(outgoing, parts.vertices[id], reading.scope)
    broken = NONDETERMINISTIC if same else COINCIDING
    reading.sink.report(broken, subject, transitions=named, vertex=name, pick=pick)
    return pick


def _assemble(parts: Parts, top: tuple[str, ...]) -> Machine:
    reading = parts.reading
    features = {one.variable: one for one in reading.context.features.values()}
    assigned = tuple(name for name in features if name in reading.assigned)
    defaults = {name: features[name].default for name in assigned}
    return Machine(
        parts.machine.id,
        parts.machine.name,
        (*_event_variable(parts), *_properties(reading), *reading.made.values()),
        parts.vertices,
        parts.regions,
        parts.outgoing,
        top,
        reading.scope,
        {name: value for name, value in defaults.items() if value is not None},
        tuple(reading.outputs),
        assigned,
        parts.memories,
    )


def _event_variable(parts: Parts) -> tuple[Variable, ...]:
    if not parts.events:
        return ()
    domain = EnumerationDomain((NO_EVENT, *parts.events.values()))
    return (Variable("event", Owner.ENVIRONMENT, domain, parts.machine.id),)


def _properties(reading: Reading) -> list[Variable]:
    found: list[Variable] = []
    for feature in reading.context.features.values():
        is_assigned = feature.variable in reading.assigned
        is_read = feature.variable in reading.used and not feature.constant
        if feature.domain is not None and (is_assigned or is_read):
            owner = Owner.SYSTEM if is_assigned else Owner.ENVIRONMENT
            found.append(Variable(feature.variable, owner, feature.domain, feature.element.id))
    return found
