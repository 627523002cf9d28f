"""Base types that each metaclass implicitly specialises (KerML 8.4.2 to 8.4.4, SysML 8.4)."""

from typing import NamedTuple

from sysmlc.language.metaclasses import kinds_of

BASES: dict[str, str] = {
    "Type": "Base::Anything",
    "Classifier": "Base::Anything",
    "DataType": "Base::DataValue",
    "Class": "Occurrences::Occurrence",
    "Structure": "Objects::Object",
    "Association": "Links::Link",
    "AssociationStructure": "Objects::LinkObject",
    "Behavior": "Performances::Performance",
    "Function": "Performances::Evaluation",
    "Predicate": "Performances::BooleanEvaluation",
    "Interaction": "Transfers::Transfer",
    "Metaclass": "Metaobjects::Metaobject",
    "Feature": "Base::things",
    "Step": "Performances::performances",
    "Expression": "Performances::evaluations",
    "BooleanExpression": "Performances::booleanEvaluations",
    "Invariant": "Performances::trueEvaluations",
    "LiteralExpression": "Performances::literalEvaluations",
    "LiteralBoolean": "Performances::literalBooleanEvaluations",
    "LiteralInteger": "Performances::literalIntegerEvaluations",
    "LiteralInfinity": "Performances::literalIntegerEvaluations",
    "LiteralRational": "Performances::literalRationalEvaluations",
    "LiteralString": "Performances::literalStringEvaluations",
    "MetadataAccessExpression": "Performances::metadataAccessEvaluations",
    "NullExpression": "Performances::nullEvaluations",
    "Connector": "Links::links",
    "BindingConnector": "Links::selfLinks",
    "Succession": "Occurrences::happensBeforeLinks",
    "Flow": "Transfers::transfers",
    "SuccessionFlow": "Transfers::flowTransfersBefore",
    "Multiplicity": "Base::naturals",
    "MetadataFeature": "Metaobjects::metaobjects",
    "AttributeDefinition": "Base::DataValue",
    "OccurrenceDefinition": "Occurrences::Occurrence",
    "ItemDefinition": "Items::Item",
    "PartDefinition": "Parts::Part",
    "PortDefinition": "Ports::Port",
    "ConnectionDefinition": "Connections::Connection",
    "InterfaceDefinition": "Interfaces::Interface",
    "AllocationDefinition": "Allocations::Allocation",
    "FlowDefinition": "Flows::MessageAction",
    "ActionDefinition": "Actions::Action",
    "StateDefinition": "States::StateAction",
    "CalculationDefinition": "Calculations::Calculation",
    "ConstraintDefinition": "Constraints::ConstraintCheck",
    "RequirementDefinition": "Requirements::RequirementCheck",
    "ConcernDefinition": "Requirements::ConcernCheck",
    "CaseDefinition": "Cases::Case",
    "AnalysisCaseDefinition": "AnalysisCases::AnalysisCase",
    "VerificationCaseDefinition": "VerificationCases::VerificationCase",
    "UseCaseDefinition": "UseCases::UseCase",
    "ViewDefinition": "Views::View",
    "ViewpointDefinition": "Views::ViewpointCheck",
    "RenderingDefinition": "Views::Rendering",
    "MetadataDefinition": "Metadata::MetadataItem",
    "AttributeUsage": "Base::dataValues",
    "OccurrenceUsage": "Occurrences::occurrences",
    "ItemUsage": "Items::items",
    "PartUsage": "Parts::parts",
    "PortUsage": "Ports::ports",
    "ConnectionUsage": "Connections::connections",
    "InterfaceUsage": "Interfaces::interfaces",
    "AllocationUsage": "Allocations::allocations",
    "FlowUsage": "Flows::messages",
    "SuccessionFlowUsage": "Flows::successionFlows",
    "BindingConnectorAsUsage": "Links::selfLinks",
    "SuccessionAsUsage": "Occurrences::happensBeforeLinks",
    "ActionUsage": "Actions::actions",
    "AcceptActionUsage": "Actions::acceptActions",
    "SendActionUsage": "Actions::sendActions",
    "TerminateActionUsage": "Actions::terminateActions",
    "AssignmentActionUsage": "Actions::assignmentActions",
    "IfActionUsage": "Actions::ifThenActions",
    "LoopActionUsage": "Actions::loopActions",
    "WhileLoopActionUsage": "Actions::whileLoopActions",
    "ForLoopActionUsage": "Actions::forLoopActions",
    "TransitionUsage": "Actions::transitionActions",
    "StateUsage": "States::stateActions",
    "CalculationUsage": "Calculations::calculations",
    "ConstraintUsage": "Constraints::constraintChecks",
    "AssertConstraintUsage": "Constraints::assertedConstraintChecks",
    "RequirementUsage": "Requirements::requirementChecks",
    "SatisfyRequirementUsage": "Requirements::satisfiedRequirementChecks",
    "ConcernUsage": "Requirements::concernChecks",
    "CaseUsage": "Cases::cases",
    "AnalysisCaseUsage": "AnalysisCases::analysisCases",
    "VerificationCaseUsage": "VerificationCases::verificationCases",
    "UseCaseUsage": "UseCases::useCases",
    "ViewUsage": "Views::views",
    "ViewpointUsage": "Views::viewpointChecks",
    "RenderingUsage": "Views::renderings",
    "MetadataUsage": "Metadata::metadataItems",
}
"""The base of a metaclass. A metaclass that is absent has the base of its nearest general."""

BINARY_BASES: dict[str, str] = {
    "Association": "Links::BinaryLink",
    "AssociationStructure": "Objects::BinaryLinkObject",
    "Connector": "Links::binaryLinks",
    "ConnectionDefinition": "Connections::BinaryConnection",
    "ConnectionUsage": "Connections::binaryConnections",
    "InterfaceDefinition": "Interfaces::BinaryInterface",
    "InterfaceUsage": "Interfaces::binaryInterfaces",
    "FlowDefinition": "Flows::Message",
}
"""The base of connectors and associations with exactly two ends."""
NEGATED_BASES: dict[str, str] = {
    "Invariant": "Performances::falseEvaluations",
    "AssertConstraintUsage": "Constraints::negatedConstraintChecks",
    "SatisfyRequirementUsage": "Requirements::notSatisfiedRequirementChecks",
}
MEMBERSHIP_BASES: dict[tuple[str, str], str] = {
    ("StateSubactionMembership", "entry"): "States::StateAction::entryAction",
    ("StateSubactionMembership", "do"): "States::StateAction::doAction",
    ("StateSubactionMembership", "exit"): "States::StateAction::exitAction",
    ("TransitionFeatureMembership", "trigger"): "Actions::TransitionAction::accepter",
    (
        "TransitionFeatureMembership",
        "guard",
    ): "TransitionPerformances::TransitionPerformance::guard",
    ("TransitionFeatureMembership", "effect"): "Actions::TransitionAction::effect",
    (
        "RequirementConstraintMembership",
        "assumption",
    ): "Requirements::RequirementCheck::assumptions",
    (
        "RequirementConstraintMembership",
        "requirement",
    ): "Requirements::RequirementCheck::constraints",
    ("ViewRenderingMembership", ""): "Views::View::viewRendering",
    ("FramedConcernMembership", ""): "Requirements::RequirementCheck::concerns",
    ("StakeholderMembership", ""): "Requirements::RequirementCheck::stakeholders",
    ("RequirementVerificationMembership", ""): (
        "VerificationCases::VerificationCase::obj::requirementVerifications"
    ),
}
"""The base of a member by its membership and role."""
REDEFINING_MEMBERSHIPS = frozenset(
    {"StateSubactionMembership", "TransitionFeatureMembership", "ViewRenderingMembership"}
)
"""Memberships whose members redefine their base instead of subsetting it."""


class OwnerBase(NamedTuple):
    """A usage of ``kinds`` owned as a feature by one of ``owners`` specialises ``base``.

    ``composite`` says whether the usage must be composite.
    """

    kinds: frozenset[str]
    owners: frozenset[str]
    base: str
    composite: bool = True


def _both_kinds(name: str) -> frozenset[str]:
    return kinds_of(f"{name}Definition") | kinds_of(f"{name}Usage")


_ACTION, _PART, _ITEM, _CASE = (
    _both_kinds("Action"),
    _both_kinds("Part"),
    _both_kinds("Item"),
    _both_kinds("Case"),
)
_CONTROL = kinds_of("ControlNode")
_TRANSITION = frozenset({"TransitionUsage"})
_STATE_USAGE = kinds_of("StateUsage") - {"ExhibitStateUsage"}
_PERFORM = kinds_of("PerformActionUsage")
_OCCURRENCE = kinds_of("OccurrenceDefinition") | kinds_of("OccurrenceUsage") | kinds_of("Class")

OWNER_BASES: tuple[OwnerBase, ...] = (
    OwnerBase(kinds_of("ActionUsage") - _PERFORM, _ACTION, "Actions::Action::subactions"),
    OwnerBase(kinds_of("ActionUsage") - _PERFORM, _PART, "Parts::Part::ownedActions"),
    OwnerBase(kinds_of("SendActionUsage"), _ACTION, "Actions::Action::sendSubactions"),
    OwnerBase(kinds_of("AcceptActionUsage"), _ACTION, "Actions::Action::acceptSubactions"),
    OwnerBase(kinds_of("TerminateActionUsage"), _ACTION, "Actions::Action::terminateSubactions"),
    OwnerBase(kinds_of("AssignmentActionUsage"), _ACTION, "Actions::Action::assignments"),
    OwnerBase(kinds_of("IfActionUsage"), _ACTION, "Actions::Action::ifSubactions"),
    OwnerBase(kinds_of("WhileLoopActionUsage"), _ACTION, "Actions::Action::whileLoops"),
    OwnerBase(kinds_of("ForLoopActionUsage"), _ACTION, "Actions::Action::forLoops"),
    OwnerBase(frozenset({"MergeNode"}), _ACTION, "Actions::Action::merges", False),
    OwnerBase(frozenset({"DecisionNode"}), _ACTION, "Actions::Action::decisions", False),
    OwnerBase(frozenset({"JoinNode"}), _ACTION, "Actions::Action::joins", False),
    OwnerBase(frozenset({"ForkNode"}), _ACTION, "Actions::Action::forks", False),
    OwnerBase(_TRANSITION, _ACTION - _both_kinds("State"), "Actions::Action::transitions"),
    OwnerBase(_TRANSITION, _both_kinds("State"), "States::StateAction::stateTransitions"),
    OwnerBase(_STATE_USAGE, _both_kinds("State"), "States::StateAction::substates"),
    OwnerBase(_STATE_USAGE, _PART, "Parts::Part::ownedStates"),
    OwnerBase(_PERFORM, _PART, "Parts::Part::performedActions", False),
    OwnerBase(_PERFORM, _ACTION, "Performances::Performance::enclosedPerformances", False),
    OwnerBase(frozenset({"ExhibitStateUsage"}), _PART, "Parts::Part::exhibitedStates", False),
    OwnerBase(
        kinds_of("CalculationUsage"),
        _both_kinds("Calculation"),
        "Calculations::Calculation::subcalculations",
    ),
    OwnerBase(kinds_of("CaseUsage"), _CASE, "Cases::Case::subcases"),
    OwnerBase(
        kinds_of("AnalysisCaseUsage"),
        _both_kinds("AnalysisCase"),
        "AnalysisCases::AnalysisCase::subAnalysisCases",
    ),
    OwnerBase(
        kinds_of("VerificationCaseUsage"),
        _both_kinds("VerificationCase"),
        "VerificationCases::VerificationCase::subVerificationCases",
    ),
    OwnerBase(
        kinds_of("UseCaseUsage"),
        _both_kinds("UseCase"),
        "UseCases::UseCase::subUseCases",
    ),
    OwnerBase(
        frozenset({"IncludeUseCaseUsage"}),
        _both_kinds("UseCase"),
        "UseCases::UseCase::includedUseCases",
        False,
    ),
    OwnerBase(kinds_of("ConstraintUsage"), _ITEM, "Items::Item::checkedConstraints"),
    OwnerBase(
        kinds_of("RequirementUsage"),
        _both_kinds("Requirement"),
        "Requirements::RequirementCheck::subrequirements",
    ),
    OwnerBase(
        kinds_of("ConcernUsage"),
        _both_kinds("Requirement"),
        "Requirements::RequirementCheck::concerns",
    ),
    OwnerBase(
        kinds_of("ViewpointUsage"),
        _both_kinds("View"),
        "Views::View::viewpointSatisfactions",
    ),
    OwnerBase(kinds_of("ViewUsage"), _both_kinds("View"), "Views::View::subviews", False),
    OwnerBase(
        kinds_of("RenderingUsage"),
        _both_kinds("Rendering"),
        "Views::Rendering::subrenderings",
        False,
    ),
    OwnerBase(kinds_of("ItemUsage"), _ITEM, "Items::Item::subitems"),
    OwnerBase(kinds_of("PartUsage"), _ITEM, "Items::Item::subparts"),
    OwnerBase(kinds_of("PortUsage"), _PART, "Parts::Part::ownedPorts", False),
    OwnerBase(kinds_of("PortUsage"), _both_kinds("Port"), "Ports::Port::subports"),
    OwnerBase(kinds_of("OccurrenceUsage"), _OCCURRENCE, "Occurrences::Occurrence::suboccurrences"),
    OwnerBase(
        kinds_of("EventOccurrenceUsage"),
        _OCCURRENCE,
        "Occurrences::Occurrence::timeEnclosedOccurrences",
        False,
    ),
    OwnerBase(
        kinds_of("Step"),
        kinds_of("Behavior") | kinds_of("Step"),
        "Performances::Performance::subperformances",
    ),
    OwnerBase(
        kinds_of("Step"),
        kinds_of("Behavior") | kinds_of("Step"),
        "Performances::Performance::enclosedPerformances",
        False,
    ),
    OwnerBase(kinds_of("Step"), kinds_of("Structure"), "Objects::Object::ownedPerformances"),
)
"""The bases of usages by their owner."""
