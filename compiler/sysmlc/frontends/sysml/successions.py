"""Steps of a behaviour in the order of the text, and the control flows between them."""

from collections.abc import Iterable
from dataclasses import dataclass, field

from sysmlc.frontends.sysml import annotations, nodes, values
from sysmlc.frontends.sysml.elements import NodeElements
from sysmlc.frontends.sysml.implied_nodes import ensure_control_node
from sysmlc.frontends.sysml.lowering import Lowering
from sysmlc.frontends.sysml.trees import Trees
from sysmlc.ir import Edge, Element, Graph, Kind
from sysmlc.language.metaclasses import is_a
from sysmlc.language.tree import Node, Reference

End = Node | Reference | None
"""An end of a succession: a step beside it in the text, the name of a step, or none."""

SUCCESSIONS = frozenset({"SuccessionAsUsage", "Succession"})
_STEP_NAMES = """
    ActionUsage PerformActionUsage SendActionUsage AcceptActionUsage AssignmentActionUsage
    IfActionUsage WhileLoopActionUsage ForLoopActionUsage TerminateActionUsage DecisionNode
    MergeNode ForkNode JoinNode CalculationUsage StateUsage ExhibitStateUsage Step Expression
    VerificationCaseUsage AnalysisCaseUsage CaseUsage UseCaseUsage IncludeUseCaseUsage
    ConstraintUsage AssertConstraintUsage EventOccurrenceUsage ItemUsage
"""
_STEPS = frozenset(_STEP_NAMES.split())
"""Members at which the next succession without a source may start."""


@dataclass(slots=True)
class _Body:
    """State of the lowering of the steps of one behaviour or block."""

    owner: Element
    entry_and_exit: list[Element] | None = None
    """Entry and exit of a block whose steps are those of the behaviour around it."""
    previous: End = None
    """The step before the current member."""
    waiting: list[tuple[End, Node]] = field(default_factory=list)
    """Sources and nodes of successions whose target is the next step."""


def lower_steps(
    lowering: Lowering,
    members: Iterable[Node],
    owner: Element,
    entry_and_exit: list[Element] | None = None,
) -> None:
    """Lower the members of a behaviour with the successions between them.

    For a block whose steps are those of the behaviour around it, ``start`` and ``done`` mean the
    entry and exit of the block. The caller may append them to the list later.
    """
    body = _Body(owner, entry_and_exit)
    for node in members:
        if node.kind in SUCCESSIONS:
            _lower_succession(lowering, node, body)
        elif node.kind == "TransitionUsage":
            _lower_guarded_succession(lowering, node, body)
        elif node.kind == "Membership" and not node.name and not node.short_name:
            # `first x;` only names the step that the next succession leaves.
            body.previous = nodes.find_reference(node, "Membership")
            _add_mentioned_end(lowering, body, body.previous, node)
        else:
            lowering.lower(node, owner)
            if node.kind in _STEPS and "direction" not in node.attributes:
                for source, succession in body.waiting:
                    _add_flow(lowering, body, succession, source, node)
                body.waiting.clear()
                body.previous = node
            elif body.waiting:
                # A `then` stands before its target, which is no step of the graph.
                _, succession = body.waiting.pop()
                lowering.verdicts.mark_unsupported(succession)


def _lower_succession(lowering: Lowering, node: Node, body: _Body) -> None:
    """Lower a succession; an end that is not stated is the step before or after it."""
    ends = nodes.ends_of(node)
    source, target = map(reference_of_end, ends[:2]) if len(ends) > 1 else (None, None)
    if target is None:
        body.waiting.append((source or body.previous, node))
    else:
        _add_flow(lowering, body, node, source or body.previous, target)


def reference_of_end(end: Node) -> Reference | None:
    """Return the reference by which an end of a succession names a step."""
    return nodes.find_reference(end, "ReferenceSubsetting", "Subsetting")


def _lower_guarded_succession(lowering: Lowering, node: Node, body: _Body) -> None:
    """Lower a guarded succession. A succession without a guard gets the guard ``else``."""
    source = nodes.find_reference(node, "Membership") or body.previous
    succession = next(nodes.iter_by_metaclass(node, *SUCCESSIONS), None)
    ends = [] if succession is None else nodes.ends_of(succession)
    target = reference_of_end(ends[-1]) if ends else None
    if target is not None:
        _add_flow(lowering, body, node, source, target, guard_of(node) or "else")


def guard_of(transition: Node) -> Node | None:
    """Return the condition of a transition."""
    return next((member for member in transition.members if member.role == "guard"), None)


# -- control flows -----------------------------------------------------------------------------


def defer_implied_start(lowering: Lowering, node: Node, owner: Element, entry: Element) -> None:
    """Add a flow from the start of the behaviour if no other node of it leads to *entry*.

    Flows of the structure itself, such as that back to the entry of a loop, do not count. A loop
    could not start otherwise, and an accept action would wait again after each event (UML 2.5.1,
    16.10.3), while one of SysML v2 occurs once.
    """

    def connect_start() -> None:
        flows = lowering.graph.sources(entry, Edge.FLOW_TARGET)
        if all(lowering.elements.origins.get(flow.id) is node for flow in flows):
            start = ensure_control_node(lowering, owner, "start")
            flow = lowering.add_derived(node, Kind.CONTROL_FLOW, "", owner)
            lowering.graph.connect(Edge.FLOW_SOURCE, flow, start)
            lowering.graph.connect(Edge.FLOW_TARGET, flow, entry)

    # Blocks around this node add their flows in the first round.
    lowering.queue.defer_to_second_round(connect_start)


def _add_flow(
    lowering: Lowering,
    body: _Body,
    node: Node,
    source: End,
    target: End,
    guard: Node | str | None = None,
) -> None:
    """Add a control flow for a succession; metadata may make it an object flow."""
    if _is_action_of_package(lowering.trees, source) or _is_action_of_package(
        lowering.trees, target
    ):
        lowering.verdicts.mark_unsupported(node)
        return
    _add_mentioned_end(lowering, body, source, node)
    _add_mentioned_end(lowering, body, target, node)
    is_object_flow = "ObjectFlow" in nodes.shipped_metadata_of(node)
    kind = Kind.OBJECT_FLOW if is_object_flow else Kind.CONTROL_FLOW
    flow = lowering.add_element(node, kind, node.name or "", body.owner)
    values.defer_expression(lowering, flow, "guard", guard)
    lowering.lower_annotations(node, flow)
    lowering.queue.defer_until_edges(lambda: _connect_ends(lowering, flow, (source, target), body))
    if is_object_flow:
        lowering.queue.defer_until_edges(
            lambda: _move_ends_to_pins(lowering.graph, lowering.elements, node, flow)
        )
    if guard is not None:
        # All flows must have their targets.
        lowering.queue.defer_to_second_round(lambda: _add_merge(lowering, flow))


def _move_ends_to_pins(graph: Graph, elements: NodeElements, node: Node, flow: Element) -> None:
    """Move the ends of an object flow from steps to the pins that metadata names."""
    for key, edge in (("source", Edge.FLOW_SOURCE), ("target", Edge.FLOW_TARGET)):
        step = graph.target(flow, edge)
        name = annotations.metadata_value(node, "ObjectFlow", key)
        members = [] if step is None or not name else graph.owned(step)
        pins = (member for member in members if member.kind is Kind.PIN)
        pin = next((pin for pin in pins if elements.text_name_of(pin) == name), None)
        if step is not None and pin is not None:
            graph.disconnect(edge, flow, step)
            graph.connect(edge, flow, pin)


def _add_merge(lowering: Lowering, guarded_flow: Element) -> None:
    """Add a merge before the target of a guarded flow if other control flows lead there, too.

    A guarded succession that is not taken does not occur (SysML 2.0, 8.4.13.5); the step waits for
    those that are taken. A step of UML would wait for all (UML 2.5.1, 15.2.3.4).
    """
    step = lowering.graph.target(guarded_flow, Edge.FLOW_TARGET)
    if step is None or step.kind not in (Kind.ACTION, Kind.STRUCTURED):
        return
    if any(owner.attrs.get("token_rules") == "uml" for owner in lowering.graph.ancestors(step)):
        return
    flows = [
        flow
        for flow in lowering.graph.sources(step, Edge.FLOW_TARGET)
        if flow.kind is Kind.CONTROL_FLOW
    ]
    if len(flows) < 2:
        return
    merge = lowering.add_implied_sibling(step, Kind.CONTROL, "")
    lowering.set_attributes(merge, subkind="merge")
    for flow in flows:
        lowering.graph.disconnect(Edge.FLOW_TARGET, flow, step)
        lowering.graph.connect(Edge.FLOW_TARGET, flow, merge)
    merged_flow = lowering.add_implied_sibling(step, Kind.CONTROL_FLOW, "")
    lowering.graph.connect(Edge.FLOW_SOURCE, merged_flow, merge)
    lowering.graph.connect(Edge.FLOW_TARGET, merged_flow, step)


def _connect_ends(lowering: Lowering, flow: Element, ends: tuple[End, End], body: _Body) -> None:
    for edge, end in zip((Edge.FLOW_SOURCE, Edge.FLOW_TARGET), ends, strict=True):
        if body.entry_and_exit and isinstance(end, Reference) and is_own_end(lowering.trees, end):
            entry, exit_ = body.entry_and_exit
            node: Element | None = exit_ if nodes.last_name(end) == "done" else entry
        else:
            is_target = edge is Edge.FLOW_TARGET
            node = _find_flow_node(lowering, body.owner, end, is_target=is_target)
        if node is None:
            target = end.target if isinstance(end, Reference) else end
            lowering.connect_node(edge, flow, target)
        else:
            lowering.graph.connect(edge, flow, node)


def _find_flow_node(
    lowering: Lowering, owner: Element, end: End, *, is_target: bool
) -> Element | None:
    """Return the node of an activity that an end of a succession means."""
    if end is None:
        return None
    if isinstance(end, Node):
        return lowering.elements.flow_node_of(end, is_target=is_target)
    if is_start_or_done(lowering.trees, end):
        holders = (end.targets or [])[:-1]
        has_holder = holders and len(end.chain) > 1
        holder = lowering.elements.find(holders[-1]) if has_holder else owner
        if holder is None:
            return None
        return ensure_control_node(lowering, holder, nodes.last_name(end))
    target = end.target
    return None if target is None else lowering.elements.flow_node_of(target, is_target=is_target)


# -- starts and ends ---------------------------------------------------------------------------


def _is_action_of_package(trees: Trees, end: End) -> bool:
    """Whether an end is an action of a package, which is no step of any behaviour."""
    if not isinstance(end, Reference) or len(end.chain) > 1 or end.target is None:
        return False
    owner = end.target.owner
    is_in_package = owner is not None and (owner.kind == "Namespace" or is_a(owner.kind, "Package"))
    return is_in_package and not is_start_or_done(trees, end)


def _add_mentioned_end(lowering: Lowering, body: _Body, end: End, node: Node) -> None:
    """Add the initial or final node of a behaviour if the end names it; *node* is its location."""
    if (
        body.entry_and_exit is None
        and isinstance(end, Reference)
        and is_own_end(lowering.trees, end)
    ):
        ensure_control_node(lowering, body.owner, nodes.last_name(end), node)


def is_own_end(trees: Trees, reference: Reference) -> bool:
    """Whether a reference is ``start`` or ``done`` of the behaviour that contains it."""
    return len(reference.chain) == 1 and is_start_or_done(trees, reference)


def is_start_or_done(trees: Trees, reference: Reference) -> bool:
    """Whether a reference is the start or the end that every behaviour inherits."""
    if nodes.last_name(reference) not in ("start", "done"):
        return False
    target = reference.target
    return target is None or trees.document_of(target) is None
