"""Vertices and regions of a state machine, with those of the submachines that its states are."""

from dataclasses import dataclass, field

from msgspec.structs import replace

from sysmlc.ir import Edge, Element, Graph, Kind
from sysmlc.logic.contract import BooleanDomain, EnumerationDomain, Owner
from sysmlc.logic.expressions.expression import Expression
from sysmlc.logic.machines.actions import Reading, read_behaviours
from sysmlc.logic.machines.machine import (
    INACTIVE,
    Region,
    Transition,
    Vertex,
    element_id,
    id_within,
)
from sysmlc.logic.machines.supported_constructs import initial_of, submachine_of
from sysmlc.logic.names import identifier, unique


@dataclass(slots=True)
class Parts:
    """The machine while it grows."""

    reading: Reading
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

    def key(self, element: Element) -> str:
        """The id that an element has in the machine."""
        return id_within(self.within, element.id)

    def element(self, key: str) -> Element:
        """What is drawn with an id of the machine."""
        return self.reading.graph[element_id(key)]

    def state_of(self, key: str) -> str:
        """The submachine state in whose submachine something with this id is; empty in none."""
        return key[: -len(element_id(key)) - 1] if key != element_id(key) else ""


_KINDS = (Kind.STATE, Kind.FINAL_STATE, Kind.PSEUDOSTATE)


def read_regions(parts: Parts, owner: Element, state: str, named: Element) -> tuple[str, ...]:
    """Read the regions that an element owns; ``state`` is the id of the state that they are in.

    Their variables are named after ``named``: a state that is a submachine has its regions.
    """
    graph = parts.reading.graph
    found = [
        one
        for one in graph.owned(owner)
        if one.kind is Kind.REGION and initial_of(graph, one) is not None
    ]
    for region in found:
        alone = len(found) == 1
        _read_region(parts, region, state, _region_name(named, region, state, alone))
    return tuple(parts.key(region) for region in found)


def _region_name(owner: Element, region: Element, state: str, alone: bool) -> str:
    own = "state" if alone else region.name or "state"
    return f"{identifier(owner.name)}_{own}" if state else own


def _read_region(parts: Parts, region: Element, state: str, name: str) -> None:
    graph, id = parts.reading.graph, parts.key(region)
    vertices = [one for one in graph.owned(region) if one.kind in _KINDS]
    stable = [one for one in vertices if one.kind is not Kind.PSEUDOSTATE]
    fallbacks = [
        one.name or ("final" if one.kind is Kind.FINAL_STATE else "state") for one in stable
    ]
    literals = unique(fallbacks, "state", INACTIVE)
    domain = EnumerationDomain((*((INACTIVE,) if state else ()), *literals))
    variable = parts.reading.make(f"region {id}", name, Owner.SYSTEM, domain, region.id)
    initial = initial_of(graph, region)
    parts.regions[id] = Region(
        id,
        variable,
        state,
        parts.key(initial) if initial else "",
        tuple(parts.key(one) for one in vertices),
    )
    names = dict(zip((one.id for one in stable), literals, strict=True))
    for vertex in vertices:
        _read_vertex(parts, vertex, id, names.get(vertex.id, ""))


def _read_vertex(parts: Parts, element: Element, region: str, literal: str) -> None:
    id = parts.key(element)
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
        do=_read_do(parts, element),
    )
    _read_border(parts, element, id, region)
    inner = read_regions(parts, element, id, element)
    called = submachine_of(parts.reading.graph, element)
    if called is not None:
        inner += _read_submachine(parts, element, called, region)
    parts.vertices[id] = replace(parts.vertices[id], regions=inner)


def _read_border(parts: Parts, owner: Element, state: str, region: str) -> None:
    """Entry and exit points of a state; those of a submachine state stand for the submachine's."""
    graph = parts.reading.graph
    for one in graph.owned(owner):
        if one.kind is not Kind.PSEUDOSTATE:
            continue
        if one.subkind == "connection-point":
            points = graph.targets(one, Edge.REFERENCES)
            parts.aliases[parts.key(one)] = [id_within(state, point.id) for point in points]
        else:
            id = parts.key(one)
            parts.vertices[id] = Vertex(id, one.subkind, "", region, border=state)


def _read_submachine(
    parts: Parts, element: Element, called: Element, region: str
) -> tuple[str, ...]:
    state, before = parts.key(element), parts.within
    parts.within = state
    _read_border(parts, called, state, region)
    inner = read_regions(parts, called, state, element)
    parts.within = before
    return inner


def _read_do(parts: Parts, state: Element) -> str:
    behaviour = parts.reading.graph.target(state, Edge.DO)
    if behaviour is None:
        return ""
    name = behaviour.name or str(behaviour.attrs.get("body", "")) or state.name
    key, domain = f"do {parts.key(state)}", BooleanDomain()
    return parts.reading.make(key, f"do_{name}", Owner.SYSTEM, domain, behaviour.id)


def remember(parts: Parts) -> None:
    """Give the regions that history leads back to a variable for what they were."""
    for vertex in tuple(parts.vertices.values()):
        if vertex.kind == "shallow-history":
            _remember(parts, vertex.region)
        elif vertex.kind == "deep-history":
            for region in tuple(parts.regions):
                if region == vertex.region or vertex.region in _above(parts, region):
                    _remember(parts, region)


def _above(parts: Parts, region: str) -> list[str]:
    found: list[str] = []
    while parts.regions[region].state:
        region = parts.vertices[parts.regions[region].state].region
        found.append(region)
    return found


def _remember(parts: Parts, id: str) -> None:
    region, reading = parts.regions[id], parts.reading
    if not region.state or region.memory:
        return
    variable = next(one for one in reading.made.values() if one.name == region.variable)
    name = f"last_{region.variable}"
    made = reading.make(f"last {id}", name, Owner.SYSTEM, variable.domain, variable.origin)
    parts.regions[id] = replace(region, memory=made)


def drawn_from(parts: Parts, vertex: str) -> list[tuple[Element, str]]:
    """The transitions that leave a vertex, each with the submachine state in which it is drawn."""
    graph = parts.reading.graph
    points = [vertex, *(one for one, known in parts.aliases.items() if vertex in known)]
    return [
        (one, parts.state_of(point))
        for point in points
        for one in _leaving(graph, parts.element(point))
    ]


def _leaving(graph: Graph, element: Element) -> list[Element]:
    return [one for one in graph.sources(element, Edge.FLOW_SOURCE) if one.kind is Kind.TRANSITION]
