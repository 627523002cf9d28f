"""Actions and control nodes of activities."""

from sysmlc.frontends.sysml import annotations, expressions, nodes, values
from sysmlc.frontends.sysml.activities import list_members_beside
from sysmlc.frontends.sysml.definitions import visibility_attributes
from sysmlc.frontends.sysml.kinds import ACTIVITIES
from sysmlc.frontends.sysml.lowering import Lowering
from sysmlc.frontends.sysml.successions import defer_implied_start, lower_steps
from sysmlc.frontends.sysml.triggers import connect_links, lower_trigger
from sysmlc.ir import AttrValue, Edge, Element, Kind, as_items
from sysmlc.language.metaclasses import is_a
from sysmlc.language.tree import Node

_STRUCTURED_SUBKINDS = frozenset(
    {"conditional", "loop", "sequence", "expansion", "interruptible", "structured"}
)
_PARTITION_KINDS = (Kind.PARTITION, Kind.STRUCTURED)
_CONTROL_SUBKINDS = {
    "DecisionNode": "decision",
    "MergeNode": "merge",
    "ForkNode": "fork",
    "JoinNode": "join",
}


def lower_action(lowering: Lowering, node: Node, owner: Element) -> Element:
    """Lower a step: the call of a behaviour, a group of steps, or an opaque action."""
    subkind = str(annotations.metadata_value(node, "Kind", "name") or "")
    body = nodes.body_of(node)
    has_steps = any(map(_is_step, body))
    statements = expressions.list_statements(body) if has_steps else None
    if statements is not None and expressions.write_effect(statements) is not None:
        action = _add_action(lowering, node, owner, "opaque")
        values.set_effect(lowering, action, statements)
        lowering.lower_all(list_members_beside(body, statements), action)
        return action
    is_group = subkind in _STRUCTURED_SUBKINDS or (has_steps and not subkind)
    if is_group and _find_called(node) is None:
        return _lower_group(lowering, node, owner, subkind)
    return _lower_call(lowering, node, owner, subkind)


def _is_step(node: Node) -> bool:
    """Whether a member makes an action a group: a step, or an order between steps.

    An action with features, connections, flows, bindings, constraints, definitions or imports only
    is elementary.
    """
    if "direction" in node.attributes or node.attributes.get("isReference"):
        return False
    if node.kind == "Membership":
        return not node.name and not node.short_name  # `first x;`, no alias
    if is_a(node.kind, "Step"):
        # Constraints and flows are steps in KerML.
        return not is_a(node.kind, "BooleanExpression") and not is_a(node.kind, "Connector")
    return is_a(node.kind, "Succession")


def _add_action(
    lowering: Lowering, node: Node, owner: Element, subkind: str, **attrs: AttrValue
) -> Element:
    attributes = _action_attributes(node) | attrs
    action = lowering.add_element(
        node, Kind.ACTION, nodes.name_of(node), owner, subkind=subkind, **attributes
    )
    _assign_partitions(lowering, node, owner, action)
    return action


def _action_attributes(node: Node) -> dict[str, AttrValue]:
    """Return the attributes for a visibility other than public, and for ``ref``."""
    attributes = visibility_attributes(node)
    return attributes | {"referential": True} if node.attributes.get("isReference") else attributes


def _lower_group(lowering: Lowering, node: Node, owner: Element, subkind: str) -> Element:
    group = lowering.add_element(
        node,
        Kind.STRUCTURED,
        nodes.name_of(node),
        owner,
        subkind=subkind or "structured",
        **_action_attributes(node),
    )
    _assign_partitions(lowering, node, owner, group)
    lower_steps(lowering, nodes.body_of(node), group)
    return group


def _lower_call(lowering: Lowering, node: Node, owner: Element, subkind: str) -> Element:
    """Lower a call of a behaviour or an operation, or an opaque action if it calls none."""
    called = _find_called(node)
    default_subkind = "opaque" if called is None else "call-behavior"
    action = _add_action(lowering, node, owner, subkind or default_subkind)
    annotations.apply_task_values(lowering, node, action)
    for member in nodes.body_of(node):
        is_nameless = member.kind == "ReferenceUsage" and not member.name
        if is_nameless and "direction" not in member.attributes:
            for reference in nodes.list_references(member, "FeatureTyping", "Subsetting"):
                lowering.connect_reference(Edge.CALLS, action, reference)
        else:
            lowering.lower(member, action)
    if called is not None:
        lowering.queue.defer_until_elements(lambda: _connect_called(lowering, action, called))
    return action


def _find_called(node: Node) -> Node | None:
    """Return the behaviour or operation that a step performs."""
    kinds = ("FeatureTyping", "ReferenceSubsetting", "Subsetting", "Redefinition")
    return nodes.find_target(node, *kinds)


def _connect_called(lowering: Lowering, action: Element, called: Node) -> None:
    lowering.connect_node(Edge.CALLS, action, called)
    target = lowering.graph.target(action, Edge.CALLS)
    if target is not None and target.kind is Kind.OPERATION:
        lowering.graph.set(action, subkind="call-operation")


# -- partitions --------------------------------------------------------------------------------


def _assign_partitions(lowering: Lowering, node: Node, owner: Element, action: Element) -> None:
    """Assign an action to the partitions that metadata names."""
    if "Partition" not in nodes.shipped_metadata_of(node):
        return
    names = _list_texts(annotations.metadata_value(node, "Partition", "names"))
    represented = _list_texts(annotations.metadata_value(node, "Partition", "represents"))
    padding = [""] * len(names)
    for name, represented_name in zip(names, [*represented, *padding], strict=False):
        _defer_partition(lowering, action, owner, name, represented_name)


def _defer_partition(
    lowering: Lowering, action: Element, owner: Element, name: str, represented: str
) -> None:
    """Assign an action to the partition or interruptible region *name*; add it if it is new.

    ``represented`` is the qualified name of the element that the partition represents, or empty.
    """

    def assign() -> None:
        areas = (
            member
            for member in lowering.graph.owned(owner)
            if member.kind in _PARTITION_KINDS and member.name == name
        )
        area = next(areas, None) or lowering.add_implied_child(owner, Kind.PARTITION, name)
        lowering.graph.connect(Edge.IN_PARTITION, action, area)
        element = lowering.graph.get(lowering.names.id_of(represented)) if represented else None
        if element is not None and area.kind is Kind.PARTITION:
            lowering.graph.connect(Edge.REPRESENTS, area, element)

    lowering.queue.defer_until_elements(assign)


def _list_texts(value: AttrValue) -> list[str]:
    return [] if value is None else [str(item) for item in as_items(value)]


# -- sending, accepting, assigning -------------------------------------------------------------


def lower_send(lowering: Lowering, node: Node, owner: Element) -> Element:
    """Lower a send action: its signal, the arguments, and the port of sender or receiver."""
    action = _add_action(lowering, node, owner, "send")
    payload, sender, receiver = [*expressions.list_inputs(node), None, None, None][:3]
    if payload is not None:
        _lower_payload(lowering, action, payload)
    for end in (sender, receiver):
        if end is not None:
            _defer_port(lowering, action, end)
    _lower_members(lowering, node, action)
    return action


def _lower_payload(lowering: Lowering, action: Element, payload: Node) -> None:
    """Lower a payload: a new signal with its arguments, or one argument."""
    signal = nodes.find_reference(payload, "Membership", "FeatureTyping")
    is_new = payload.kind in ("ConstructorExpression", "InvocationExpression")
    if signal is None or not is_new:
        _add_argument(lowering, action, payload)
        return
    lowering.connect_reference(Edge.CALLS, action, signal)
    for argument in expressions.list_arguments_by_parameter(payload):
        _add_argument(lowering, action, argument)


def _add_argument(lowering: Lowering, action: Element, argument: Node) -> None:
    name = nodes.name_of(argument)
    pin = lowering.add_derived(argument, Kind.PIN, name, action, direction="in", subkind="argument")
    values.set_value(lowering, pin, "value", nodes.value_of(argument) or argument)


def _defer_port(lowering: Lowering, action: Element, end: Node) -> None:
    def set_port() -> None:
        path = nodes.path_of_expression(end)
        *links, port = map(lowering.elements.find, path)
        if port is not None and port.kind is Kind.PORT:
            text = expressions.write_expression(end) if None in path else None
            lowering.graph.set(action, on_port=port.id, port_path=text)
            connect_links(lowering.graph, action, links)

    lowering.queue.defer_until_elements(set_port)


def lower_accept(lowering: Lowering, node: Node, owner: Element) -> Element:
    """Lower an accept action with its trigger."""
    subkind = str(annotations.metadata_value(node, "Kind", "name") or "accept")
    action = _add_action(lowering, node, owner, subkind)
    lower_trigger(lowering, node, action)
    is_repeated = "Repeated" in nodes.shipped_metadata_of(node)
    if owner.kind in ACTIVITIES and not is_repeated and "referential" not in action.attrs:
        defer_implied_start(lowering, node, owner, action)
    _lower_members(lowering, node, action)
    return action


def lower_assignment(lowering: Lowering, node: Node, owner: Element) -> Element:
    """Lower an assignment to an opaque action whose body is its text."""
    action = _add_action(lowering, node, owner, "opaque")
    document = lowering.trees.document_of(node)
    if expressions.read_statement(node) is not None:
        values.set_effect(lowering, action, [node])
    elif document is not None and node.end > node.start >= 0:
        lowering.set_attributes(action, body=nodes.quote_source(node, document.text))
    _lower_members(lowering, node, action)
    return action


def _lower_members(lowering: Lowering, node: Node, action: Element) -> None:
    """Lower the members of an action, without its parameters."""
    for member in nodes.body_of(node):
        if member.membership != "ParameterMembership":
            lowering.lower(member, action)


# -- control nodes -----------------------------------------------------------------------------


def lower_control_node(lowering: Lowering, node: Node, owner: Element) -> Element:
    """Lower a decision, merge, fork or join."""
    subkind, attributes = _CONTROL_SUBKINDS[node.kind], visibility_attributes(node)
    control_node = lowering.add_element(
        node, Kind.CONTROL, nodes.name_of(node), owner, subkind=subkind, **attributes
    )
    _assign_partitions(lowering, node, owner, control_node)
    lowering.lower_all(nodes.body_of(node), control_node)
    return control_node


def lower_termination(lowering: Lowering, node: Node, owner: Element) -> Element:
    """Lower a terminate action: the end of the behaviour, or an action for another occurrence."""
    if any(expression is not None for expression in expressions.list_inputs(node)):
        construct = "a terminate action for another occurrence"
        lowering.verdicts.mark_approximated(node, construct, "an action of its own")
        return _add_action(lowering, node, owner, "destroy")
    name = nodes.name_of(node)
    end = lowering.add_element(node, Kind.CONTROL, name, owner, subkind="final")
    annotations.lower_only_annotations(lowering, node, end, "a terminate action")
    return end
