"""Well-formedness of state machines.

The checks concern transition targets, dead ends, cycles of pseudostates, forks and joins,
and regions that are entered by default.
"""

from collections.abc import Iterator
from itertools import combinations

from sysmlc.diagnostics import Severity, Sink, rule
from sysmlc.ir import Edge, Graph
from sysmlc.logic.machines.machine import HISTORIES, Machine, Region, Transition, element_id
from sysmlc.logic.machines.supported_constructs import (
    NOT_DERIVED,
    describe_missing_start,
    report_bad_start,
)

PSEUDO_CYCLE = rule(
    "SM424",
    "pseudostate-cycle",
    Severity.ERROR,
    "pseudostate '{vertex}' leads back to itself without a state between",
    help="put a state into the cycle",
)
DEAD_END = rule(
    "SM425",
    "pseudostate-without-exit",
    Severity.ERROR,
    "{kind} '{vertex}' has no outgoing transition",
)
STRAY = rule(
    "SM431",
    "transition-out-of-reach",
    Severity.WARNING,
    "transition '{transition}' leads {where}; the component gets no contract",
    help="let the transition end at a vertex that it may reach",
)


MALFORMED = rule(
    "SM504",
    "malformed-fork-or-join",
    Severity.ERROR,
    "{kind} '{vertex}': {reason}",
    help=(
        "let its transitions lead to, or from, states in different regions of one state, "
        "without guards and triggers"
    ),
)


def has_valid_targets(graph: Graph, machine: Machine, sink: Sink) -> bool:
    """Whether every transition leads to a vertex of the machine; report the others."""
    return not list(_report_foreign_targets(graph, machine, sink))


def is_well_formed(graph: Graph, machine: Machine, sink: Sink) -> bool:
    """Whether the machine passes the other checks; report the faults."""
    if [*_report_dead_ends(graph, machine, sink), *_report_cycles(graph, machine, sink)]:
        return False
    if [*_report_strays(graph, machine, sink), *_report_malformed(graph, machine, sink)]:
        return False
    return can_start_regions(graph, machine, sink)


def _report_foreign_targets(graph: Graph, machine: Machine, sink: Sink) -> Iterator[str]:
    """Report transitions to a target outside this machine. Yield their ids."""
    for transition in machine.list_transitions():
        if transition.target in machine.vertices:
            continue
        target = graph.get(element_id(transition.target))
        if target is not None and target.subkind == "exit-point" and target.owner == machine.id:
            what = f"the end at exit point '{target.name}'"
            subject = graph.subject(graph[element_id(transition.id)])
            sink.report(NOT_DERIVED, subject, what=what, machine=graph[machine.id].name)
            yield transition.id
        else:
            where = "to a vertex outside of this machine"
            yield _report_stray(graph, transition, where, sink)


def _report_stray(graph: Graph, transition: Transition, where: str, sink: Sink) -> str:
    subject = graph.subject(graph[element_id(transition.id)])
    sink.report(STRAY, subject, transition=transition.words, where=where)
    return transition.id


def _report_strays(graph: Graph, machine: Machine, sink: Sink) -> Iterator[str]:
    """Report transitions that leave a region although UML forbids it. Yield their ids.

    UML forbids transitions between regions of the machine, and transitions from an initial or
    history pseudostate to a vertex outside its region.
    """
    for transition in machine.list_transitions():
        source = machine.vertices[transition.source]
        if machine.find_main_region(transition) is None:
            yield _report_stray(graph, transition, "out of its region", sink)
        elif source.kind == "initial" or source.kind in HISTORIES:
            targets = _list_stable_targets(machine, transition)
            if not all(source.region in machine.list_enclosing_regions(end) for end in targets):
                yield _report_stray(graph, transition, "out of its region", sink)


def _report_dead_ends(graph: Graph, machine: Machine, sink: Sink) -> Iterator[str]:
    """Report pseudostates without outgoing transition. Yield their ids.

    A history pseudostate needs none: its region starts by default. ``can_start_regions`` checks the
    initial pseudostates of nested regions.
    """
    for vertex in machine.vertices.values():
        is_nested_start = vertex.kind == "initial" and machine.regions[vertex.region].state != ""
        is_transient = not (vertex.is_stable or vertex.kind in HISTORIES or is_nested_start)
        if not is_transient or machine.outgoing.get(vertex.id):
            continue
        element = graph[element_id(vertex.id)]
        name = element.name or vertex.kind
        if vertex.kind not in ("entry-point", "exit-point"):
            sink.report(DEAD_END, graph.subject(element), kind=vertex.kind, vertex=name)
            yield vertex.id
        elif graph.sources(element, Edge.FLOW_TARGET):
            # UML states constraints on the transitions of the other pseudostates only (14.5.6).
            what = f"{vertex.kind.replace('-', ' ')} '{name}' without outgoing transition"
            machine_name = graph[machine.id].name
            sink.report(NOT_DERIVED, graph.subject(element), what=what, machine=machine_name)
            yield vertex.id


def _report_cycles(graph: Graph, machine: Machine, sink: Sink) -> Iterator[str]:
    """Report pseudostates that lie on a cycle of pseudostates. Yield their ids."""
    for vertex in machine.vertices.values():
        if not vertex.is_stable and vertex.id in _reachable_pseudostates(machine, vertex.id):
            element = graph[element_id(vertex.id)]
            name = element.name or vertex.kind
            sink.report(PSEUDO_CYCLE, graph.subject(element), vertex=name)
            yield vertex.id


def _reachable_pseudostates(machine: Machine, start: str) -> dict[str, None]:
    """Return the pseudostates that are reachable from *start* through pseudostates alone."""
    pseudostates: dict[str, None] = {}
    worklist = [start]
    while worklist:
        for transition in machine.outgoing.get(worklist.pop(), ()):
            target = machine.vertices.get(transition.target)
            if target is not None and not target.is_stable and target.id not in pseudostates:
                pseudostates[target.id] = None
                worklist.append(target.id)
    return pseudostates


def collect_segments(machine: Machine, first: Transition) -> list[Transition]:
    """List the segments of a compound transition.

    These are the first transition, its join partners, and all transitions behind pseudostates.
    """
    transitions = [first, *first.join_partners]
    if first.kind == "internal" or machine.vertices[first.target].is_stable:
        return transitions
    for id in (first.target, *_reachable_pseudostates(machine, first.target)):
        transitions += (
            transition
            for transition in machine.outgoing.get(id, ())
            if transition not in transitions
        )
    return transitions


def _list_stable_targets(machine: Machine, transition: Transition) -> list[str]:
    """List the stable vertices to which the compound transition can lead."""
    targets = (segment.target for segment in collect_segments(machine, transition))
    return [segment for segment in dict.fromkeys(targets) if machine.vertices[segment].is_stable]


# -- forks and joins -----------------------------------------------------------------------------


def _report_malformed(graph: Graph, machine: Machine, sink: Sink) -> Iterator[str]:
    """Report forks and joins that violate UML 2.5.1, 14.5.11. Yield their ids."""
    for vertex in machine.vertices.values():
        reason = ""
        if vertex.kind == "fork":
            reason = _explain_bad_fork(machine, machine.outgoing[vertex.id])
        elif vertex.kind == "join":
            reason = _explain_bad_join(machine, machine.list_incoming(vertex.id))
            if not reason and len(machine.outgoing[vertex.id]) != 1:
                reason = "more than one transition leaves it"
        if reason:
            element = graph[element_id(vertex.id)]
            name = element.name or vertex.kind
            sink.report(
                MALFORMED, graph.subject(element), kind=vertex.kind, vertex=name, reason=reason
            )
            yield vertex.id


def _explain_bad_fork(machine: Machine, outgoing: tuple[Transition, ...]) -> str:
    """Return why the transitions of a fork are invalid, or an empty text."""
    if any(transition.guard is not None for transition in outgoing):
        return "a transition that leaves it has a guard"
    if not _are_orthogonal(machine, [transition.target for transition in outgoing]):
        return "its transitions do not lead to different regions of one state"
    return ""


def _explain_bad_join(machine: Machine, incoming: list[Transition]) -> str:
    """Return why the transitions that lead to a join are invalid, or an empty text."""
    if any(machine.vertices[transition.source].kind != "state" for transition in incoming):
        return "a transition leads to it from a vertex that is not a state"
    if any(transition.guard is not None or transition.occurrences for transition in incoming):
        return "a transition that leads to it has a guard or a trigger"
    if not _are_orthogonal(machine, [transition.source for transition in incoming]):
        return "its transitions do not come from different regions of one state"
    return ""


def _are_orthogonal(machine: Machine, vertices: list[str]) -> bool:
    """Whether the vertices lie in different regions of one state."""
    states = [find_common_state(machine, *pair) for pair in combinations(vertices, 2)]
    return None not in states and len(set(states)) <= 1


def find_common_state(machine: Machine, left: str, right: str) -> str | None:
    """Return the state that contains both vertices in two different regions.

    The result is empty if the two regions belong to the machine itself. It is None if no state has
    the vertices in different regions.
    """
    if machine.contains(left, right) or machine.contains(right, left):
        return None
    chains = [
        {
            machine.regions[region].state: region
            for region in reversed(machine.list_enclosing_regions(start))
        }
        for start in (left, right)
    ]
    for region in machine.list_enclosing_regions(left):
        state = machine.regions[region].state
        if state in chains[1]:
            return state if chains[1][state] != region else None
    return None


# -- regions that are entered by default -----------------------------------------------------------


def can_start_regions(graph: Graph, machine: Machine, sink: Sink) -> bool:
    """Whether each nested region that is entered by default has an initial transition.

    Report the others. The machine must have passed the other checks of well-formedness.
    """
    faulty: set[str] = set()
    for region in machine.regions.values():
        element = graph[element_id(region.id)]
        if not region.state or machine.outgoing.get(region.initial) or element.id in faulty:
            continue
        entry = next(_describe_default_entries(machine, region), "")
        if entry:
            fault = f"{describe_missing_start(graph, element)}, but {entry} enters it by default"
            report_bad_start(graph, element, fault, sink)
            # Copies of a submachine share their regions.
            faulty.add(element.id)
    return not faulty


def _describe_default_entries(machine: Machine, region: Region) -> Iterator[str]:
    """Yield a description of each transition and history that enters the region by default."""
    for transition in machine.list_transitions():
        is_entered = region.state in _list_entered_states(machine, transition)
        if is_entered and region.id not in _collect_named_regions(machine, transition):
            yield f"transition '{transition.words}'"
    outer_region = machine.vertices[region.state].region
    for vertex in machine.vertices.values():
        # A shallow history enters the stored state by default. A history without a transition
        # starts its region if no state is stored (14.2.3.7).
        is_above = vertex.kind == "shallow-history" and vertex.region == outer_region
        is_inside = vertex.kind in HISTORIES and vertex.region == region.id
        if is_above or (is_inside and not machine.outgoing.get(vertex.id)):
            yield f"a {vertex.kind.replace('-', ' ')} pseudostate"


def _list_entered_states(machine: Machine, transition: Transition) -> list[str]:
    """List the states that the transition enters, without those behind pseudostates."""
    main_region = machine.find_main_region(transition)
    if not main_region:
        return []
    states = machine.list_enclosing_states(transition.target)
    if machine.vertices[transition.target].kind == "state":
        states.append(transition.target)
    return [state for state in states if main_region in machine.list_enclosing_regions(state)]


def _collect_named_regions(machine: Machine, transition: Transition) -> frozenset[str]:
    """Return the regions that contain an end of the compound transition."""
    is_parallel = machine.has_concurrent_exits(transition.source)
    segments = machine.outgoing[transition.source] if is_parallel else (transition,)
    return frozenset().union(*(_collect_regions_behind(machine, s.target) for s in segments))


def _collect_regions_behind(machine: Machine, vertex: str) -> frozenset[str]:
    """Return the regions that are certainly reached at *vertex* and the pseudostates behind it."""
    regions = frozenset(machine.list_enclosing_regions(vertex))
    outgoing = machine.outgoing.get(vertex, ())
    kind = machine.vertices[vertex]
    if kind.is_stable or kind.kind in HISTORIES or not outgoing:
        return regions
    branches = [_collect_regions_behind(machine, transition.target) for transition in outgoing]
    if machine.has_concurrent_exits(vertex):
        return regions.union(*branches)
    return regions | branches[0].intersection(*branches)
