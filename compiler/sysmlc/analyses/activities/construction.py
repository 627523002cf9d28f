"""Construction of the token graph of a drawing: drawn nodes and flows, and those that UML implies.

UML implies the start of actions without incoming flows (an accept action listens again after each
event), the fork after an action, the join before it, the merge at a pin that several flows reach,
the choice at an object node that several flows leave, and the order of a sequence node. The module
also reports control nodes with flows that UML does not allow.
"""

from collections.abc import Iterator

from msgspec.structs import replace

from sysmlc.analyses.activities import rules
from sysmlc.analyses.activities.draft import Draft, lower_bound
from sysmlc.analyses.activities.drawing import Drawing
from sysmlc.analyses.activities.exception_analysis import Raising
from sysmlc.analyses.activities.exceptions import (
    add_exceptions,
    chain_handler_bodies,
    exception_region_id,
)
from sysmlc.analyses.activities.flows import add_default_branch, add_flow
from sysmlc.analyses.activities.implied_control import (
    ACCEPTS,
    add_implied_start,
    chain_sequence_node,
    expand_structured_node,
)
from sysmlc.analyses.activities.inputs import Inputs, describe_events, read_events
from sysmlc.analyses.activities.regions import (
    FLOWS,
    Regions,
    find_interruptible_regions,
    is_entered_later,
)
from sysmlc.diagnostics import Sink
from sysmlc.ir import Edge, Element, Graph, Kind, query
from sysmlc.ir.element import derived_id
from sysmlc.logic.activities.token_graph import TokenGraph
from sysmlc.logic.activities.token_nodes import Duration, Interruptible, NodeKind, TokenNode
from sysmlc.logic.feature_writes import takes_one_step
from sysmlc.logic.identifiers import identifier


def build(
    graph: Graph, drawing: Drawing, inputs: Inputs, raising: Raising, sink: Sink
) -> TokenGraph:
    """Return the token graph of a drawing. Reports nodes with flows that UML does not allow."""
    draft = Draft(graph, drawing, inputs, sink)
    # Before the nodes: pins of chained nodes are not reported as open.
    chain_handler_bodies(draft)
    for node in drawing.nodes:
        add_node(draft, node)
    # Before the flows: flows after a protected node leave its outcome.
    add_exceptions(draft, raising)
    for node in drawing.nodes:
        chain_sequence_node(draft, node)
    for flow in drawing.flows:
        add_flow(draft, flow)
    regions = find_interruptible_regions(graph, drawing.inside, drawing.nodes)
    listening_regions = _find_listening_regions(draft, regions)
    for node in drawing.nodes:
        add_default_branch(draft, node)
        add_implied_start(draft, node, listening_regions)
    _check_events(draft)
    return _finish(draft, regions)


def _check_events(draft: Draft) -> None:
    for event, accept_actions in draft.inputs.receivers.items():
        if len(accept_actions) > 1:
            names = " and ".join(draft.drawing.labels[node.id] for node in accept_actions)
            subject = draft.graph.subject(accept_actions[0])
            draft.sink.report(rules.SHARED_EVENT, subject, nodes=names, event=event)


def _find_listening_regions(draft: Draft, regions: Regions) -> dict[str, str]:
    """Return the interruptible region whose first token makes an accept action listen, by action.

    These are the actions without incoming flows, if the region is not entered at the start.
    """
    listening_regions: dict[str, str] = {}
    for region, members in regions:
        idle_actions = [
            e for e in members if e.subkind in ACCEPTS and not draft.drawing.incoming(e)
        ]
        if is_entered_later(draft.graph, members):
            for node in idle_actions:
                listening_regions[node.id] = region.id
    return listening_regions


def _finish(draft: Draft, regions: Regions) -> TokenGraph:
    activity = draft.drawing.activity
    rounds = list(_list_rounds(draft))
    # A new round of a loop removes the tokens that the last round left, like an interruption.
    round_of_edge = {edge: round.id for edge, round in rounds}
    edges = (
        replace(edge, interrupts=round_of_edge[edge.id]) if edge.id in round_of_edge else edge
        for edge in draft.edges.values()
    )
    return TokenGraph(
        activity=activity.id,
        component=query.component_name(draft.graph, activity),
        label=f"activity '{activity.name}'" if activity.name else "the activity",
        nodes=tuple(draft.nodes.values()),
        edges=tuple(edges),
        inputs=tuple(draft.inputs.variables.values()),
        pulses=tuple(draft.inputs.pulses),
        stores=tuple(draft.inputs.memories.values()),
        interruptibles=(
            *_describe_regions(draft, regions),
            *_list_exception_regions(draft),
            *(round for _, round in rounds),
        ),
    )


def _describe_regions(draft: Draft, regions: Regions) -> Iterator[Interruptible]:
    for region, members in regions:
        yield Interruptible(region.id, region.name, _list_members(draft, members))


def _list_members(draft: Draft, elements: list[Element]) -> tuple[str, ...]:
    """Return the ids of token nodes that stand for the elements, and of those added for them."""
    owners = {element.id for element in elements}
    return tuple(
        node.id
        for node in draft.nodes.values()
        if node.origin in owners or draft.graph[node.origin].owner in owners
    )


def _list_exception_regions(draft: Draft) -> Iterator[Interruptible]:
    """Yield for each exception the nodes that lose their tokens when it ends a structured node."""
    catchers = {exception_region_id(id): draft.graph[id] for id in draft.drawing.handlers}
    for id in dict.fromkeys(edge.interrupts for edge in draft.edges.values()):
        catcher = catchers.get(id)
        if catcher is None:
            continue
        members = (
            node.id
            for node in draft.nodes.values()
            if node.id == catcher.id or catcher.id in draft.drawing.enclosing_regions(node.region)
        )
        yield Interruptible(id, catcher.name, tuple(members))


def _list_rounds(draft: Draft) -> Iterator[tuple[str, Interruptible]]:
    """Yield the edge that begins a new round, and the nodes that then lose their tokens."""
    for id, back_edge in draft.back_edges.items():
        edges = (edge for edge in draft.edges.values() if edge.region == id)
        flows = [edge for edge in edges if draft.graph[edge.origin].kind in FLOWS]
        members = dict.fromkeys(end for flow in flows for end in (flow.source, flow.target))
        if members:
            name = draft.drawing.labels[id]
            yield back_edge, Interruptible(derived_id(id, "rounds"), name, tuple(members))


# -- nodes -------------------------------------------------------------------------------------

_CONTROL_KINDS = {
    "initial": NodeKind.INITIAL,
    "final": NodeKind.ACTIVITY_FINAL,
    "flow-final": NodeKind.FLOW_FINAL,
    "decision": NodeKind.DECISION,
    "merge": NodeKind.MERGE,
    "fork": NodeKind.FORK,
    "join": NodeKind.JOIN,
}
_SILENT_SUBKINDS = (
    "value read read-self read-extent read-link read-link-object-end read-variable "
    "read-is-classified-object test-identity unmarshall reduce"
)
_PULSE_SUBKINDS = (
    "send broadcast send-object reply raise start start-object-behavior start-classifier-behavior "
    "write clear remove create destroy reclassify create-link destroy-link create-link-object "
    "clear-association add-structural-feature-value add-variable-value remove-variable-value "
    "clear-variable assign"
)
_SILENT_ACTIONS = frozenset(_SILENT_SUBKINDS.split(" "))
_PULSE_ACTIONS = frozenset(_PULSE_SUBKINDS.split(" "))
_DEFAULT_NAMES = {"initial": "start", "final": "end"}
_OUTPUT_PREFIXES = {"send": "send", "broadcast": "send", "send-object": "send", "reply": "reply"}


def add_node(draft: Draft, node: Element) -> None:
    """Add the token node of a drawn node, and the variables that it needs."""
    label = draft.drawing.labels[node.id]
    kind = _classify_node(draft, node)
    title = draft.drawing.titles[node.id]
    short = identifier(title or _DEFAULT_NAMES.get(node.subkind, label))
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
    if node.kind in (Kind.ACTION, Kind.ACTIVITY):
        return NodeKind.ACTION
    if node.kind is Kind.STRUCTURED:
        return NodeKind.STRUCTURED
    if not draft.drawing.incoming(node):
        return NodeKind.INITIAL
    if node.kind is Kind.DATA_STORE:
        return NodeKind.DATA_STORE
    return NodeKind.MERGE if draft.drawing.outgoing(node) else NodeKind.SINK


def _classify_control(draft: Draft, node: Element) -> NodeKind:
    kind = _CONTROL_KINDS.get(node.subkind, NodeKind.MERGE)
    # A fork has one incoming flow. With several it is taken as a join and a fork, and a join also
    # offers a token to all its outgoing flows.
    if kind is NodeKind.FORK and len(draft.drawing.incoming(node)) > 1:
        return NodeKind.JOIN
    return kind


def _add_action_variables(draft: Draft, node: Element, token_node: TokenNode) -> TokenNode:
    """Return the token node of an action with the variables of its start and end."""
    if node.subkind in _SILENT_ACTIONS:
        return replace(token_node, duration=Duration.SILENT)
    short = draft.short_names[node.id]
    prefix = _OUTPUT_PREFIXES.get(node.subkind, "run")
    called_name = _find_called_name(draft, node) if prefix != "run" else ""
    run = draft.inputs.names.new(f"{prefix}_{identifier(called_name) if called_name else short}")
    # The caller does not wait for the end of an asynchronous call (UML 2.5.1, 16.3.3).
    is_asynchronous = node.attrs.get("synchronous") is False
    if node.subkind in _PULSE_ACTIONS or is_asynchronous or takes_one_step(node):
        return replace(token_node, duration=Duration.PULSE, run=run)
    if node.subkind in ACCEPTS:
        awaited = describe_events(draft.graph, node)
        return replace(token_node, run=run, done=read_events(draft.inputs, node), awaited=awaited)
    return replace(token_node, run=run, done=draft.inputs.declare_pulse(f"done_{short}", node))


def _find_called_name(draft: Draft, node: Element) -> str:
    called = draft.graph.target(node, Edge.CALLS)
    return "" if called is None else called.name


def _check_pins(draft: Draft, node: Element) -> None:
    connected = {flow.target_pin.id for flow in draft.drawing.incoming(node) if flow.target_pin}
    # The exception fills the input pin of a handler body, without a drawn flow.
    if node.id in draft.chained or _redefines_inherited_step(draft, node):
        return
    for pin in draft.graph.owned(node):
        is_input = pin.kind is Kind.PIN and pin.attrs.get("direction") == "in"
        # In SysML v2 a flow of the part that performs the activity may lead to a parameter.
        is_filled = "value" in pin.attrs or bool(draft.graph.sources(pin, Edge.FLOW_TARGET))
        is_open = is_input and not is_filled and lower_bound(pin) != 0
        if is_open and pin.id not in connected:
            subject = draft.graph.subject(pin)
            label = draft.drawing.labels[node.id]
            draft.sink.report(rules.OPEN_PIN, subject, pin=pin.name or pin.subkind, node=label)


def _redefines_inherited_step(draft: Draft, node: Element) -> bool:
    """Whether an action of SysML v2 redefines or subsets a feature, which gives it its arguments.

    An example is the function that evaluates the alternatives of a trade study.
    """
    called = draft.graph.targets(node, Edge.CALLS)
    return draft.follows_v2 and any(element.kind not in query.BEHAVIORS for element in called)


def _check_shape(draft: Draft, node: Element) -> None:
    """Report a control node that stands for two, such as a merge with several outgoing flows."""
    if node.kind is not Kind.CONTROL:
        return
    incoming, outgoing = len(draft.primary_flows(node)), len(draft.drawing.outgoing(node))
    # In SysML v2 only 'decide' chooses.
    choice = "fork" if draft.follows_v2 else "decision"
    shapes = {
        "decision": (incoming > 1, f"{incoming} incoming flows", "a merge and a decision"),
        "merge": (outgoing > 1, f"{outgoing} outgoing flows", f"a merge and a {choice}"),
        "fork": (incoming > 1, f"{incoming} incoming flows", "a join and a fork"),
        "join": (outgoing > 1, f"{outgoing} outgoing flows", "a join and a fork"),
    }
    is_combined, drawn, meaning = shapes.get(node.subkind, (False, "", ""))
    if is_combined:
        subject, label = draft.graph.subject(node), draft.drawing.labels[node.id]
        draft.sink.report(
            rules.COMBINED_CONTROL_NODE, subject, node=label, drawn=drawn, meaning=meaning
        )


def _check_ends(draft: Draft, node: Element, kind: NodeKind) -> None:
    """Report flows into an initial node and out of a final node."""
    is_final = kind in (NodeKind.ACTIVITY_FINAL, NodeKind.FLOW_FINAL)
    flows = ""
    if kind is NodeKind.INITIAL and draft.drawing.incoming(node):
        flows = "incoming flows"
    elif is_final and draft.drawing.outgoing(node):
        flows = "outgoing flows"
    if flows:
        subject, label = draft.graph.subject(node), draft.drawing.labels[node.id]
        draft.sink.report(rules.MISPLACED_FLOW, subject, node=label, flows=flows)
