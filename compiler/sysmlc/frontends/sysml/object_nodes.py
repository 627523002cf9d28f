"""Features of behaviours: parameters, pins and buffers, and the object flows between them."""

from sysmlc.frontends.sysml import nodes, quantities, values
from sysmlc.frontends.sysml.definitions import read_kind, visibility_attributes
from sysmlc.frontends.sysml.elements import NodeElements
from sysmlc.frontends.sysml.features import connect_types, describe_feature, lower_property
from sysmlc.frontends.sysml.implied_nodes import ensure_parameter_node
from sysmlc.frontends.sysml.lowering import Lowering
from sysmlc.frontends.sysml.trees import Trees
from sysmlc.ir import AttrValue, Edge, Element, Graph, Kind
from sysmlc.language.tree import Node

_STEPS = frozenset({Kind.ACTION, Kind.STRUCTURED})
_BUFFERS = (Kind.OBJECT_NODE, Kind.DATA_STORE)
_OBJECT_NODES = frozenset({Kind.PIN, Kind.OBJECT_NODE, Kind.DATA_STORE, Kind.ACTIVITY_PARAMETER})
_CALLS = frozenset({"call-behavior", "call-operation"})
_PIN_SUBKINDS = {
    ("opaque", "in"): "input-value",
    ("opaque", "out"): "output-value",
    ("send", "in"): "argument",
    ("accept", "out"): "result",
    ("value", "out"): "result",
    ("read", "out"): "result",
}
"""Subkinds of pins by the subkind of the action and the direction."""
_FLOW_EDGES = (Edge.FLOW_SOURCE, Edge.FLOW_TARGET)


def lower_behaviour_feature(lowering: Lowering, node: Node, owner: Element) -> Element:
    """Lower a feature of an activity, a step, a state machine or an operation."""
    if "direction" in node.attributes or node.membership == "ReturnParameterMembership":
        if owner.kind in _STEPS:
            return _lower_pin(lowering, node, owner)
        return _lower_parameter(lowering, node, owner)
    kind, subkind = read_kind(node, _default_kind(lowering.trees, node, owner))
    if kind not in _BUFFERS and subkind != "expansion":
        return lower_property(lowering, node, owner)
    buffer = lowering.add_element(
        node,
        kind if kind in _BUFFERS else Kind.OBJECT_NODE,
        nodes.name_of(node),
        owner,
        subkind=subkind,
        **visibility_attributes(node),
    )
    describe_feature(lowering, node, buffer)
    return buffer


def _default_kind(trees: Trees, node: Node, owner: Element) -> Kind:
    """Return object node for items of an activity, and for features at which flows end there."""
    if owner.kind not in (Kind.ACTIVITY, Kind.STRUCTURED):
        return Kind.PROPERTY
    is_item = node.kind == "ItemUsage" and not node.attributes.get("isReference")
    is_object_node = is_item or id(node) in trees.flow_features
    return Kind.OBJECT_NODE if is_object_node else Kind.PROPERTY


def _lower_parameter(lowering: Lowering, node: Node, owner: Element) -> Element:
    direction = _direction_of(node)
    parameter = lowering.add_element(
        node,
        Kind.PARAMETER,
        nodes.name_of(node),
        owner,
        direction=direction,
        **visibility_attributes(node),
    )
    describe_feature(lowering, node, parameter)
    return parameter


def _direction_of(node: Node) -> str:
    if node.membership == "ReturnParameterMembership":
        return "return"
    return str(node.attributes.get("direction", "in"))


# -- pins of actions ---------------------------------------------------------------------------


def _lower_pin(lowering: Lowering, node: Node, action: Element) -> Element:
    """Lower a parameter of an action to a pin, with the value bound to it."""
    direction = _direction_of(node)
    if direction == "return":
        direction = "out"
    attributes: dict[str, AttrValue] = {
        "direction": direction,
        "subkind": _pin_subkind(action, direction),
        "multiplicity": values.multiplicity_of(lowering.trees, node),
        "ordered": bool(node.attributes.get("isOrdered")),
    }
    pin = lowering.add_element(node, Kind.PIN, nodes.name_of(node), action, **attributes)
    if node.attributes.get("isUnique") is False:
        lowering.graph.set(pin, unique=False)
    lowering.queue.defer_until_elements(lambda: connect_types(lowering, node, pin))
    value = nodes.value_of(node)
    if value is not None and direction == "out" and action.subkind not in _CALLS:
        quantities.set_kind(lowering.graph, pin, "value", value)
        lowering.queue.defer_until_elements(lambda: _set_output(lowering, action, value))
    elif value is not None:
        values.set_value(lowering, pin, "value", value)
    lowering.lower_annotations(node, pin)
    return pin


def _pin_subkind(action: Element, direction: str) -> str:
    if action.subkind in _CALLS:
        return "argument" if direction == "in" else "result"
    return _PIN_SUBKINDS.get((action.subkind, direction), "")


def _set_output(lowering: Lowering, action: Element, value: Node) -> None:
    """Set the subkind of an action whose output is bound: a value action or a read action."""
    if action.subkind in _CALLS or action.kind is not Kind.ACTION:
        return
    constant = values.constant_of(value)
    is_reference = value.kind == "FeatureReferenceExpression"
    target = nodes.find_target(value, "Membership") if is_reference else None
    feature = lowering.elements.find(target)
    if constant is not None:
        lowering.graph.set(action, subkind="value", value=constant)
        if quantities.has_unit(value):
            lowering.queue.defer_until_edges(
                lambda: quantities.set_unit(lowering, action, "value", value)
            )
    elif feature is not None and _is_instance(feature):
        lowering.graph.set(action, subkind="value", value=feature.name, value_instance=feature.id)
    elif feature is not None:
        lowering.graph.set(action, subkind="read")
        lowering.connect_node(Edge.CALLS, action, target)
    else:
        lowering.graph.set(action, subkind="value")
        values.set_value(lowering, action, "value", value)
    for pin in lowering.graph.owned(action):
        if pin.kind is Kind.PIN and pin.subkind == "output-value":
            lowering.graph.set(pin, subkind="result")


def _is_instance(feature: Element) -> bool:
    """Whether a feature is an instance of the model; of a stub, the kind is not known."""
    return feature.kind is Kind.INSTANCE and not feature.attrs.get("external")


# -- object nodes that flows need --------------------------------------------------------------


def ensure_pin(lowering: Lowering, action: Element, parameter: Element) -> Element:
    """Return the pin of a call for a parameter of the called behaviour; add it if it is new."""
    for member in lowering.graph.owned(action):
        if member.kind is Kind.PIN and member.name == parameter.name:
            return member
    pin = lowering.add_implied_child(action, Kind.PIN, parameter.name)
    direction = "out" if parameter.attrs.get("direction") in ("out", "return") else "in"
    lowering.set_attributes(
        pin,
        direction=direction,
        subkind=_pin_subkind(action, direction),
        multiplicity=parameter.attrs.get("multiplicity"),
    )
    lowering.library.copy_types(parameter, pin)
    return pin


def _ensure_own_parameter(lowering: Lowering, parameter: Element, activity: Element) -> Element:
    """Return the parameter of an activity; add a redefinition of an inherited one if needed."""
    if lowering.graph.owner(parameter) is activity:
        return parameter
    for member in lowering.graph.owned(activity):
        if member.kind is Kind.PARAMETER and member.name == parameter.name:
            return member
    redefinition = lowering.add_implied_child(activity, Kind.PARAMETER, parameter.name)
    lowering.set_attributes(redefinition, direction=parameter.attrs.get("direction"))
    lowering.set_attributes(redefinition, multiplicity=parameter.attrs.get("multiplicity"))
    lowering.graph.connect(Edge.REDEFINES, redefinition, parameter)
    lowering.library.copy_types(parameter, redefinition)
    return redefinition


# -- object flows ------------------------------------------------------------------------------


def lower_object_flow(lowering: Lowering, node: Node, owner: Element) -> None:
    """Lower a flow among steps; a succession flow also becomes a control flow."""
    flow = _add_object_flow(lowering, node, owner)
    if flow is None:
        return
    lowering.queue.defer_until_edges(
        lambda: _connect_ends(lowering, flow, *_find_end_nodes(lowering, node, flow))
    )
    if node.kind == "SuccessionFlowUsage":
        control_flow = lowering.add_derived(node, Kind.CONTROL_FLOW, "", owner)
        lowering.queue.defer_until_edges(lambda: _order_steps(lowering.graph, flow, control_flow))


def lower_binding(lowering: Lowering, node: Node, owner: Element) -> None:
    """Lower a binding among steps to an object flow from the end that has a value."""
    flow = _add_object_flow(lowering, node, owner)
    if flow is not None:
        lowering.queue.defer_until_edges(lambda: _connect_binding(lowering, node, flow))


def _add_object_flow(lowering: Lowering, node: Node, owner: Element) -> Element | None:
    """Add the object flow of a flow or binding, unless metadata marks it as implied by others."""
    if "Through" in nodes.shipped_metadata_of(node):
        lowering.verdicts.skipped.update(id(member) for member in node.members)
        return None
    attributes = visibility_attributes(node)
    flow = lowering.add_element(node, Kind.OBJECT_FLOW, node.name or "", owner, **attributes)
    lowering.lower_annotations(node, flow)
    return flow


def _order_steps(graph: Graph, object_flow: Element, control_flow: Element) -> None:
    """Connect a control flow to the steps that own the pins at the ends of an object flow."""
    for edge in _FLOW_EDGES:
        end = graph.target(object_flow, edge)
        step = graph.owner(end) if end is not None and end.kind is Kind.PIN else end
        if step is not None:
            graph.connect(edge, control_flow, step)


def _find_end_nodes(
    lowering: Lowering, node: Node, flow: Element
) -> tuple[Element | None, Element | None]:
    """Return the object nodes at the two ends of a flow or a binding."""
    object_nodes = [_find_object_node(lowering, flow, end) for end in nodes.ends_of(node)[:2]]
    first, second = [*object_nodes, None, None][:2]
    return first, second


def _connect_ends(
    lowering: Lowering, flow: Element, source: Element | None, target: Element | None
) -> None:
    for edge, end in zip(_FLOW_EDGES, (source, target), strict=True):
        if end is None:
            lowering.connect_node(edge, flow, None)
        else:
            lowering.graph.connect(edge, flow, end)


def _connect_binding(lowering: Lowering, node: Node, flow: Element) -> None:
    first, second = _find_end_nodes(lowering, node, flow)
    if _is_default_value(lowering.graph, lowering.elements, node, (first, second)):
        lowering.graph.remove(flow)
    elif _flows_forward(*(_is_source(lowering.graph, flow, end) for end in (first, second))):
        _connect_ends(lowering, flow, first, second)
    else:
        _connect_ends(lowering, flow, second, first)


def _is_default_value(
    graph: Graph, elements: NodeElements, node: Node, ends: tuple[Element | None, Element | None]
) -> bool:
    """Whether a binding leads from a parameter to a property or port; set the default if so.

    Such a feature has no object node. The default of the parameter is its path as text.
    """
    for number, (feature, parameter_node) in enumerate((ends, ends[::-1])):
        if feature is None or feature.kind not in (Kind.PROPERTY, Kind.PORT):
            continue
        if parameter_node is None or parameter_node.kind is not Kind.ACTIVITY_PARAMETER:
            continue
        path = nodes.path_of_end(nodes.ends_of(node)[number])
        features = [elements.find(step) for step in path]
        text = ".".join(step.name for step in features if step is not None)
        parameter = graph.target(parameter_node, Edge.REFERENCES)
        if parameter is not None:
            graph.set(parameter, default=text, default_language="")
        return True
    return False


def _flows_forward(first_is_source: bool | None, second_is_source: bool | None) -> bool:
    """Whether the value of a binding flows from the first end to the second.

    ``bind a = b`` sets ``a`` if both ends may be source and target.
    """
    if first_is_source is True:
        return second_is_source is not True
    return second_is_source is False and first_is_source is not False


def _is_source(graph: Graph, flow: Element, end: Element | None) -> bool | None:
    """Whether an end of a flow must be its source; None if it may be source or target.

    Inside of a structured node, its inputs are sources and its outputs are targets.
    """
    if end is None:
        return None
    direction = str(end.attrs.get("direction"))
    is_inside = any(owner.id == end.owner for owner in graph.ancestors(flow))
    if end.kind is Kind.PIN and not is_inside:
        return {"out": True, "in": False}.get(direction)
    if end.kind in (Kind.PIN, Kind.ACTIVITY_PARAMETER):
        return {"in": True, "out": False}.get(direction)
    return None


def _find_object_node(lowering: Lowering, flow: Element, end: Node) -> Element | None:
    """Return the object node at an end: a pin, an activity parameter node or a buffer.

    A feature without object node is returned itself.
    """
    path = [lowering.elements.find(feature) for feature in nodes.path_of_end(end)]
    feature = path[-1] if path else None
    if feature is None or feature.kind in _OBJECT_NODES:
        return feature
    if feature.kind is Kind.PARAMETER:
        step = path[-2] if len(path) > 1 else None
        if step is not None and step.kind in _STEPS:
            return ensure_pin(lowering, step, feature)
        return _ensure_node_of_activity(lowering, flow, feature)
    for step in path:
        if step is not None and step.kind is Kind.ACTION:
            return ensure_pin(lowering, step, feature)
    return feature


def _ensure_node_of_activity(lowering: Lowering, flow: Element, parameter: Element) -> Element:
    """Return the node for a parameter of the activity that owns the flow; it may be inherited."""
    for ancestor in lowering.graph.ancestors(flow):
        if ancestor.kind is Kind.ACTIVITY:
            own_parameter = _ensure_own_parameter(lowering, parameter, ancestor)
            return ensure_parameter_node(lowering, own_parameter)
    return ensure_parameter_node(lowering, parameter)
