"""Token edges of flows: where they start and end, and the guards of decisions they leave."""

from sysmlc.ir import Element, Kind
from sysmlc.ir.identity import derived_id
from sysmlc.logic import formula as f
from sysmlc.logic.tokens import Guard, NodeKind
from sysmlc.passes import activity_rules as rules
from sysmlc.passes.activity_draft import Draft
from sysmlc.passes.activity_drawing import Flow, flow_label
from sysmlc.passes.activity_inputs import Answer


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
        flow.region,
        marked=marked,
        guard=guard,
        interrupts=_interrupted(draft, flow),
    )


def _interrupted(draft: Draft, flow: Flow) -> str:
    """Id of the interruptible region of this activity that the flow interrupts."""
    id = flow.element.attrs.get("interrupts")
    region = draft.graph.get(id) if isinstance(id, str) else None
    if region is None or region.subkind != "interruptible":
        return ""
    is_here = any(above is draft.drawing.activity for above in draft.graph.ancestors(region))
    return region.id if is_here else ""


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
        if len(same) > 1:
            return _entry_merge(draft, flow, flow.target_pin, same)
    return node.id


def _entry_merge(draft: Draft, flow: Flow, base: Element, flows: list[Flow]) -> str:
    if all(flow is not one for one in flows):
        return flow.target.id
    owner = flow.target
    is_new = derived_id(base.id, "merge") not in draft.nodes
    label = f"the merge before {draft.drawing.labels[owner.id]}"
    merge = draft.extra(base, "merge", NodeKind.MERGE, label, flow.region)
    if is_new:
        draft.link(merge.id, owner.id, base, flow.region)
    return merge.id


def _exit(draft: Draft, flow: Flow) -> tuple[str, bool, str | None]:
    """Source node, whether its token is there at the start, and the deciding node if any."""
    node = flow.source
    if flow.enters:
        start = _extra_start(draft, flow)
        return start, True, None
    kind = draft.nodes[node.id].kind
    if kind is NodeKind.DECISION:
        return node.id, False, node.id
    marked = kind is NodeKind.INITIAL
    same = [g for g in draft.outgoing[node.id] if g.source_pin is flow.source_pin]
    competes = kind in (NodeKind.INITIAL, NodeKind.MERGE) or flow.source_pin is not None
    if competes and len(same) > 1:
        return node.id, marked, _exit_choice(draft, flow, flow.source_pin or node, marked)
    return node.id, marked, None


def _extra_start(draft: Draft, flow: Flow) -> str:
    label = f"the start of {draft.drawing.labels[flow.source.id]}"
    role = draft.role("input", flow.source, flow.region)
    return draft.extra(flow.source, role, NodeKind.INITIAL, label, flow.region).id


def _exit_choice(draft: Draft, flow: Flow, base: Element, marked: bool) -> str:
    is_new = derived_id(base.id, "choice") not in draft.nodes
    label = f"the choice after {draft.drawing.labels[flow.source.id]}"
    choice = draft.extra(base, "choice", NodeKind.DECISION, label, flow.region)
    if is_new:
        draft.link(flow.source.id, choice.id, base, flow.region, marked=marked)
    return choice.id


def _is_trivial(draft: Draft, flow: Flow) -> bool:
    """No guard, or the literal true that tools write by themselves."""
    text = _text(flow)
    return not text or (text == "true" and flow.element.attrs.get("guard_literal") is True)


def _waiting(draft: Draft, flow: Flow, source: str, marked: bool) -> str:
    """A decision with one branch, for a guard on a flow that leaves no decision."""
    made = draft.nodes[source].label
    label = f"the guard after {made}"
    node = draft.extra(flow.element, "guard", NodeKind.DECISION, label, flow.region)
    draft.link(source, node.id, flow.element, flow.region, marked=marked)
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


def _passes_objects(draft: Draft, node: Element) -> bool:
    return any(flow.element.kind is Kind.OBJECT_FLOW for flow in draft.incoming[node.id])


def _text(flow: Flow) -> str:
    return str(flow.element.attrs.get("guard") or "").strip()
