"""Activities and operations: behaviours whose members are steps."""

from sysmlc.frontends.sysml import expressions, nodes
from sysmlc.frontends.sysml.definitions import (
    connect_generals,
    declaration_attributes,
    read_kind,
)
from sysmlc.frontends.sysml.features import connect_types
from sysmlc.frontends.sysml.kinds import BEHAVIOURS, FUNCTIONS
from sysmlc.frontends.sysml.lowering import Lowering
from sysmlc.frontends.sysml.relations import allocate_arguments, allocate_steps
from sysmlc.frontends.sysml.successions import lower_steps
from sysmlc.frontends.sysml.values import expression_text, set_effect
from sysmlc.ir import Edge, Element, Kind
from sysmlc.ir.query import BEHAVIORS
from sysmlc.language.tree import Node

_CONSTRAINTS = ("AssertConstraintUsage", "ConstraintUsage")
_INHERITED_ATTRIBUTES = ("direction", "multiplicity", "ordered")


def lower_behaviour_definition(lowering: Lowering, node: Node, owner: Element | None) -> None:
    """Lower an action definition, a calculation or a case."""
    _, role = BEHAVIOURS[node.kind]
    lower_activity(lowering, node, owner, role)


def lower_activity(
    lowering: Lowering, node: Node, owner: Element | None, role: str = ""
) -> Element:
    """Lower a definition, or a usage that is no step, to an activity."""
    _, subkind = read_kind(node, Kind.ACTIVITY)
    activity = lowering.add_element(
        node, Kind.ACTIVITY, nodes.name_of(node), owner, role=role, subkind=subkind
    )
    lowering.set_attributes(activity, **declaration_attributes(node))
    connect_generals(lowering, node, activity)
    lower_body(lowering, node, activity)
    return activity


def lower_body(lowering: Lowering, node: Node, activity: Element) -> None:
    """Lower the members of a behaviour: to a text, to an expression, or to steps and flows."""
    body = nodes.body_of(node)
    statements = expressions.list_statements(body)
    if statements is not None and expressions.write_effect(statements) is not None:
        lowering.set_attributes(activity, subkind="opaque")
        set_effect(lowering, activity, statements)
        lowering.lower_all(list_members_beside(body, statements), activity)
        return
    result = nodes.result_of(node)
    if node.kind in FUNCTIONS:
        lowering.set_attributes(activity, subkind="function")
    if result is not None:
        lowering.queue.defer_until_elements(
            lambda: lowering.set_attributes(activity, body=expression_text(result, lowering))
        )
    lower_steps(lowering, (member for member in body if member is not result), activity)


def list_members_beside(body: list[Node], statements: list[Node]) -> list[Node]:
    """Return the members of a body that are neither among the statements nor successions."""
    excluded = {id(statement) for statement in statements}
    return [
        member
        for member in body
        if member.kind != "SuccessionAsUsage" and id(member) not in excluded
    ]


# -- behaviours of classifiers -----------------------------------------------------------------


def lower_performance(lowering: Lowering, node: Node, owner: Element) -> None:
    """Lower what a classifier performs: its own behaviour, or one that is defined elsewhere."""
    performed = nodes.find_reference(node, "ReferenceSubsetting")
    definition = nodes.find_reference(node, "FeatureTyping")
    has_own_content = node.name or nodes.body_of(node)
    if performed is not None and not has_own_content:
        lowering.queue.defer_until_elements(
            lambda: _connect_performed(lowering, node, owner, performed.target)
        )
    elif definition is not None and not has_own_content:
        lowering.connect_reference(Edge.CLASSIFIER_BEHAVIOR, owner, definition)
    elif definition is not None and _has_only_redefinitions(node):
        lowering.connect_reference(Edge.CLASSIFIER_BEHAVIOR, owner, definition)
        allocate_arguments(lowering, node, owner)
        allocate_steps(lowering, node, owner)
    else:
        activity = lower_activity(lowering, node, owner)
        lowering.graph.connect(Edge.CLASSIFIER_BEHAVIOR, owner, activity)
        if performed is not None:
            lowering.queue.defer_until_elements(
                lambda: _connect_referenced(lowering, activity, performed.target)
            )


def _connect_referenced(lowering: Lowering, activity: Element, target: Node | None) -> None:
    """Make an activity a special case of the one that it references: it has the same steps."""
    referenced = lowering.elements.find(target)
    if referenced is not None and referenced.kind is Kind.ACTIVITY:
        lowering.connect_node(Edge.SPECIALIZES, activity, target)


def _has_only_redefinitions(node: Node) -> bool:
    """Whether a usage only redefines features of its definition."""
    members = [member for member in nodes.body_of(node) if not nodes.is_annotation(member)]
    return bool(members) and all(
        nodes.find_reference(member, "Redefinition") is not None for member in members
    )


def _connect_performed(lowering: Lowering, node: Node, owner: Element, target: Node | None) -> None:
    """Lower a performance: set the classifier behaviour, or allocate a step to the behaviour.

    The performed element is a behaviour in the first case, a step in the second.
    """
    performed = lowering.elements.find(target)
    if performed is None or performed.kind in BEHAVIORS:
        lowering.connect_node(Edge.CLASSIFIER_BEHAVIOR, owner, target)
    elif performed.kind in (Kind.ACTION, Kind.STRUCTURED):
        context = lowering.graph.owner(owner)
        allocation = lowering.add_element(
            node, Kind.DEPENDENCY, "", context, role="allocate", subkind="abstraction"
        )
        lowering.graph.connect(Edge.CLIENT, allocation, performed)
        lowering.graph.connect(Edge.SUPPLIER, allocation, owner)
    elif performed.kind is Kind.OPERATION:
        lowering.verdicts.mark_approximated(
            node, "the performance of an operation", "the operation"
        )
    else:
        lowering.verdicts.mark_approximated(
            node, "the performance of an element that is not an action", "nothing"
        )


def lower_classifier_action(lowering: Lowering, node: Node, owner: Element) -> None:
    """Lower an action of a classifier: an operation, unless it has steps of its own."""
    kind, _ = read_kind(node, Kind.OPERATION)
    is_operation_by_metadata = read_kind(node, Kind.ACTIVITY)[0] is Kind.OPERATION
    if node.kind == "AcceptActionUsage":
        _lower_reception(lowering, node, owner)
    elif kind is Kind.ACTIVITY or (_has_steps(node) and not is_operation_by_metadata):
        lower_activity(lowering, node, owner)
    else:
        _lower_operation(lowering, node, owner)


def _has_steps(node: Node) -> bool:
    return any(
        member.kind == "TextualRepresentation" or _is_step(member) for member in nodes.body_of(node)
    )


def _is_step(node: Node) -> bool:
    is_parameter = "direction" in node.attributes
    return not (nodes.is_annotation(node) or is_parameter or node.kind in _CONSTRAINTS)


def _lower_operation(lowering: Lowering, node: Node, owner: Element) -> None:
    """Lower an operation; the behaviours that it specialises, or that type it, implement it."""
    operation = lowering.add_element(node, Kind.OPERATION, nodes.name_of(node), owner)
    lowering.set_attributes(operation, **declaration_attributes(node))
    for reference in nodes.list_references(node, "Redefinition"):
        lowering.connect_reference(Edge.REDEFINES, operation, reference)
    methods = nodes.list_references(node, "FeatureTyping", "Subsetting", "ReferenceSubsetting")
    for reference in methods:
        lowering.connect_reference(Edge.METHOD, operation, reference)
    if methods and methods[0].target is not None:
        definition = methods[0].target
        lowering.queue.defer_until_edges(
            lambda: _inherit_parameters(lowering, operation, definition)
        )
    body = nodes.body_of(node)
    if not _has_steps(node):
        lowering.lower_all(body, operation)
        return
    lowering.lower_all((member for member in body if "direction" in member.attributes), operation)
    method = lowering.add_derived(node, Kind.ACTIVITY, operation.name, owner)
    lowering.graph.connect(Edge.METHOD, operation, method)
    lower_body(lowering, node, method)


def _inherit_parameters(lowering: Lowering, operation: Element, definition: Node) -> None:
    """Add the parameters of the implementing behaviour to an operation that states none."""
    if any(member.kind is Kind.PARAMETER for member in lowering.graph.owned(operation)):
        return
    for member in definition.members:
        parameter = lowering.elements.find(member)
        if parameter is None or parameter.kind is not Kind.PARAMETER:
            continue
        copy = lowering.add_implied_child(operation, Kind.PARAMETER, parameter.name)
        attributes = {
            key: parameter.attrs[key] for key in _INHERITED_ATTRIBUTES if key in parameter.attrs
        }
        lowering.set_attributes(copy, **attributes)
        connect_types(lowering, member, copy)


def _lower_reception(lowering: Lowering, node: Node, owner: Element) -> None:
    reception = lowering.add_element(node, Kind.RECEPTION, nodes.name_of(node), owner)
    payload = next(nodes.iter_by_membership(node, "ParameterMembership"), None)
    if payload is not None:
        for reference in nodes.list_references(payload, "FeatureTyping"):
            lowering.connect_reference(Edge.TYPED_BY, reception, reference)
    lowering.lower_annotations(node, reception)
