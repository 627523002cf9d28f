"""From the graph to ``Machine``: vertices, regions, transitions and their variables."""

from msgspec import Struct
from msgspec.structs import replace

from sysmlc.diagnostics import Severity, Sink, rule
from sysmlc.ir import Element, Graph, query
from sysmlc.logic.contract import EnumerationDomain, IntegerDomain, Owner, Variable
from sysmlc.logic.expressions.context import context_of
from sysmlc.logic.machines.actions import Reading, Sharing
from sysmlc.logic.machines.conflicts import (
    GuardComparison,
    TooManyValuationsError,
    have_common_cause,
    is_undisturbed,
    may_compete,
    report_overrides,
)
from sysmlc.logic.machines.machine import NO_EVENT, Machine, Transition, element_id
from sysmlc.logic.machines.supported_constructs import is_supported
from sysmlc.logic.machines.transitions import join_up, read_transitions
from sysmlc.logic.machines.vertices import Parts, read_regions, remember
from sysmlc.logic.machines.well_formedness import has_ends, is_well_formed
from sysmlc.logic.names import Names
from sysmlc.logic.writers import Writers

NONDETERMINISTIC = rule(
    "SM422",
    "competing-transitions",
    Severity.WARNING,
    "transitions {transitions} that leave '{vertex}' can be enabled at once",
    help="make the guards exclude one another",
)
TOO_MANY_GUARDS = rule(
    "SM485",
    "too-many-guards-to-compare",
    Severity.WARNING,
    "the guards of '{machine}' have too many combinations of values to be compared; the component "
    "gets no contract",
    help="make the ranges of the variables smaller, use different events, or split the machine",
)
COINCIDING = rule(
    "SM432",
    "coinciding-triggers",
    Severity.INFO,
    "transitions {transitions} that leave '{vertex}' have triggers that can occur in one step",
)


class MachineOptions(Struct, frozen=True):
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
    graph: Graph,
    machine: Element,
    sink: Sink,
    options: MachineOptions | None = None,
    writers: Writers | None = None,
) -> Machine | None:
    """The state machine as values, or None when something in it is not derived.

    Everything that is missing or wrong is reported. What others of the ``writers`` write, too, is
    the environment's; without them the machine alone is looked at.
    """
    if not is_supported(graph, machine, sink):
        return None
    sharing = Sharing(graph, machine, writers)
    parts = _start(graph, sharing, sink, options or MachineOptions())
    top = read_regions(parts, machine, "", machine)
    remember(parts)
    read_transitions(parts)
    drawn = _assemble(parts, top)
    completing = {one.source for one in drawn.transitions() if not one.occurrences}
    if not (has_ends(graph, drawn, sink) and join_up(graph, drawn, sink)):
        return None
    comparison = GuardComparison(drawn.scope)
    try:
        _complete_states(parts, drawn, completing, comparison)
        made = _assemble(parts, top)
        if not is_well_formed(graph, made, sink):
            return None
        if not is_undisturbed(graph, made, comparison, sink):
            return None
        report_overrides(graph, made, comparison, sink)
    except TooManyValuationsError:
        sink.report(TOO_MANY_GUARDS, graph.subject(machine), machine=machine.name)
        return None
    return made


def _start(graph: Graph, sharing: Sharing, sink: Sink, options: MachineOptions) -> Parts:
    machine = sharing.machine
    found = context_classifier(graph, machine)
    context = context_of(graph, found, options.assumed_range, machine)
    taken = [*context.variables.values(), *context.features]
    names = Names("event", NO_EVENT, *taken)
    return Parts(Reading(graph, sink, context, names, options.tick_seconds, sharing), machine)


# -- the whole ---------------------------------------------------------------------------------


def _complete_states(
    parts: Parts, machine: Machine, completing: set[str], comparison: GuardComparison
) -> None:
    """Give states and branching pseudostates the variables that their transitions need.

    ``completing`` are the vertices that something leaves when they are complete.
    """
    reading = parts.reading
    for id, vertex in tuple(parts.vertices.items()):
        outgoing = parts.outgoing.get(id, ())
        element = parts.element(id)
        name = element.name or vertex.kind
        timer, done, pick = vertex.timer, vertex.done, vertex.pick
        if id in parts.bounds:
            domain = IntegerDomain(0, parts.bounds[id])
            timer = reading.make(f"timer {id}", f"ticks_{name}", Owner.SYSTEM, domain, element.id)
        if vertex.do and id in completing:
            told = vertex.do.replace("do_", "done_", 1)
            done = reading.told(f"end {id}", told, element.id)
        if not machine.is_split(id) and may_compete(outgoing, vertex, comparison):
            pick = _pick(parts, id, name, outgoing, comparison)
        if timer or done or pick:
            parts.vertices[id] = replace(vertex, timer=timer, done=done, pick=pick)


def _pick(
    parts: Parts,
    id: str,
    name: str,
    outgoing: tuple[Transition, ...],
    comparison: GuardComparison,
) -> str:
    reading = parts.reading
    literals = tuple(one.literal for one in outgoing)
    domain = EnumerationDomain((NO_EVENT, *literals))
    pick = reading.make(f"pick {id}", f"taken_{name}", Owner.SYSTEM, domain, element_id(id))
    named = ", ".join(f"'{one.words}'" for one in outgoing)
    subject = reading.graph.subject(parts.element(id))
    same = have_common_cause(outgoing, parts.vertices[id], comparison)
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
