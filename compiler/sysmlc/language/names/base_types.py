"""What each metaclass implicitly specialises (KerML 8.4.2 to 8.4.4, SysML 8.4: the base tables)."""

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
"""The base of a metaclass; one that has none here has that of its nearest general."""

BINARY: dict[str, str] = {
    "Association": "Links::BinaryLink",
    "AssociationStructure": "Objects::BinaryLinkObject",
    "Connector": "Links::binaryLinks",
    "ConnectionDefinition": "Connections::BinaryConnection",
    "ConnectionUsage": "Connections::binaryConnections",
    "InterfaceDefinition": "Interfaces::BinaryInterface",
    "InterfaceUsage": "Interfaces::binaryInterfaces",
    "FlowDefinition": "Flows::Message",
}
"""The base of what has exactly two ends."""
NEGATED: dict[str, str] = {
    "Invariant": "Performances::falseEvaluations",
    "AssertConstraintUsage": "Constraints::negatedConstraintChecks",
    "SatisfyRequirementUsage": "Requirements::notSatisfiedRequirementChecks",
}
BY_MEMBERSHIP: dict[tuple[str, str], str] = {
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
"""What a member specialises because of its membership and the role that this gives it."""
REDEFINED_BY_MEMBERSHIP = frozenset(
    {"StateSubactionMembership", "TransitionFeatureMembership", "ViewRenderingMembership"}
)
"""Memberships whose members redefine that feature."""


class Place(NamedTuple):
    """A usage of ``kinds`` owned as a feature by one of ``owners`` specialises ``base``."""

    kinds: frozenset[str]
    owners: frozenset[str]
    base: str
    composite: bool = True


def _both(name: str) -> frozenset[str]:
    return kinds_of(f"{name}Definition") | kinds_of(f"{name}Usage")


_ACTION, _PART, _ITEM, _CASE = _both("Action"), _both("Part"), _both("Item"), _both("Case")
_CONTROL = kinds_of("ControlNode")
_TRANSITION = frozenset({"TransitionUsage"})
_STATE_USAGE = kinds_of("StateUsage") - {"ExhibitStateUsage"}
_PERFORM = kinds_of("PerformActionUsage")
_OCCURRENCE = kinds_of("OccurrenceDefinition") | kinds_of("OccurrenceUsage") | kinds_of("Class")

PLACES: tuple[Place, ...] = (
    Place(kinds_of("ActionUsage") - _PERFORM, _ACTION, "Actions::Action::subactions"),
    Place(kinds_of("ActionUsage") - _PERFORM, _PART, "Parts::Part::ownedActions"),
    Place(kinds_of("SendActionUsage"), _ACTION, "Actions::Action::sendSubactions"),
    Place(kinds_of("AcceptActionUsage"), _ACTION, "Actions::Action::acceptSubactions"),
    Place(kinds_of("TerminateActionUsage"), _ACTION, "Actions::Action::terminateSubactions"),
    Place(kinds_of("AssignmentActionUsage"), _ACTION, "Actions::Action::assignments"),
    Place(kinds_of("IfActionUsage"), _ACTION, "Actions::Action::ifSubactions"),
    Place(kinds_of("WhileLoopActionUsage"), _ACTION, "Actions::Action::whileLoops"),
    Place(kinds_of("ForLoopActionUsage"), _ACTION, "Actions::Action::forLoops"),
    Place(frozenset({"MergeNode"}), _ACTION, "Actions::Action::merges", False),
    Place(frozenset({"DecisionNode"}), _ACTION, "Actions::Action::decisions", False),
    Place(frozenset({"JoinNode"}), _ACTION, "Actions::Action::joins", False),
    Place(frozenset({"ForkNode"}), _ACTION, "Actions::Action::forks", False),
    Place(_TRANSITION, _ACTION - _both("State"), "Actions::Action::transitions"),
    Place(_TRANSITION, _both("State"), "States::StateAction::stateTransitions"),
    Place(_STATE_USAGE, _both("State"), "States::StateAction::substates"),
    Place(_STATE_USAGE, _PART, "Parts::Part::ownedStates"),
    Place(_PERFORM, _PART, "Parts::Part::performedActions", False),
    Place(_PERFORM, _ACTION, "Performances::Performance::enclosedPerformances", False),
    Place(frozenset({"ExhibitStateUsage"}), _PART, "Parts::Part::exhibitedStates", False),
    Place(
        kinds_of("CalculationUsage"),
        _both("Calculation"),
        "Calculations::Calculation::subcalculations",
    ),
    Place(kinds_of("CaseUsage"), _CASE, "Cases::Case::subcases"),
    Place(
        kinds_of("AnalysisCaseUsage"),
        _both("AnalysisCase"),
        "AnalysisCases::AnalysisCase::subAnalysisCases",
    ),
    Place(
        kinds_of("VerificationCaseUsage"),
        _both("VerificationCase"),
        "VerificationCases::VerificationCase::subVerificationCases",
    ),
    Place(kinds_of("UseCaseUsage"), _both("UseCase"), "UseCases::UseCase::subUseCases"),
    Place(
        frozenset({"IncludeUseCaseUsage"}),
        _both("UseCase"),
        "UseCases::UseCase::includedUseCases",
        False,
    ),
    Place(kinds_of("ConstraintUsage"), _ITEM, "Items::Item::checkedConstraints"),
    Place(
        kinds_of("RequirementUsage"),
        _both("Requirement"),
        "Requirements::RequirementCheck::subrequirements",
    ),
    Place(
        kinds_of("ConcernUsage"), _both("Requirement"), "Requirements::RequirementCheck::concerns"
    ),
    Place(kinds_of("ViewpointUsage"), _both("View"), "Views::View::viewpointSatisfactions"),
    Place(kinds_of("ViewUsage"), _both("View"), "Views::View::subviews", False),
    Place(kinds_of("RenderingUsage"), _both("Rendering"), "Views::Rendering::subrenderings", False),
    Place(kinds_of("ItemUsage"), _ITEM, "Items::Item::subitems"),
    Place(kinds_of("PartUsage"), _ITEM, "Items::Item::subparts"),
    Place(kinds_of("PortUsage"), _PART, "Parts::Part::ownedPorts", False),
    Place(kinds_of("PortUsage"), _both("Port"), "Ports::Port::subports"),
    Place(kinds_of("OccurrenceUsage"), _OCCURRENCE, "Occurrences::Occurrence::suboccurrences"),
    Place(
        kinds_of("EventOccurrenceUsage"),
        _OCCURRENCE,
        "Occurrences::Occurrence::timeEnclosedOccurrences",
        False,
    ),
    Place(
        kinds_of("Step"),
        kinds_of("Behavior") | kinds_of("Step"),
        "Performances::Performance::subperformances",
    ),
    Place(
        kinds_of("Step"),
        kinds_of("Behavior") | kinds_of("Step"),
        "Performances::Performance::enclosedPerformances",
        False,
    ),
    Place(kinds_of("Step"), kinds_of("Structure"), "Objects::Object::ownedPerformances"),
)
"""What usages specialise because of where they are."""
