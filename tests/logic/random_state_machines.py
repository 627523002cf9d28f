"""Random state machines as graphs: nested and orthogonal states, choices, triggers of all kinds.

``rich_machines`` also draws history, forks, joins, entry and exit points, and submachines.
"""

from hypothesis import strategies as st

from sysmlc.ir import Edge, Element, Graph, Kind

GUARDS = [
    "",
    "",
    "",
    "q",
    "not p",
    "x > 1",
    "x == 0 or q",
    "mode == hand",
    "p and x < 3",
    "x + 1 < 3",
]
EFFECTS = [
    "",
    "x := x + 1",
    "x := 0; p := q",
    "beep",
    "send done; x := x - 1",
    "mode := if q ? hand else auto",
    "p := not p; x := if p ? 2 else x",
]
TRIGGERS = [
    ("signal", "e"),
    ("signal", "e"),
    ("signal", "f"),
    ("time", "after 2"),
    ("time", "after 1 s"),
    ("change", "q"),
    ("change", "x > 1"),
    ("immediate change", "q"),
    ("immediate change", "x > 1"),
    ("any", ""),
    ("none", ""),
]


class Builder:
    """Adds elements with consecutive ids to a graph."""

    def __init__(self):
        self.graph = Graph()
        self.number = 0

    def add(self, kind, owner=None, name="", **attrs):
        self.number += 1
        owner_id = None if owner is None else owner.id
        element = Element(f"e{self.number}", kind, name, owner_id, self.number, "m.uml", attrs)
        return self.graph.add(element)

    def add_property(self, owner, name, type_, **attrs):
        property_ = self.add(Kind.PROPERTY, owner, name, **attrs)
        self.graph.connect(Edge.TYPED_BY, property_, type_)

    def add_behaviour(self, owner, edge, body):
        """Add a behaviour with the text *body*; without a text, add nothing."""
        if body:
            behaviour = self.add(Kind.ACTIVITY, owner, subkind="opaque", body=body)
            self.graph.connect(edge, owner, behaviour)


def add_context(build):
    """Add a package with a class, its properties, signals and an empty state machine.

    Return the state machine, and the signals by name.
    """
    package = build.add(Kind.PACKAGE, name="P")
    integer = build.add(Kind.DATA_TYPE, package, "Integer")
    boolean = build.add(Kind.DATA_TYPE, package, "Boolean")
    mode = build.add(Kind.ENUMERATION, package, "Mode")
    for literal in ("auto", "hand"):
        build.add(Kind.ENUMERATION_LITERAL, mode, literal)
    signals = {name: build.add(Kind.SIGNAL, package, name) for name in ("e", "f")}
    owner = build.add(Kind.CLASS, package, "C")
    build.add_property(owner, "x", integer, default=0)
    build.add_property(owner, "p", boolean)
    build.add_property(owner, "q", boolean)
    build.add_property(owner, "mode", mode, default="auto")
    build.add(Kind.CONSTRAINT, owner, body="0 <= x <= 3")
    return build.add(Kind.STATE_MACHINE, owner, "M"), signals


@st.composite
def machines(draw):
    """Draw a graph and its state machine."""
    build = Builder()
    machine, signals = add_context(build)
    build.add_behaviour(machine, Edge.ENTRY, draw(st.sampled_from(EFFECTS)))
    for _ in range(draw(st.sampled_from([1, 1, 1, 2]))):
        region = build.add(Kind.REGION, machine, "r")
        vertices = _add_vertices(draw, build, region, depth=0)
        _add_transitions(draw, build, region, vertices, signals)
    return build.graph, machine


@st.composite
def rich_machines(draw):
    """Draw a graph and its state machine, with pseudostates of all kinds and submachines."""
    build = Builder()
    machine, signals = add_context(build)
    submachine = _add_submachine(draw, build, machine, signals) if draw(st.booleans()) else None
    region = build.add(Kind.REGION, machine, "r")
    vertices = _add_vertices(draw, build, region, depth=0)
    for _ in range(0 if submachine is None else draw(st.integers(1, 2))):
        state = build.add(Kind.STATE, region, f"Sub{build.number}")
        build.graph.connect(Edge.CALLS, state, submachine)
        vertices.append(state)
    if draw(st.booleans()):
        vertices += _add_orthogonal_state(draw, build, region)
    _add_transitions(draw, build, region, vertices, signals)
    for state in [vertex for vertex in vertices if vertex.kind is Kind.STATE]:
        _add_pseudostates(draw, build, state, vertices, signals)
    return build.graph, machine


def _add_orthogonal_state(draw, build, region):
    """Add a state with two regions; return its vertices and the state itself."""
    state = build.add(Kind.STATE, region, f"Two{build.number}")
    vertices = [state]
    for _ in range(2):
        vertices += _add_vertices(draw, build, build.add(Kind.REGION, state, "r"), depth=1)
    return vertices


def _add_submachine(draw, build, machine, signals):
    """Add a state machine with an entry point and an exit point."""
    submachine = build.add(Kind.STATE_MACHINE, build.graph.owner(machine), "Called")
    for edge in (Edge.ENTRY, Edge.EXIT):
        build.add_behaviour(submachine, edge, draw(st.sampled_from(EFFECTS)))
    region = build.add(Kind.REGION, submachine, "r")
    vertices = _add_vertices(draw, build, region, depth=1)
    _add_transitions(draw, build, region, vertices, signals)
    states = [vertex for vertex in vertices if vertex.kind is Kind.STATE]
    for kind in ("entry-point", "exit-point"):
        point = build.add(Kind.PSEUDOSTATE, submachine, kind, subkind=kind)
        inner = draw(st.sampled_from(states))
        ends = (point, inner) if kind == "entry-point" else (inner, point)
        transition = _add_transition(draw, build, region, *ends)
        if kind == "exit-point":
            _add_triggers(draw, build, transition, signals)
    return submachine


def _add_pseudostates(draw, build, state, vertices, signals):
    """Add pseudostates in and on a state, and transitions to and from them."""
    graph, home = build.graph, build.graph.owner(state)
    outside = [vertex for vertex in vertices if graph.owner(vertex) is home]
    if graph.target(state, Edge.CALLS) is not None:
        _add_connection_points(draw, build, state, outside, signals)
        return
    regions = [element for element in graph.owned(state) if element.kind is Kind.REGION]
    inside = {
        region.id: [vertex for vertex in vertices if vertex.owner == region.id]
        for region in regions
    }
    surroundings = (home, outside, signals)
    for region in regions:
        if draw(st.integers(0, 2)) == 0:
            _add_history(draw, build, region, inside[region.id], surroundings)
    if regions:
        _add_entry_and_exit(draw, build, state, regions, inside, surroundings)
    if len(regions) > 1:
        _add_fork_and_join(draw, build, regions, inside, surroundings)


def _add_connection_points(draw, build, state, outside, signals):
    """Connect the entry and exit points of a submachine to the states around *state*."""
    graph, home = build.graph, build.graph.owner(state)
    submachine = graph.target(state, Edge.CALLS)
    points = [vertex for vertex in graph.owned(submachine) if vertex.kind is Kind.PSEUDOSTATE]
    for point in points:
        reference = build.add(Kind.PSEUDOSTATE, state, point.name, subkind="connection-point")
        graph.connect(Edge.REFERENCES, reference, point)
        if point.subkind == "entry-point":
            _add_incoming(draw, build, (home, outside, signals), reference)
        else:
            _add_transition(draw, build, home, reference, draw(st.sampled_from(outside)))


def _add_history(draw, build, region, inside, surroundings):
    kind = draw(st.sampled_from(["shallow-history", "deep-history"]))
    history = build.add(Kind.PSEUDOSTATE, region, "H", subkind=kind)
    _add_incoming(draw, build, surroundings, history)
    if draw(st.booleans()):
        _add_transition(draw, build, region, history, inside[0])


def _add_entry_and_exit(draw, build, state, regions, inside, surroundings):
    home, outside, signals = surroundings
    if draw(st.integers(0, 2)) == 0:
        point = build.add(Kind.PSEUDOSTATE, state, "in", subkind="entry-point")
        _add_incoming(draw, build, surroundings, point)
        for region in draw(st.sampled_from([regions, regions[:1]])):
            _add_transition(draw, build, region, point, inside[region.id][-1])
    if draw(st.integers(0, 2)) == 0:
        point = build.add(Kind.PSEUDOSTATE, state, "out", subkind="exit-point")
        transition = _add_transition(draw, build, regions[0], inside[regions[0].id][0], point)
        _add_triggers(draw, build, transition, signals)
        _add_transition(draw, build, home, point, draw(st.sampled_from(outside)))


def _add_fork_and_join(draw, build, regions, inside, surroundings):
    home, outside, _ = surroundings
    owner = draw(st.sampled_from([home, regions[0]]))
    if draw(st.booleans()):
        fork = build.add(Kind.PSEUDOSTATE, owner, "fork", subkind="fork")
        _add_incoming(draw, build, surroundings, fork)
        for region in regions:
            _add_transition(draw, build, owner, fork, draw(st.sampled_from(inside[region.id])))
    if draw(st.booleans()):
        join = build.add(Kind.PSEUDOSTATE, owner, "join", subkind="join")
        for region in regions:
            _add_transition(draw, build, region, inside[region.id][0], join)
        _add_transition(draw, build, home, join, draw(st.sampled_from(outside)))


def _add_incoming(draw, build, surroundings, target):
    home, outside, signals = surroundings
    source = draw(st.sampled_from([vertex for vertex in outside if vertex.kind is Kind.STATE]))
    transition = _add_transition(draw, build, home, source, target, draw(st.sampled_from(GUARDS)))
    _add_triggers(draw, build, transition, signals)


def _add_vertices(draw, build, region, depth):
    vertices = []
    for number in range(draw(st.integers(1, 3 - depth))):
        state = build.add(Kind.STATE, region, f"S{build.number}_{number}")
        build.add_behaviour(state, Edge.ENTRY, draw(st.sampled_from(["", "", *EFFECTS])))
        build.add_behaviour(state, Edge.EXIT, draw(st.sampled_from(["", "", *EFFECTS])))
        if draw(st.integers(0, 5)) == 0:
            build.add_behaviour(state, Edge.DO, "mill")
        vertices.append(state)
        if depth < 2 and draw(st.integers(0, 2)) == 0:
            for _ in range(draw(st.sampled_from([1, 1, 2]))):
                inner = build.add(Kind.REGION, state, "r")
                vertices += _add_vertices(draw, build, inner, depth + 1)
    if draw(st.booleans()):
        vertices.append(build.add(Kind.FINAL_STATE, region, "end"))
    return vertices


def _add_transitions(draw, build, region, vertices, signals):
    graph = build.graph
    regions = dict.fromkeys(graph.owner(vertex).id for vertex in vertices)
    for id in regions:
        if id != region.id and draw(st.integers(0, 5)) == 0:
            continue
        inside = [vertex for vertex in vertices if vertex.owner == id and vertex.kind is Kind.STATE]
        start = build.add(Kind.PSEUDOSTATE, graph[id], subkind="initial")
        _add_transition(draw, build, graph[id], start, draw(st.sampled_from(inside)))
    states = [vertex for vertex in vertices if vertex.kind is Kind.STATE]
    for _ in range(draw(st.integers(1, 4))):
        source = draw(st.sampled_from(states))
        target = draw(st.sampled_from(vertices))
        home = graph.owner(source)
        if draw(st.integers(0, 3)) == 0:
            target = _add_branch(draw, build, home, target, draw(st.sampled_from(vertices)))
        transition = _add_transition(
            draw, build, home, source, target, draw(st.sampled_from(GUARDS))
        )
        _add_triggers(draw, build, transition, signals)


def _add_branch(draw, build, region, first, second):
    kind = draw(st.sampled_from(["choice", "junction"]))
    vertex = build.add(Kind.PSEUDOSTATE, region, subkind=kind)
    _add_transition(draw, build, region, vertex, first, draw(st.sampled_from(GUARDS[3:])))
    guard = draw(st.sampled_from(["else", "else", "q"]))
    _add_transition(draw, build, region, vertex, second, guard)
    return vertex


def _add_transition(draw, build, region, source, target, guard=""):
    attrs = {"guard": guard} if guard else {}
    if source.kind is Kind.STATE and target.kind is not Kind.PSEUDOSTATE:
        kind = draw(st.sampled_from(["external", "external", "local", "internal"]))
        if kind != "external" and (kind == "local" or target is source):
            attrs["subkind"] = kind
    transition = build.add(Kind.TRANSITION, region, **attrs)
    build.graph.connect(Edge.FLOW_SOURCE, transition, source)
    build.graph.connect(Edge.FLOW_TARGET, transition, target)
    build.add_behaviour(transition, Edge.EFFECT, draw(st.sampled_from(EFFECTS)))
    return transition


def _add_triggers(draw, build, transition, signals):
    for kind, text in draw(st.lists(st.sampled_from(TRIGGERS), min_size=1, max_size=2)):
        if kind == "none":
            continue
        attrs = {"time": {"when": text}, "change": {"condition": text}}.get(kind, {})
        if kind == "immediate change":
            kind, attrs = "change", {"condition": text, "immediate": True}
        trigger = build.add(Kind.TRIGGER, transition, subkind=kind, **attrs)
        build.graph.connect(Edge.TRIGGER, transition, trigger)
        if kind == "signal":
            build.graph.connect(Edge.TYPED_BY, trigger, signals[text])
