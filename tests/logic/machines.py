"""Random state machines as graphs: nested and orthogonal states, choices, every trigger.

``rich_machines`` have every other pseudostate too, and states that are submachines.
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
    ("any", ""),
    ("none", ""),
]


class Builder:
    """Adds elements to a graph, with ids that count."""

    def __init__(self):
        self.graph = Graph()
        self.number = 0

    def add(self, kind, owner=None, name="", **attrs):
        self.number += 1
        owner_id = None if owner is None else owner.id
        element = Element(f"e{self.number}", kind, name, owner_id, self.number, "m.uml", attrs)
        return self.graph.add(element)

    def typed(self, kind, owner, name, type_, **attrs):
        made = self.add(kind, owner, name, **attrs)
        self.graph.connect(Edge.TYPED_BY, made, type_)
        return made

    def behaviour(self, owner, edge, body):
        if body:
            made = self.add(Kind.ACTIVITY, owner, subkind="opaque", body=body)
            self.graph.connect(edge, owner, made)


def context(build):
    """A package with a class, its properties, signals, and an empty machine."""
    package = build.add(Kind.PACKAGE, name="P")
    integer = build.add(Kind.DATA_TYPE, package, "Integer")
    boolean = build.add(Kind.DATA_TYPE, package, "Boolean")
    mode = build.add(Kind.ENUMERATION, package, "Mode")
    for literal in ("auto", "hand"):
        build.add(Kind.ENUMERATION_LITERAL, mode, literal)
    signals = {name: build.add(Kind.SIGNAL, package, name) for name in ("e", "f")}
    owner = build.add(Kind.CLASS, package, "C")
    build.typed(Kind.PROPERTY, owner, "x", integer, default=0)
    build.typed(Kind.PROPERTY, owner, "p", boolean)
    build.typed(Kind.PROPERTY, owner, "q", boolean)
    build.typed(Kind.PROPERTY, owner, "mode", mode, default="auto")
    build.add(Kind.CONSTRAINT, owner, body="0 <= x <= 3")
    return build.add(Kind.STATE_MACHINE, owner, "M"), signals


@st.composite
def machines(draw):
    """(graph, state machine)."""
    build = Builder()
    machine, signals = context(build)
    for _ in range(draw(st.sampled_from([1, 1, 1, 2]))):
        region = build.add(Kind.REGION, machine, "r")
        vertices = _fill(draw, build, region, depth=0)
        _connect(draw, build, region, vertices, signals)
    return build.graph, machine


@st.composite
def rich_machines(draw):
    """(graph, state machine) with history, forks, joins, entry and exit points, submachines."""
    build = Builder()
    machine, signals = context(build)
    called = _submachine(draw, build, machine, signals) if draw(st.booleans()) else None
    region = build.add(Kind.REGION, machine, "r")
    vertices = _fill(draw, build, region, depth=0)
    for _ in range(0 if called is None else draw(st.integers(1, 2))):
        state = build.add(Kind.STATE, region, f"Sub{build.number}")
        build.graph.connect(Edge.CALLS, state, called)
        vertices.append(state)
    if draw(st.booleans()):
        vertices += _composite(draw, build, region)
    _connect(draw, build, region, vertices, signals)
    for state in [one for one in vertices if one.kind is Kind.STATE]:
        _enrich(draw, build, state, vertices, signals)
    return build.graph, machine


def _composite(draw, build, region):
    """An orthogonal state with two states in each region."""
    state = build.add(Kind.STATE, region, f"Two{build.number}")
    found = [state]
    for _ in range(2):
        inner = build.add(Kind.REGION, state, "r")
        found += _fill(draw, build, inner, depth=1)
    return found


def _submachine(draw, build, machine, signals):
    called = build.add(Kind.STATE_MACHINE, build.graph.owner(machine), "Called")
    region = build.add(Kind.REGION, called, "r")
    vertices = _fill(draw, build, region, depth=1)
    _connect(draw, build, region, vertices, signals)
    states = [one for one in vertices if one.kind is Kind.STATE]
    for kind in ("entry-point", "exit-point"):
        point = build.add(Kind.PSEUDOSTATE, called, kind, subkind=kind)
        inner = draw(st.sampled_from(states))
        ends = (point, inner) if kind == "entry-point" else (inner, point)
        made = _transition(draw, build, region, *ends)
        if kind == "exit-point":
            _trigger(draw, build, made, signals)
    return called


def _enrich(draw, build, state, vertices, signals):
    """Pseudostates in and on a state, with ways to and from them."""
    graph, home = build.graph, build.graph.owner(state)
    outside = [one for one in vertices if graph.owner(one) is home]
    if graph.target(state, Edge.CALLS) is not None:
        _connect_points(draw, build, state, outside, signals)
        return
    inner = [one for one in graph.owned(state) if one.kind is Kind.REGION]
    inside = {one.id: [v for v in vertices if v.owner == one.id] for one in inner}
    for region in inner:
        if draw(st.integers(0, 2)) == 0:
            _history(draw, build, region, inside[region.id], (home, outside, signals))
    if inner:
        _points(draw, build, state, inner, inside, (home, outside, signals))
    if len(inner) > 1:
        _forks(draw, build, inner, inside, (home, outside, signals))


def _connect_points(draw, build, state, outside, signals):
    graph, home = build.graph, build.graph.owner(state)
    called = graph.target(state, Edge.CALLS)
    for point in [one for one in graph.owned(called) if one.kind is Kind.PSEUDOSTATE]:
        one = build.add(Kind.PSEUDOSTATE, state, point.name, subkind="connection-point")
        graph.connect(Edge.REFERENCES, one, point)
        if point.subkind == "entry-point":
            _triggered(draw, build, (home, outside, signals), one)
        else:
            _transition(draw, build, home, one, draw(st.sampled_from(outside)))


def _history(draw, build, region, inside, around):
    kind = draw(st.sampled_from(["shallow-history", "deep-history"]))
    history = build.add(Kind.PSEUDOSTATE, region, "H", subkind=kind)
    _triggered(draw, build, around, history)
    if draw(st.booleans()):
        _transition(draw, build, region, history, inside[0])


def _points(draw, build, state, inner, inside, around):
    home, outside, signals = around
    if draw(st.integers(0, 2)) == 0:
        point = build.add(Kind.PSEUDOSTATE, state, "in", subkind="entry-point")
        _triggered(draw, build, around, point)
        for region in draw(st.sampled_from([inner, inner[:1]])):
            _transition(draw, build, region, point, inside[region.id][-1])
    if draw(st.integers(0, 2)) == 0:
        point = build.add(Kind.PSEUDOSTATE, state, "out", subkind="exit-point")
        made = _transition(draw, build, inner[0], inside[inner[0].id][0], point)
        _trigger(draw, build, made, signals)
        _transition(draw, build, home, point, draw(st.sampled_from(outside)))


def _forks(draw, build, inner, inside, around):
    home, outside, _ = around
    place = draw(st.sampled_from([home, inner[0]]))
    if draw(st.booleans()):
        fork = build.add(Kind.PSEUDOSTATE, place, "fork", subkind="fork")
        _triggered(draw, build, around, fork)
        for region in inner:
            _transition(draw, build, place, fork, draw(st.sampled_from(inside[region.id])))
    if draw(st.booleans()):
        join = build.add(Kind.PSEUDOSTATE, place, "join", subkind="join")
        for region in inner:
            _transition(draw, build, region, inside[region.id][0], join)
        _transition(draw, build, home, join, draw(st.sampled_from(outside)))


def _triggered(draw, build, around, target):
    home, outside, signals = around
    source = draw(st.sampled_from([one for one in outside if one.kind is Kind.STATE]))
    made = _transition(draw, build, home, source, target, draw(st.sampled_from(GUARDS)))
    _trigger(draw, build, made, signals)


def _fill(draw, build, region, depth):
    found = []
    for number in range(draw(st.integers(1, 3 - depth))):
        state = build.add(Kind.STATE, region, f"S{build.number}_{number}")
        build.behaviour(state, Edge.ENTRY, draw(st.sampled_from(["", "", *EFFECTS])))
        build.behaviour(state, Edge.EXIT, draw(st.sampled_from(["", "", *EFFECTS])))
        if draw(st.integers(0, 5)) == 0:
            build.behaviour(state, Edge.DO, "mill")
        found.append(state)
        if depth < 2 and draw(st.integers(0, 2)) == 0:
            for _ in range(draw(st.sampled_from([1, 1, 2]))):
                inner = build.add(Kind.REGION, state, "r")
                found += _fill(draw, build, inner, depth + 1)
    if draw(st.booleans()):
        found.append(build.add(Kind.FINAL_STATE, region, "end"))
    return found


def _connect(draw, build, region, vertices, signals):
    graph = build.graph
    regions = dict.fromkeys(graph.owner(vertex).id for vertex in vertices)
    for id in regions:
        own = [vertex for vertex in vertices if vertex.owner == id and vertex.kind is Kind.STATE]
        start = build.add(Kind.PSEUDOSTATE, graph[id], subkind="initial")
        _transition(draw, build, graph[id], start, draw(st.sampled_from(own)))
    states = [vertex for vertex in vertices if vertex.kind is Kind.STATE]
    for _ in range(draw(st.integers(1, 4))):
        source = draw(st.sampled_from(states))
        target = draw(st.sampled_from(vertices))
        home = graph.owner(source)
        if draw(st.integers(0, 3)) == 0:
            target = _branch(draw, build, home, target, draw(st.sampled_from(vertices)))
        made = _transition(draw, build, home, source, target, draw(st.sampled_from(GUARDS)))
        _trigger(draw, build, made, signals)


def _branch(draw, build, region, first, second):
    kind = draw(st.sampled_from(["choice", "junction"]))
    vertex = build.add(Kind.PSEUDOSTATE, region, subkind=kind)
    _transition(draw, build, region, vertex, first, draw(st.sampled_from(GUARDS[3:])))
    guard = draw(st.sampled_from(["else", "else", "q"]))
    _transition(draw, build, region, vertex, second, guard)
    return vertex


def _transition(draw, build, region, source, target, guard=""):
    attrs = {"guard": guard} if guard else {}
    if source.kind is Kind.STATE and target.kind is not Kind.PSEUDOSTATE:
        kind = draw(st.sampled_from(["external", "external", "local", "internal"]))
        if kind != "external" and (kind == "local" or target is source):
            attrs["subkind"] = kind
    made = build.add(Kind.TRANSITION, region, **attrs)
    build.graph.connect(Edge.FLOW_SOURCE, made, source)
    build.graph.connect(Edge.FLOW_TARGET, made, target)
    build.behaviour(made, Edge.EFFECT, draw(st.sampled_from(EFFECTS)))
    return made


def _trigger(draw, build, transition, signals):
    for kind, text in draw(st.lists(st.sampled_from(TRIGGERS), min_size=1, max_size=2)):
        if kind == "none":
            continue
        attrs = {"time": {"when": text}, "change": {"condition": text}}.get(kind, {})
        trigger = build.add(Kind.TRIGGER, transition, subkind=kind, **attrs)
        build.graph.connect(Edge.TRIGGER, transition, trigger)
        if kind == "signal":
            build.graph.connect(Edge.TYPED_BY, trigger, signals[text])
