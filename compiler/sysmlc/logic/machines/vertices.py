"""Vertices and regions of a state machine, including copies of its submachines."""

from dataclasses import dataclass, field

from msgspec.structs import replace

from sysmlc.ir import Edge, Element, Graph, Kind
from sysmlc.logic.contract import BooleanDomain, EnumerationDomain, Owner
from sysmlc.logic.identifiers import identifier, make_unique
from sysmlc.logic.machines.actions import ReadingContext, read_behaviours
from sysmlc.logic.machines.machine import (
    INACTIVE,
    Action,
    Memory,
    Region,
    Transition,
    Vertex,
    element_id,
    submachine_id,
)
from sysmlc.logic.machines.supported_constructs import (
    find_initial,
    find_submachine,
    list_behaviours,
)


@dataclass(slots=True)
class MachineDraft:
    """A state machine that is being read.

    ``events`` has the literal of ``event`` for each type of trigger, ``bounds`` the largest time
    for which a state waits, and ``memories`` what each memory variable stores.
    """

    reading: ReadingContext
    machine: Element
    vertices: dict[str, Vertex] = field(default_factory=dict)
    regions: dict[str, Region] = field(default_factory=dict)
    outgoing: dict[str, tuple[Transition, ...]] = field(default_factory=dict)
    events: dict[str, str] = field(default_factory=dict)
    bounds: dict[str, int] = field(default_factory=dict)
    memories: dict[str, Memory] = field(default_factory=dict)
    entry: tuple[Action, ...] = ()
    within: str = ""
    """The id of the state whose submachine is being read; empty outside submachines."""
    aliases: dict[str, list[str]] = field(default_factory=dict)
    """The points of a submachine that each connection point reference represents."""

    def id_of(self, element: Element) -> str:
        """Return the id of *element*, or of its copy in the submachine that is being read."""
        return submachine_id(self.within, element.id)

    def element(self, key: str) -> Element:
        """Return the element of the model for an id of the machine."""
        return self.reading.graph[element_id(key)]

    def find_submachine_state(self, key: str) -> str:
        """Return the submachine state that contains the element with this id, or an empty text."""
        return key[: -len(element_id(key)) - 1] if key != element_id(key) else ""


_VERTEX_KINDS = (Kind.STATE, Kind.FINAL_STATE, Kind.PSEUDOSTATE)


def read_regions(
    draft: MachineDraft, owner: Element, state: str, named: Element
) -> tuple[str, ...]:
    """Read the regions that *owner* owns and return their ids.

    *state* is the id of the state that contains them. The region variables are named after *named*:
    for a submachine this is the submachine state, because several states may use one submachine.
    """
    graph = draft.reading.graph
    regions = [
        child
        for child in graph.owned(owner)
        if child.kind is Kind.REGION and _has_content(graph, child)
    ]
    for region in regions:
        is_only = len(regions) == 1
        _read_region(draft, region, state, _region_name(named, region, state, is_only))
    return tuple(draft.id_of(region) for region in regions)


def _has_content(graph: Graph, region: Element) -> bool:
    """Whether the region has a state, a final state or an initial pseudostate."""
    owned = graph.owned(region)
    has_states = any(vertex.kind in (Kind.STATE, Kind.FINAL_STATE) for vertex in owned)
    return has_states or find_initial(graph, region) is not None


def _region_name(owner: Element, region: Element, state: str, is_only: bool) -> str:
    base_name = "state" if is_only else region.name or "state"
    return f"{identifier(owner.name)}_{base_name}" if state else base_name


def _read_region(draft: MachineDraft, region: Element, state: str, name: str) -> None:
    graph, id = draft.reading.graph, draft.id_of(region)
    vertices = [vertex for vertex in graph.owned(region) if vertex.kind in _VERTEX_KINDS]
    stable = [vertex for vertex in vertices if vertex.kind is not Kind.PSEUDOSTATE]
    fallbacks = [
        vertex.name or ("final" if vertex.kind is Kind.FINAL_STATE else "state")
        for vertex in stable
    ]
    literals = make_unique(fallbacks, "state", INACTIVE)
    domain = EnumerationDomain((*((INACTIVE,) if state else ()), *literals))
    variable = draft.reading.variable_for(f"region {id}", name, Owner.SYSTEM, domain, region.id)
    initial = find_initial(graph, region)
    if state and initial not in vertices:
        # Only the machine itself starts at its entry point: transitions enter a submachine there.
        initial = None
    draft.regions[id] = Region(
        id,
        variable,
        state,
        draft.id_of(initial) if initial else "",
        tuple(draft.id_of(vertex) for vertex in vertices),
    )
    names = dict(zip((vertex.id for vertex in stable), literals, strict=True))
    if initial is not None and initial not in vertices:
        draft.vertices[draft.id_of(initial)] = Vertex(draft.id_of(initial), "initial", "", id)
    for vertex in vertices:
        _read_vertex(draft, vertex, id, names.get(vertex.id, ""))


def _read_vertex(draft: MachineDraft, element: Element, region: str, literal: str) -> None:
    id = draft.id_of(element)
    if element.kind is not Kind.STATE:
        kind = "final" if element.kind is Kind.FINAL_STATE else element.subkind
        draft.vertices[id] = Vertex(id, kind, literal, region)
        return
    # Stored before its inner states, so that the order of the machine is that of the model.
    draft.vertices[id] = Vertex(
        id,
        "state",
        literal,
        region,
        entry=read_behaviours(draft.reading, element, Edge.ENTRY),
        exit=read_behaviours(draft.reading, element, Edge.EXIT),
        do=_read_do_activity(draft, element),
    )
    _read_border(draft, element, id, region)
    inner = read_regions(draft, element, id, element)
    submachine = find_submachine(draft.reading.graph, element)
    if submachine is not None:
        inner += _read_submachine(draft, element, submachine, region)
    draft.vertices[id] = replace(draft.vertices[id], regions=inner)


def _read_border(draft: MachineDraft, owner: Element, state: str, region: str) -> None:
    """Read the entry and exit points of a state.

    A connection point of a submachine state is an alias of a point of the submachine.
    """
    graph = draft.reading.graph
    for point in graph.owned(owner):
        if point.kind is not Kind.PSEUDOSTATE:
            continue
        if point.subkind == "connection-point":
            points = graph.targets(point, Edge.REFERENCES)
            draft.aliases[draft.id_of(point)] = [submachine_id(state, point.id) for point in points]
        else:
            id = draft.id_of(point)
            draft.vertices[id] = Vertex(id, point.subkind, "", region, border=state)


def _read_submachine(
    draft: MachineDraft, element: Element, submachine: Element, region: str
) -> tuple[str, ...]:
    """Read the points and regions of the submachine of *element*; return the ids of the regions."""
    state, outer_state = draft.id_of(element), draft.within
    draft.within = state
    _read_border(draft, submachine, state, region)
    inner = read_regions(draft, submachine, state, element)
    draft.within = outer_state
    return inner


def _read_do_activity(draft: MachineDraft, state: Element) -> str:
    """Return the output that is true while the do behaviour of *state* runs, or an empty text."""
    behaviours = list_behaviours(draft.reading.graph, state, Edge.DO)
    if not behaviours:
        return ""
    behaviour = behaviours[0]
    name = behaviour.name or str(behaviour.attrs.get("body", "")) or state.name
    key, domain = f"do {draft.id_of(state)}", BooleanDomain()
    return draft.reading.variable_for(key, f"do_{name}", Owner.SYSTEM, domain, behaviour.id)


def add_history_memories(draft: MachineDraft) -> None:
    """Add a memory variable to every region to which a history pseudostate can return."""
    for vertex in tuple(draft.vertices.values()):
        if vertex.kind == "shallow-history":
            _add_memory(draft, vertex.region)
        elif vertex.kind == "deep-history":
            for region in tuple(draft.regions):
                if region == vertex.region or vertex.region in _list_enclosing_regions(
                    draft, region
                ):
                    _add_memory(draft, region)


def _list_enclosing_regions(draft: MachineDraft, region: str) -> list[str]:
    """List the regions around *region*, innermost first."""
    regions: list[str] = []
    while draft.regions[region].state:
        region = draft.vertices[draft.regions[region].state].region
        regions.append(region)
    return regions


def _add_memory(draft: MachineDraft, id: str) -> None:
    """Add a memory variable to a nested region.

    A region of the machine needs none, because it is never inactive.
    """
    region, reading = draft.regions[id], draft.reading
    if not region.state or region.memory:
        return
    variable = next(
        candidate for candidate in reading.auxiliary.values() if candidate.name == region.variable
    )
    name = f"last_{region.variable}"
    memory = reading.memory_for(f"last {id}", name, variable.domain, variable.origin)
    draft.regions[id] = replace(region, memory=memory)


def list_outgoing(draft: MachineDraft, vertex: str) -> list[tuple[Element, str]]:
    """List the transitions that leave *vertex*, each with the submachine state that contains it."""
    graph = draft.reading.graph
    points = [
        vertex,
        *(transition for transition, targets in draft.aliases.items() if vertex in targets),
    ]
    return [
        (transition, draft.find_submachine_state(point_id))
        for point_id in points
        for transition in _list_transitions(graph, draft.element(point_id))
    ]


def _list_transitions(graph: Graph, element: Element) -> list[Element]:
    """Return the outgoing transitions; those of a machine that extends this one are not of it."""
    machines = [a for a in graph.ancestors(element) if a.kind is Kind.STATE_MACHINE]
    extensions = {e for machine in machines for e in graph.sources(machine, Edge.REDEFINES)}
    return [
        transition
        for transition in graph.sources(element, Edge.FLOW_SOURCE)
        if transition.kind is Kind.TRANSITION
        and not (extensions and extensions.intersection(graph.ancestors(transition)))
    ]
