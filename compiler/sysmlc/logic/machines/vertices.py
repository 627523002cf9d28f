"""Vertices and regions of a state machine, with those of the submachines of its states."""

from dataclasses import dataclass, field

from msgspec.structs import replace

from sysmlc.ir import Edge, Element, Graph, Kind
from sysmlc.logic.contract import BooleanDomain, EnumerationDomain, Owner
from sysmlc.logic.expressions.expression import Expression
from sysmlc.logic.machines.actions import ReadingContext, read_behaviours
from sysmlc.logic.machines.machine import (
    INACTIVE,
    Region,
    Transition,
    Vertex,
    element_id,
    submachine_id,
)
from sysmlc.logic.machines.supported_constructs import find_initial, find_submachine
from sysmlc.logic.names import identifier, make_unique


@dataclass(slots=True)
class MachineDraft:
    """The state machine while it is read."""

    reading: ReadingContext
    machine: Element
    vertices: dict[str, Vertex] = field(default_factory=dict)
    regions: dict[str, Region] = field(default_factory=dict)
    outgoing: dict[str, tuple[Transition, ...]] = field(default_factory=dict)
    events: dict[str, str] = field(default_factory=dict)
    bounds: dict[str, int] = field(default_factory=dict)
    memories: dict[str, Expression] = field(default_factory=dict)
    within: str = ""
    """The state whose submachine is read, as id of the machine; empty outside submachines."""
    aliases: dict[str, list[str]] = field(default_factory=dict)
    """Entry and exit points of a submachine by what stands for them at the submachine state."""

    def id_of(self, element: Element) -> str:
        """Return the id of *element* in the machine, inside the submachine that is being read."""
        return submachine_id(self.within, element.id)

    def element(self, key: str) -> Element:
        """Return the drawn element behind an id of the machine."""
        return self.reading.graph[element_id(key)]

    def find_submachine_state(self, key: str) -> str:
        """Return the submachine state that contains the element with this id, or an empty text."""
        return key[: -len(element_id(key)) - 1] if key != element_id(key) else ""


_VERTEX_KINDS = (Kind.STATE, Kind.FINAL_STATE, Kind.PSEUDOSTATE)


def read_regions(
    parts: MachineDraft, owner: Element, state: str, named: Element
) -> tuple[str, ...]:
    """Read the regions that *owner* owns and return their ids.

    *state* is the id of the state that contains them. The region variables are named after *named*,
    because the regions of a submachine belong to the state that uses it.
    """
    graph = parts.reading.graph
    regions = [
        child
        for child in graph.owned(owner)
        if child.kind is Kind.REGION and find_initial(graph, child) is not None
    ]
    for region in regions:
        is_only = len(regions) == 1
        _read_region(parts, region, state, _region_name(named, region, state, is_only))
    return tuple(parts.id_of(region) for region in regions)


def _region_name(owner: Element, region: Element, state: str, is_only: bool) -> str:
    base_name = "state" if is_only else region.name or "state"
    return f"{identifier(owner.name)}_{base_name}" if state else base_name


def _read_region(parts: MachineDraft, region: Element, state: str, name: str) -> None:
    graph, id = parts.reading.graph, parts.id_of(region)
    vertices = [vertex for vertex in graph.owned(region) if vertex.kind in _VERTEX_KINDS]
    stable = [vertex for vertex in vertices if vertex.kind is not Kind.PSEUDOSTATE]
    fallbacks = [
        vertex.name or ("final" if vertex.kind is Kind.FINAL_STATE else "state")
        for vertex in stable
    ]
    literals = make_unique(fallbacks, "state", INACTIVE)
    domain = EnumerationDomain((*((INACTIVE,) if state else ()), *literals))
    variable = parts.reading.variable_for(f"region {id}", name, Owner.SYSTEM, domain, region.id)
    initial = find_initial(graph, region)
    parts.regions[id] = Region(
        id,
        variable,
        state,
        parts.id_of(initial) if initial else "",
        tuple(parts.id_of(vertex) for vertex in vertices),
    )
    names = dict(zip((vertex.id for vertex in stable), literals, strict=True))
    for vertex in vertices:
        _read_vertex(parts, vertex, id, names.get(vertex.id, ""))


def _read_vertex(parts: MachineDraft, element: Element, region: str, literal: str) -> None:
    id = parts.id_of(element)
    if element.kind is not Kind.STATE:
        kind = "final" if element.kind is Kind.FINAL_STATE else element.subkind
        parts.vertices[id] = Vertex(id, kind, literal, region)
        return
    parts.vertices[id] = Vertex(
        id,
        "state",
        literal,
        region,
        entry=read_behaviours(parts.reading, element, Edge.ENTRY),
        exit=read_behaviours(parts.reading, element, Edge.EXIT),
        do=_read_do_activity(parts, element),
    )
    _read_border(parts, element, id, region)
    inner = read_regions(parts, element, id, element)
    submachine = find_submachine(parts.reading.graph, element)
    if submachine is not None:
        inner += _read_submachine(parts, element, submachine, region)
    parts.vertices[id] = replace(parts.vertices[id], regions=inner)


def _read_border(parts: MachineDraft, owner: Element, state: str, region: str) -> None:
    """Read the entry and exit points of a state.

    A connection point of a submachine state is an alias of a point of the submachine.
    """
    graph = parts.reading.graph
    for point in graph.owned(owner):
        if point.kind is not Kind.PSEUDOSTATE:
            continue
        if point.subkind == "connection-point":
            points = graph.targets(point, Edge.REFERENCES)
            parts.aliases[parts.id_of(point)] = [submachine_id(state, point.id) for point in points]
        else:
            id = parts.id_of(point)
            parts.vertices[id] = Vertex(id, point.subkind, "", region, border=state)


def _read_submachine(
    parts: MachineDraft, element: Element, submachine: Element, region: str
) -> tuple[str, ...]:
    """Read the points and regions of the submachine of *element*; return the ids of the regions."""
    state, outer_state = parts.id_of(element), parts.within
    parts.within = state
    _read_border(parts, submachine, state, region)
    inner = read_regions(parts, submachine, state, element)
    parts.within = outer_state
    return inner


def _read_do_activity(parts: MachineDraft, state: Element) -> str:
    """Return the output that is true while the do behaviour of *state* runs, or an empty text."""
    behaviour = parts.reading.graph.target(state, Edge.DO)
    if behaviour is None:
        return ""
    name = behaviour.name or str(behaviour.attrs.get("body", "")) or state.name
    key, domain = f"do {parts.id_of(state)}", BooleanDomain()
    return parts.reading.variable_for(key, f"do_{name}", Owner.SYSTEM, domain, behaviour.id)


def add_history_memories(parts: MachineDraft) -> None:
    """Add a memory variable to every region to which a history pseudostate can return."""
    for vertex in tuple(parts.vertices.values()):
        if vertex.kind == "shallow-history":
            _add_memory(parts, vertex.region)
        elif vertex.kind == "deep-history":
            for region in tuple(parts.regions):
                if region == vertex.region or vertex.region in _list_enclosing_regions(
                    parts, region
                ):
                    _add_memory(parts, region)


def _list_enclosing_regions(parts: MachineDraft, region: str) -> list[str]:
    """List the regions around *region*, innermost first."""
    regions: list[str] = []
    while parts.regions[region].state:
        region = parts.vertices[parts.regions[region].state].region
        regions.append(region)
    return regions


def _add_memory(parts: MachineDraft, id: str) -> None:
    """Add a memory variable to a nested region that has none."""
    region, reading = parts.regions[id], parts.reading
    if not region.state or region.memory:
        return
    variable = next(
        candidate for candidate in reading.auxiliary.values() if candidate.name == region.variable
    )
    name = f"last_{region.variable}"
    memory = reading.variable_for(
        f"last {id}", name, Owner.SYSTEM, variable.domain, variable.origin
    )
    parts.regions[id] = replace(region, memory=memory)


def list_outgoing(parts: MachineDraft, vertex: str) -> list[tuple[Element, str]]:
    """List the transitions that leave *vertex*, each with the submachine state in which it is
    drawn.
    """
    graph = parts.reading.graph
    points = [
        vertex,
        *(transition for transition, targets in parts.aliases.items() if vertex in targets),
    ]
    return [
        (transition, parts.find_submachine_state(point_id))
        for point_id in points
        for transition in _list_transitions(graph, parts.element(point_id))
    ]


def _list_transitions(graph: Graph, element: Element) -> list[Element]:
    return [
        transition
        for transition in graph.sources(element, Edge.FLOW_SOURCE)
        if transition.kind is Kind.TRANSITION
    ]
