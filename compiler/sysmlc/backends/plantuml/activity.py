"""Activity diagrams: one for each activity with nodes, drawn as a graph (docs/decisions)."""

from collections.abc import Iterator
from dataclasses import dataclass, field

from sysmlc.backends.plantuml import activity_nodes, labels
from sysmlc.backends.plantuml.aliases import Aliases
from sysmlc.backends.plantuml.behaviour_notes import notes
from sysmlc.backends.plantuml.block_definition import ACTIVITY_NODES
from sysmlc.backends.plantuml.state_machine import divided, guard_text
from sysmlc.backends.plantuml.views import Diagram, GraphView, Line, Node
from sysmlc.ir import AttrValue, Edge, Element, Graph, Kind
from sysmlc.support.plantuml_text import label, plain, small, stack

TINTS = 6
"""Number of tints in ``_style.j2``; further partitions take them again."""


def tint(number: int) -> str:
    """Style of the nodes in the partition with this number, from 0."""
    return f"lane{number % TINTS + 1}"


FLOWS = (Kind.CONTROL_FLOW, Kind.OBJECT_FLOW)
_CONTROL_FLOW = "-[dashed]->"
_OBJECT_FLOW = "-->"
_INTERRUPTING = "-[bold]->"
_PARTITION, _PARAMETER = Kind.PARTITION, Kind.PARAMETER
_DRAWN = frozenset([*ACTIVITY_NODES, Kind.PARTITION])
_LABEL = 30
_FRAME = 60


def diagrams(graph: Graph) -> Iterator[Diagram]:
    """All activity diagrams, in the order of the model."""
    for activity in graph.of_kind(Kind.ACTIVITY):
        if not activity.attrs.get("external"):
            yield from _of_activity(graph, activity)


def _of_activity(graph: Graph, activity: Element) -> Iterator[Diagram]:
    inside = list(graph.subtree(activity))
    if not any(item.kind in _DRAWN for item in inside):
        return
    drawing = _Drawing(graph, activity, inside)
    view = drawing.view()
    if view.nodes:
        said = (item.id for item in graph.owned(activity) if item.kind is _PARAMETER)
        details = tuple(said) if drawing.signature else ()
        title = "Activity diagram"
        yield from divided(graph, activity, view, "act", title, drawing.signature, details)


def whole(graph: Graph, activity: Element) -> GraphView:
    """All of an activity in one view, however large."""
    return _Drawing(graph, activity, list(graph.subtree(activity))).view()


@dataclass(slots=True)
class _Drawing:
    """One activity on its way to a picture; ``homes`` maps what a flow may touch to a node."""

    graph: Graph
    activity: Element
    inside: list[Element]
    """The activity and all below it."""
    aliases: Aliases = field(default_factory=Aliases)
    homes: dict[str, str] = field(default_factory=dict)
    tints: dict[str, str] = field(default_factory=dict)
    signature: str = ""
    """Parameters for the frame; nothing when they are too long for it."""

    def __post_init__(self) -> None:
        text = labels.signature(self.graph, self.activity)
        self.signature = text if len(text) <= _FRAME else ""

    def view(self) -> GraphView:
        nodes = [node for node in self._nodes(self.activity) if self._region(node) is None]
        self.tints = self._tints()
        drawn = (*self._empty_lanes(), *map(self._node, nodes))
        said = notes(self.graph, self.activity, self.aliases, not self.signature, self.inside)
        return GraphView(drawn, (*self._lines(), *self._handlers()), said)

    def _tints(self) -> dict[str, str]:
        found = (item for item in self.inside if item.kind is _PARTITION)
        return {partition.id: tint(number) for number, partition in enumerate(found)}

    def _region(self, node: Element) -> Element | None:
        """The interruptible region that holds the node."""
        groups = self.graph.targets(node, Edge.IN_PARTITION)
        return next((item for item in groups if item.kind is Kind.STRUCTURED), None)

    def _owned(self, owner: Element) -> list[Element]:
        return self.graph.owned(owner)

    def _nodes(self, owner: Element) -> list[Element]:
        return [item for item in self._owned(owner) if item.kind in ACTIVITY_NODES]

    def _partitions(self, node: Element) -> list[Element]:
        groups = self.graph.targets(node, Edge.IN_PARTITION)
        return [group for group in groups if group.kind is Kind.PARTITION]

    def _empty_lanes(self) -> Iterator[Node]:
        """Boxes for partitions that no node has written on it."""
        for partition in map(self.graph.__getitem__, self.tints):
            nodes = self.graph.sources(partition, Edge.IN_PARTITION)
            if all(node.kind is Kind.CONTROL for node in nodes):
                alias = self.aliases.make(partition.id, partition.name, "partition")
                title = label(self._lane_name(partition))
                yield Node(alias, title, "lane", shows=(partition.id,))

    def _lane_name(self, partition: Element) -> str:
        word = "«allocate» " if partition.role == "allocate partition" else ""
        represented = self.graph.targets(partition, Edge.REPRESENTS)
        names = ", ".join(labels.typed(self.graph, item) for item in represented)
        if not partition.name.strip() or partition.name == names:
            return word + (names or "partition")
        return word + (f"{partition.name}: {names}" if names else partition.name)

    def _group(self, element: Element, title: str, shape: str, children: tuple[Node, ...]) -> Node:
        alias = self.aliases.make(element.id, element.name, str(element.kind))
        return Node(alias, title, shape, children=children, shows=(element.id,))

    def _node(self, node: Element) -> Node:
        alias = self.aliases.make(node.id, node.name, node.subkind or str(node.kind))
        look = activity_nodes.look(self.graph, node)
        self.homes[node.id] = alias
        self.homes.update(dict.fromkeys(look.pins, alias))
        lanes = self._written_lanes(node)
        where = small(plain(", ".join(f"({lane})" for lane in lanes.values())))
        title = stack([where, small(plain(labels.guillemets(look.words))), look.title])
        return Node(
            alias,
            title,
            look.shape,
            look.rows,
            self._content(node),
            look.note,
            (node.id, *look.pins, *look.shows, *lanes),
            next((self.tints[lane] for lane in lanes if lane in self.tints), ""),
        )

    def _written_lanes(self, node: Element) -> dict[str, str]:
        """Names of the node's partitions; diamonds and bars have no room for them."""
        found = () if node.kind is Kind.CONTROL else self._partitions(node)
        return {partition.id: self._lane_name(partition) for partition in found}

    def _content(self, node: Element) -> tuple[Node, ...]:
        if node.kind is not Kind.STRUCTURED:
            return ()
        held = [self._inner(node, item) for item in self._nodes(node)]
        held += self._regional(node)
        return _in_sections(node, held, self.aliases)

    def _inner(self, owner: Element, item: Element) -> tuple[str, Node]:
        return item.id, self._node(item)

    def _regional(self, region: Element) -> Iterator[tuple[str, Node]]:
        """Nodes of the activity that are in an interruptible region."""
        for node in self.graph.sources(region, Edge.IN_PARTITION):
            if node.owner == self.activity.id and self._region(node) is region:
                yield node.id, self._node(node)

    def _lines(self) -> Iterator[Line]:
        for flow in self.inside:
            if flow.kind not in FLOWS:
                continue
            source = self.graph.target(flow, Edge.FLOW_SOURCE)
            target = self.graph.target(flow, Edge.FLOW_TARGET)
            if source is None or target is None:
                continue
            if source.id in self.homes and target.id in self.homes:
                yield self._line(flow, source, target)

    def _handlers(self) -> Iterator[Line]:
        """From each protected node to the bodies of its exception handlers."""
        for node in (one for one in self.inside if "handlers" in one.attrs):
            for body, types in activity_nodes.handlers(self.graph, node):
                if node.id in self.homes and body in self.homes:
                    text = label(" ".join(["⚡", ", ".join(types)]).strip(), _LABEL)
                    yield Line(self.homes[node.id], _INTERRUPTING, self.homes[body], text)

    def _line(self, flow: Element, source: Element, target: Element) -> Line:
        arrow = _CONTROL_FLOW if flow.kind is Kind.CONTROL_FLOW else _OBJECT_FLOW
        if flow.attrs.get("interrupts"):
            arrow = _INTERRUPTING
        text = label(self._flow_text(flow, source, target), _LABEL)
        owned = [item.id for item in self._owned(flow) if item.kind is not Kind.APPLICATION]
        shows = (flow.id, *owned)
        return Line(self.homes[source.id], arrow, self.homes[target.id], text, shows=shows)

    def _flow_text(self, flow: Element, source: Element, target: Element) -> str:
        pins = [item.name for item in (source, target) if item.kind is Kind.PIN and item.name]
        weight = flow.attrs.get("weight")
        parts = [
            labels.guillemets(labels.keywords(self.graph, flow)),
            "⚡" if flow.attrs.get("interrupts") else "",
            "«decisionInputFlow»" if target.attrs.get("decision_input_flow") == flow.id else "",
            " → ".join(dict.fromkeys(pins)),
            "" if _is_default_guard(flow, source) else guard_text(self.graph, flow),
            f"{{weight = {labels.literal(weight)}}}" if _is_weighted(weight) else "",
        ]
        return " ".join(part for part in parts if part)


def _is_default_guard(flow: Element, source: Element) -> bool:
    """Tools write the literal true by themselves; it says something after a decision only."""
    is_literal = flow.attrs.get("guard_literal") is True and flow.attrs.get("guard") == "true"
    return is_literal and source.subkind != "decision"


def _is_weighted(weight: AttrValue) -> bool:
    """Whether someone set the weight: 1 is the default, and Papyrus writes 0 by itself."""
    return weight is not None and str(weight) not in ("0", "1")


def _in_sections(
    owner: Element, held: list[tuple[str, Node]], aliases: Aliases
) -> tuple[Node, ...]:
    """Nodes of a loop or a conditional in dashed boxes named after its sections."""
    left = dict(held)
    boxes = []
    for title, ids in _sections(owner):
        members = tuple(left.pop(id) for id in ids if id in left)
        if members:
            alias = aliases.make(f"{owner.id} {title}", title, "section")
            boxes.append(Node(alias, small(plain(title)), "section", children=members))
    return (*boxes, *left.values())


def _sections(owner: Element) -> Iterator[tuple[str, tuple[str, ...]]]:
    if owner.subkind == "loop":
        tested = "while" if owner.attrs.get("tested_first") else "until test"
        keys = {"setup_part": "setup", "test": tested, "body_part": "body"}
        yield from ((title, _ids(owner.attrs.get(key))) for key, title in keys.items())
    clauses = owner.attrs.get("clauses")
    for number, clause in enumerate(clauses if isinstance(clauses, tuple) else (), 1):
        tests, bodies = clause if isinstance(clause, tuple) and len(clause) == 2 else ((), ())
        yield f"if {number}", _ids(tests)
        yield f"then {number}", _ids(bodies)


def _ids(value: AttrValue) -> tuple[str, ...]:
    if isinstance(value, tuple):
        return tuple(str(item) for item in value)
    return () if value is None else tuple(str(value).split())
