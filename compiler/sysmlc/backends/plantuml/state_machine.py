"""State machine diagrams: one for each state machine with states."""

from collections.abc import Iterator

from sysmlc.backends.plantuml import labels, partitioning
from sysmlc.backends.plantuml.aliases import Aliases
from sysmlc.backends.plantuml.behaviour_notes import notes
from sysmlc.backends.plantuml.partitioning import split_view
from sysmlc.backends.plantuml.views import Diagram, GraphView, Line, Node
from sysmlc.ir import Edge, Element, Graph, Kind
from sysmlc.support.plantuml_text import label, lines, plain, small, stack

VERTICES = (Kind.STATE, Kind.PSEUDOSTATE, Kind.FINAL_STATE)
_SHAPES = {
    "initial": "start",
    "choice": "choice",
    "junction": "start",
    "fork": "fork",
    "join": "join",
    "deep-history": "history*",
    "shallow-history": "history",
    "entry-point": "entryPoint",
    "exit-point": "exitPoint",
}
_POINTS = frozenset(["entry-point", "exit-point"])
_TRANSITION = Kind.TRANSITION
_REFERENCE = "connection-point"
_ROW = 44


def diagrams(graph: Graph) -> Iterator[Diagram]:
    """All state machine diagrams, in the order of the model."""
    for machine in graph.of_kind(Kind.STATE_MACHINE):
        view = whole(graph, machine)
        if view.nodes:
            regions = tuple(item.id for item in _regions(graph, machine))
            title = "State machine diagram"
            yield from divided(graph, machine, view, "stm", title, details=regions)


def divided(
    graph: Graph,
    about: Element,
    view: GraphView,
    kind: str,
    title: str,
    signature: str = "",
    details: tuple[str, ...] = (),
) -> Iterator[Diagram]:
    """The diagram of one behaviour, or its parts when it is too large for one picture.

    ``signature`` follows the name in the frame; ``details`` are the ids that it stands for.
    """
    whole = graph.qualified_name(about)
    parts = split_view(view)
    for index, part in enumerate(parts):
        yield Diagram(
            kind=kind,
            name=partitioning.numbered(whole, index, len(parts)),
            frame=plain(f"{kind} {labels.name(about)}{signature}"),
            heading=(title, whole),
            view=part,
            about=about.id,
            footer=plain(partitioning.footer(index, len(parts), whole)),
            details=details,
        )


def whole(graph: Graph, machine: Element) -> GraphView:
    """All of a state machine in one view, however large."""
    aliases = Aliases()
    nodes = _inside(graph, machine, aliases)
    if any(child.subkind in _POINTS for child in graph.owned(machine)):
        alias = aliases.make(machine.id, machine.name, "machine")
        nodes = (Node(alias, label(labels.name(machine)), "machine", children=nodes),)
    flows = tuple(_transitions(graph, machine, aliases))
    return GraphView(nodes, flows, notes(graph, machine, aliases))


def depth(graph: Graph) -> int:
    """How deep states are within one another, over all state machines."""
    level = list(graph.of_kind(Kind.STATE_MACHINE))
    levels = 0
    while level:
        levels += 1
        regions = [region for one in level for region in _regions(graph, one)]
        level = [v for one in regions for v in graph.owned(one) if v.kind in VERTICES]
    return levels


def _inside(graph: Graph, owner: Element, aliases: Aliases) -> tuple[Node, ...]:
    """What a state or state machine holds: one region directly, several in dashed boxes."""
    regions = _regions(graph, owner)
    points = [_vertex(graph, v, aliases) for v in graph.owned(owner) if v.kind is Kind.PSEUDOSTATE]
    held = [_vertices(graph, region, aliases) for region in regions]
    if len(regions) < 2:
        return (*points, *(vertex for vertices in held for vertex in vertices))
    boxes = [
        Node(
            aliases.make(region.id, region.name, "region"),
            small(plain(region.name or f"region {number}")),
            "region",
            children=vertices,
            shows=(region.id,),
        )
        for number, (region, vertices) in enumerate(zip(regions, held, strict=True), 1)
    ]
    return (*points, *boxes)


def _regions(graph: Graph, owner: Element) -> list[Element]:
    return [item for item in graph.owned(owner) if item.kind is Kind.REGION]


def _vertices(graph: Graph, region: Element, aliases: Aliases) -> tuple[Node, ...]:
    owned = [item for item in graph.owned(region) if item.kind in VERTICES]
    return tuple(_vertex(graph, item, aliases) for item in owned)


def _vertex(graph: Graph, vertex: Element, aliases: Aliases) -> Node:
    alias = aliases.make(vertex.id, vertex.name, vertex.subkind or str(vertex.kind))
    name = label(labels.name(vertex))
    if vertex.kind is Kind.FINAL_STATE:
        return Node(alias, name, "end", shows=(vertex.id,))
    if vertex.kind is Kind.PSEUDOSTATE:
        return _pseudostate(graph, vertex, alias, name)
    rows, shown = _rows(graph, vertex)
    return Node(
        alias,
        stack(
            [small(plain(labels.guillemets(labels.keywords(graph, vertex)))), _title(graph, vertex)]
        ),
        "state",
        rows,
        _inside(graph, vertex, aliases),
        shows=(vertex.id, *shown, *(region.id for region in _regions(graph, vertex))),
    )


def _pseudostate(graph: Graph, vertex: Element, alias: str, name: str) -> Node:
    """A reference to an entry or exit point of a submachine is drawn as that point."""
    points = (item.subkind for item in graph.targets(vertex, Edge.REFERENCES))
    shape = _SHAPES.get(next(points, "") if vertex.subkind == _REFERENCE else vertex.subkind)
    if shape is not None:
        return Node(alias, name, shape, shows=(vertex.id,))
    sign = "✕" if vertex.subkind == "terminate" else f"«{plain(vertex.subkind)}»"
    return Node(alias, stack([sign, label(vertex.name)]), "terminate", shows=(vertex.id,))


def _title(graph: Graph, state: Element) -> str:
    machines = (labels.name(item) for item in graph.targets(state, Edge.CALLS))
    submachine = ", ".join(machines) or labels.type_name(graph, state)
    return label(f"{labels.name(state)} : {submachine}" if submachine else labels.name(state))


def _rows(graph: Graph, state: Element) -> tuple[tuple[str, ...], list[str]]:
    """Entry, do and exit, internal transitions, deferred triggers and invariants of a state."""
    rows: list[str] = []
    shown: list[str] = []
    for word, edge in (("entry", Edge.ENTRY), ("do", Edge.DO), ("exit", Edge.EXIT)):
        for behaviour in graph.targets(state, edge):
            rows += lines(f"{word} / {behaviour_text(behaviour)}", _ROW)
            shown.append(behaviour.id)
    for item in graph.owned(state):
        if item.kind is Kind.TRIGGER:
            rows += lines(f"{trigger_text(graph, item)} / defer", _ROW)
        elif item.kind is Kind.CONSTRAINT:
            rows += lines(labels.condition(item), _ROW)
        else:
            continue
        shown.append(item.id)
    for transition in graph.sources(state, Edge.FLOW_SOURCE):
        if transition.subkind == "internal":
            rows += lines(transition_text(graph, transition), _ROW)
            shown += _parts(graph, transition)
    return tuple(rows), shown


def _transitions(graph: Graph, machine: Element, aliases: Aliases) -> Iterator[Line]:
    for item in graph.subtree(machine):
        if item.kind is not _TRANSITION or item.subkind == "internal":
            continue
        source = graph.target(item, Edge.FLOW_SOURCE)
        target = graph.target(item, Edge.FLOW_TARGET)
        if source is not None and target is not None and {source.id, target.id} <= aliases.keys():
            text = label(transition_text(graph, item))
            shows = tuple(_parts(graph, item))
            yield Line(aliases[source.id], "-->", aliases[target.id], text, shows=shows)


def _parts(graph: Graph, transition: Element) -> list[str]:
    """Ids that the label of a transition stands for."""
    effects = graph.targets(transition, Edge.EFFECT)
    owned = [item for item in graph.owned(transition) if item.kind is not Kind.APPLICATION]
    return [item.id for item in (transition, *owned, *effects)]


def transition_text(graph: Graph, transition: Element) -> str:
    """``trigger [guard] / effect``, of protocols ``/ [postcondition]`` (UML 2.5.1, 14.2.4)."""
    triggers = [trigger_text(graph, item) for item in graph.targets(transition, Edge.TRIGGER)]
    effects = [behaviour_text(item) for item in graph.targets(transition, Edge.EFFECT)]
    effects += [
        f"[{item.attrs.get('body') or labels.name(item)}]"
        for item in graph.owned(transition)
        if item.subkind == "postcondition"
    ]
    guard = guard_text(graph, transition)
    words = labels.guillemets(labels.keywords(graph, transition))
    parts = [words, ", ".join(triggers), guard, f"/ {'; '.join(effects)}" if effects else ""]
    return " ".join(part for part in parts if part) or transition.name


def guard_text(graph: Graph, flow: Element) -> str:
    """``[guard]`` of a transition or a flow, from its text or from the guard it refers to."""
    found = [str(item.attrs.get("body", item.name)) for item in graph.targets(flow, Edge.GUARD)]
    text = flow.attrs.get("guard", ", ".join(found))
    return "" if text in ("", None) else f"[{labels.literal(text)}]"


def behaviour_text(behaviour: Element) -> str:
    """The body of an opaque behaviour, else the behaviour's name."""
    return str(behaviour.attrs.get("body") or labels.name(behaviour))


def trigger_text(graph: Graph, trigger: Element) -> str:
    """``signal``, ``operation()``, ``after (5 s)``, ``at (noon)``, ``when (x > 3)`` or ``all``."""
    event = ", ".join(labels.name(item) for item in graph.targets(trigger, Edge.TYPED_BY))
    if trigger.subkind == "time":
        word = "after" if trigger.attrs.get("relative") else "at"
        return f"{word} ({trigger.attrs.get('when', trigger.name)})"
    if trigger.subkind == "change":
        return f"when ({trigger.attrs.get('condition', trigger.name)})"
    if trigger.subkind == "any":
        return "all"
    return f"{event}()" if trigger.subkind == "call" and event else event or labels.name(trigger)
