"""State machines: states, regions, pseudostates, transitions."""

from typing import TYPE_CHECKING

from sysmlc.frontends.sysml import annotations, nodes, statements, values
from sysmlc.frontends.sysml.activities import fill
from sysmlc.frontends.sysml.allocated import arguments
from sysmlc.frontends.sysml.definitions import flags, generalize, marked, visibility
from sysmlc.frontends.sysml.events import trigger
from sysmlc.frontends.sysml.successions import guard_of, is_of_library
from sysmlc.ir import Edge, Element, Kind
from sysmlc.language.tree import Node, Reference

if TYPE_CHECKING:
    from sysmlc.frontends.sysml.lowering import Lowering

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
_SUBACTIONS = {"entry": Edge.ENTRY, "do": Edge.DO, "exit": Edge.EXIT}
_STATES = frozenset({"StateUsage", "ExhibitStateUsage"})


def machine(low: "Lowering", node: Node, owner: Element | None) -> Element:
    """A state definition, or a state usage that is no part of another state."""
    _, subkind = marked(node, Kind.STATE_MACHINE)
    name = nodes.name_of(node)
    made = low.add(node, Kind.STATE_MACHINE, name, owner, subkind=subkind, **flags(node))
    generalize(low, node, made)
    _content(low, node, made)
    return made


def exhibit(low: "Lowering", node: Node, owner: Element) -> None:
    """What a classifier exhibits: its own state machine, or one that stands elsewhere."""
    inside = [one for one in nodes.body_of(node) if one.kind in _STATES]
    found = nodes.reference(node, "ReferenceSubsetting", "FeatureTyping", "Subsetting")
    if found is not None and not inside:
        low.refer(Edge.CLASSIFIER_BEHAVIOR, owner, found)
        low.lower_texts(node, owner)
        arguments(low, node, owner)
        return
    made = machine(low, node, owner)
    if not low.graph.targets(owner, Edge.CLASSIFIER_BEHAVIOR):
        low.graph.connect(Edge.CLASSIFIER_BEHAVIOR, owner, made)


def _content(low: "Lowering", node: Node, made: Element) -> None:
    """Parameters and texts belong to the state itself, vertices to its regions."""
    inside = nodes.body_of(node)
    if node.attributes.get("isParallel"):
        for one in inside:
            if one.kind in _STATES:
                _parallel(low, one, made)
            elif one.membership not in _NO_VERTEX:
                low.lower(one, made)
        _subactions(low, node, made)
        return
    vertices = [one for one in inside if _is_of_region(one)]
    low.lower_all((one for one in inside if not _is_of_region(one) and not _is_sub(one)), made)
    _subactions(low, node, made)
    if vertices:
        region = low.make(node, Kind.REGION, "", made)
        _vertices(low, node, region)


_NO_VERTEX = frozenset({"StateSubactionMembership"})
_FLOWS = frozenset({"TransitionUsage", "SuccessionAsUsage", "Membership"})


def _is_sub(node: Node) -> bool:
    return node.membership in _NO_VERTEX


def _is_of_region(node: Node) -> bool:
    return node.kind in _STATES or (node.kind in _FLOWS and not _is_alias(node))


def _is_alias(node: Node) -> bool:
    return node.kind == "Membership" and bool(node.name or node.short_name)


def _parallel(low: "Lowering", node: Node, owner: Element) -> None:
    """A state that runs beside others: a region with its substates, or with itself alone."""
    region = low.make(node, Kind.REGION, nodes.name_of(node), owner)
    inside = [one for one in nodes.body_of(node) if _is_of_region(one)]
    own = [one for one in nodes.body_of(node) if _is_sub(one) and not _is_empty(one)]
    if own or not inside or node.attributes.get("isParallel"):
        made = state(low, node, region)
        start = low.vertex(region, "start", node)
        _transition(low, node, region, start, made)
        return
    low.elements[id(node)] = region
    rest = (one for one in nodes.body_of(node) if not (_is_of_region(one) or _is_sub(one)))
    low.lower_all(rest, region)
    _vertices(low, node, region)


def _is_empty(node: Node) -> bool:
    """Whether a subaction says nothing but when something starts (``entry; then a``)."""
    return node.kind == "ActionUsage" and not (node.name or node.members or _stated(node))


def _stated(node: Node) -> bool:
    return bool(node.relations)


def _transition(
    low: "Lowering", node: Node, region: Element, start: Element, end: Element
) -> Element:
    made = low.make(node, Kind.TRANSITION, "", region)
    low.graph.connect(Edge.FLOW_SOURCE, made, start)
    low.graph.connect(Edge.FLOW_TARGET, made, end)
    return made


def state(low: "Lowering", node: Node, region: Element) -> Element:
    """A state with what it does and what is inside it; a keyword of ours makes a pseudostate."""
    subkind = next(
        (_PSEUDOSTATES[one] for one in annotations.ours(node) if one in _PSEUDOSTATES), ""
    )
    if subkind:
        return _pseudostate(low, node, region, subkind)
    made = low.add(node, Kind.STATE, nodes.name_of(node), region, **visibility(node))
    for found in nodes.references(node, "FeatureTyping", "Subsetting", "ReferenceSubsetting"):
        low.refer(Edge.CALLS, made, found)
    _content(low, node, made)
    return made


def _pseudostate(low: "Lowering", node: Node, region: Element, subkind: str) -> Element:
    is_point = subkind in ("entry-point", "exit-point", "connection-point")
    owner = low.graph.owner(region) if is_point else region
    made = low.add(node, Kind.PSEUDOSTATE, nodes.name_of(node), owner or region, subkind=subkind)
    for one in nodes.body_of(node):
        if one.kind == "ReferenceUsage":
            for found in nodes.references(one, "Subsetting", "ReferenceSubsetting"):
                low.refer(Edge.REFERENCES, made, found)
        else:
            low.lower(one, made)
    return made


# -- what states do ----------------------------------------------------------------------------


def _subactions(low: "Lowering", node: Node, made: Element) -> None:
    for one in node.members:
        if _is_sub(one):
            held(low, one, made, _SUBACTIONS.get(one.role, Edge.DO))


def held(low: "Lowering", node: Node, owner: Element, edge: Edge) -> None:
    """A behaviour of a state or a transition: its own, or one that stands elsewhere."""
    written = statements.statement(node)
    if written is not None:
        made = low.add(node, Kind.ACTIVITY, node.name or "", owner, subkind="opaque")
        low.set(made, body=statements.effect([node]))
        low.graph.connect(edge, owner, made)
        return
    found = nodes.reference(node, "ReferenceSubsetting", "FeatureTyping", "Subsetting")
    if _is_empty(node):
        low.skipped.add(id(node))
    elif found is not None and not nodes.body_of(node):
        low.refer(edge, owner, found)
    else:
        _own(low, node, owner, edge)


_NO_EFFECT = "an action without effect"


def _own(low: "Lowering", node: Node, owner: Element, edge: Edge) -> None:
    only = nodes.body_of(node)
    if node.kind == "TerminateActionUsage":
        # It ends the state itself or what it names; the effect has no words.
        low.approximated(node, "a terminate action of a state or a transition", _NO_EFFECT)
    if len(only) == 1 and only[0].kind in _STATES and not node.name:
        made = machine(low, only[0], owner)
    elif node.kind == "SendActionUsage" or node.kind == "AcceptActionUsage":
        made = low.make(node, Kind.ACTIVITY, node.name or "", owner)
        low.lower(node, made)
    else:
        made = low.add(node, Kind.ACTIVITY, node.name or "", owner)
        generalize(low, node, made)
        fill(low, node, made)
    low.graph.connect(edge, owner, made)


# -- transitions -------------------------------------------------------------------------------


def _vertices(low: "Lowering", node: Node, region: Element) -> None:
    """States, then transitions: what is not stated of one is the state before it."""
    previous: Node | Reference | None = None
    waiting: list[tuple[Node | Reference | None, Node]] = []
    for one in node.members:
        if one.kind in _STATES:
            state(low, one, region)
            for source, succession in waiting:
                _step(low, succession, region, source, one)
            waiting.clear()
            previous = one
        elif _is_sub(one) and one.role == "entry":
            previous = one
        elif one.kind == "Membership" and not _is_alias(one):
            previous = nodes.reference(one, "Membership")
        elif one.kind == "TransitionUsage":
            transition(low, one, region, previous)
        elif one.kind == "SuccessionAsUsage":
            source, target = _succession(one)
            if target is None:
                waiting.append((source or previous, one))
            else:
                _step(low, one, region, source or previous, target)
        elif waiting:
            # A `then` stands before its target, and only states are vertices.
            low.unsupported(waiting.pop()[1])


def _succession(node: Node) -> tuple[Reference | None, Reference | None]:
    ends = nodes.ends_of(node)
    if len(ends) < 2:
        return None, None
    found = [nodes.reference(end, "ReferenceSubsetting", "Subsetting") for end in ends[:2]]
    return found[0], found[1]


def _step(
    low: "Lowering",
    node: Node,
    region: Element,
    source: "Node | Reference | None",
    target: "Node | Reference",
) -> None:
    for point in (source, target):
        _mention(low, region, point, node)
    made = low.add(node, Kind.TRANSITION, node.name or "", region)
    low.last(lambda: _ends(low, made, source, target))


def transition(
    low: "Lowering", node: Node, region: Element, previous: "Node | Reference | None"
) -> None:
    """A transition with its trigger, guard and effect."""
    _, subkind = marked(node, Kind.TRANSITION)
    name = node.name or ""
    source = nodes.reference(node, "Membership") or previous
    _mention(low, region, source, node)
    made = low.add(node, Kind.TRANSITION, name, region, subkind=subkind, **visibility(node))
    guard = guard_of(node)
    if guard is not None:
        low.later(lambda: values.say(low, made, "guard", guard))
    target: Node | Reference | None = None
    for one in node.members:
        if one.role == "trigger":
            trigger(low, one, made)
        elif one.role == "effect":
            held(low, one, made, Edge.EFFECT)
        elif one.kind in ("SuccessionAsUsage", "Succession"):
            target = _succession(one)[1] or target
        elif nodes.is_text(one) or one.kind.endswith("ConstraintUsage"):
            low.lower(one, made)
    low.last(lambda: _ends(low, made, source, target))


def _mention(
    low: "Lowering", region: Element, point: "Node | Reference | None", node: Node
) -> None:
    """Make the start of a region, or its end, where the text first names it."""
    if isinstance(point, Reference) and len(point.chain) == 1 and is_of_library(low, point):
        low.vertex(region, nodes.last_name(point), node)
    elif isinstance(point, Node) and _is_sub(point):
        low.vertex(region, "start", node)


def _ends(
    low: "Lowering",
    made: Element,
    source: "Node | Reference | None",
    target: "Node | Reference | None",
) -> None:
    region = low.graph.owner(made)
    assert region is not None
    for edge, point in ((Edge.FLOW_SOURCE, source), (Edge.FLOW_TARGET, target)):
        found = _vertex(low, region, point)
        if found is None:
            low.lead(edge, made, None)
        else:
            low.graph.connect(edge, made, found)


def _vertex(low: "Lowering", region: Element, point: "Node | Reference | None") -> Element | None:
    """The vertex that an end means: a state, the start or the end of a region."""
    if point is None:
        return None
    if isinstance(point, Node):
        return low.vertex(region, "start") if _is_sub(point) else low.element(point)
    target, name = point.target, nodes.last_name(point)
    if target is not None and _is_sub(target):
        return low.vertex(region, "start")
    if is_of_library(low, point):
        before = [low.element(one) for one in (point.targets or [])[:-1]]
        holder = before[-1] if before and len(point.chain) > 1 else None
        inside = region if holder is None else _region_in(low, holder)
        return None if inside is None else low.vertex(inside, name)
    return low.element(target)


def _region_in(low: "Lowering", holder: Element) -> Element | None:
    if holder.kind is Kind.REGION:
        return holder
    inside = (one for one in low.graph.owned(holder) if one.kind is Kind.REGION)
    return next(inside, None)
