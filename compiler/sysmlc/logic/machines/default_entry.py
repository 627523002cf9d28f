"""Default entry of nested regions: a region is entered although no transition names a vertex in it.

It then starts with its initial transition. A region that all transitions enter at one of its
vertices needs no initial pseudostate (UML 2.5.1, 14.2.3.2 and 14.2.3.4.5).
"""

from collections.abc import Iterator

from sysmlc.diagnostics import Sink
from sysmlc.ir import Graph
from sysmlc.logic.machines.machine import HISTORIES, Machine, Region, Transition, element_id
from sysmlc.logic.machines.supported_constructs import describe_missing_start, report_bad_start


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
