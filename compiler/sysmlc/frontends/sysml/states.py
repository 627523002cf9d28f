"""State machines: states, regions, pseudostates, transitions."""

from sysmlc.frontends.sysml import annotations, expressions, nodes, values
from sysmlc.frontends.sysml.activities import lower_body
from sysmlc.frontends.sysml.definitions import (
    connect_generals,
    declaration_attributes,
    lower_definition,
    read_kind,
    visibility_attributes,
)
from sysmlc.frontends.sysml.implied_nodes import ensure_vertex
from sysmlc.frontends.sysml.lowering import Lowering
from sysmlc.frontends.sysml.relations import allocate_arguments
from sysmlc.frontends.sysml.successions import (
    End,
    guard_of,
    is_own_end,
    is_start_or_done,
    reference_of_end,
)
from sysmlc.frontends.sysml.triggers import lower_trigger
from sysmlc.ir import Edge, Element, Graph, Kind
from sysmlc.language.tree import Node, Reference

_PSEUDOSTATES = {
    "Choice": "choice",
    "Junction": "junction",
    "Fork": "fork",
    "Join": "join",
    "ShallowHistory": "shallow-history",
    "DeepHistory": "deep-history",
    "EntryPoint": "entry-point",
    "ExitPoint": "exit-point",
    "ConnectionPoint": "connection-point",
    "Termination": "terminate",
}
"""Kinds of pseudostates by the keyword of our library."""
_CONNECTION_POINTS = ("entry-point", "exit-point", "connection-point")
_SUBACTION_EDGES = {"entry": Edge.ENTRY, "do": Edge.DO, "exit": Edge.EXIT}
_STATES = frozenset({"StateUsage", "ExhibitStateUsage"})
_SUCCESSIONS = frozenset({"SuccessionAsUsage", "Succession"})
_TRANSITIONS = frozenset({"TransitionUsage", "SuccessionAsUsage"})


# -- state machines ----------------------------------------------------------------------------


def lower_state_machine(lowering: Lowering, node: Node, owner: Element | None) -> Element:
    """Lower a state definition, or a state usage that is no part of another state."""
    _, subkind = read_kind(node, Kind.STATE_MACHINE)
    attributes = declaration_attributes(node)
    machine = lowering.add_element(
        node, Kind.STATE_MACHINE, nodes.name_of(node), owner, subkind=subkind, **attributes
    )
    connect_generals(lowering, node, machine)
    _lower_content(lowering, node, machine)
    return machine


def lower_exhibited_machine(lowering: Lowering, node: Node, owner: Element) -> None:
    """Lower what a classifier exhibits: its own state machine, or one defined elsewhere."""
    has_states = any(member.kind in _STATES for member in nodes.body_of(node))
    reference = _find_behaviour_reference(node)
    if reference is not None and not has_states:
        lowering.connect_reference(Edge.CLASSIFIER_BEHAVIOR, owner, reference)
        lowering.lower_annotations(node, owner)
        allocate_arguments(lowering, node, owner)
        return
    machine = lower_state_machine(lowering, node, owner)
    if not lowering.graph.targets(owner, Edge.CLASSIFIER_BEHAVIOR):
        lowering.graph.connect(Edge.CLASSIFIER_BEHAVIOR, owner, machine)


def _find_behaviour_reference(node: Node) -> Reference | None:
    return nodes.find_reference(node, "ReferenceSubsetting", "FeatureTyping", "Subsetting")


def _lower_content(lowering: Lowering, node: Node, state: Element) -> None:
    """Lower the members of a state or state machine: vertices belong to its regions."""
    body = nodes.body_of(node)
    if node.attributes.get("isParallel"):
        for member in body:
            if member.kind in _STATES:
                _lower_parallel_state(lowering, member, state)
            elif not _is_subaction(member):
                lowering.lower(member, state)
        _lower_subactions(lowering, node, state)
        return
    for member in body:
        if not _belongs_to_region(member) and not _is_subaction(member):
            lowering.lower(member, state)
    _lower_subactions(lowering, node, state)
    if any(map(_belongs_to_region, body)):
        region = lowering.add_derived(node, Kind.REGION, "", state)
        _lower_vertices(lowering, node, region)


def _lower_parallel_state(lowering: Lowering, node: Node, owner: Element) -> None:
    """Lower a state of a parallel state to a region with its substates.

    A state with subactions or parallel substates, or without substates, is itself the only state of
    the region, unless metadata calls it a region.
    """
    region = lowering.add_derived(node, Kind.REGION, nodes.name_of(node), owner)
    body = nodes.body_of(node)
    has_substates = any(map(_belongs_to_region, body))
    is_marked = annotations.metadata_value(node, "Kind", "name") == "region"
    has_subactions = any(_is_subaction(member) and not _is_empty(member) for member in body)
    is_state = has_subactions or not has_substates or node.attributes.get("isParallel")
    if is_state and not is_marked:
        state = lower_state(lowering, node, region)
        start = ensure_vertex(lowering, region, "start", node)
        transition = lowering.add_derived(node, Kind.TRANSITION, "", region)
        lowering.graph.connect(Edge.FLOW_SOURCE, transition, start)
        lowering.graph.connect(Edge.FLOW_TARGET, transition, state)
        return
    lowering.elements.own[id(node)] = region
    for member in body:
        if not _belongs_to_region(member) and not _is_subaction(member):
            lowering.lower(member, region)
    _lower_vertices(lowering, node, region)


def _is_subaction(node: Node) -> bool:
    return node.membership == "StateSubactionMembership"


def _belongs_to_region(node: Node) -> bool:
    is_first = node.kind == "Membership" and not _is_alias(node)
    return node.kind in _STATES or node.kind in _TRANSITIONS or is_first


def _is_alias(node: Node) -> bool:
    return node.kind == "Membership" and bool(node.name or node.short_name)


def _is_empty(subaction: Node) -> bool:
    """Whether a subaction is only the source of the first succession (``entry; then a``)."""
    has_content = subaction.name or subaction.members or subaction.relations
    return subaction.kind == "ActionUsage" and not has_content


# -- states and what they do -------------------------------------------------------------------


def lower_state(lowering: Lowering, node: Node, region: Element) -> Element:
    """Lower a state with its behaviours and substates; a keyword may make it a pseudostate."""
    for keyword in nodes.shipped_metadata_of(node):
        if keyword in _PSEUDOSTATES:
            return _lower_pseudostate(lowering, node, region, _PSEUDOSTATES[keyword])
    attributes = visibility_attributes(node)
    state = lowering.add_element(node, Kind.STATE, nodes.name_of(node), region, **attributes)
    for reference in nodes.list_references(
        node, "FeatureTyping", "Subsetting", "ReferenceSubsetting"
    ):
        lowering.connect_reference(Edge.CALLS, state, reference)
    _lower_content(lowering, node, state)
    return state


def _lower_pseudostate(lowering: Lowering, node: Node, region: Element, subkind: str) -> Element:
    """Lower a pseudostate; a connection point belongs to the state that owns the region."""
    owner = lowering.graph.owner(region) if subkind in _CONNECTION_POINTS else region
    pseudostate = lowering.add_element(
        node, Kind.PSEUDOSTATE, nodes.name_of(node), owner or region, subkind=subkind
    )
    for member in nodes.body_of(node):
        if member.kind == "ReferenceUsage":
            for reference in nodes.list_references(member, "Subsetting", "ReferenceSubsetting"):
                lowering.connect_reference(Edge.REFERENCES, pseudostate, reference)
        else:
            lowering.lower(member, pseudostate)
    return pseudostate


def _lower_subactions(lowering: Lowering, node: Node, state: Element) -> None:
    for member in node.members:
        if _is_subaction(member):
            edge = _SUBACTION_EDGES.get(member.role, Edge.DO)
            _lower_behaviour(lowering, member, state, edge)


def _lower_behaviour(lowering: Lowering, node: Node, owner: Element, edge: Edge) -> None:
    """Lower a behaviour of a state or a transition: its own, or one defined elsewhere."""
    if expressions.read_statement(node) is not None:
        name = node.name or ""
        activity = lowering.add_element(node, Kind.ACTIVITY, name, owner, subkind="opaque")
        values.set_effect(lowering, activity, [node])
        lowering.graph.connect(edge, owner, activity)
        return
    reference = _find_behaviour_reference(node)
    if _is_empty(node):
        lowering.verdicts.skipped.add(id(node))
    elif reference is not None and not nodes.body_of(node):
        lowering.connect_reference(edge, owner, reference)
    else:
        behaviour = _lower_own_behaviour(lowering, node, owner)
        lowering.graph.connect(edge, owner, behaviour)


def _lower_own_behaviour(lowering: Lowering, node: Node, owner: Element) -> Element:
    if node.kind == "TerminateActionUsage":
        # It ends the state itself or what it names; the grammar of effects cannot express this.
        lowering.verdicts.mark_approximated(
            node, "a terminate action of a state or a transition", "an action without effect"
        )
    body, name = nodes.body_of(node), node.name or ""
    if len(body) == 1 and body[0].kind in _STATES and not name:
        return lower_state_machine(lowering, body[0], owner)
    if len(body) == 1 and read_kind(body[0], Kind.CLASS)[0] is Kind.INTERACTION and not name:
        return lower_definition(lowering, body[0], owner, Kind.INTERACTION, "")
    if node.kind in ("SendActionUsage", "AcceptActionUsage"):
        activity = lowering.add_derived(node, Kind.ACTIVITY, name, owner)
        lowering.lower(node, activity)
        return activity
    activity = lowering.add_element(node, Kind.ACTIVITY, name, owner)
    connect_generals(lowering, node, activity)
    lower_body(lowering, node, activity)
    return activity


# -- transitions -------------------------------------------------------------------------------


def _lower_vertices(lowering: Lowering, node: Node, region: Element) -> None:
    """Lower the states and transitions of a region in the order of the text.

    A transition without a source leaves the state before it.
    """
    previous: End = None
    # Sources and nodes of successions whose target is the next state.
    waiting: list[tuple[End, Node]] = []
    for member in node.members:
        if member.kind in _STATES:
            lower_state(lowering, member, region)
            for source, succession in waiting:
                _lower_succession(lowering, succession, region, source, member)
            waiting.clear()
            previous = member
        elif _is_subaction(member) and member.role == "entry":
            previous = member
        elif member.kind == "Membership" and not _is_alias(member):
            previous = nodes.find_reference(member, "Membership")
        elif member.kind == "TransitionUsage":
            _lower_transition(lowering, member, region, previous)
        elif member.kind == "SuccessionAsUsage":
            source, target = _read_ends(member)
            if target is None:
                waiting.append((source or previous, member))
            else:
                _lower_succession(lowering, member, region, source or previous, target)
        elif waiting:
            # A `then` stands before its target, and only states are vertices.
            _, succession = waiting.pop()
            lowering.verdicts.mark_unsupported(succession)


def _read_ends(succession: Node) -> tuple[Reference | None, Reference | None]:
    ends = nodes.ends_of(succession)
    if len(ends) < 2:
        return None, None
    return reference_of_end(ends[0]), reference_of_end(ends[1])


def _lower_succession(
    lowering: Lowering, node: Node, region: Element, source: End, target: End
) -> None:
    """Lower a succession between states to a transition without trigger."""
    _add_mentioned_vertex(lowering, region, source, node)
    _add_mentioned_vertex(lowering, region, target, node)
    transition = lowering.add_element(node, Kind.TRANSITION, node.name or "", region)
    lowering.queue.defer_until_edges(lambda: _connect_ends(lowering, transition, source, target))


def _lower_transition(lowering: Lowering, node: Node, region: Element, previous: End) -> None:
    """Lower a transition with its trigger, guard and effect."""
    _, subkind = read_kind(node, Kind.TRANSITION)
    source = nodes.find_reference(node, "Membership") or previous
    _add_mentioned_vertex(lowering, region, source, node)
    attributes = visibility_attributes(node)
    transition = lowering.add_element(
        node, Kind.TRANSITION, node.name or "", region, subkind=subkind, **attributes
    )
    values.defer_expression(lowering, transition, "guard", guard_of(node))
    target: End = None
    for member in node.members:
        if member.role == "trigger":
            lower_trigger(lowering, member, transition)
        elif member.role == "effect":
            _lower_behaviour(lowering, member, transition, Edge.EFFECT)
        elif member.kind in _SUCCESSIONS:
            target = _read_ends(member)[1] or target
        elif nodes.is_annotation(member) or member.kind.endswith("ConstraintUsage"):
            lowering.lower(member, transition)
    lowering.queue.defer_until_edges(lambda: _connect_ends(lowering, transition, source, target))


def _add_mentioned_vertex(lowering: Lowering, region: Element, end: End, node: Node) -> None:
    """Add the initial or final vertex of a region if the end names it; *node* is its location."""
    if isinstance(end, Reference) and is_own_end(lowering.trees, end):
        ensure_vertex(lowering, region, nodes.last_name(end), node)
    elif isinstance(end, Node) and _is_subaction(end):
        ensure_vertex(lowering, region, "start", node)


def _connect_ends(lowering: Lowering, transition: Element, source: End, target: End) -> None:
    region = lowering.graph.owner(transition)
    assert region is not None
    for edge, end in ((Edge.FLOW_SOURCE, source), (Edge.FLOW_TARGET, target)):
        vertex = _find_vertex(lowering, region, end)
        if vertex is None:
            lowering.connect_node(edge, transition, None)
        else:
            lowering.graph.connect(edge, transition, vertex)


def _find_vertex(lowering: Lowering, region: Element, end: End) -> Element | None:
    """Return the vertex that an end means: a state, or the start or the end of a region."""
    if end is None:
        return None
    target = end if isinstance(end, Node) else end.target
    if target is not None and _is_subaction(target):
        return ensure_vertex(lowering, region, "start")
    if isinstance(end, Node) or not is_start_or_done(lowering.trees, end):
        return lowering.elements.find(target)
    holders = (end.targets or [])[:-1]
    holder = lowering.elements.find(holders[-1]) if holders and len(end.chain) > 1 else None
    inner_region = region if holder is None else _find_region(lowering.graph, holder)
    if inner_region is None:
        return None
    return ensure_vertex(lowering, inner_region, nodes.last_name(end))


def _find_region(graph: Graph, holder: Element) -> Element | None:
    """Return a region itself, or the first region of a state."""
    if holder.kind is Kind.REGION:
        return holder
    members = graph.owned(holder)
    return next((member for member in members if member.kind is Kind.REGION), None)
