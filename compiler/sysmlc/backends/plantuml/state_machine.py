"""State machine diagrams: one for each state machine with states."""

from collections.abc import Iterator

from sysmlc.backends.plantuml import labels, partitioning
from sysmlc.backends.plantuml.labels import make_notes
from sysmlc.backends.plantuml.partitioning import split_view
from sysmlc.backends.plantuml.views import Aliases, Diagram, GraphView, Line, Node
from sysmlc.ir import Edge, Element, Graph, Kind, query
from sysmlc.support.plantuml_text import escape_line, format_label, join_rows, shrink, wrap_lines

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
_POINT_REFERENCE = "connection-point"
_ROW_WIDTH = 44


def draw_state_machines(graph: Graph) -> Iterator[Diagram]:
    """Yield all state machine diagrams, in the order of the model."""
    for machine in graph.of_kind(Kind.STATE_MACHINE):
        view = draw_whole(graph, machine)
        if view.nodes:
            regions = tuple(item.id for item in _list_regions(graph, machine))
            title = "State machine diagram"
            yield from draw_parts(graph, machine, view, "stm", title, details=regions)


def draw_parts(
    graph: Graph,
    about: Element,
    view: GraphView,
    kind: str,
    title: str,
    signature: str = "",
    details: tuple[str, ...] = (),
) -> Iterator[Diagram]:
    """Yield the diagram of one behaviour, or its parts if it is too large for one picture.

    *signature* follows the name in the frame; *details* are the ids that the frame shows.
    """
    qualified_name = graph.qualified_name(about)
    parts = split_view(view)
    for index, part in enumerate(parts):
        diagram = Diagram(
            kind=kind,
            name=qualified_name,
            frame=escape_line(f"{kind} {labels.name(about)}{signature}"),
            heading=(title, qualified_name),
            view=part,
            about=about.id,
            details=details,
        )
        yield partitioning.name_part(diagram, index, len(parts))


def draw_whole(graph: Graph, machine: Element) -> GraphView:
    """Return the complete view of a state machine, however large."""
    aliases = Aliases()
    nodes = _list_content(graph, machine, aliases)
    # Entry and exit points stand on a border, so the machine gets a state around its content.
    if any(child.subkind in _POINTS for child in graph.owned(machine)):
        alias = aliases.make(machine.id, machine.name, "machine")
        nodes = (Node(alias, format_label(labels.name(machine)), "machine", children=nodes),)
    flows = tuple(_iter_transitions(graph, machine, aliases))
    return GraphView(nodes, flows, make_notes(graph, machine, aliases))


def find_depth(graph: Graph) -> int:
    """Return the largest nesting depth of states in all state machines."""
    level = list(graph.of_kind(Kind.STATE_MACHINE))
    levels = 0
    while level:
        levels += 1
        regions = [region for owner in level for region in _list_regions(graph, owner)]
        level = [v for owner in regions for v in graph.owned(owner) if v.kind in VERTICES]
    return levels


def _list_content(graph: Graph, owner: Element, aliases: Aliases) -> tuple[Node, ...]:
    """Return the vertices inside a state or state machine.

    Two or more regions have a dashed box each.
    """
    regions = _list_regions(graph, owner)
    points = [
        _make_vertex(graph, v, aliases) for v in graph.owned(owner) if v.kind is Kind.PSEUDOSTATE
    ]
    vertices_by_region = [
        tuple(_make_vertex(graph, v, aliases) for v in graph.owned(region) if v.kind in VERTICES)
        for region in regions
    ]
    if len(regions) < 2:
        return (*points, *(vertex for vertices in vertices_by_region for vertex in vertices))
    boxes = [
        Node(
            aliases.make(region.id, region.name, "region"),
            shrink(escape_line(region.name or f"region {number}")),
            "region",
            children=vertices,
            shows=(region.id,),
        )
        for number, (region, vertices) in enumerate(
            zip(regions, vertices_by_region, strict=True), 1
        )
    ]
    return (*points, *boxes)


def _list_regions(graph: Graph, owner: Element) -> list[Element]:
    return [item for item in graph.owned(owner) if item.kind is Kind.REGION]


def _make_vertex(graph: Graph, vertex: Element, aliases: Aliases) -> Node:
    alias = aliases.make(vertex.id, vertex.name, vertex.subkind or str(vertex.kind))
    name = format_label(labels.name(vertex))
    if vertex.kind is Kind.FINAL_STATE:
        return Node(alias, name, "end", shows=(vertex.id,))
    if vertex.kind is Kind.PSEUDOSTATE:
        return _make_pseudostate(graph, vertex, alias, name)
    rows, row_ids = _list_rows(graph, vertex)
    return Node(
        alias,
        join_rows(
            [
                shrink(escape_line(labels.guillemets(labels.keywords(graph, vertex)))),
                _format_title(graph, vertex),
            ]
        ),
        "state",
        rows,
        _list_content(graph, vertex, aliases),
        shows=(vertex.id, *row_ids, *(region.id for region in _list_regions(graph, vertex))),
    )


def _make_pseudostate(graph: Graph, vertex: Element, alias: str, name: str) -> Node:
    """Return the node of a pseudostate; a connection point reference has the shape of its point."""
    points = (item.subkind for item in graph.targets(vertex, Edge.REFERENCES))
    shape = _SHAPES.get(next(points, "") if vertex.subkind == _POINT_REFERENCE else vertex.subkind)
    if shape is not None:
        return Node(alias, name, shape, shows=(vertex.id,))
    sign = "✕" if vertex.subkind == "terminate" else f"«{escape_line(vertex.subkind)}»"
    return Node(
        alias, join_rows([sign, format_label(vertex.name)]), "terminate", shows=(vertex.id,)
    )


def _format_title(graph: Graph, state: Element) -> str:
    machines = (labels.name(item) for item in graph.targets(state, Edge.CALLS))
    submachine = ", ".join(machines) or labels.type_name(graph, state)
    return format_label(
        f"{labels.name(state)} : {submachine}" if submachine else labels.name(state)
    )


def _list_rows(graph: Graph, state: Element) -> tuple[tuple[str, ...], list[str]]:
    """Return the rows of a state, and the ids that they show.

    The rows are entry, do and exit behaviours, internal transitions, deferred triggers, invariants.
    """
    rows: list[str] = []
    ids: list[str] = []
    for word, edge in (("entry", Edge.ENTRY), ("do", Edge.DO), ("exit", Edge.EXIT)):
        for behaviour in graph.targets(state, edge):
            rows += wrap_lines(f"{word} / {_format_behaviour(behaviour)}", _ROW_WIDTH)
            ids.append(behaviour.id)
    for item in graph.owned(state):
        if item.kind is Kind.TRIGGER:
            rows += wrap_lines(f"{format_trigger(graph, item)} / defer", _ROW_WIDTH)
        elif item.kind is Kind.CONSTRAINT:
            rows += wrap_lines(labels.condition(item), _ROW_WIDTH)
        else:
            continue
        ids.append(item.id)
    for transition in graph.sources(state, Edge.FLOW_SOURCE):
        if transition.subkind == "internal":
            rows += wrap_lines(_format_transition(graph, transition), _ROW_WIDTH)
            ids += _list_label_ids(graph, transition)
    return tuple(rows), ids


def _iter_transitions(graph: Graph, machine: Element, aliases: Aliases) -> Iterator[Line]:
    for item in graph.subtree(machine):
        if item.kind is not _TRANSITION or item.subkind == "internal":
            continue
        ends = graph.target(item, Edge.FLOW_SOURCE), graph.target(item, Edge.FLOW_TARGET)
        source, target = (aliases[end.id] if end and end.id in aliases else "" for end in ends)
        if source and target:
            text = format_label(_format_transition(graph, item))
            yield Line(source, "-->", target, text, shows=tuple(_list_label_ids(graph, item)))


def _list_label_ids(graph: Graph, transition: Element) -> list[str]:
    """Return the ids of the elements in the label of a transition."""
    effects = graph.targets(transition, Edge.EFFECT)
    members = [item for item in graph.owned(transition) if item.kind is not Kind.APPLICATION]
    return [item.id for item in (transition, *members, *effects)]


def _format_transition(graph: Graph, transition: Element) -> str:
    """Return ``trigger [guard] / effect`` (UML 2.5.1, 14.2.4).

    A protocol transition also has ``/ [postcondition]``.
    """
    triggers = [format_trigger(graph, item) for item in graph.targets(transition, Edge.TRIGGER)]
    effects = [_format_behaviour(item) for item in graph.targets(transition, Edge.EFFECT)]
    effects += [
        f"[{item.attrs.get('body') or labels.name(item)}]"
        for item in graph.owned(transition)
        if item.subkind == "postcondition"
    ]
    guard = format_guard(graph, transition)
    words = labels.guillemets(labels.keywords(graph, transition))
    parts = [words, ", ".join(triggers), guard, f"/ {'; '.join(effects)}" if effects else ""]
    return " ".join(part for part in parts if part) or transition.name


def format_guard(graph: Graph, flow: Element) -> str:
    """Return ``[guard]`` of a transition or flow, or an empty text.

    The guard is an attribute of the flow, or a constraint to which the flow refers.
    """
    texts = [str(item.attrs.get("body", item.name)) for item in graph.targets(flow, Edge.GUARD)]
    text = flow.attrs.get("guard", ", ".join(texts))
    return "" if text in ("", None) else f"[{labels.literal(text)}]"


def _format_behaviour(behaviour: Element) -> str:
    """Return the body of an opaque behaviour, else the behaviour's name."""
    return str(behaviour.attrs.get("body") or labels.name(behaviour))


def format_trigger(graph: Graph, trigger: Element) -> str:
    """Return the text of a trigger.

    The forms are ``signal``, ``operation()``, ``after (5 s)``, ``at (noon)``, ``when (x > 3)`` and
    ``all``.
    """
    event = ", ".join(labels.name(item) for item in graph.targets(trigger, Edge.TYPED_BY))
    if trigger.subkind == "time":
        time = query.time_of(trigger)
        return f"{'after' if time.is_relative else 'at'} ({time.text})"
    if trigger.subkind == "change":
        return f"when ({trigger.attrs.get('condition', trigger.name)})"
    if trigger.subkind == "any":
        return "all"
    return f"{event}()" if trigger.subkind == "call" and event else event or labels.name(trigger)
