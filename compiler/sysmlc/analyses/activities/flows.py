"""Token edges of drawn flows: their source and target nodes, their regions and their guards."""

from sysmlc.analyses.activities import rules
from sysmlc.analyses.activities.draft import Draft, lower_bound
from sysmlc.analyses.activities.drawing import Flow, flow_label
from sysmlc.analyses.activities.implied_control import ROUND
from sysmlc.analyses.activities.inputs import DecisionInput
from sysmlc.ir import Edge, Element, Kind, query
from sysmlc.ir.element import derived_id
from sysmlc.logic import formula as f
from sysmlc.logic.activities.token_nodes import Guard, NodeKind


def add_flow(draft: Draft, flow: Flow) -> None:
    """Add the edge of a flow, and the merges, choices and waiting guards that it implies."""
    target = _find_entry(draft, flow)
    source, marked, choice = _find_exit(draft, flow)
    if choice is None and not query.has_guard(draft.graph, flow.element):
        _add_edge(draft, flow, source, target, marked, None)
        return
    if choice is None:
        choice = _add_waiting_guard(draft, flow, source, marked)
    _add_edge(draft, flow, choice, target, False, _read_guard(draft, flow, choice))


def _add_edge(
    draft: Draft, flow: Flow, source: str, target: str, marked: bool, guard: Guard | None
) -> None:
    draft.add_edge(
        source,
        target,
        flow.element,
        _find_region(draft, flow, target),
        marked=marked,
        guard=guard,
        interrupts=_find_interrupted_region(draft, flow),
        keeps=flow.source.kind is Kind.DATA_STORE and source == flow.source.id,
    )


def _find_region(draft: Draft, flow: Flow, target: str) -> str:
    """Return the region of the flow, or an outer region if the merge at its target is there."""
    target_region = draft.nodes[target].region
    if target_region == flow.region:
        return target_region
    return (
        target_region
        if target_region in list(draft.drawing.enclosing_regions(flow.region))[1:]
        else flow.region
    )


def _find_interrupted_region(draft: Draft, flow: Flow) -> str:
    """Return the id of the interruptible region that the flow interrupts, or an empty text."""
    id = flow.element.attrs.get("interrupts")
    region = draft.graph.get(id) if isinstance(id, str) else None
    if region is None or region.subkind != "interruptible":
        return ""
    # The flow may name a region of another activity, which it cannot interrupt.
    is_here = any(above is draft.drawing.activity for above in draft.graph.ancestors(region))
    if not is_here or not _is_inside(draft, flow.target, region):
        return region.id if is_here else ""
    name = flow_label(
        flow.element, draft.nodes[flow.source.id].label, draft.nodes[flow.target.id].label
    )
    draft.sink.report(rules.STAYS_INSIDE, draft.graph.subject(flow.element), flow=name)
    return ""


def _is_inside(draft: Draft, node: Element, region: Element) -> bool:
    """Whether the interruptible region contains the node, or an element around it."""
    return any(
        region in (element, *draft.graph.targets(element, Edge.IN_PARTITION))
        for element in (node, *draft.graph.ancestors(node))
    )


def _find_entry(draft: Draft, flow: Flow) -> str:
    """Return the id of the token node at which the edge of the flow ends."""
    node = flow.target
    if flow.leaves:
        role = draft.qualify_role("result", node, flow.region)
        return draft.ensure_node(node, role, NodeKind.SINK, "its result", flow.region).id
    kind = draft.nodes[node.id].kind
    if kind is NodeKind.DECISION and len(draft.primary_flows(node)) > 1:
        return _ensure_entry_merge(draft, flow, node, draft.primary_flows(node))
    if flow.target_pin is not None:
        flows_to_pin = [g for g in draft.drawing.incoming(node) if g.target_pin is flow.target_pin]
        if len(flows_to_pin) > 1 and not _needs_all(flow.target_pin, len(flows_to_pin)):
            return _ensure_entry_merge(draft, flow, flow.target_pin, flows_to_pin)
    return node.id


def _needs_all(pin: Element, flows: int) -> bool:
    """Whether the pin requires as many values as flows lead to it (UML 2.5.1, 16.2.3)."""
    return lower_bound(pin) == flows


def _ensure_entry_merge(draft: Draft, flow: Flow, origin: Element, flows: list[Flow]) -> str:
    if all(flow is not merged for merged in flows):
        return flow.target.id
    owner = flow.target
    is_new = derived_id(origin.id, "merge") not in draft.nodes
    label = f"the merge before {draft.drawing.labels[owner.id]}"
    region = _find_merge_region(draft, owner, flows)
    merge = draft.ensure_node(origin, "merge", NodeKind.MERGE, label, region)
    if is_new:
        draft.add_edge(merge.id, owner.id, origin, region)
    return merge.id


def _find_merge_region(draft: Draft, owner: Element, flows: list[Flow]) -> str:
    """Return the region of the merge before a node.

    The merge is in the region of the node. If all flows come from outside, it is in the innermost
    region that holds all flows, because the region of the node would wait for a merge inside it.
    """
    regions = list(draft.drawing.enclosing_regions(draft.drawing.region[owner.id]))
    flow_regions = {flow.region for flow in flows}
    return (
        regions[0]
        if regions[0] in flow_regions
        else [region for region in regions if region in flow_regions][-1]
    )


def _find_exit(draft: Draft, flow: Flow) -> tuple[str, bool, str | None]:
    """Return the source node, whether the edge is marked at the start, and the decision or None."""
    node = flow.source
    if flow.enters:
        return _find_inner_exit(draft, flow)
    kind = draft.nodes[node.id].kind
    if kind is NodeKind.DECISION:
        return node.id, False, node.id
    marked = kind is NodeKind.INITIAL
    flows_from_pin = [g for g in draft.drawing.outgoing(node) if g.source_pin is flow.source_pin]
    holds = kind in (NodeKind.INITIAL, NodeKind.MERGE) and node.kind is not Kind.DATA_STORE
    has_choice = (holds or flow.source_pin is not None) and len(flows_from_pin) > 1
    # In SysML v2 only 'decide' chooses: all other successions and flows of a node are taken.
    if has_choice and not draft.follows_v2:
        region = draft.drawing.region[node.id]
        source = draft.exit_of(node)
        choice = _ensure_exit_choice(draft, flow, flow.source_pin or node, source, region, marked)
        return source, marked, choice
    return draft.exit_of(node), marked, None


def _find_inner_exit(draft: Draft, flow: Flow) -> tuple[str, bool, str | None]:
    """Return the exit of a flow that enters a region: the start of the region or of each round."""
    node = flow.source
    rounds = derived_id(node.id, ROUND)
    if flow.region == node.id and rounds in draft.nodes:
        return rounds, False, None
    label = f"the start of {draft.drawing.labels[node.id]}"
    role = draft.qualify_role("input", node, flow.region)
    return draft.ensure_node(node, role, NodeKind.INITIAL, label, flow.region).id, True, None


def _ensure_exit_choice(
    draft: Draft, flow: Flow, origin: Element, source: str, region: str, marked: bool
) -> str:
    role = draft.qualify_role("choice", flow.source, region)
    is_new = derived_id(origin.id, role) not in draft.nodes
    label = f"the choice after {draft.drawing.labels[flow.source.id]}"
    choice = draft.ensure_node(origin, role, NodeKind.DECISION, label, region)
    if is_new:
        draft.add_edge(source, choice.id, origin, region, marked=marked)
    return choice.id


def _add_waiting_guard(draft: Draft, flow: Flow, source: str, marked: bool) -> str:
    """Add a decision with one branch, for a guard on a flow that does not leave a decision."""
    source_label = draft.nodes[source].label
    label = f"the guard after {source_label}"
    region = draft.nodes[source].region
    node = draft.ensure_node(flow.element, "guard", NodeKind.DECISION, label, region)
    draft.add_edge(source, node.id, flow.element, region, marked=marked)
    target = draft.drawing.labels[flow.target.id]
    name = flow_label(flow.element, source_label, target)
    subject = draft.graph.subject(flow.element)
    text = _guard_text(flow)
    guard = f"the guard '{text}'" if text else "a guard without text"
    draft.sink.report(rules.WAITING_GUARD, subject, guard=guard, flow=name)
    return node.id


def _read_guard(draft: Draft, flow: Flow, decision: str) -> Guard | None:
    text = _guard_text(flow)
    if text.lower() == "else":
        return Guard("else", None)
    if "guard" not in flow.element.attrs:
        return None
    if flow.element.attrs.get("guard_literal") is True:
        return _read_literal_guard(draft, flow, decision, text)
    condition = draft.inputs.read_condition(text, flow.element, "the guard")
    return Guard(text, condition)


def _read_literal_guard(draft: Draft, flow: Flow, decision: str, text: str) -> Guard | None:
    decision_input = _find_decision_input(draft, flow.source, decision)
    if decision_input is None and text in ("true", "false"):
        return None if text == "true" else Guard(text, f.FALSE)
    if decision_input is None:
        return Guard(text, draft.inputs.read_condition(text, flow.element, "the guard"))
    return Guard(text, decision_input.equals(text))


def _find_decision_input(draft: Draft, node: Element, decision: str) -> DecisionInput | None:
    """Return the input that a decision compares with its literal guards, or None."""
    if decision in draft.decision_inputs:
        return draft.decision_inputs[decision]
    if not query.has_decision_input(draft.graph, node):
        return None
    literals = [
        _guard_text(g) for g in draft.drawing.outgoing(node) if g.element.attrs.get("guard_literal")
    ]
    decision_input = draft.inputs.declare_decision_input(
        f"input_{draft.short_names[node.id]}", literals, node
    )
    draft.decision_inputs[decision] = decision_input
    return decision_input


def add_default_branch(draft: Draft, node: Element) -> None:
    """Add a branch that removes a token whose value equals none of the literal guards, as in fUML.

    By UML the token would wait at the decision forever, because its value never changes.
    """
    decision_input = draft.decision_inputs.get(node.id)
    if decision_input is None:
        return
    flows = draft.drawing.outgoing(node)
    texts = list(dict.fromkeys(_guard_text(flow) for flow in flows))
    is_literal = all(flow.element.attrs.get("guard_literal") is True for flow in flows)
    if not is_literal or decision_input.is_covered(texts):
        return
    label, region = draft.drawing.labels[node.id], draft.drawing.region[node.id]
    rest = draft.ensure_node(node, "rest", NodeKind.SINK, "no branch", region)
    draft.add_edge(node.id, rest.id, node, region, guard=Guard("else", None))
    subject, guards = draft.graph.subject(node), ", ".join(texts)
    draft.sink.report(rules.OTHER_VALUES, subject, node=label, guards=guards)


def _guard_text(flow: Flow) -> str:
    return str(flow.element.attrs.get("guard") or "").strip()
