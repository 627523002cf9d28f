"""Nodes that the text implies: starts and ends of behaviours and regions, nodes of parameters."""

from sysmlc.frontends.sysml.lowering import Lowering
from sysmlc.ir import Edge, Element, Kind
from sysmlc.ir.query.activities import is_joined
from sysmlc.language.tree import Node


def ensure_control_node(
    lowering: Lowering, owner: Element, name: str, node: Node | None = None
) -> Element:
    """Return the ``start`` or ``done`` of a behaviour; add it if it is new."""
    subkind = "initial" if name == "start" else "final"
    return _ensure(lowering, owner, name, node, Kind.CONTROL, subkind)


def ensure_vertex(
    lowering: Lowering, region: Element, name: str, node: Node | None = None
) -> Element:
    """Return the initial pseudostate or the final state of a region; add it if it is new."""
    kind, subkind = (Kind.PSEUDOSTATE, "initial") if name == "start" else (Kind.FINAL_STATE, "")
    return _ensure(lowering, region, name, node, kind, subkind)


def _ensure(
    lowering: Lowering, owner: Element, name: str, node: Node | None, kind: Kind, subkind: str
) -> Element:
    """Return the element for ``start`` or ``done``; *node*, which names it, gives the location."""
    starts_and_ends = lowering.elements.starts_and_ends
    element = starts_and_ends.get((owner.id, name))
    if element is None:
        if node is None:
            element = lowering.add_implied_child(owner, kind, name)
        else:
            element = lowering.add_derived(node, kind, name, owner)
        starts_and_ends[owner.id, name] = element
        lowering.set_attributes(element, subkind=subkind)
    return element


def mark_flow_finals(lowering: Lowering) -> None:
    """Mark each ``done`` that ends one of several concurrent branches as a flow final node."""
    for (_, name), end in lowering.elements.starts_and_ends.items():
        if name == "done" and end.kind is Kind.CONTROL and not is_joined(lowering.graph, end):
            lowering.set_attributes(end, subkind="flow-final")


def ensure_parameter_node(lowering: Lowering, parameter: Element) -> Element:
    """Return the activity parameter node of a parameter; add it if it is new."""
    for source in lowering.graph.sources(parameter, Edge.REFERENCES):
        if source.kind is Kind.ACTIVITY_PARAMETER:
            return source
    node = lowering.add_implied_sibling(parameter, Kind.ACTIVITY_PARAMETER, parameter.name)
    direction = str(parameter.attrs.get("direction", "in"))
    lowering.set_attributes(node, direction="out" if direction == "return" else direction)
    lowering.graph.connect(Edge.REFERENCES, node, parameter)
    lowering.library.copy_types(parameter, node)
    return node
