"""Activity diagrams: one for each activity with nodes, drawn as a graph (docs/decisions).

Activity partitions are written on their nodes, with a tint for each partition. UML 2.5.1, clause
15.6.4 allows ``(Robot)`` above a name instead of a lane; docs/decisions says why lanes as boxes
were given up.
"""

from collections.abc import Iterator
from dataclasses import dataclass, field

from msgspec import Struct

from sysmlc.backends.plantuml import labels
from sysmlc.backends.plantuml.block_definition import ACTIVITY_NODES
from sysmlc.backends.plantuml.labels import make_notes
from sysmlc.backends.plantuml.relations import list_node_allocations
from sysmlc.backends.plantuml.state_machine import draw_parts, format_guard, format_trigger
from sysmlc.backends.plantuml.views import Aliases, Diagram, GraphView, Line, Node
from sysmlc.ir import AttrValue, Edge, Element, Graph, Kind, as_texts, list_items
from sysmlc.ir.query import has_generated_name
from sysmlc.ir.query.classifiers import name_value_unit
from sysmlc.support.plantuml_text import escape_line, format_label, join_rows, shrink, wrap_lines

_CONTROL_SHAPES = {
    "initial": "start",
    "final": "end",
    "flow-final": "flowfinal",
    "decision": "choice",
    "merge": "choice",
    "fork": "fork",
    "join": "join",
}
_WITHOUT_KEYWORD = frozenset(["call-behavior", "call-operation", "opaque", ""])
_KEYWORDS = {
    "send": "send signal",
    "accept": "accept event",
    "accept-call": "accept call",
    "read": "read",
    "write": "write",
}
_SHAPES = {"accept": "accept", "accept-call": "accept", "send": "send", "broadcast": "send"}
_ROW_WIDTH = 44


class Look(Struct, frozen=True):
    """The look of a node.

    ``words`` are keywords and stereotypes. ``pins`` are the ids of the pins that the rows show, and
    ``shows`` the ids of the other elements that they show.
    """

    shape: str
    title: str
    words: tuple[str, ...] = ()
    rows: tuple[str, ...] = ()
    note: str = ""
    pins: tuple[str, ...] = ()
    shows: tuple[str, ...] = ()


def choose_look(graph: Graph, node: Element) -> Look:
    """Return the look of an activity node, from its kind and subkind."""
    if node.kind is Kind.CONTROL:
        return _look_of_control(graph, node)
    if node.kind in (Kind.ACTION, Kind.STRUCTURED):
        return _look_of_action(graph, node)
    return _look_of_object(graph, node)


def iter_handlers(graph: Graph, node: Element) -> Iterator[tuple[str, list[str]]]:
    """Yield the exception handlers of a protected node.

    Each is the id of the handler body with the names of the exception types.
    """
    for handler in list_items(node.attrs.get("handlers")):
        parts = list_items(handler)
        body, types = (as_texts(parts[index]) if len(parts) > index else () for index in (0, 2))
        elements = (graph.get(id) for id in types)
        yield (
            next(iter(body), ""),
            [labels.name(element) for element in elements if element is not None],
        )


def _look_of_control(graph: Graph, node: Element) -> Look:
    shape = _CONTROL_SHAPES.get(node.subkind, "control")
    if shape == "flowfinal":
        # State diagrams of PlantUML have no flow final node, so a large sign is drawn as text.
        return Look("flowfinal", "<size:22>⊗</size>")
    return Look(
        shape, format_label(labels.name(node)), note=format_label(_format_control_note(graph, node))
    )


def _format_control_note(graph: Graph, node: Element) -> str:
    """Return the texts that PlantUML cannot print inside a diamond or a bar."""
    behaviour = graph.get(str(node.attrs.get("decision_input", "")))
    parts = [
        "" if node.subkind == "initial" or has_generated_name(node) else node.name,
        f"«decisionInput» {labels.name(behaviour)}" if behaviour is not None else "",
        f"{{joinSpec = {node.attrs['join_spec']}}}" if node.attrs.get("join_spec") else "",
    ]
    return "\n".join(part for part in parts if part)


def _look_of_object(graph: Graph, node: Element) -> Look:
    words = {Kind.DATA_STORE: ("datastore",), Kind.OBJECT_NODE: ("centralBuffer",)}
    if node.subkind == "expansion":
        words[Kind.OBJECT_NODE] = ("expansionNode",)
    direction = node.attrs.get("direction")
    applied = labels.list_stereotypes(graph, node)
    # A node without a name has the name of the parameter or state that it refers to.
    typed = next((t for t in (node, *graph.targets(node, Edge.REFERENCES)) if t.name), node)
    text = labels.format_typed(graph, node)
    if node.kind is Kind.ACTIVITY_PARAMETER:
        parameter = graph.target(node, Edge.REFERENCES)
        source = parameter if parameter is not None else node
        text = labels.format_typed(graph, source, node.name or typed.name)
        words = {Kind.ACTIVITY_PARAMETER: (f"parameter {direction}" if direction else "parameter",)}
    shape = "store" if node.kind is Kind.DATA_STORE else "object"
    states = [s.name for s in graph.targets(node, Edge.REFERENCES) if s.kind is Kind.STATE]
    rows = wrap_lines(f"[{', '.join(states)}]") if states else ()
    return Look(shape, format_label(text), applied or words.get(node.kind, ()), rows)


def _look_of_action(graph: Graph, node: Element) -> Look:
    pins = [item for item in graph.owned(node) if item.kind is Kind.PIN]
    behaviours = graph.targets(node, Edge.CALLS)
    details = [item for item in graph.owned(node) if item.kind in (Kind.TRIGGER, Kind.CONSTRAINT)]
    rows = [
        *_iter_body_rows(node),
        *_iter_called_rows(node, behaviours),
        *_iter_detail_rows(graph, node, details),
    ]
    rows += [row for pin in pins for row in _format_pin(graph, pin)]
    allocations, ids = list_node_allocations(graph, node)
    return Look(
        _SHAPES.get(node.subkind, "structured" if node.kind is Kind.STRUCTURED else "action"),
        format_label(_format_title(graph, node, behaviours)),
        _list_keywords(graph, node),
        (*rows, *allocations),
        pins=tuple(pin.id for pin in pins),
        shows=(*(item.id for item in details), *ids),
    )


def _format_title(graph: Graph, node: Element, behaviours: list[Element]) -> str:
    if node.name:
        return node.name
    if behaviours:
        return ", ".join(labels.name(item) for item in behaviours)
    if "collection" in node.attrs:
        variables = (feature.name for feature in graph.owned(node) if feature.subkind == "variable")
        return f"for each {next(variables, 'one')} of {node.attrs['collection']}"
    return labels.literal(node.attrs.get("value")) if "value" in node.attrs else labels.name(node)


def _list_keywords(graph: Graph, node: Element) -> tuple[str, ...]:
    applied = labels.list_stereotypes(graph, node)
    if node.subkind == "expansion":
        return (str(node.attrs.get("mode") or "parallel"), *applied)
    if node.kind is Kind.STRUCTURED:
        return (node.subkind or "structured", *applied)
    # State diagrams of PlantUML have no shapes for accept and send actions (decision 10).
    kind = _KEYWORDS.get(node.subkind, node.subkind.replace("-", " "))
    return (
        applied
        if node.subkind in _WITHOUT_KEYWORD and applied
        else tuple(w for w in (kind, *applied) if w)
    )


def _iter_body_rows(node: Element) -> Iterator[str]:
    """Yield the body of an opaque action, or the value of a value action."""
    if node.attrs.get("body"):
        for part in labels.literal(node.attrs["body"]).splitlines():
            yield from wrap_lines(part, _ROW_WIDTH)
    if "value" in node.attrs and node.name:
        yield from wrap_lines(f"= {labels.literal(node.attrs['value'])}", _ROW_WIDTH)


def _iter_called_rows(node: Element, behaviours: list[Element]) -> Iterator[str]:
    for item in behaviours:
        if node.name and item.name.lower() != node.name.lower():
            yield from wrap_lines(f"calls {labels.name(item)}", _ROW_WIDTH)


def _iter_detail_rows(graph: Graph, node: Element, details: list[Element]) -> Iterator[str]:
    for item in details:
        if item.kind is Kind.TRIGGER:
            text = format_trigger(graph, item)
            yield from wrap_lines(text, _ROW_WIDTH) if text != node.name else ()
        else:
            yield from wrap_lines(labels.condition(item), _ROW_WIDTH)


def _format_pin(graph: Graph, pin: Element) -> tuple[str, ...]:
    """Return the rows ``in name : Type = value unit``."""
    direction = str(pin.attrs.get("direction", ""))
    name = pin.name or (pin.subkind if not graph.targets(pin, Edge.TYPED_BY) else "")
    value = f" = {labels.literal(pin.attrs['value'])}" if "value" in pin.attrs else ""
    unit = name_value_unit(graph, pin, "value")
    text = f"{direction} {labels.format_typed(graph, pin, name)}{value} {unit}".strip()
    return wrap_lines(text, _ROW_WIDTH)


# -- diagrams --------------------------------------------------------------------------------------


TINTS = 6
"""Number of tints in ``_style.j2``; a seventh partition has the tint of the first."""


FLOWS = (Kind.CONTROL_FLOW, Kind.OBJECT_FLOW)
_CONTROL_FLOW = "-[dashed]->"
_OBJECT_FLOW = "-->"
_INTERRUPTING = "-[bold]->"
_PARTITION, _PARAMETER = Kind.PARTITION, Kind.PARAMETER
_DRAWN = frozenset([*ACTIVITY_NODES, Kind.PARTITION])
_FLOW_LABEL_WIDTH = 30
_MAX_SIGNATURE = 60


def draw_activities(graph: Graph) -> Iterator[Diagram]:
    """Yield all activity diagrams, in the order of the model."""
    for activity in graph.of_kind(Kind.ACTIVITY):
        if not activity.attrs.get("external"):
            yield from _draw_activity(graph, activity)


def _draw_activity(graph: Graph, activity: Element) -> Iterator[Diagram]:
    inside = list(graph.subtree(activity))
    if not any(item.kind in _DRAWN for item in inside):
        return
    drawing = _ActivityDrawing(graph, activity, inside)
    view = drawing.build_view()
    if view.nodes:
        parameters = (item.id for item in graph.owned(activity) if item.kind is _PARAMETER)
        details = tuple(parameters) if drawing.signature else ()
        title = "Activity diagram"
        yield from draw_parts(graph, activity, view, "act", title, drawing.signature, details)


def draw_whole(graph: Graph, activity: Element) -> GraphView:
    """Return the complete view of an activity, however large."""
    return _ActivityDrawing(graph, activity, list(graph.subtree(activity))).build_view()


@dataclass(slots=True)
class _ActivityDrawing:
    """Builder of the view of one activity.

    ``alias_by_end`` maps the id of each node or pin, where flows may end, to the alias of the node.
    """

    graph: Graph
    activity: Element
    inside: list[Element]
    """The activity and all its direct and indirect members."""
    aliases: Aliases = field(default_factory=Aliases)
    alias_by_end: dict[str, str] = field(default_factory=dict)
    tints: dict[str, str] = field(default_factory=dict)
    signature: str = ""
    """The parameters in the heading of the frame; empty if the text would be too long."""

    def __post_init__(self) -> None:
        text = labels.signature(self.graph, self.activity)
        self.signature = text if len(text) <= _MAX_SIGNATURE else ""

    def build_view(self) -> GraphView:
        top_nodes = [
            node for node in self._list_nodes(self.activity) if self._find_region(node) is None
        ]
        partitions = (item for item in self.inside if item.kind is _PARTITION)
        self.tints = {item.id: f"lane{n % TINTS + 1}" for n, item in enumerate(partitions)}
        nodes = (*self._iter_partition_boxes(), *map(self._make_node, top_nodes))
        note_boxes = make_notes(
            self.graph, self.activity, self.aliases, not self.signature, self.inside
        )
        return GraphView(nodes, (*self._iter_lines(), *self._iter_handler_lines()), note_boxes)

    def _find_region(self, node: Element) -> Element | None:
        """Return the interruptible region that contains the node."""
        # The activity owns the node: regions, like partitions, only refer to their nodes.
        groups = self.graph.targets(node, Edge.IN_PARTITION)
        return next((item for item in groups if item.kind is Kind.STRUCTURED), None)

    def _list_nodes(self, owner: Element) -> list[Element]:
        return [item for item in self.graph.owned(owner) if item.kind in ACTIVITY_NODES]

    def _iter_partition_boxes(self) -> Iterator[Node]:
        """Yield a box for each partition that appears in the title of no node."""
        for partition in map(self.graph.__getitem__, self.tints):
            nodes = self.graph.sources(partition, Edge.IN_PARTITION)
            if all(node.kind is Kind.CONTROL for node in nodes):
                alias = self.aliases.make(partition.id, partition.name, "partition")
                title = format_label(self._format_partition(partition))
                yield Node(alias, title, "lane", shows=(partition.id,))

    def _format_partition(self, partition: Element) -> str:
        word = "«allocate» " if partition.role == "allocate partition" else ""
        represented = self.graph.targets(partition, Edge.REPRESENTS)
        names = ", ".join(labels.format_typed(self.graph, item) for item in represented)
        if not partition.name.strip() or partition.name == names:
            return word + (names or "partition")
        return word + (f"{partition.name}: {names}" if names else partition.name)

    def _make_group(
        self, element: Element, title: str, shape: str, children: tuple[Node, ...]
    ) -> Node:
        alias = self.aliases.make(element.id, element.name, str(element.kind))
        return Node(alias, title, shape, children=children, shows=(element.id,))

    def _make_node(self, node: Element) -> Node:
        alias = self.aliases.make(node.id, node.name, node.subkind or str(node.kind))
        # Pins are rows of the action: squares on its border would have their labels on the lines
        # (decision 10). A flow to a pin therefore ends at the action.
        look = choose_look(self.graph, node)
        self.alias_by_end[node.id] = alias
        self.alias_by_end.update(dict.fromkeys(look.pins, alias))
        lanes = self._list_title_partitions(node)
        where = shrink(escape_line(", ".join(f"({lane})" for lane in lanes.values())))
        title = join_rows([where, shrink(escape_line(labels.guillemets(look.words))), look.title])
        return Node(
            alias,
            title,
            look.shape,
            look.rows,
            self._list_content(node),
            look.note,
            (node.id, *look.pins, *look.shows, *lanes),
            next((self.tints[lane] for lane in lanes if lane in self.tints), ""),
        )

    def _list_title_partitions(self, node: Element) -> dict[str, str]:
        """Return the names of the node's partitions by id.

        The result is empty for control nodes: PlantUML prints no text in diamonds and bars.
        """
        if node.kind is Kind.CONTROL:
            return {}
        groups = self.graph.targets(node, Edge.IN_PARTITION)
        return {g.id: self._format_partition(g) for g in groups if g.kind is Kind.PARTITION}

    def _list_content(self, node: Element) -> tuple[Node, ...]:
        if node.kind is not Kind.STRUCTURED:
            return ()
        members = [self._make_member(node, item) for item in self._list_nodes(node)]
        members += self._iter_region_members(node)
        return _group_by_section(node, members, self.aliases)

    def _make_member(self, owner: Element, item: Element) -> tuple[str, Node]:
        return item.id, self._make_node(item)

    def _iter_region_members(self, region: Element) -> Iterator[tuple[str, Node]]:
        """Yield the nodes of the activity that are in an interruptible region."""
        for node in self.graph.sources(region, Edge.IN_PARTITION):
            if node.owner == self.activity.id and self._find_region(node) is region:
                yield node.id, self._make_node(node)

    def _iter_lines(self) -> Iterator[Line]:
        for flow in self.inside:
            if flow.kind not in FLOWS:
                continue
            source = self.graph.target(flow, Edge.FLOW_SOURCE)
            target = self.graph.target(flow, Edge.FLOW_TARGET)
            if source is None or target is None:
                continue
            # An end without alias has no shape in this activity, and PlantUML would invent one.
            if source.id in self.alias_by_end and target.id in self.alias_by_end:
                yield self._make_line(flow, source, target)

    def _iter_handler_lines(self) -> Iterator[Line]:
        """Yield lines from each protected node to the bodies of its exception handlers."""
        for node in (element for element in self.inside if "handlers" in element.attrs):
            for body, types in iter_handlers(self.graph, node):
                if node.id in self.alias_by_end and body in self.alias_by_end:
                    text = format_label(
                        " ".join(["⚡", ", ".join(types)]).strip(), _FLOW_LABEL_WIDTH
                    )
                    yield Line(
                        self.alias_by_end[node.id], _INTERRUPTING, self.alias_by_end[body], text
                    )

    def _make_line(self, flow: Element, source: Element, target: Element) -> Line:
        arrow = _CONTROL_FLOW if flow.kind is Kind.CONTROL_FLOW else _OBJECT_FLOW
        if flow.attrs.get("interrupts"):
            arrow = _INTERRUPTING
        text = format_label(self._format_flow(flow, source, target), _FLOW_LABEL_WIDTH)
        owned = [item.id for item in self.graph.owned(flow) if item.kind is not Kind.APPLICATION]
        shows = (flow.id, *owned)
        return Line(
            self.alias_by_end[source.id], arrow, self.alias_by_end[target.id], text, shows=shows
        )

    def _format_flow(self, flow: Element, source: Element, target: Element) -> str:
        pins = [item.name for item in (source, target) if item.kind is Kind.PIN and item.name]
        weight = flow.attrs.get("weight")
        parts = [
            labels.guillemets(labels.keywords(self.graph, flow)),
            "⚡" if flow.attrs.get("interrupts") else "",
            "«decisionInputFlow»" if target.attrs.get("decision_input_flow") == flow.id else "",
            " → ".join(dict.fromkeys(pins)),
            "" if _is_default_guard(flow, source) else format_guard(self.graph, flow),
            "" if pins else _format_flow_name(flow),
            f"{{weight = {labels.literal(weight)}}}" if _is_weighted(weight) else "",
        ]
        return " ".join(part for part in parts if part)


def _format_flow_name(flow: Element) -> str:
    """Return the name of a flow, unless a tool made it up or the guard says the same."""
    is_repeated = flow.name.strip() == str(flow.attrs.get("guard", ""))
    return "" if is_repeated or has_generated_name(flow) else flow.name.strip()


def _is_default_guard(flow: Element, source: Element) -> bool:
    """Whether the guard is the literal ``true`` that tools add to every flow.

    After a decision the literal is shown because it tells that this branch is always possible.
    """
    is_literal = flow.attrs.get("guard_literal") is True and flow.attrs.get("guard") == "true"
    return is_literal and source.subkind != "decision"


def _is_weighted(weight: AttrValue) -> bool:
    """Whether the author set the weight: 1 is the default, and 0 is what Papyrus writes unasked."""
    return weight is not None and str(weight) not in ("0", "1")


def _group_by_section(
    owner: Element, members: list[tuple[str, Node]], aliases: Aliases
) -> tuple[Node, ...]:
    """Put the nodes of a loop or a conditional into dashed boxes named after its sections."""
    remaining = dict(members)
    boxes = []
    for title, ids in _iter_sections(owner):
        section_nodes = tuple(remaining.pop(id) for id in ids if id in remaining)
        if section_nodes:
            alias = aliases.make(f"{owner.id} {title}", title, "section")
            boxes.append(Node(alias, shrink(escape_line(title)), "section", children=section_nodes))
    return (*boxes, *remaining.values())


def _iter_sections(owner: Element) -> Iterator[tuple[str, tuple[str, ...]]]:
    if owner.subkind == "loop":
        tested = "while" if owner.attrs.get("tested_first") else "until test"
        keys = {"setup_part": "setup", "test": tested, "body_part": "body"}
        yield from ((title, _list_ids(owner.attrs.get(key))) for key, title in keys.items())
    for number, clause in enumerate(list_items(owner.attrs.get("clauses")), 1):
        tests, bodies = clause if isinstance(clause, tuple) and len(clause) == 2 else ((), ())
        yield f"if {number}", _list_ids(tests)
        yield f"then {number}", _list_ids(bodies)


def _list_ids(value: AttrValue) -> tuple[str, ...]:
    if isinstance(value, tuple):
        return tuple(str(item) for item in value)
    return () if value is None else tuple(str(value).split())
