"""Flows and bindings between the pins of steps and the parameters of an activity."""

from typing import TYPE_CHECKING

from sysmlc.frontends.sysml import annotations, nodes
from sysmlc.frontends.sysml.connections import steps_of
from sysmlc.frontends.sysml.definitions import visibility
from sysmlc.frontends.sysml.parameters import node_of, own_parameter, pin_of
from sysmlc.ir import Edge, Element, Kind
from sysmlc.language.tree import Node

if TYPE_CHECKING:
    from sysmlc.frontends.sysml.lowering import Lowering

_NODES = frozenset({Kind.PIN, Kind.OBJECT_NODE, Kind.DATA_STORE, Kind.ACTIVITY_PARAMETER})


def flow(low: "Lowering", node: Node, owner: Element) -> None:
    """A flow from one object node to another; one that is a succession too orders the steps."""
    if "Through" in annotations.ours(node):
        low.skipped.update(id(one) for one in node.members)
        return
    made = low.add(node, Kind.OBJECT_FLOW, node.name or "", owner, **visibility(node))
    low.lower_texts(node, made)
    low.last(lambda: _join(low, node, made, is_turned=False))
    if node.kind == "SuccessionFlowUsage":
        order = low.make(node, Kind.CONTROL_FLOW, "", owner)
        low.last(lambda: _order(low, made, order))


def binding(low: "Lowering", node: Node, owner: Element) -> None:
    """A binding: an object flow to what is not known by itself."""
    made = low.add(node, Kind.OBJECT_FLOW, node.name or "", owner, **visibility(node))
    low.lower_texts(node, made)
    low.last(lambda: _join(low, node, made, is_turned=True))


def _order(low: "Lowering", made: Element, order: Element) -> None:
    for edge in (Edge.FLOW_SOURCE, Edge.FLOW_TARGET):
        end = low.graph.target(made, edge)
        step = low.graph.owner(end) if end is not None and end.kind is Kind.PIN else end
        if step is not None:
            low.graph.connect(edge, order, step)


def _join(low: "Lowering", node: Node, made: Element, *, is_turned: bool) -> None:
    found = [_node(low, made, end) for end in nodes.ends_of(node)[:2]]
    found += [None] * (2 - len(found))
    if is_turned and _is_value(low, node, made, found):
        return
    if is_turned and not _is_forward(found):
        found = found[::-1]
    for edge, one in zip((Edge.FLOW_SOURCE, Edge.FLOW_TARGET), found, strict=True):
        if one is None:
            low.lead(edge, made, None)
        else:
            low.graph.connect(edge, made, one)


def _of_activity(low: "Lowering", made: Element, parameter_: Element) -> Element:
    """The node for a parameter of the activity that owns the flow; it may be inherited."""
    for above in low.graph.ancestors(made):
        if above.kind is Kind.ACTIVITY:
            return node_of(low, own_parameter(low, parameter_, above))
    return node_of(low, parameter_)


def _is_value(low: "Lowering", node: Node, made: Element, found: list[Element | None]) -> bool:
    """Whether a parameter is bound to a feature that no object node stands for: its value."""
    for number, one in enumerate(found):
        other = found[1 - number]
        is_feature = one is not None and one.kind in (Kind.PROPERTY, Kind.PORT)
        if is_feature and other is not None and other.kind is Kind.ACTIVITY_PARAMETER:
            steps = [low.element(step) for step in steps_of(nodes.ends_of(node)[number])]
            text = ".".join(step.name for step in steps if step is not None)
            parameter_ = low.graph.target(other, Edge.REFERENCES)
            if parameter_ is not None:
                low.graph.set(parameter_, default=text, default_language="")
            low.graph.remove(made)
            return True
    return False


def _is_forward(found: list[Element | None]) -> bool:
    """Whether a binding's first end gives the value: ``bind a = b`` sets ``a`` where both may."""
    first, second = (_gives(one) for one in found)
    return (first is True and second is not True) or (second is False and first is not False)


def _gives(one: Element | None) -> bool | None:
    """Whether an end can only be a source (true) or a target (false) of a flow."""
    if one is None:
        return None
    direction = one.attrs.get("direction")
    if one.kind is Kind.PIN:
        return {"out": True, "in": False}.get(str(direction))
    if one.kind is Kind.ACTIVITY_PARAMETER:
        return {"in": True, "out": False}.get(str(direction))
    return None


def _node(low: "Lowering", made: Element, end: Node) -> Element | None:
    """The object node at an end: a pin, a parameter node, a buffer."""
    path = [low.element(one) for one in steps_of(end)]
    if not path or path[-1] is None:
        return None
    last, before = path[-1], path[-2] if len(path) > 1 else None
    if last.kind in _NODES:
        return last
    if last.kind is Kind.PARAMETER:
        is_step = before is not None and before.kind in (Kind.ACTION, Kind.STRUCTURED)
        return (
            pin_of(low, before, last)
            if is_step and before is not None
            else _of_activity(low, made, last)
        )
    step = next((one for one in path if one is not None and one.kind is Kind.ACTION), None)
    if step is not None:
        return pin_of(low, step, last)
    return last
