"""The drawing of an activity: nodes with their regions, and flows with both ends.

A structured node is a region of its own. Each test, body and set-up of a loop or conditional
becomes a structured node too (``Part``), so that it starts and ends as a whole.
"""

import re
from collections.abc import Iterator
from dataclasses import dataclass, field

from msgspec import Struct

from sysmlc.analyses.activities import rules
from sysmlc.analyses.activities.regions import (
    FLOWS,
    NODES,
    Handler,
    Part,
    count_handlers,
    find_expansion_nodes,
    find_groups,
    handlers_of,
    is_entered_again,
    parts_of,
)
from sysmlc.diagnostics import Sink, Subject
from sysmlc.ir import Edge, Element, Graph, Kind, query
from sysmlc.logic.activities.token_nodes import ACTIVITY_REGION
from sysmlc.logic.feature_writes import takes_one_step

_WORDS = {
    Kind.STRUCTURED: "structured node",
    Kind.ACTIVITY_PARAMETER: "parameter",
    Kind.OBJECT_NODE: "object node",
    Kind.DATA_STORE: "data store",
}
_ACTION_WORDS = {"accept": "accept action", "accept-call": "accept action", "send": "send action"}
_ASSIGNMENT = re.compile(r"\s*([\w.]+)\s*:=[^;]*;?\s*")
"""A text that is one assignment."""
_CONTROL_WORDS = {"initial": "initial node", "final": "activity final node"}


class CannotPlayError(Exception):
    """The activity has no token graph; the reason has been reported."""


class Flow(Struct, frozen=True):
    """A drawn flow. A pin is None if the flow is attached to the node itself.

    ``region`` is the innermost region that holds both ends. ``enters`` and ``leaves`` mean that the
    flow starts or ends at the border of that region, at a structured node or one of its pins.
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
    """The drawing of one activity. ``region`` maps the id of a node to the id of its region."""

    activity: Element
    inside: list[Element]
    """The activity and its content, nested content included."""
    nodes: list[Element] = field(default_factory=list)
    flows: list[Flow] = field(default_factory=list)
    region: dict[str, str] = field(default_factory=dict)
    parts: dict[str, list[Part]] = field(default_factory=dict)
    titles: dict[str, str] = field(default_factory=dict)
    """The name of each node, or what it calls or assigns, or nothing."""
    labels: dict[str, str] = field(default_factory=dict)
    handlers: dict[str, list[Handler]] = field(default_factory=dict)
    is_playable: bool = True
    """False if the token game cannot express the drawing; the reason has been reported."""
    _incoming: dict[str, list[Flow]] = field(default_factory=dict)
    _outgoing: dict[str, list[Flow]] = field(default_factory=dict)

    def add_flow(self, flow: Flow) -> None:
        """Add a flow, whose ends are nodes of the drawing."""
        self.flows.append(flow)
        if not flow.leaves:
            self._incoming.setdefault(flow.target.id, []).append(flow)
        if not flow.enters:
            self._outgoing.setdefault(flow.source.id, []).append(flow)

    def list_steps(self) -> list[Element]:
        """List the actions, structured nodes and control nodes outside of structured nodes."""
        steps = (Kind.ACTION, Kind.STRUCTURED, Kind.CONTROL, Kind.ACTIVITY)
        candidates = (node for node in self.nodes if node.kind in steps)
        return [node for node in candidates if self.region[node.id] == ACTIVITY_REGION]

    def incoming(self, node: Element) -> list[Flow]:
        """Return the flows to the node or its pins, without flows from inside the node."""
        return self._incoming.get(node.id, [])

    def outgoing(self, node: Element) -> list[Flow]:
        """Return the flows from the node or its pins, without flows to nodes inside the node."""
        return self._outgoing.get(node.id, [])

    def enclosing_regions(self, region: str) -> Iterator[str]:
        """Yield the region and those around it, from the innermost to the activity's."""
        owners = {part.id: part.owner.id for parts in self.parts.values() for part in parts}
        while region != ACTIVITY_REGION:
            yield region
            region = owners[region] if region in owners else self.region[region]
        yield ACTIVITY_REGION

    def common_region(self, left: Element, right: Element) -> str:
        """Return the innermost region that contains both nodes."""
        left_regions, right_regions = (
            list(self.enclosing_regions(self.region[node.id])) for node in (left, right)
        )
        return next(region for region in left_regions if region in right_regions)


def read_drawing(graph: Graph, activity: Element, sink: Sink) -> Drawing:
    """Return the drawing of an activity.

    An activity whose text consists of assignments is its own only step.
    """
    drawing = Drawing(activity, list(graph.subtree(activity)))
    if takes_one_step(activity):
        drawing.nodes.append(activity)
        drawing.region[activity.id] = ACTIVITY_REGION
        _name_nodes(graph, drawing)
        return drawing
    # Groups and expansion nodes are no regions: nodes in them belong to the region around them.
    groups = find_groups(graph, drawing.inside)
    expansion_nodes = find_expansion_nodes(graph, drawing.inside)
    _collect_nodes(
        graph, drawing, activity, ACTIVITY_REGION, frozenset([*groups, *expansion_nodes])
    )
    _name_nodes(graph, drawing)
    for group in filter(lambda node: is_entered_again(graph, node), groups.values()):
        label = f"structured node '{group.name}'" if group.name else "a structured node"
        sink.report(rules.GROUPING, graph.subject(group), node=label)
    reader = _Reader(graph, drawing, sink, expansion_nodes)
    reader.check_nodes()
    reader.read_flows()
    return drawing


def _collect_nodes(
    graph: Graph, drawing: Drawing, owner: Element, region: str, dissolved: frozenset[str]
) -> None:
    parts = parts_of(graph, owner) if owner.kind is Kind.STRUCTURED else []
    if parts:
        drawing.parts[owner.id] = parts
    home = {id: part.id for part in parts for id in part.nodes}
    for element in graph.owned(owner):
        if element.kind not in NODES or not query.is_performed(graph, element):
            continue
        inner_region = home.get(element.id, region)
        if element.subkind == "interruptible" or element.id in dissolved:
            _collect_nodes(graph, drawing, element, inner_region, dissolved)
            continue
        drawing.nodes.append(element)
        drawing.region[element.id] = inner_region
        if element.kind is Kind.STRUCTURED:
            _collect_nodes(graph, drawing, element, element.id, dissolved)


def _name_nodes(graph: Graph, drawing: Drawing) -> None:
    numbers: dict[str, int] = {}
    uses = dict.fromkeys((node.name for node in drawing.nodes), 1)
    for node in drawing.nodes:
        word = _describe_kind(node)
        numbers[word] = numbers.get(word, 0) + 1
        title = node.name or _describe_content(graph, node)
        if title and not node.name:
            uses[title] = uses.get(title, 0) + 1
            title = title if uses[title] == 1 else f"{title} {uses[title]}"
        drawing.titles[node.id] = title
        drawing.labels[node.id] = f"{word} '{title}'" if title else f"{word} {numbers[word]}"


def _describe_content(graph: Graph, node: Element) -> str:
    """Return what an action without a name calls or assigns, or nothing."""
    called = graph.target(node, Edge.CALLS)
    if called is not None and node.subkind not in _ACTION_WORDS:
        return called.name
    assignment = _ASSIGNMENT.fullmatch(str(node.attrs.get("body", "")))
    return f"assign {assignment[1]}" if assignment else ""


def _describe_kind(node: Element) -> str:
    if node.kind is Kind.CONTROL:
        return _CONTROL_WORDS.get(node.subkind, node.subkind or "control node")
    if node.kind in (Kind.ACTION, Kind.ACTIVITY):
        return _ACTION_WORDS.get(node.subkind, "action")
    return _WORDS[node.kind]


class _Reader:
    """Finds the ends of flows, and reports elements that a token graph cannot express."""

    def __init__(
        self, graph: Graph, drawing: Drawing, sink: Sink, expansion_nodes: dict[str, Element]
    ) -> None:
        self.graph = graph
        self.drawing = drawing
        self.sink = sink
        self.expansion_nodes = expansion_nodes
        self.node_ids = {node.id for node in drawing.nodes}

    def check_nodes(self) -> None:
        for node in self.drawing.nodes:
            label = self.drawing.labels[node.id]
            self._read_handlers(node, label)
            if node.subkind == "expansion" and node.attrs.get("mode") != "iterative":
                mode = str(node.attrs.get("mode") or "parallel")
                subject = self.graph.subject(node)
                self.sink.report(rules.PARALLEL_EXPANSION, subject, node=label, mode=mode)
            if _is_special_join(node):
                text = str(node.attrs["join_spec"])
                self.sink.report(rules.JOIN_SPEC, self._fail(node), node=label, text=text)
            self._check_parts(node, label)
            self._check_selection(node, label)

    def _check_selection(self, element: Element, label: str) -> None:
        """Report behaviours that choose or change the objects of a flow or an object node."""
        for behaviour in ("selection", "transformation"):
            if behaviour in element.attrs:
                subject = self.graph.subject(element)
                self.sink.report(rules.SELECTION, subject, node=label, behaviour=behaviour)

    def _read_handlers(self, node: Element, label: str) -> None:
        if "handlers" not in node.attrs:
            return
        handlers = [h for h in handlers_of(self.graph, node) if h.body.id in self.node_ids]
        if handlers:
            self.drawing.handlers[node.id] = handlers
        if len(handlers) < count_handlers(node):
            self.sink.report(rules.NO_HANDLER_BODY, self.graph.subject(node), node=label)

    def _check_parts(self, node: Element, label: str) -> None:
        if node.subkind not in ("loop", "conditional"):
            return
        inside = {id for part in self.drawing.parts.get(node.id, ()) for id in part.nodes}
        works = (Kind.ACTION, Kind.STRUCTURED)
        unlisted = [
            member
            for member in self.drawing.nodes
            if self.drawing.region[member.id] == node.id and member.kind in works
        ]
        if unlisted or not inside:
            self.sink.report(
                rules.UNLISTED_ACTIONS, self._fail(node), node=label, kind=node.subkind
            )

    def read_flows(self) -> None:
        for element in self._list_flow_elements():
            flow = self._read_flow(element)
            if flow is not None:
                self.drawing.add_flow(flow)

    def _list_flow_elements(self) -> Iterator[Element]:
        stack = [self.drawing.activity]
        while stack:
            owner = stack.pop()
            owned = self.graph.owned(owner)
            yield from (element for element in owned if element.kind in FLOWS)
            stack.extend(reversed([e for e in owned if e.kind is Kind.STRUCTURED]))

    def _read_flow(self, element: Element) -> Flow | None:
        ends = [self._find_end(element, edge) for edge in (Edge.FLOW_SOURCE, Edge.FLOW_TARGET)]
        source, target = ends
        if source is None or target is None:
            return None
        self._check_selection(element, self._label_flow(element))
        weight = element.attrs.get("weight", 1)
        # Papyrus writes weight 0, which UML forbids, if the author sets none.
        if weight not in (0, 1, "0", "1"):
            self.sink.report(
                rules.WEIGHT, self._fail(element), flow=self._label_flow(element), weight=weight
            )
        return self._assign_region(Flow(element, source[0], target[0], source[1], target[1]))

    def _find_end(self, element: Element, edge: Edge) -> tuple[Element, Element | None] | None:
        """Return the node at an end of a flow and its pin, or None if the end is missing."""
        attached = self.graph.target(element, edge)
        node = attached
        while node is not None and node.id not in self.node_ids:
            node = self.expansion_nodes.get(node.id) or self.graph.owner(node)
        # The pass `resolve` has reported an end that leads to a missing element.
        unresolved = element.attrs.get("unresolved")
        if node is None and isinstance(unresolved, tuple) and edge.value in unresolved:
            self.drawing.is_playable = False
            return None
        if node is None:
            end = "source" if edge is Edge.FLOW_SOURCE else "target"
            self.sink.report(
                rules.MISSING_FLOW_END, self._fail(element), flow=self._label_flow(element), end=end
            )
            return None
        return node, None if attached is node else attached

    def _assign_region(self, flow: Flow) -> Flow:
        source, target = flow.source, flow.target
        if source is target:
            return self._assign_region_of_own_pins(flow)
        region = self.drawing.region[source.id]
        if region == self.drawing.region[target.id]:
            return flow if region == ACTIVITY_REGION else _with_region(flow, region)
        source_regions = list(self.drawing.enclosing_regions(region))
        target_regions = list(self.drawing.enclosing_regions(self.drawing.region[target.id]))
        if source.id in target_regions:
            return _with_region(flow, self._find_part(target_regions, source), enters=True)
        if target.id in source_regions:
            return _with_region(flow, self._find_part(source_regions, target), leaves=True)
        return _with_region(
            flow, next(region for region in source_regions if region in target_regions)
        )

    def _find_part(self, regions: list[str], node: Element) -> str:
        """Return the region among *regions* that is a part of the node, or else the node itself."""
        parts = {part.id for part in self.drawing.parts.get(node.id, ())}
        return next((region for region in regions if region in parts), node.id)

    def _assign_region_of_own_pins(self, flow: Flow) -> Flow:
        """Assign the region of a flow between pins of one node.

        A flow from an input pin to an output pin of a structured node is inside the node.
        """
        pins = (flow.source_pin, flow.target_pin)
        if flow.source.kind is Kind.STRUCTURED and None not in pins and _passes_through(*pins):
            return _with_region(flow, flow.source.id, enters=True, leaves=True)
        return _with_region(flow, self.drawing.region[flow.source.id])

    def _label_flow(self, element: Element) -> str:
        return flow_label(
            element,
            self._label_end(element, Edge.FLOW_SOURCE),
            self._label_end(element, Edge.FLOW_TARGET),
        )

    def _label_end(self, element: Element, edge: Edge) -> str:
        node = self.graph.target(element, edge)
        while node is not None and node.id not in self.node_ids:
            node = self.graph.owner(node)
        return "" if node is None else self.drawing.labels[node.id]

    def _fail(self, element: Element) -> Subject:
        """Note that the activity has no token graph, and return the subject of the diagnostic."""
        self.drawing.is_playable = False
        return self.graph.subject(element)


def flow_label(element: Element, source: str, target: str) -> str:
    """Return the text that names a flow in messages."""
    ends = f" from {source}" * bool(source) + f" to {target}" * bool(target)
    return f"the flow{ends}" if ends else f"flow '{element.name}'"


def _passes_through(source: Element | None, target: Element | None) -> bool:
    return _is_parameter_pin(source, "region_as_input", "in") and _is_parameter_pin(
        target, "region_as_output", "out"
    )


def _is_parameter_pin(pin: Element | None, side: str, direction: str) -> bool:
    return pin is not None and (side in pin.attrs or pin.attrs.get("direction") == direction)


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
    return str(node.attrs.get("join_spec", "and")).strip() != "and"
