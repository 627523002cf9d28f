"""Parameters of behaviours and operations, their nodes, and pins of actions."""

from typing import TYPE_CHECKING

from sysmlc.frontends.sysml import nodes, values
from sysmlc.frontends.sysml.definitions import visibility
from sysmlc.frontends.sysml.features import describe, give_types
from sysmlc.ir import AttrValue, Edge, Element, Kind
from sysmlc.language.tree import Node

if TYPE_CHECKING:
    from sysmlc.frontends.sysml.lowering import Lowering

_CALLS = frozenset({"call-behavior", "call-operation"})
_SUBKINDS = {
    ("opaque", "in"): "input-value",
    ("opaque", "out"): "output-value",
    ("send", "in"): "argument",
    ("accept", "out"): "result",
    ("value", "out"): "result",
    ("read", "out"): "result",
}


def parameter(low: "Lowering", node: Node, owner: Element) -> Element:
    """A parameter of a behaviour or an operation."""
    direction = direction_of(node)
    attrs = {"direction": direction} | visibility(node)
    made = low.add(node, Kind.PARAMETER, nodes.name_of(node), owner, **attrs)
    value = nodes.value_of(node)
    if direction != "in" and value is not None and value.role == ":=":
        low.set(made, initial=True)
    describe(low, node, made)
    return made


def direction_of(node: Node) -> str:
    """The direction of a parameter; a result is returned."""
    if node.membership == "ReturnParameterMembership":
        return "return"
    return str(node.attributes.get("direction", "in"))


def pin(low: "Lowering", node: Node, action: Element) -> Element:
    """A pin: a parameter of an action, with the value that it is given."""
    said = direction_of(node)
    direction = "out" if said == "return" else said
    given: dict[str, AttrValue] = {
        "direction": direction,
        "subkind": _subkind(action, direction),
        "multiplicity": values.multiplicity(low, node),
        "ordered": bool(node.attributes.get("isOrdered")),
    }
    made = low.add(node, Kind.PIN, nodes.name_of(node), action, **given)
    if node.attributes.get("isUnique") is False:
        low.graph.set(made, unique=False)
    low.later(lambda: give_types(low, node, made))
    value = nodes.value_of(node)
    if value is not None:
        _value(low, made, action, value)
    low.lower_texts(node, made)
    return made


def _subkind(action: Element, direction: str) -> str:
    if action.subkind in _CALLS:
        return "argument" if direction == "in" else "result"
    return _SUBKINDS.get((action.subkind, direction), "")


def _value(low: "Lowering", made: Element, action: Element, value: Node) -> None:
    if made.attrs.get("direction") == "out":
        low.later(lambda: _given(low, action, value))
    else:
        values.give(low, made, "value", value)
        if unit := values.measure(value):
            low.set(made, value_unit=unit)


def _given(low: "Lowering", action: Element, value: Node) -> None:
    """A value or a feature that an action gives out: it reads it."""
    literal = values.constant(value)
    target = nodes.target(value, "Membership") if value.kind == _REFERENCE else None
    if action.subkind in _CALLS or action.kind is not Kind.ACTION:
        return
    if literal is not None:
        low.graph.set(action, subkind="value", value=literal)
    elif target is not None and low.element(target) is not None:
        low.graph.set(action, subkind="read")
        low.lead(Edge.CALLS, action, target)
    else:
        low.graph.set(action, subkind="value")
        values.give(low, action, "value", value)
    for one in low.graph.owned(action):
        if one.kind is Kind.PIN and one.subkind == "output-value":
            low.graph.set(one, subkind="result")


_REFERENCE = "FeatureReferenceExpression"


def own_parameter(low: "Lowering", parameter_: Element, activity: Element) -> Element:
    """The parameter as one of the activity: an inherited one is repeated when a flow needs it."""
    if low.graph.owner(parameter_) is activity:
        return parameter_
    for one in low.graph.owned(activity):
        if one.kind is Kind.PARAMETER and one.name == parameter_.name:
            return one
    made = low.below(activity, Kind.PARAMETER, parameter_.name)
    low.set(made, direction=parameter_.attrs.get("direction"))
    low.set(made, multiplicity=parameter_.attrs.get("multiplicity"))
    low.graph.connect(Edge.REDEFINES, made, parameter_)
    low.share_types(parameter_, made)
    return made


def node_of(low: "Lowering", parameter_: Element) -> Element:
    """The node of an activity that stands for its parameter; it is made when a flow needs it."""
    for one in low.graph.sources(parameter_, Edge.REFERENCES):
        if one.kind is Kind.ACTIVITY_PARAMETER:
            return one
    direction = str(parameter_.attrs.get("direction", "in"))
    made = low.beside(parameter_, Kind.ACTIVITY_PARAMETER, parameter_.name)
    low.set(made, direction="out" if direction == "return" else direction)
    low.graph.connect(Edge.REFERENCES, made, parameter_)
    low.share_types(parameter_, made)
    return made


def pin_of(low: "Lowering", action: Element, parameter_: Element) -> Element:
    """The pin of an action for a parameter of what it calls; made when a flow needs it."""
    for one in low.graph.owned(action):
        if one.kind is Kind.PIN and one.name == parameter_.name:
            return one
    made = low.below(action, Kind.PIN, parameter_.name)
    direction = "out" if parameter_.attrs.get("direction") in ("out", "return") else "in"
    count = parameter_.attrs.get("multiplicity")
    low.set(made, direction=direction, subkind=_subkind(action, direction), multiplicity=count)
    low.share_types(parameter_, made)
    return made
