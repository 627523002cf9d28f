"""Handlers by metaclass; what a usage is lowered to depends on its owner."""

from collections.abc import Callable

from sysmlc.frontends.sysml import (
    actions,
    activities,
    annotations,
    connections,
    control_structures,
    definitions,
    features,
    instances,
    interactions,
    nodes,
    object_nodes,
    relations,
    requirements,
    states,
    use_cases,
)
from sysmlc.frontends.sysml.kinds import ACTIVITIES, BEHAVIOURS, CLASSIFIERS, STRUCTURAL
from sysmlc.frontends.sysml.lowering import Handler, Lowering
from sysmlc.ir import Element, Kind
from sysmlc.ir.query import BEHAVIORS
from sysmlc.language.tree import Node

_PACKAGES = frozenset({Kind.PACKAGE, Kind.PROFILE})
_BEHAVIOURS_WITHOUT_STEPS = frozenset(
    {Kind.OPERATION, Kind.STATE_MACHINE, Kind.STATE, Kind.REGION, Kind.RECEPTION}
)
_WITH_PROPERTIES = STRUCTURAL | {Kind.STATE_MACHINE}
_INTERACTIONS = frozenset({Kind.INTERACTION, Kind.FRAGMENT, Kind.OPERAND})

_MemberHandler = Callable[[Lowering, Node, Element], object]


def _lower_feature(lowering: Lowering, node: Node, owner: Element | None) -> None:
    """Lower a structural usage.

    A feature that stands for a condition in words has no element: the condition is its text.
    """
    if "InWords" in nodes.shipped_metadata_of(node):
        return
    if node.kind == "OccurrenceUsage" and _is_interaction(node):
        definitions.lower_definition(lowering, node, owner, Kind.INTERACTION, "")
    elif owner is None or owner.kind in _PACKAGES:
        instances.lower_package_usage(lowering, node, owner)
    elif owner.kind in STRUCTURAL and instances.is_marked_part(node):
        instances.lower_part(lowering, node, owner)
    elif owner.kind in STRUCTURAL:
        features.lower_classifier_feature(lowering, node, owner)
    elif owner.kind in ACTIVITIES or owner.kind in _BEHAVIOURS_WITHOUT_STEPS:
        object_nodes.lower_behaviour_feature(lowering, node, owner)
    elif owner.kind in _INTERACTIONS and "direction" not in node.attributes:
        interactions.lower_interaction_member(lowering, node, owner)
    elif owner.kind is Kind.INTERACTION:
        object_nodes.lower_behaviour_feature(lowering, node, owner)
    else:
        lowering.verdicts.mark_unsupported(node)


def _is_property(node: Node) -> bool:
    """Whether metadata states that a usage with the keyword of a behaviour is a property."""
    return annotations.metadata_value(node, "Kind", "name") == "property"


def _is_interaction(node: Node) -> bool:
    kind, _ = definitions.read_kind(node, Kind.CLASS)
    return kind is Kind.INTERACTION


def _lower_action(lowering: Lowering, node: Node, owner: Element | None) -> None:
    """Lower an action usage to an activity, a step, a parameter or an operation."""
    if owner is None or owner.kind in _PACKAGES:
        activities.lower_activity(lowering, node, owner)
    elif owner.kind in ACTIVITIES and "direction" in node.attributes:
        object_nodes.lower_behaviour_feature(lowering, node, owner)
    elif _is_operation_of_behaviour(node, owner):
        activities.lower_classifier_action(lowering, node, owner)
    elif owner.kind in ACTIVITIES:
        actions.lower_action(lowering, node, owner)
    elif owner.kind in _WITH_PROPERTIES and _is_property(node):
        features.lower_property(lowering, node, owner)
    elif owner.kind in STRUCTURAL and node.kind == "PerformActionUsage":
        activities.lower_performance(lowering, node, owner)
    elif owner.kind in STRUCTURAL:
        activities.lower_classifier_action(lowering, node, owner)
    elif owner.kind in _BEHAVIOURS_WITHOUT_STEPS:
        activities.lower_activity(lowering, node, owner)
    else:
        lowering.verdicts.mark_unsupported(node)


def _as_step(handler: _MemberHandler) -> Handler:
    """Return a handler for a construct that is special only among the steps of an activity."""

    def lower_step(lowering: Lowering, node: Node, owner: Element | None) -> None:
        is_step = owner is not None and not _is_operation_of_behaviour(node, owner)
        if owner is not None and owner.kind in ACTIVITIES and is_step:
            handler(lowering, node, owner)
        else:
            _lower_action(lowering, node, owner)

    return lower_step


def _is_operation_of_behaviour(node: Node, owner: Element) -> bool:
    """Whether metadata states that an action is no step of a behaviour, but its operation."""
    if owner.kind not in BEHAVIORS:
        return False
    return definitions.read_kind(node, Kind.ACTION)[0] in (Kind.OPERATION, Kind.RECEPTION)


def _lower_connection(lowering: Lowering, node: Node, owner: Element | None) -> None:
    if relations.is_derivation(node):
        relations.lower_derivation(lowering, node, owner)
    elif owner is not None and connections.list_linked_ends(node):
        connections.lower_connector(lowering, node, owner)
    elif owner is not None and owner.kind in STRUCTURAL:
        features.lower_classifier_feature(lowering, node, owner)
    else:
        lowering.verdicts.mark_unsupported(node)


def _lower_binding(lowering: Lowering, node: Node, owner: Element | None) -> None:
    if owner is None:
        lowering.verdicts.mark_unsupported(node)
    elif owner.kind in ACTIVITIES:
        object_nodes.lower_binding(lowering, node, owner)
    else:
        connections.lower_connector(lowering, node, owner, "binding connector")


def _lower_flow(lowering: Lowering, node: Node, owner: Element | None) -> None:
    if owner is not None and owner.kind in _INTERACTIONS:
        interactions.lower_message(lowering, node, owner)
    elif owner is not None and owner.kind in ACTIVITIES:
        object_nodes.lower_object_flow(lowering, node, owner)
    elif nodes.is_message(node) and (owner is None or not nodes.events_of(node)):
        lowering.verdicts.mark_unsupported(node)
    else:
        connections.lower_item_flow(lowering, node, owner)


def _lower_event(lowering: Lowering, node: Node, owner: Element | None) -> None:
    if owner is not None and owner.kind in _INTERACTIONS:
        interactions.lower_event(lowering, node, owner)
    elif owner is not None and owner.kind is Kind.USE_CASE:
        use_cases.lower_extension_point(lowering, node, owner)
    else:
        lowering.verdicts.mark_unsupported(node)


def _lower_succession(lowering: Lowering, node: Node, owner: Element | None) -> None:
    """Lower a succession outside of activities, whose steps ``successions`` lowers in order."""
    if owner is not None and owner.kind in _INTERACTIONS:
        interactions.lower_event_order(lowering, node, owner)
    else:
        lowering.verdicts.mark_unsupported(node)


def _lower_state(lowering: Lowering, node: Node, owner: Element | None) -> None:
    if owner is not None and owner.kind is Kind.REGION:
        states.lower_state(lowering, node, owner)
    elif owner is not None and owner.kind in ACTIVITIES:
        actions.lower_action(lowering, node, owner)
    elif owner is not None and owner.kind in _WITH_PROPERTIES and _is_property(node):
        features.lower_property(lowering, node, owner)
    else:
        states.lower_state_machine(lowering, node, owner)


def _lower_exhibited_state(lowering: Lowering, node: Node, owner: Element | None) -> None:
    if owner is not None and owner.kind in STRUCTURAL:
        states.lower_exhibited_machine(lowering, node, owner)
    else:
        _lower_state(lowering, node, owner)


def _lower_case(lowering: Lowering, node: Node, owner: Element | None) -> None:
    """Lower a case, or its definition, to a step, an activity or an interaction."""
    role = "test case" if node.kind.startswith("Verification") else ""
    if _is_interaction(node):
        definitions.lower_definition(lowering, node, owner, Kind.INTERACTION, role)
    elif owner is not None and owner.kind in ACTIVITIES and node.kind.endswith("Usage"):
        actions.lower_action(lowering, node, owner)
    else:
        activities.lower_activity(lowering, node, owner, role)


def _as_class(role: str) -> Handler:
    """Return a handler for usages that become classes, whatever their owner."""

    def lower_to_class(lowering: Lowering, node: Node, owner: Element | None) -> None:
        definitions.lower_definition(lowering, node, owner, Kind.CLASS, role, usage=True)

    return lower_to_class


def _lower_expression(lowering: Lowering, node: Node, owner: Element | None) -> None:
    """Lower a result expression; other expressions are read with their owners."""
    if node.membership == "ResultExpressionMembership" and owner is not None:
        requirements.lower_result(lowering, node, owner)
    elif node.membership == "ElementFilterMembership":
        relations.lower_filter(lowering, node, owner)


def _ignore(lowering: Lowering, node: Node, owner: Element | None) -> None:
    lowering.verdicts.mark_ignored(node)


_FEATURES = """
    AttributeUsage PartUsage ItemUsage PortUsage ReferenceUsage OccurrenceUsage EnumerationUsage
    Feature
"""
_CONTROL_NODES = "DecisionNode MergeNode ForkNode JoinNode"

HANDLERS: dict[str, Handler] = {
    **dict.fromkeys(CLASSIFIERS, definitions.lower_classifier),
    **dict.fromkeys(BEHAVIOURS, activities.lower_behaviour_definition),
    **dict.fromkeys(_FEATURES.split(), _lower_feature),
    **dict.fromkeys(_CONTROL_NODES.split(), _as_step(actions.lower_control_node)),
    **dict.fromkeys(nodes.EXPRESSIONS, _lower_expression),
    "Package": definitions.lower_package,
    "LibraryPackage": definitions.lower_package,
    "ItemDefinition": definitions.lower_item,
    "OccurrenceDefinition": definitions.lower_occurrence,
    "VerificationCaseDefinition": _lower_case,
    "StateDefinition": states.lower_state_machine,
    "ConnectionDefinition": connections.lower_association,
    "InterfaceDefinition": connections.lower_association,
    "Association": connections.lower_association,
    "AssociationStructure": connections.lower_association,
    "AllocationDefinition": relations.lower_allocation_definition,
    "FlowDefinition": connections.lower_flow_definition,
    "UseCaseDefinition": use_cases.lower_use_case,
    "UseCaseUsage": use_cases.lower_use_case,
    "IncludeUseCaseUsage": use_cases.lower_inclusion,
    "EventOccurrenceUsage": _lower_event,
    "SuccessionAsUsage": _lower_succession,
    "Succession": _lower_succession,
    "Usage": _lower_feature,
    "RequirementDefinition": requirements.lower_requirement,
    "RequirementUsage": requirements.lower_requirement,
    "ConcernDefinition": requirements.lower_requirement,
    "ConcernUsage": requirements.lower_requirement,
    "SatisfyRequirementUsage": requirements.lower_satisfaction,
    "ConstraintUsage": requirements.lower_constraint,
    "AssertConstraintUsage": requirements.lower_constraint,
    "Invariant": requirements.lower_constraint,
    "BooleanExpression": requirements.lower_constraint,
    "ActionUsage": _lower_action,
    "PerformActionUsage": _lower_action,
    "CalculationUsage": _lower_action,
    "Step": _lower_action,
    "Expression": _lower_action,
    "SendActionUsage": _as_step(actions.lower_send),
    "AcceptActionUsage": _as_step(actions.lower_accept),
    "AssignmentActionUsage": _as_step(actions.lower_assignment),
    "TerminateActionUsage": _as_step(actions.lower_termination),
    "IfActionUsage": _as_step(control_structures.lower_if),
    "WhileLoopActionUsage": _as_step(control_structures.lower_while),
    "ForLoopActionUsage": _as_step(control_structures.lower_for),
    "StateUsage": _lower_state,
    "ExhibitStateUsage": _lower_exhibited_state,
    "VerificationCaseUsage": _lower_case,
    "AnalysisCaseUsage": _lower_case,
    "CaseUsage": _lower_case,
    "ViewUsage": _as_class("view"),
    "ViewpointUsage": _as_class("viewpoint"),
    "ConnectionUsage": _lower_connection,
    "InterfaceUsage": _lower_connection,
    "Connector": _lower_connection,
    "BindingConnectorAsUsage": _lower_binding,
    "BindingConnector": _lower_binding,
    "FlowUsage": _lower_flow,
    "Flow": _lower_flow,
    "SuccessionFlowUsage": _lower_flow,
    "SuccessionFlow": _lower_flow,
    "AllocationUsage": relations.lower_allocation,
    "Dependency": relations.lower_dependency,
    "NamespaceImport": relations.lower_import,
    "MembershipImport": relations.lower_import,
    "Membership": relations.lower_alias,
    "Documentation": annotations.lower_documentation,
    "Comment": annotations.lower_comment,
    "TextualRepresentation": annotations.lower_textual_representation,
    "MetadataUsage": annotations.lower_metadata,
    "MetadataFeature": annotations.lower_metadata,
    "Multiplicity": _ignore,
    "MultiplicityRange": _ignore,
    "Expose": relations.lower_expose,
    "MembershipExpose": relations.lower_expose,
    "NamespaceExpose": relations.lower_expose,
}
"""The handler of each metaclass. A metaclass without a handler is reported as not read."""
