"""Reader of state machines: from the graph to ``Machine``.

The vertices, regions and transitions are read first. The checks of well-formedness and of conflicts
between transitions follow, because they need the complete machine.
"""

from collections.abc import Iterator, Mapping

from msgspec import Struct
from msgspec.structs import replace

from sysmlc.diagnostics import Severity, Sink, rule
from sysmlc.ir import Edge, Element, Graph, Kind, query
from sysmlc.logic.contract import EnumerationDomain, IntegerDomain, Owner, Variable
from sysmlc.logic.expressions.context import context_of
from sysmlc.logic.expressions.parsing import GuardTerms
from sysmlc.logic.feature_writes import Sharing, WriterIndex
from sysmlc.logic.identifiers import Names, spell_name
from sysmlc.logic.machines.actions import ReadingContext, read_behaviours
from sysmlc.logic.machines.conflicts import (
    GuardComparison,
    TooManyValuationsError,
    are_regions_independent,
    list_competing,
    may_compete,
    report_lost_events,
)
from sysmlc.logic.machines.descriptions import list_names
from sysmlc.logic.machines.machine import NO_EVENT, Machine, Transition, element_id
from sysmlc.logic.machines.supported_constructs import is_supported
from sysmlc.logic.machines.transitions import combine_joins, read_transitions
from sysmlc.logic.machines.vertices import MachineDraft, add_history_memories, read_regions
from sysmlc.logic.machines.well_formedness import has_valid_targets, is_well_formed

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
    "transitions {transitions} can leave '{vertex}' in the same step; the contract leaves open "
    "which of them does",
    help="give them guards that exclude each other if it matters",
)


class MachineOptions(Struct, frozen=True):
    """Length of a step in seconds, and the range of Integer properties without a range."""

    tick_seconds: float = 1.0
    assumed_range: tuple[int, int] = (0, 15)


def find_context_classifier(graph: Graph, behaviour: Element) -> Element | None:
    """Return the classifier in which names of *behaviour* are resolved.

    It is the innermost classifier around the behaviour that is not a behaviour itself. Without one,
    it is the behaviour.
    """
    for ancestor in graph.ancestors(behaviour):
        if ancestor.kind in query.CLASSIFIERS and ancestor.kind not in query.BEHAVIORS:
            return ancestor
    return behaviour if behaviour.kind in query.BEHAVIORS else None


def read_machine(
    graph: Graph,
    machine: Element,
    sink: Sink,
    options: MachineOptions | None = None,
    writers: WriterIndex | None = None,
    classifier: Element | None = None,
) -> Machine | None:
    """Read a state machine; return None if something in it cannot be derived.

    Every fault is reported. A feature that another behaviour of *writers* writes becomes an input;
    without *writers* only the machine itself is searched for writers. *classifier* is the type of
    the object that has the machine, if it inherits the machine.
    """
    if not is_supported(graph, machine, sink):
        return None
    classifier = classifier or find_context_classifier(graph, machine)
    sharing = Sharing(graph, machine, writers, classifier)
    draft = _start_draft(graph, sharing, sink, options or MachineOptions())
    draft.entry = read_behaviours(draft.reading, machine, Edge.ENTRY)
    top = read_regions(draft, machine, "", machine)
    add_history_memories(draft)
    read_transitions(draft)
    raw_machine = _assemble(draft, top)
    # combine_joins removes completion transitions from raw_machine, but their sources still need an
    # input for the end of their do behaviours.
    completion_sources = {
        transition.source
        for transition in raw_machine.list_transitions()
        if not transition.occurrences
    }
    if not (
        has_valid_targets(graph, raw_machine, sink) and combine_joins(graph, raw_machine, sink)
    ):
        return None
    comparison = GuardComparison(raw_machine.scope, draft.reading.context.facts)
    try:
        _add_state_variables(draft, raw_machine, completion_sources, comparison)
        # Assembled again, because competing transitions, which need choice variables, can only be
        # found in a complete machine.
        result = _assemble(draft, top)
        if not is_well_formed(graph, result, sink):
            return None
        if not are_regions_independent(graph, result, comparison, sink):
            return None
        report_lost_events(graph, result, comparison, sink)
    except TooManyValuationsError:
        sink.report(TOO_MANY_GUARDS, graph.subject(machine), machine=machine.name)
        return None
    return result


def _start_draft(
    graph: Graph, sharing: Sharing, sink: Sink, options: MachineOptions
) -> MachineDraft:
    machine = sharing.machine
    context = context_of(graph, sharing.classifier, options.assumed_range, machine)
    reserved = [*context.variables.values(), *context.features]
    # No auxiliary variable may have the name of a property, which ``find_symbol`` finds last.
    names = Names("event", NO_EVENT, *reserved)
    return MachineDraft(
        ReadingContext(graph, sink, context, names, options.tick_seconds, sharing), machine
    )


# -- the whole ---------------------------------------------------------------------------------


def _add_state_variables(
    draft: MachineDraft, machine: Machine, completing: set[str], comparison: GuardComparison
) -> None:
    """Add timers, inputs for ends of do behaviours, and choice variables to the vertices.

    *completing* has the sources of completion transitions.
    """
    reading = draft.reading
    for id, vertex in tuple(draft.vertices.items()):
        outgoing = draft.outgoing.get(id, ())
        element = draft.element(id)
        name = element.name or vertex.kind
        timer, done, pick = vertex.timer, vertex.done, vertex.pick
        if id in draft.bounds:
            domain = IntegerDomain(0, draft.bounds[id])
            timer = reading.variable_for(
                f"timer {id}", f"ticks_{name}", Owner.SYSTEM, domain, element.id
            )
        if vertex.do and id in completing:
            done_name = vertex.do.replace("do_", "done_", 1)
            done = reading.input_for(f"end {id}", done_name, element.id)
        if not machine.has_concurrent_exits(id) and may_compete(outgoing, vertex, comparison):
            pick = _add_choice_variable(draft, id, name, outgoing, comparison)
        if timer or done or pick:
            draft.vertices[id] = replace(vertex, timer=timer, done=done, pick=pick)


def _add_choice_variable(
    draft: MachineDraft,
    id: str,
    name: str,
    outgoing: tuple[Transition, ...],
    comparison: GuardComparison,
) -> str:
    """Create the variable that names the transition taken at a vertex.

    Report the transitions that compete there.
    """
    reading = draft.reading
    literals = tuple(transition.literal for transition in outgoing)
    domain = EnumerationDomain((NO_EVENT, *literals))
    pick = reading.variable_for(f"pick {id}", f"taken_{name}", Owner.SYSTEM, domain, element_id(id))
    vertex = draft.vertices[id]
    terms = {
        t.id: GuardTerms.read(str(draft.element(t.id).attrs.get("guard", ""))) for t in outgoing
    }
    for finding, by_one_occurrence in ((NONDETERMINISTIC, True), (COINCIDING, False)):
        competing = list_competing(
            outgoing, vertex, comparison, terms=terms, by_one_occurrence=by_one_occurrence
        )
        if competing:
            names = list_names(competing, draft.vertices)
            subject = reading.graph.subject(draft.element(id))
            reading.sink.report(finding, subject, transitions=names, vertex=name)
            break
    return pick


def _assemble(draft: MachineDraft, top: tuple[str, ...]) -> Machine:
    reading = draft.reading
    features = {feature.variable: feature for feature in reading.context.features.values()}
    assigned = tuple(name for name in features if name in reading.assigned_variables)
    defaults = {name: features[name].default for name in assigned}
    properties = _property_variables(reading)
    assumed = [variable.name for variable in properties if variable.is_range_assumed]
    machine = Machine(
        draft.machine.id,
        draft.machine.name,
        (*_event_variable(draft), *properties, *reading.auxiliary.values()),
        draft.vertices,
        draft.regions,
        draft.outgoing,
        top,
        reading.find_symbol,
        {name: value for name, value in defaults.items() if value is not None},
        tuple(reading.output_names),
        assigned,
        tuple(name for name in assigned if name in assumed),
        draft.memories,
        reads={
            target: tuple(name for name in names if name in assumed)
            for target, names in reading.reads.items()
        },
        entry=draft.entry,
    )
    names = name_regions(reading.graph, machine)
    regions = {
        id: replace(region, wording=names.get(region.variable, ""))
        for id, region in machine.regions.items()
    }
    return replace(machine, regions=regions)


def _event_variable(draft: MachineDraft) -> tuple[Variable, ...]:
    if not draft.events:
        return ()
    domain = EnumerationDomain((NO_EVENT, *draft.events.values()))
    return (Variable("event", Owner.ENVIRONMENT, domain, draft.machine.id),)


def _property_variables(reading: ReadingContext) -> list[Variable]:
    """List the variables of the properties that the machine reads or assigns."""
    variables: list[Variable] = []
    for feature in reading.context.features.values():
        is_assigned = feature.variable in reading.assigned_variables
        is_read = feature.variable in reading.read_variables and not feature.is_constant
        if feature.domain is not None and (is_assigned or is_read):
            owner = Owner.SYSTEM if is_assigned else Owner.ENVIRONMENT
            variables.append(feature.make_variable(owner))
    return variables


# -- names of regions ------------------------------------------------------------------------------


def name_regions(graph: Graph, machine: Machine) -> Mapping[str, str]:
    """Return the shortest unambiguous name of each region, by its variable."""
    owner = graph.owner(graph[machine.id])
    siblings = [] if owner is None else graph.owned(owner)
    is_only = sum(element.kind is Kind.STATE_MACHINE for element in siblings) <= 1
    variables: dict[str, set[str]] = {}
    for name, variable in iter_region_names(graph, machine, is_only):
        variables.setdefault(name, set()).add(variable)
    return choose_shortest(
        (variable, name)
        for name, denoted in variables.items()
        for variable in denoted
        if len(denoted) == 1
    )


def choose_shortest(spellings: Iterator[tuple[str, str]]) -> dict[str, str]:
    """Return for each variable its name with the fewest dots, of these the shortest, first one."""
    shortest: dict[str, str] = {}
    for variable, name in spellings:
        names = (shortest.get(variable, name), name)
        shortest[variable] = min(names, key=lambda name: (name.count("."), len(name)))
    return shortest


def iter_region_names(graph: Graph, machine: Machine, is_only: bool) -> Iterator[tuple[str, str]]:
    """Yield each name of a region, seen from the owner of the machine, with its variable.

    *is_only* is true if the owner has no second machine.
    """
    regions, machine_name = machine.regions, spell_name(machine.name)
    for id in machine.top:
        variable = regions[id].variable
        if len(machine.top) == 1:
            yield f"{machine_name}.state", variable
            if is_only:
                yield "state", variable
        else:
            region = spell_name(graph[element_id(id)].name)
            yield f"{region}.state", variable
            yield f"{machine_name}.{region}.state", variable
    for state in machine.list_states():
        for id in state.regions:
            for path in _list_region_paths(graph, machine, id):
                yield f"{path}.state", regions[id].variable
                yield f"{machine_name}.{path}.state", regions[id].variable


def _list_region_paths(graph: Graph, machine: Machine, region: str) -> list[str]:
    """Return the paths of a region in a state: its own name, from its state on, and the whole path.

    A region that is the only one of its state has the name of the state.
    """
    levels = list(_iter_levels(graph, machine, region))[::-1]
    state, name = levels[-1]
    states = [state for state, _ in levels if state]
    whole = [part for level in levels for part in level if part]
    paths = ([name], [state, name], whole, [*states, name])
    return list(dict.fromkeys(".".join(filter(None, path)) for path in paths if any(path)))


def _iter_levels(graph: Graph, machine: Machine, region: str) -> Iterator[tuple[str, str]]:
    """Yield the names of the state and the region at each level around a region, inside out.

    A region without siblings has no name, and a region of the machine no state.
    """
    vertices = machine.vertices
    id = region
    while id:
        state = machine.regions[id].state
        siblings = vertices[state].regions if state else machine.top
        name = spell_name(graph[element_id(id)].name) if len(siblings) > 1 else ""
        yield spell_name(graph[element_id(state)].name) if state else "", name
        id = vertices[state].region if state else ""
