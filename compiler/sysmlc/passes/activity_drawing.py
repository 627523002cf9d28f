"""What is drawn of an activity: its nodes with their regions, and its flows with both ends.

A structured node is a region of its own. The tests, bodies and set-ups of loops and conditionals
become structured nodes too (``Part``), so that each of them starts and ends as a whole.
"""

from collections.abc import Iterator
from dataclasses import dataclass, field

from sysmlc.diagnostics import Sink, Subject
from sysmlc.ir import Edge, Element, Graph, Kind
from sysmlc.logic.tokens import ACTIVITY_REGION
from sysmlc.passes import activity_rules as rules
from sysmlc.passes.activity_regions import FLOWS, Part, groups_of, handlers_of, parts_of

_NODES = (
    Kind.ACTION,
    Kind.STRUCTURED,
    Kind.CONTROL,
    Kind.ACTIVITY_PARAMETER,
    Kind.OBJECT_NODE,
    Kind.DATA_STORE,
)
_WORDS = {
    Kind.STRUCTURED: "structured node",
    Kind.ACTIVITY_PARAMETER: "parameter",
    Kind.OBJECT_NODE: "object node",
    Kind.DATA_STORE: "data store",
}
_ACTION_WORDS = {"accept": "accept action", "accept-call": "accept action", "send": "send action"}
_CONTROL_WORDS = {"initial": "initial node", "final": "activity final node"}


class CannotPlayError(Exception):
    """The activity has no token graph; the reason has been reported."""


@dataclass(frozen=True, slots=True)
class Flow:
    """One drawn flow; pins are None where it is attached to the node itself.

    ``region`` is where its token is; ``enters`` and ``leaves`` say that it starts or ends at the
    border of that region.
    """

    element: Element
    source: Element
    target: Element
    source_pin: Element | None = None
    target_pin: Element | None = None
    region: str = ACTIVITY_REGION
    enters: bool = False
    leaves: bool = False


@dataclass(slots=True)
class Drawing:
    """One activity; ``region`` maps each node's id to the id of its region."""

    activity: Element
    nodes: list[Element] = field(default_factory=list)
    flows: list[Flow] = field(default_factory=list)
    region: dict[str, str] = field(default_factory=dict)
    parts: dict[str, list[Part]] = field(default_factory=dict)
    labels: dict[str, str] = field(default_factory=dict)

    def incoming(self, node: Element) -> list[Flow]:
        """Flows that reach the node or one of its pins from outside."""
        return [flow for flow in self.flows if flow.target is node and not flow.leaves]

    def outgoing(self, node: Element) -> list[Flow]:
        """Flows that leave the node or one of its pins to the outside."""
        return [flow for flow in self.flows if flow.source is node and not flow.enters]


def read(graph: Graph, activity: Element, sink: Sink) -> Drawing:
    """The drawing of an activity. Raises CannotPlayError after it has reported why."""
    drawing = Drawing(activity)
    handlers = handlers_of(graph, activity)
    groups = groups_of(graph, activity)
    _collect(graph, drawing, activity, ACTIVITY_REGION, handlers, frozenset(groups))
    _name_nodes(drawing)
    for group in groups.values():
        label = f"structured node '{group.name}'" if group.name else "a structured node"
        sink.report(rules.GROUPING, graph.subject(group), node=label)
    reader = _Reader(graph, drawing, sink, handlers)
    reader.check_nodes()
    reader.read_flows()
    if reader.has_failed:
        raise CannotPlayError
    return drawing


def _collect(
    graph: Graph,
    drawing: Drawing,
    owner: Element,
    region: str,
    left_out: frozenset[str],
    groups: frozenset[str],
) -> None:
    parts = parts_of(owner) if owner.kind is Kind.STRUCTURED else []
    if parts:
        drawing.parts[owner.id] = parts
    home = {id: part.id for part in parts for id in part.nodes}
    for element in graph.owned(owner):
        if element.kind not in _NODES or element.id in left_out:
            continue
        inside = home.get(element.id, region)
        if element.subkind == "interruptible" or element.id in groups:
            _collect(graph, drawing, element, inside, left_out, groups)
            continue
        drawing.nodes.append(element)
        drawing.region[element.id] = inside
        if element.kind is Kind.STRUCTURED:
            _collect(graph, drawing, element, element.id, left_out, groups)


def _name_nodes(drawing: Drawing) -> None:
    numbers: dict[str, int] = {}
    for node in drawing.nodes:
        word = _word(node)
        numbers[word] = numbers.get(word, 0) + 1
        drawing.labels[node.id] = (
            f"{word} '{node.name}'" if node.name else f"{word} {numbers[word]}"
        )


def _word(node: Element) -> str:
    if node.kind is Kind.CONTROL:
        return _CONTROL_WORDS.get(node.subkind, node.subkind or "control node")
    if node.kind is Kind.ACTION:
        return _ACTION_WORDS.get(node.subkind, "action")
    return _WORDS[node.kind]


class _Reader:
    """Finds the ends of flows, and reports what has no token graph."""

    def __init__(
        self, graph: Graph, drawing: Drawing, sink: Sink, left_out: frozenset[str]
    ) -> None:
        self.graph = graph
        self.drawing = drawing
        self.sink = sink
        self.left_out = left_out
        self.has_failed = False
        self.known = {node.id for node in drawing.nodes}

    def check_nodes(self) -> None:
        for node in self.drawing.nodes:
            label = self.drawing.labels[node.id]
            if "handlers" in node.attrs:
                self.sink.report(rules.HANDLER, self.graph.subject(node), node=label)
            if node.kind is Kind.DATA_STORE:
                self.sink.report(
                    rules.UNSUPPORTED, self._failed(node), node=label, what="a data store"
                )
            elif node.subkind == "expansion":
                self.sink.report(
                    rules.UNSUPPORTED, self._failed(node), node=label, what="an expansion region"
                )
            elif _is_special_join(node):
                text = str(node.attrs["join_spec"])
                self.sink.report(rules.JOIN_SPEC, self._failed(node), node=label, text=text)
            self._check_parts(node, label)

    def _check_parts(self, node: Element, label: str) -> None:
        parts = self.drawing.parts.get(node.id, ())
        inside = {id for part in parts for id in part.nodes}
        loose = [n for n in self.drawing.nodes if self.drawing.region[n.id] == node.id]
        if node.subkind in ("loop", "conditional") and (loose or not inside):
            what = f"a {node.subkind} node with nodes outside its tests and bodies"
            self.sink.report(rules.UNSUPPORTED, self._failed(node), node=label, what=what)

    def read_flows(self) -> None:
        for element in self._flow_elements():
            flow = self._flow(element)
            if flow is not None:
                self.drawing.flows.append(flow)

    def _flow_elements(self) -> Iterator[Element]:
        stack = [self.drawing.activity]
        while stack:
            owner = stack.pop()
            owned = self.graph.owned(owner)
            yield from (element for element in owned if element.kind in FLOWS)
            inner = [e for e in owned if e.kind is Kind.STRUCTURED and e.id not in self.left_out]
            stack.extend(reversed(inner))

    def _flow(self, element: Element) -> Flow | None:
        ends = [self._end(element, edge) for edge in (Edge.FLOW_SOURCE, Edge.FLOW_TARGET)]
        source, target = ends
        if source is None or target is None:
            return None
        weight = element.attrs.get("weight", 1)
        # Papyrus writes weight 0, which UML forbids, where nobody set one.
        if weight not in (0, 1, "0", "1"):
            self.sink.report(
                rules.WEIGHT, self._failed(element), flow=self._flow_label(element), weight=weight
            )
            return None
        return self._placed(element, *source, *target)

    def _end(self, element: Element, edge: Edge) -> tuple[Element, Element | None] | None:
        """The node at an end and its pin; None for what was reported or left out."""
        found = self.graph.target(element, edge)
        node = found
        while node is not None and node.id not in self.known and node.id not in self.left_out:
            node = self.graph.owner(node)
        if node is None:
            end = "source" if edge is Edge.FLOW_SOURCE else "target"
            self.sink.report(
                rules.LOOSE_FLOW, self._failed(element), flow=self._flow_label(element), end=end
            )
        if node is None or node.id in self.left_out or self._is_left_out(node):
            return None
        return node, None if found is node else found

    def _is_left_out(self, node: Element) -> bool:
        return any(above.id in self.left_out for above in self.graph.ancestors(node))

    def _placed(
        self,
        element: Element,
        source: Element,
        source_pin: Element | None,
        target: Element,
        target_pin: Element | None,
    ) -> Flow | None:
        flow = Flow(element, source, target, source_pin, target_pin)
        here, there = self.drawing.region[source.id], self.drawing.region[target.id]
        if here == there and source is not target:
            return _with_region(flow, here)
        if self._is_border(source, there):
            return _with_region(flow, there, enters=True)
        if self._is_border(target, here):
            return _with_region(flow, here, leaves=True)
        if here == there:
            return _with_region(flow, here)
        self.sink.report(rules.CROSSING, self._failed(element), flow=self._flow_label(element))
        return None

    def _is_border(self, node: Element, region: str) -> bool:
        """Whether the region is inside the structured node: the node, or one of its parts."""
        parts = (part.id for part in self.drawing.parts.get(node.id, ()))
        return node.kind is Kind.STRUCTURED and region in (node.id, *parts)

    def _flow_label(self, element: Element) -> str:
        return flow_label(
            element,
            self._name_of_end(element, Edge.FLOW_SOURCE),
            self._name_of_end(element, Edge.FLOW_TARGET),
        )

    def _name_of_end(self, element: Element, edge: Edge) -> str:
        node = self.graph.target(element, edge)
        while node is not None and node.id not in self.known:
            node = self.graph.owner(node)
        return "" if node is None else self.drawing.labels[node.id]

    def _failed(self, element: Element) -> Subject:
        """The element as the subject of what stops the drawing from being a token graph."""
        self.has_failed = True
        return self.graph.subject(element)


def flow_label(element: Element, source: str, target: str) -> str:
    """What a flow is called in messages."""
    ends = f" from {source}" * bool(source) + f" to {target}" * bool(target)
    return f"the flow{ends}" if ends else f"flow '{element.name}'"


def _with_region(flow: Flow, region: str, enters: bool = False, leaves: bool = False) -> Flow:
    return Flow(
        flow.element,
        flow.source,
        flow.target,
        flow.source_pin,
        flow.target_pin,
        region,
        enters,
        leaves,
    )


def _is_special_join(node: Element) -> bool:
    return str(node.attrs.get("join_spec") or "and").strip() not in ("and", "")
