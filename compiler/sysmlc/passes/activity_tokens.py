"""From a drawing to a token graph: one node a node, one edge a flow, and what UML implies.

Implied are: the start of actions without incoming flows (an accept action listens again after
each event), the fork after an action, the join before it, the merge at a pin that several flows
reach, the choice at an object node that several flows leave, and the order of a sequence node.
"""

from dataclasses import replace
from itertools import pairwise

from sysmlc.diagnostics import Sink
from sysmlc.ir import Edge, Element, Graph, Kind, query
from sysmlc.ir.identity import derived_id
from sysmlc.logic import formula as f
from sysmlc.logic.names import identifier
from sysmlc.logic.tokens import (
    Duration,
    Guard,
    Interruptible,
    NodeKind,
    TokenEdge,
    TokenGraph,
    TokenNode,
)
from sysmlc.passes import activity_rules as rules
from sysmlc.passes.activity_drawing import Drawing, Flow, Part, flow_label, interruptible_regions
from sysmlc.passes.activity_inputs import Answer, Inputs, events

_CONTROLS = {
    "initial": NodeKind.INITIAL,
    "final": NodeKind.ACTIVITY_FINAL,
    "flow-final": NodeKind.FLOW_FINAL,
    "decision": NodeKind.DECISION,
    "merge": NodeKind.MERGE,
    "fork": NodeKind.FORK,
    "join": NodeKind.JOIN,
}
_SILENT_WORDS = (
    "value read read-self read-extent read-link read-link-object-end read-variable "
    "read-is-classified-object test-identity unmarshall reduce"
)
_PULSE_WORDS = (
    "send broadcast send-object reply raise start start-object-behavior start-classifier-behavior "
    "write clear remove create destroy reclassify create-link destroy-link create-link-object "
    "clear-association add-structural-feature-value add-variable-value remove-variable-value "
    "clear-variable assign"
)
_SILENT = frozenset(_SILENT_WORDS.split(" "))
_PULSES = frozenset(_PULSE_WORDS.split(" "))
_SHORT = {"initial": "start", "final": "end"}
_OUTPUTS = {"send": "send", "broadcast": "send", "send-object": "send", "reply": "reply"}
_ACCEPTS = ("accept", "accept-call")


def build(graph: Graph, drawing: Drawing, inputs: Inputs, sink: Sink) -> TokenGraph:
    """The token graph of a drawing; reports shapes that UML asks to be drawn otherwise."""
    return _Builder(graph, drawing, inputs, sink).build()


class _Builder:
    def __init__(self, graph: Graph, drawing: Drawing, inputs: Inputs, sink: Sink) -> None:
        self.graph = graph
        self.drawing = drawing
        self.inputs = inputs
        self.sink = sink
        self.nodes: dict[str, TokenNode] = {}
        self.edges: list[TokenEdge] = []
        self.short: dict[str, str] = {}
        self.answers: dict[str, Answer] = {}
        self.chained: set[str] = set()
        self.used: set[str] = set()
        self.takers: dict[str, list[Element]] = {}
        self.incoming: dict[str, list[Flow]] = {node.id: [] for node in drawing.nodes}
        self.outgoing: dict[str, list[Flow]] = {node.id: [] for node in drawing.nodes}

    def build(self) -> TokenGraph:
        for flow in self.drawing.flows:
            if not flow.enters:
                self.outgoing[flow.source.id].append(flow)
            if not flow.leaves:
                self.incoming[flow.target.id].append(flow)
        for node in self.drawing.nodes:
            self._add_node(node)
        for node in self.drawing.nodes:
            self._add_order(node)
        for flow in self.drawing.flows:
            self._add_flow(flow)
        for node in self.drawing.nodes:
            self._add_start(node)
        self._check_events()
        return self._result()

    def _check_events(self) -> None:
        for event, takers in self.takers.items():
            if len(takers) > 1:
                names = " and ".join(self.drawing.labels[node.id] for node in takers)
                subject = self.graph.subject(takers[0])
                self.sink.report(rules.SHARED_EVENT, subject, nodes=names, event=event)

    def _result(self) -> TokenGraph:
        activity = self.drawing.activity
        return TokenGraph(
            activity=activity.id,
            component=query.component_name(self.graph, activity),
            label=f"activity '{activity.name}'" if activity.name else "the activity",
            nodes=tuple(self.nodes.values()),
            edges=tuple(self.edges),
            inputs=tuple(self.inputs.variables.values()),
            pulses=tuple(self.inputs.pulses),
            interruptibles=tuple(
                Interruptible(region.id, region.name, self._members(members))
                for region, members in interruptible_regions(
                    self.graph, activity, self.drawing.nodes
                )
            ),
        )

    def _members(self, elements: list[Element]) -> tuple[str, ...]:
        """The region's nodes with what was added for them."""
        owners = {element.id for element in elements}
        return tuple(node.id for node in self.nodes.values() if node.origin in owners)

    # -- nodes ---------------------------------------------------------------------------------

    def _add_node(self, node: Element) -> None:
        label = self.drawing.labels[node.id]
        kind = self._kind(node)
        short = identifier(node.name or _SHORT.get(node.subkind, label))
        self._put(TokenNode(node.id, kind, label, node.id, self.drawing.region[node.id]), short)
        if kind is NodeKind.ACTION:
            self._put(self._action(node, self.nodes[node.id]), short)
        elif kind is NodeKind.STRUCTURED:
            run = self.inputs.names.new(f"run_{short}")
            self._put(replace(self.nodes[node.id], run=run), short)
            self._add_parts(node)
        if kind in (NodeKind.ACTION, NodeKind.STRUCTURED):
            self._check_pins(node)
        self._check_shape(node, kind)

    def _put(self, node: TokenNode, short: str) -> TokenNode:
        self.nodes[node.id] = node
        self.short[node.id] = short
        return node

    def _kind(self, node: Element) -> NodeKind:
        if node.kind is Kind.CONTROL:
            return self._control(node)
        if node.kind is Kind.ACTION:
            return NodeKind.ACTION
        if node.kind is Kind.STRUCTURED:
            return NodeKind.STRUCTURED
        if not self.incoming[node.id]:
            return NodeKind.INITIAL
        return NodeKind.MERGE if self.outgoing[node.id] else NodeKind.SINK

    def _control(self, node: Element) -> NodeKind:
        kind = _CONTROLS.get(node.subkind, NodeKind.MERGE)
        if kind is NodeKind.FORK and len(self.incoming[node.id]) > 1:
            return NodeKind.JOIN
        return kind

    def _action(self, node: Element, made: TokenNode) -> TokenNode:
        if node.subkind in _SILENT:
            return replace(made, duration=Duration.SILENT)
        short = self.short[node.id]
        prefix = _OUTPUTS.get(node.subkind, "run")
        what = self._called_name(node) if prefix != "run" else ""
        run = self.inputs.names.new(f"{prefix}_{identifier(what) if what else short}")
        if node.subkind in _PULSES:
            return replace(made, duration=Duration.PULSE, run=run)
        if node.subkind in _ACCEPTS:
            done, names = events(self.inputs, node)
            for name in names:
                self.takers.setdefault(name, []).append(node)
            return replace(made, run=run, done=done)
        return replace(made, run=run, done=self.inputs.pulse(f"done_{short}", node))

    def _called_name(self, node: Element) -> str:
        called = self.graph.target(node, Edge.CALLS)
        return "" if called is None else called.name

    def _check_pins(self, node: Element) -> None:
        fed = {flow.target_pin.id for flow in self.incoming[node.id] if flow.target_pin}
        for pin in self.graph.owned(node):
            is_open = pin.kind is Kind.PIN and pin.attrs.get("direction") == "in"
            if is_open and pin.id not in fed and "value" not in pin.attrs:
                subject = self.graph.subject(pin)
                label = self.drawing.labels[node.id]
                self.sink.report(rules.OPEN_PIN, subject, pin=pin.name or pin.subkind, node=label)

    def _check_shape(self, node: Element, kind: NodeKind) -> None:
        incoming, outgoing = len(self._primary(node)), len(self.outgoing[node.id])
        two = {
            "decision": (incoming > 1, f"{incoming} incoming flows", "a merge and a decision"),
            "merge": (outgoing > 1, f"{outgoing} outgoing flows", "a merge and a decision"),
            "fork": (incoming > 1, f"{incoming} incoming flows", "a join and a fork"),
            "join": (outgoing > 1, f"{outgoing} outgoing flows", "a join and a fork"),
        }
        is_odd, drawn, meaning = two.get(node.subkind, (False, "", ""))
        if is_odd and node.kind is Kind.CONTROL:
            subject, label = self.graph.subject(node), self.drawing.labels[node.id]
            self.sink.report(rules.TWO_IN_ONE, subject, node=label, drawn=drawn, meaning=meaning)

    def _primary(self, node: Element) -> list[Flow]:
        """Incoming flows without the flow that only brings a decision's input."""
        side = node.attrs.get("decision_input_flow")
        return [flow for flow in self.incoming[node.id] if flow.element.id != side]

    # -- what UML implies ----------------------------------------------------------------------

    def _extra(
        self, base: Element, role: str, kind: NodeKind, label: str, region: str
    ) -> TokenNode:
        id = derived_id(base.id, role)
        if id in self.nodes:
            return self.nodes[id]
        short = f"{role}_{self.short.get(base.id, identifier(base.name, 'node'))}"
        return self._put(TokenNode(id, kind, label, base.id, region), identifier(short))

    def _link(
        self,
        source: str,
        target: str,
        origin: Element,
        region: str,
        *,
        marked: bool = False,
        guard: Guard | None = None,
        interrupts: str = "",
    ) -> TokenEdge:
        label = flow_label(origin, self.nodes[source].label, self.nodes[target].label)
        variable = self.inputs.names.new(f"at_{self.short[source]}_to_{self.short[target]}")
        id = origin.id if self._is_free(origin) else derived_id(origin.id, variable)
        self.used.add(id)
        edge = TokenEdge(
            id, variable, label, source, target, (origin.id,), region, marked, guard, interrupts
        )
        self.edges.append(edge)
        return edge

    def _is_free(self, origin: Element) -> bool:
        is_flow = origin.kind in (Kind.CONTROL_FLOW, Kind.OBJECT_FLOW)
        return is_flow and origin.id not in self.used

    def _add_start(self, node: Element) -> None:
        made = self.nodes[node.id]
        works = made.kind in (NodeKind.ACTION, NodeKind.STRUCTURED)
        if not works or self.incoming[node.id] or node.id in self.chained:
            return
        if node.subkind in _ACCEPTS:
            self._link(node.id, node.id, node, made.region, marked=True)
            return
        start = self._extra(node, "start", NodeKind.INITIAL, "the start", made.region)
        self._link(start.id, node.id, node, made.region, marked=True)

    def _add_order(self, node: Element) -> None:
        if node.subkind != "sequence":
            return
        inside = [
            n
            for n in self.drawing.nodes
            if self.drawing.region[n.id] == node.id and n.kind in (Kind.ACTION, Kind.STRUCTURED)
        ]
        for before, after in pairwise(inside):
            self._link(before.id, after.id, after, node.id)
            self.chained.add(after.id)

    # -- flows ---------------------------------------------------------------------------------

    def _add_flow(self, flow: Flow) -> None:
        target = self._entry(flow)
        source, marked, choice = self._exit(flow)
        if choice is None and self._is_trivial(flow):
            self._connect(flow, source, target, marked, None)
            return
        if choice is None:
            choice = self._waiting(flow, source, marked)
        self._connect(flow, choice, target, False, self._guard(flow, choice))

    def _connect(
        self, flow: Flow, source: str, target: str, marked: bool, guard: Guard | None
    ) -> None:
        interrupts = flow.element.attrs.get("interrupts")
        self._link(
            source,
            target,
            flow.element,
            flow.region,
            marked=marked,
            guard=guard,
            interrupts=interrupts if isinstance(interrupts, str) else "",
        )

    def _entry(self, flow: Flow) -> str:
        node = flow.target
        if flow.leaves:
            role = self._role("result", node, flow.region)
            return self._extra(node, role, NodeKind.SINK, "its result", flow.region).id
        kind = self.nodes[node.id].kind
        if kind is NodeKind.DECISION and len(self._primary(node)) > 1:
            return self._entry_merge(flow, node, self._primary(node))
        if flow.target_pin is not None:
            same = [g for g in self.incoming[node.id] if g.target_pin is flow.target_pin]
            if len(same) > 1:
                return self._entry_merge(flow, flow.target_pin, same)
        return node.id

    def _entry_merge(self, flow: Flow, base: Element, flows: list[Flow]) -> str:
        if all(flow is not one for one in flows):
            return flow.target.id
        owner = flow.target
        is_new = derived_id(base.id, "merge") not in self.nodes
        label = f"the merge before {self.drawing.labels[owner.id]}"
        merge = self._extra(base, "merge", NodeKind.MERGE, label, flow.region)
        if is_new:
            self._link(merge.id, owner.id, base, flow.region)
        return merge.id

    def _exit(self, flow: Flow) -> tuple[str, bool, str | None]:
        """Source node, whether its token is there at the start, and the deciding node if any."""
        node = flow.source
        if flow.enters:
            start = self._extra_start(flow)
            return start, True, None
        kind = self.nodes[node.id].kind
        if kind is NodeKind.DECISION:
            return node.id, False, node.id
        marked = kind is NodeKind.INITIAL
        same = [g for g in self.outgoing[node.id] if g.source_pin is flow.source_pin]
        competes = kind in (NodeKind.INITIAL, NodeKind.MERGE) or flow.source_pin is not None
        if competes and len(same) > 1:
            return node.id, marked, self._exit_choice(flow, flow.source_pin or node, marked)
        return node.id, marked, None

    def _extra_start(self, flow: Flow) -> str:
        label = f"the start of {self.drawing.labels[flow.source.id]}"
        role = self._role("input", flow.source, flow.region)
        return self._extra(flow.source, role, NodeKind.INITIAL, label, flow.region).id

    def _role(self, word: str, node: Element, region: str) -> str:
        """The word, and the part of the node that the region is."""
        parts = self.drawing.parts.get(node.id, ())
        return " ".join([word, *(part.word for part in parts if part.id == region)])

    def _exit_choice(self, flow: Flow, base: Element, marked: bool) -> str:
        is_new = derived_id(base.id, "choice") not in self.nodes
        label = f"the choice after {self.drawing.labels[flow.source.id]}"
        choice = self._extra(base, "choice", NodeKind.DECISION, label, flow.region)
        if is_new:
            self._link(flow.source.id, choice.id, base, flow.region, marked=marked)
        return choice.id

    # -- guards --------------------------------------------------------------------------------

    def _is_trivial(self, flow: Flow) -> bool:
        """No guard, or the literal true that tools write by themselves."""
        text = _text(flow)
        return not text or (text == "true" and flow.element.attrs.get("guard_literal") is True)

    def _waiting(self, flow: Flow, source: str, marked: bool) -> str:
        """A decision with one branch, for a guard on a flow that leaves no decision."""
        made = self.nodes[source].label
        label = f"the guard after {made}"
        node = self._extra(flow.element, "guard", NodeKind.DECISION, label, flow.region)
        self._link(source, node.id, flow.element, flow.region, marked=marked)
        target = self.drawing.labels[flow.target.id]
        name = flow_label(flow.element, made, target)
        subject = self.graph.subject(flow.element)
        self.sink.report(rules.WAITING_GUARD, subject, text=_text(flow), flow=name)
        return node.id

    def _guard(self, flow: Flow, decision: str) -> Guard | None:
        text = _text(flow)
        if text.lower() == "else":
            return Guard("else", None)
        if not text:
            return None
        if flow.element.attrs.get("guard_literal") is True:
            return self._literal_guard(flow, decision, text)
        condition = self.inputs.condition(text, flow.element, "the guard")
        return Guard(text, condition)

    def _literal_guard(self, flow: Flow, decision: str, text: str) -> Guard | None:
        answer = self._answer(flow.source, decision)
        if answer is None:
            return None if text == "true" else Guard(text, f.FALSE)
        return Guard(text, answer.equals(text))

    def _answer(self, node: Element, decision: str) -> Answer | None:
        """What a decision compares literals with: its input, or the object that it passes on."""
        if decision in self.answers:
            return self.answers[decision]
        if node.subkind != "decision":
            return None
        has_input = bool(node.attrs.get("decision_input") or node.attrs.get("decision_input_flow"))
        if not has_input and not self._passes_objects(node):
            return None
        literals = [
            _text(g) for g in self.outgoing[node.id] if g.element.attrs.get("guard_literal")
        ]
        made = self.inputs.answer(f"input_{self.short[node.id]}", literals, node)
        self.answers[decision] = made
        return made

    def _passes_objects(self, node: Element) -> bool:
        return any(flow.element.kind is Kind.OBJECT_FLOW for flow in self.incoming[node.id])

    # -- loops and conditionals ----------------------------------------------------------------

    def _add_parts(self, node: Element) -> None:
        parts = self.drawing.parts.get(node.id, [])
        for part in parts:
            label = f"the {part.word} of {self.drawing.labels[node.id]}"
            short = f"{identifier(part.word)}_{self.short[node.id]}"
            run = self.inputs.names.new(f"run_{short}")
            made = TokenNode(part.id, NodeKind.STRUCTURED, label, node.id, node.id, run=run)
            self._put(made, short)
        if parts and node.subkind == "loop":
            self._add_loop(node, {part.word: part for part in parts})
        elif parts:
            self._add_clauses(node, parts)

    def _inner(self, node: Element, role: str, kind: NodeKind) -> str:
        label = f"the {role} of {self.drawing.labels[node.id]}"
        return self._extra(node, role, kind, label, node.id).id

    def _test(self, node: Element, role: str) -> tuple[str, Guard]:
        """A decision after a test, and the guard that the test is true."""
        decision = self._inner(node, role, NodeKind.DECISION)
        name = identifier(f"{role}_{self.short[node.id]}")
        answer = self.inputs.answer(f"input_{name}", ["true"], node)
        return decision, Guard(f"{role} is true", answer.equals("true"))

    def _add_loop(self, node: Element, parts: dict[str, Part]) -> None:
        start = self._inner(node, "begin", NodeKind.INITIAL)
        end = self._inner(node, "end", NodeKind.SINK)
        again = self._inner(node, "repetition", NodeKind.MERGE)
        decision, guard = self._test(node, "test")
        setup, test, body = (
            [parts[word].id] if word in parts else [] for word in ("setup", "test", "body")
        )
        is_first = node.attrs.get("tested_first") is not False
        self._path(node, start, *setup, again, marked=True)
        self._path(node, again, *(test if is_first else [*body, *test]), decision)
        self._path(node, decision, *(body if is_first else []), again, guard=guard)
        self._path(node, decision, end, guard=Guard("else", None))

    def _add_clauses(self, node: Element, parts: list[Part]) -> None:
        before = self._inner(node, "begin", NodeKind.INITIAL)
        end = self._inner(node, "end", NodeKind.SINK)
        marked, otherwise = True, None
        words = {part.word: part for part in parts}
        for number in dict.fromkeys(part.word.split()[1] for part in parts):
            test, body = words.get(f"test {number}"), words.get(f"body {number}")
            decision, guard = self._test(node, f"test {number}")
            steps = [test.id] if test else []
            self._path(node, before, *steps, decision, marked=marked, guard=otherwise)
            self._path(node, decision, *([body.id] if body else []), end, guard=guard)
            before, marked, otherwise = decision, False, Guard("else", None)
        self._path(node, before, end, guard=otherwise)

    def _path(
        self, node: Element, *path: str, marked: bool = False, guard: Guard | None = None
    ) -> None:
        """Edges along the nodes; mark and guard belong to the first one."""
        for source, target in pairwise(path):
            self._link(source, target, node, node.id, marked=marked, guard=guard)
            marked, guard = False, None


def _text(flow: Flow) -> str:
    return str(flow.element.attrs.get("guard") or "").strip()
