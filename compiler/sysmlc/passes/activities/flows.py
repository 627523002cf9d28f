"""Token edges of flows: where they start and end, and the guards of decisions they leave."""

from sysmlc.ir import Edge, Element, Kind
from sysmlc.ir.identity import derived_id
from sysmlc.logic import formula as f
from sysmlc.logic.activities.token_graph import Guard, NodeKind
from sysmlc.passes.activities import rules
from sysmlc.passes.activities.draft import Draft, least
from sysmlc.passes.activities.drawing import Flow, flow_label
from sysmlc.passes.activities.implied_control import ROUND
from sysmlc.passes.activities.inputs import Answer


def add_flow(draft: Draft, flow: Flow) -> None:
    """Add the edge of a flow, and the merges, choices and waiting guards that it implies."""
    target = _entry(draft, flow)
    source, marked, choice = _exit(draft, flow)
    if choice is None and _is_trivial(draft, flow):
        _connect(draft, flow, source, target, marked, None)
        return
    if choice is None:
        choice = _waiting(draft, flow, source, marked)
    _connect(draft, flow, choice, target, False, _guard(draft, flow, choice))


def _connect(
    draft: Draft, flow: Flow, source: str, target: str, marked: bool, guard: Guard | None
) -> None:
    draft.link(
        source,
        target,
        flow.element,
        _region(draft, flow, target),
        marked=marked,
        guard=guard,
        interrupts=_interrupted(draft, flow),
        keeps=flow.source.kind is Kind.DATA_STORE and source == flow.source.id,
    )


def _region(draft: Draft, flow: Flow, target: str) -> str:
    """The flow's region, or the one around it that the merge before its target is in."""
    reached = draft.nodes[target].region
    if reached == flow.region:
        return reached
    return reached if reached in list(draft.drawing.around(flow.region))[1:] else flow.region


def _interrupted(draft: Draft, flow: Flow) -> str:
    """Id of the interruptible region of this activity that the flow interrupts."""
    id = flow.element.attrs.get("interrupts")
    region = draft.graph.get(id) if isinstance(id, str) else None
    if region is None or region.subkind != "interruptible":
        return ""
    is_here = any(above is draft.drawing.activity for above in draft.graph.ancestors(region))
    if not is_here or not _is_inside(draft, flow.target, region):
        return region.id if is_here else ""
    name = flow_label(
        flow.element, draft.nodes[flow.source.id].label, draft.nodes[flow.target.id].label
    )
    draft.sink.report(rules.STAYS_INSIDE, draft.graph.subject(flow.element), flow=name)
    return ""


def _is_inside(draft: Draft, node: Element, region: Element) -> bool:
    """Whether the interruptible region holds the node, or something around it."""
    return any(
        region in (one, *draft.graph.targets(one, Edge.IN_PARTITION))
        for one in (node, *draft.graph.ancestors(node))
    )


def _entry(draft: Draft, flow: Flow) -> str:
    node = flow.target
    if flow.leaves:
        role = draft.role("result", node, flow.region)
        return draft.extra(node, role, NodeKind.SINK, "its result", flow.region).id
    kind = draft.nodes[node.id].kind
    if kind is NodeKind.DECISION and len(draft.primary(node)) > 1:
        return _entry_merge(draft, flow, node, draft.primary(node))
    if flow.target_pin is not None:
        same = [g for g in draft.incoming[node.id] if g.target_pin is flow.target_pin]
        if len(same) > 1 and not _needs_all(flow.target_pin, len(same)):
            return _entry_merge(draft, flow, flow.target_pin, same)
    return node.id


def _needs_all(pin: Element, flows: int) -> bool:
    """Whether the pin asks for as many values as it has flows (UML 2.5.1, 16.2.3)."""
    return least(pin) == flows


def _entry_merge(draft: Draft, flow: Flow, base: Element, flows: list[Flow]) -> str:
    if all(flow is not one for one in flows):
        return flow.target.id
    owner = flow.target
    is_new = derived_id(base.id, "merge") not in draft.nodes
    label = f"the merge before {draft.drawing.labels[owner.id]}"
    region = _common_region(draft, owner, flows)
    merge = draft.extra(base, "merge", NodeKind.MERGE, label, region)
    if is_new:
        draft.link(merge.id, owner.id, base, region)
    return merge.id


def _common_region(draft: Draft, owner: Element, flows: list[Flow]) -> str:
    """The node's region; when all flows come from outside of it, the one that holds them all.

    There the merge is no part of the region, which waits for what the merge brings.
    """
    around = list(draft.drawing.around(draft.drawing.region[owner.id]))
    found = {flow.region for flow in flows}
    return around[0] if around[0] in found else [one for one in around if one in found][-1]


def _exit(draft: Draft, flow: Flow) -> tuple[str, bool, str | None]:
    """Source node, whether its token is there at the start, and the deciding node if any."""
    node = flow.source
    if flow.enters:
        return _inner_exit(draft, flow)
    kind = draft.nodes[node.id].kind
    if kind is NodeKind.DECISION:
        return node.id, False, node.id
    marked = kind is NodeKind.INITIAL
    same = [g for g in draft.outgoing[node.id] if g.source_pin is flow.source_pin]
    holds = kind in (NodeKind.INITIAL, NodeKind.MERGE) and node.kind is not Kind.DATA_STORE
    if (holds or flow.source_pin is not None) and len(same) > 1:
        region = draft.drawing.region[node.id]
        source = draft.exit(node)
        choice = _exit_choice(draft, flow, flow.source_pin or node, source, region, marked)
        return source, marked, choice
    return draft.exit(node), marked, None


def _inner_exit(draft: Draft, flow: Flow) -> tuple[str, bool, str | None]:
    """The start of the region, or the start of each round of a loop."""
    node = flow.source
    rounds = derived_id(node.id, ROUND)
    if flow.region == node.id and rounds in draft.nodes:
        return rounds, False, None
    label = f"the start of {draft.drawing.labels[node.id]}"
    role = draft.role("input", node, flow.region)
    return draft.extra(node, role, NodeKind.INITIAL, label, flow.region).id, True, None


def _exit_choice(
    draft: Draft, flow: Flow, base: Element, source: str, region: str, marked: bool
) -> str:
    role = draft.role("choice", flow.source, region)
    is_new = derived_id(base.id, role) not in draft.nodes
    label = f"the choice after {draft.drawing.labels[flow.source.id]}"
    choice = draft.extra(base, role, NodeKind.DECISION, label, region)
    if is_new:
        draft.link(source, choice.id, base, region, marked=marked)
    return choice.id


def _is_trivial(draft: Draft, flow: Flow) -> bool:
    """No guard, or the literal true that tools write by themselves."""
    text = _text(flow)
    return not text or (text == "true" and flow.element.attrs.get("guard_literal") is True)


def _waiting(draft: Draft, flow: Flow, source: str, marked: bool) -> str:
    """A decision with one branch, for a guard on a flow that leaves no decision."""
    made = draft.nodes[source].label
    label = f"the guard after {made}"
    region = draft.nodes[source].region
    node = draft.extra(flow.element, "guard", NodeKind.DECISION, label, region)
    draft.link(source, node.id, flow.element, region, marked=marked)
    target = draft.drawing.labels[flow.target.id]
    name = flow_label(flow.element, made, target)
    subject = draft.graph.subject(flow.element)
    draft.sink.report(rules.WAITING_GUARD, subject, text=_text(flow), flow=name)
    return node.id


def _guard(draft: Draft, flow: Flow, decision: str) -> Guard | None:
    text = _text(flow)
    if text.lower() == "else":
        return Guard("else", None)
    if not text:
        return None
    if flow.element.attrs.get("guard_literal") is True:
        return _literal_guard(draft, flow, decision, text)
    condition = draft.inputs.condition(text, flow.element, "the guard")
    return Guard(text, condition)


def _literal_guard(draft: Draft, flow: Flow, decision: str, text: str) -> Guard | None:
    answer = _answer(draft, flow.source, decision)
    if answer is None:
        return None if text == "true" else Guard(text, f.FALSE)
    return Guard(text, answer.equals(text))


def _answer(draft: Draft, node: Element, decision: str) -> Answer | None:
    """What a decision compares literals with: its input, or the object that it passes on."""
    if decision in draft.answers:
        return draft.answers[decision]
    if node.subkind != "decision":
        return None
    has_input = bool(node.attrs.get("decision_input") or node.attrs.get("decision_input_flow"))
    if not has_input and not _passes_objects(draft, node):
        return None
    literals = [_text(g) for g in draft.outgoing[node.id] if g.element.attrs.get("guard_literal")]
    made = draft.inputs.answer(f"input_{draft.short[node.id]}", literals, node)
    draft.answers[decision] = made
    return made


def add_rest(draft: Draft, node: Element) -> None:
    """Let a token end at a decision that has no branch for its value, as in fUML.

    Its value never changes: by UML it would wait there for ever.
    """
    answer = draft.answers.get(node.id)
    if answer is None:
        return
    flows = draft.outgoing[node.id]
    texts = list(dict.fromkeys(_text(flow) for flow in flows))
    is_literal = all(flow.element.attrs.get("guard_literal") is True for flow in flows)
    if not is_literal or answer.is_covered(texts):
        return
    label, region = draft.drawing.labels[node.id], draft.drawing.region[node.id]
    rest = draft.extra(node, "rest", NodeKind.SINK, "no branch", region)
    draft.link(node.id, rest.id, node, region, guard=Guard("else", None))
    subject, guards = draft.graph.subject(node), ", ".join(texts)
    draft.sink.report(rules.OTHER_VALUES, subject, node=label, guards=guards)


def _passes_objects(draft: Draft, node: Element) -> bool:
    return any(flow.element.kind is Kind.OBJECT_FLOW for flow in draft.incoming[node.id])


def _text(flow: Flow) -> str:
    return str(flow.element.attrs.get("guard") or "").strip()
