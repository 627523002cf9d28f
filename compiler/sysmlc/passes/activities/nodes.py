"""Token nodes of drawn nodes with their variables, and checks of the drawn shapes."""

from msgspec.structs import replace

from sysmlc.ir import Edge, Element, Kind
from sysmlc.logic.activities.token_graph import Duration, NodeKind, TokenNode
from sysmlc.logic.names import identifier
from sysmlc.passes.activities import rules
from sysmlc.passes.activities.draft import Draft, lower_bound
from sysmlc.passes.activities.implied_control import ACCEPTS, expand_structured_node
from sysmlc.passes.activities.inputs import read_events

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


def add_node(draft: Draft, node: Element) -> None:
    """Add the token node of a drawn node, and the variables that it needs."""
    label = draft.drawing.labels[node.id]
    kind = _classify_node(draft, node)
    short = identifier(node.name or _SHORT.get(node.subkind, label))
    draft.put_node(TokenNode(node.id, kind, label, node.id, draft.drawing.region[node.id]), short)
    if kind is NodeKind.ACTION:
        draft.put_node(_add_action_variables(draft, node, draft.nodes[node.id]), short)
    elif kind is NodeKind.STRUCTURED:
        run = draft.inputs.names.new(f"run_{short}")
        draft.put_node(replace(draft.nodes[node.id], run=run), short)
        expand_structured_node(draft, node)
    if kind in (NodeKind.ACTION, NodeKind.STRUCTURED):
        _check_pins(draft, node)
    _check_shape(draft, node)
    _check_ends(draft, node, kind)


def _classify_node(draft: Draft, node: Element) -> NodeKind:
    if node.kind is Kind.CONTROL:
        return _classify_control(draft, node)
    if node.kind is Kind.ACTION:
        return NodeKind.ACTION
    if node.kind is Kind.STRUCTURED:
        return NodeKind.STRUCTURED
    if not draft.incoming[node.id]:
        return NodeKind.INITIAL
    if node.kind is Kind.DATA_STORE:
        return NodeKind.DATA_STORE
    return NodeKind.MERGE if draft.outgoing[node.id] else NodeKind.SINK


def _classify_control(draft: Draft, node: Element) -> NodeKind:
    kind = _CONTROLS.get(node.subkind, NodeKind.MERGE)
    if kind is NodeKind.FORK and len(draft.incoming[node.id]) > 1:
        return NodeKind.JOIN
    return kind


def _add_action_variables(draft: Draft, node: Element, token_node: TokenNode) -> TokenNode:
    """Return the token node of an action with the variables of its start and end."""
    if node.subkind in _SILENT:
        return replace(token_node, duration=Duration.SILENT)
    short = draft.short[node.id]
    prefix = _OUTPUTS.get(node.subkind, "run")
    called_name = _find_called_name(draft, node) if prefix != "run" else ""
    run = draft.inputs.names.new(f"{prefix}_{identifier(called_name) if called_name else short}")
    if node.subkind in _PULSES or node.attrs.get("synchronous") is False:
        # The caller does not wait for the end of an asynchronous call (UML 2.5.1, 16.3.3).
        return replace(token_node, duration=Duration.PULSE, run=run)
    if node.subkind in ACCEPTS:
        end_condition, names = read_events(draft.inputs, node)
        for name in names:
            draft.takers.setdefault(name, []).append(node)
        return replace(token_node, run=run, done=end_condition)
    return replace(token_node, run=run, done=draft.inputs.declare_pulse(f"done_{short}", node))


def _find_called_name(draft: Draft, node: Element) -> str:
    called = draft.graph.target(node, Edge.CALLS)
    return "" if called is None else called.name


def _check_pins(draft: Draft, node: Element) -> None:
    connected = {flow.target_pin.id for flow in draft.incoming[node.id] if flow.target_pin}
    if node.id in draft.chained:
        return
    for pin in draft.graph.owned(node):
        is_input = pin.kind is Kind.PIN and pin.attrs.get("direction") == "in"
        is_open = is_input and "value" not in pin.attrs and lower_bound(pin) != 0
        if is_open and pin.id not in connected:
            subject = draft.graph.subject(pin)
            label = draft.drawing.labels[node.id]
            draft.sink.report(rules.OPEN_PIN, subject, pin=pin.name or pin.subkind, node=label)


def _check_shape(draft: Draft, node: Element) -> None:
    """Report a control node with two jobs, such as a merge with several outgoing flows."""
    if node.kind is not Kind.CONTROL:
        return
    incoming, outgoing = len(draft.primary_flows(node)), len(draft.outgoing[node.id])
    shapes = {
        "decision": (incoming > 1, f"{incoming} incoming flows", "a merge and a decision"),
        "merge": (outgoing > 1, f"{outgoing} outgoing flows", "a merge and a decision"),
        "fork": (incoming > 1, f"{incoming} incoming flows", "a join and a fork"),
        "join": (outgoing > 1, f"{outgoing} outgoing flows", "a join and a fork"),
    }
    is_combined, drawn, meaning = shapes.get(node.subkind, (False, "", ""))
    if is_combined:
        subject, label = draft.graph.subject(node), draft.drawing.labels[node.id]
        draft.sink.report(rules.TWO_IN_ONE, subject, node=label, drawn=drawn, meaning=meaning)


def _check_ends(draft: Draft, node: Element, kind: NodeKind) -> None:
    """Report flows into an initial node and out of a final node."""
    is_final = kind in (NodeKind.ACTIVITY_FINAL, NodeKind.FLOW_FINAL)
    flows = ""
    if kind is NodeKind.INITIAL and draft.incoming[node.id]:
        flows = "incoming flows"
    elif is_final and draft.outgoing[node.id]:
        flows = "outgoing flows"
    if flows:
        subject, label = draft.graph.subject(node), draft.drawing.labels[node.id]
        draft.sink.report(rules.ODD_END, subject, node=label, flows=flows)
