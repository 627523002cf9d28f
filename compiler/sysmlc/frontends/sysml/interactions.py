"""Interactions: occurrences with lifelines and messages between them."""

from typing import TYPE_CHECKING

from sysmlc.frontends.sysml import annotations, nodes
from sysmlc.frontends.sysml.connections import payloads, steps_of
from sysmlc.frontends.sysml.features import property_
from sysmlc.frontends.sysml.types import types_of
from sysmlc.ir import Edge, Element, Kind
from sysmlc.language.tree import Node

if TYPE_CHECKING:
    from sysmlc.frontends.sysml.lowering import Lowering


def member(low: "Lowering", node: Node, owner: Element) -> None:
    """A feature of an interaction: a fragment, a lifeline, or a role that the model has beside.

    The back end writes lifelines as references; in other models every feature takes part.
    """
    if node.kind == "OccurrenceUsage":
        fragment(low, node, owner)
    elif node.attributes.get("isReference") or not _is_written(node.owner):
        lifeline(low, node, owner)
    else:
        property_(low, node, owner)


def _is_written(owner: Node | None) -> bool:
    return owner is not None and annotations.said(owner, "Kind", "name") == "interaction"


def lifeline(low: "Lowering", node: Node, owner: Element) -> None:
    """A lifeline: what takes part in the interaction."""
    made = low.add(node, Kind.LIFELINE, nodes.name_of(node), owner)
    low.later(lambda: _represent(low, node, made))
    for one in nodes.body_of(node):
        if one.kind == "EventOccurrenceUsage":
            event(low, one, made)
        elif nodes.is_text(one):
            low.lower(one, made)
        else:
            low.approximated(one, "a feature of a lifeline", "nothing")


def _represent(low: "Lowering", node: Node, made: Element) -> None:
    """The feature that is meant; where only its type is said, the one part of that type."""
    for found in nodes.references(node, "Redefinition", "ReferenceSubsetting", "Subsetting"):
        low.lead(Edge.REPRESENTS, made, found.target)
        return
    for type_ in types_of(low, node):
        known = low.element(type_)
        users = [] if known is None else low.graph.sources(known, Edge.TYPED_BY)
        parts = [one for one in users if one.kind is Kind.PROPERTY]
        named = [one for one in parts if one.name == made.name] or parts
        if len(named) == 1:
            low.graph.connect(Edge.REPRESENTS, made, named[0])


def message(low: "Lowering", node: Node, owner: Element) -> None:
    """A message from one lifeline to another."""
    sort = annotations.said(node, "Kind", "name") or "asynch-signal"
    made = low.add(node, Kind.MESSAGE, nodes.name_of(node), owner, subkind=str(sort))
    called = annotations.said(node, "Kind", "calls")
    for payload in () if called else payloads(node):
        for found in nodes.references(payload, "FeatureTyping"):
            low.refer(Edge.CALLS, made, found)
    if called:
        low.last(lambda: _call(low, made, str(called)))
    low.last(lambda: _join(low, node, made))
    annotations.texts(low, node, made, "a message", payloads(node))


def _call(low: "Lowering", made: Element, name: str) -> None:
    """The operation that a message calls, by the qualified name that metadata of ours says."""
    known = low.graph.get(low.id_of(name))
    if known is not None:
        low.graph.connect(Edge.CALLS, made, known)


def _join(low: "Lowering", node: Node, made: Element) -> None:
    edges = ((Edge.FLOW_SOURCE, Edge.SEND_EVENT), (Edge.FLOW_TARGET, Edge.RECEIVE_EVENT))
    ends = nodes.ends_of(node) or nodes.events_of(node)
    for (edge, event), end in zip(edges, ends, strict=False):
        known = [one for step in steps_of(end) if (one := low.element(step)) is not None]
        line = next((one for one in known if one.kind is Kind.LIFELINE), None)
        owner = low.graph.owner(made)
        if line is None or owner is None:
            continue
        at = _occurrence(low, owner, known[-1] if known[-1] is not line else None)
        low.graph.connect(Edge.COVERS, at, line)
        low.graph.connect(edge, made, line)
        low.graph.connect(event, made, at)


def _occurrence(low: "Lowering", owner: Element, event: Element | None) -> Element:
    """The point at which something happens: an event that the model names, else a new one."""
    if event is not None and event.kind is Kind.OCCURRENCE:
        return event
    at = low.below(owner, Kind.OCCURRENCE, "")
    low.set(at, subkind="message")
    return at


def event(low: "Lowering", node: Node, owner: Element) -> None:
    """An event of a lifeline, or of the interaction itself."""
    is_line = owner.kind is Kind.LIFELINE
    home = low.graph.owner(owner) if is_line else owner
    found = nodes.reference(node, "ReferenceSubsetting")
    if found is not None and not node.name:
        low.later(lambda: _same(low, node, found.target))
        return
    made = low.add(node, Kind.OCCURRENCE, nodes.name_of(node), home, subkind="message")
    if is_line:
        low.graph.connect(Edge.COVERS, made, owner)


def _same(low: "Lowering", node: Node, target: Node | None) -> None:
    known = low.element(target)
    if known is not None:
        low.elements[id(node)] = known


def order(low: "Lowering", node: Node, owner: Element) -> None:
    """A succession between events: one comes before the other."""
    ends = nodes.ends_of(node)
    if len(ends) < 2:
        low.approximated(node, "an order of events without ends", "nothing")
        return
    made = low.add(node, Kind.GENERAL_ORDERING, node.name or "", owner)
    low.last(lambda: _order(low, made, ends))


def _order(low: "Lowering", made: Element, ends: list[Node]) -> None:
    for edge, end in zip((Edge.FLOW_SOURCE, Edge.FLOW_TARGET), ends, strict=False):
        steps = steps_of(end)
        known = low.element(steps[-1]) if steps else None
        if known is not None:
            low.graph.connect(edge, made, known)


def fragment(low: "Lowering", node: Node, owner: Element) -> None:
    """A combined fragment or an operand, as metadata of ours says."""
    name = str(annotations.said(node, "Kind", "name") or "seq")
    kind, subkind = (Kind.OPERAND, "") if name == "operand" else (Kind.FRAGMENT, name)
    made = low.add(node, kind, nodes.name_of(node), owner, subkind=subkind)
    low.lower_all(nodes.body_of(node), made)
