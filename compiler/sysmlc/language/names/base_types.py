"""Base types that each metaclass implicitly specialises (KerML 8.4.2 to 8.4.4, SysML 8.4)."""

from typing import NamedTuple

from sysmlc.language.metaclasses import kinds_of

_BASES = """\
Base: Type=Anything Classifier=Anything DataType=DataValue Feature=things Multiplicity=naturals
    AttributeDefinition=DataValue AttributeUsage=dataValues
Occurrences: Class=Occurrence Succession=happensBeforeLinks OccurrenceDefinition=Occurrence
    OccurrenceUsage=occurrences SuccessionAsUsage=happensBeforeLinks
Objects: Structure=Object AssociationStructure=LinkObject
Links: Association=Link Connector=links BindingConnector=selfLinks
    BindingConnectorAsUsage=selfLinks
Performances: Behavior=Performance Function=Evaluation Predicate=BooleanEvaluation
    Step=performances Expression=evaluations BooleanExpression=booleanEvaluations
    Invariant=trueEvaluations LiteralExpression=literalEvaluations
    LiteralBoolean=literalBooleanEvaluations LiteralInteger=literalIntegerEvaluations
    LiteralInfinity=literalIntegerEvaluations LiteralRational=literalRationalEvaluations
    LiteralString=literalStringEvaluations MetadataAccessExpression=metadataAccessEvaluations
    NullExpression=nullEvaluations
Transfers: Interaction=Transfer Flow=transfers SuccessionFlow=flowTransfersBefore
Metaobjects: Metaclass=Metaobject MetadataFeature=metaobjects
Items: ItemDefinition=Item ItemUsage=items
Parts: PartDefinition=Part PartUsage=parts
Ports: PortDefinition=Port PortUsage=ports
Connections: ConnectionDefinition=Connection ConnectionUsage=connections
Interfaces: InterfaceDefinition=Interface InterfaceUsage=interfaces
Allocations: AllocationDefinition=Allocation AllocationUsage=allocations
Flows: FlowDefinition=MessageAction FlowUsage=messages SuccessionFlowUsage=successionFlows
Actions: ActionDefinition=Action ActionUsage=actions AcceptActionUsage=acceptActions
    SendActionUsage=sendActions TerminateActionUsage=terminateActions
    AssignmentActionUsage=assignmentActions IfActionUsage=ifThenActions
    LoopActionUsage=loopActions WhileLoopActionUsage=whileLoopActions
    ForLoopActionUsage=forLoopActions TransitionUsage=transitionActions
States: StateDefinition=StateAction StateUsage=stateActions
Calculations: CalculationDefinition=Calculation CalculationUsage=calculations
Constraints: ConstraintDefinition=ConstraintCheck ConstraintUsage=constraintChecks
    AssertConstraintUsage=assertedConstraintChecks
Requirements: RequirementDefinition=RequirementCheck ConcernDefinition=ConcernCheck
    RequirementUsage=requirementChecks SatisfyRequirementUsage=satisfiedRequirementChecks
    ConcernUsage=concernChecks
Cases: CaseDefinition=Case CaseUsage=cases
AnalysisCases: AnalysisCaseDefinition=AnalysisCase AnalysisCaseUsage=analysisCases
VerificationCases: VerificationCaseDefinition=VerificationCase
    VerificationCaseUsage=verificationCases
UseCases: UseCaseDefinition=UseCase UseCaseUsage=useCases
Views: ViewDefinition=View ViewpointDefinition=ViewpointCheck RenderingDefinition=Rendering
    ViewUsage=views ViewpointUsage=viewpointChecks RenderingUsage=renderings
Metadata: MetadataDefinition=MetadataItem MetadataUsage=metadataItems
"""
"""For each package of the library: the metaclasses with a base in it, and the base."""


def _parse_bases(table: str) -> dict[str, str]:
    bases = {}
    for line in table.replace("\n    ", " ").splitlines():
        package, *entries = line.split()
        for kind, _, base in (entry.partition("=") for entry in entries):
            bases[kind] = f"{package}:{base}"
    return bases


BASES = _parse_bases(_BASES)
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


def _select_kinds(words: str) -> frozenset[str]:
    """Return the metaclasses that specialise one of the words, and none that has a minus."""
    names = words.split()
    included = frozenset().union(*(kinds_of(name) for name in names if name[0] != "-"))
    return included.difference(*(kinds_of(name[1:]) for name in names if name[0] == "-"))


_ACTION = "ActionDefinition ActionUsage"
_STATE = "StateDefinition StateUsage"
_PART = "PartDefinition PartUsage"
_ITEM = "ItemDefinition ItemUsage"
_REQUIREMENT = "RequirementDefinition RequirementUsage"
_OCCURRENCE = "OccurrenceDefinition OccurrenceUsage Class"
_OWNED_USAGES: tuple[tuple[str, str, str, bool], ...] = (
    ("ActionUsage -PerformActionUsage", _ACTION, "subactions", True),
    ("ActionUsage -PerformActionUsage", _PART, "ownedActions", True),
    ("SendActionUsage", _ACTION, "sendSubactions", True),
    ("AcceptActionUsage", _ACTION, "acceptSubactions", True),
    ("TerminateActionUsage", _ACTION, "terminateSubactions", True),
    ("AssignmentActionUsage", _ACTION, "assignments", True),
    ("IfActionUsage", _ACTION, "ifSubactions", True),
    ("WhileLoopActionUsage", _ACTION, "whileLoops", True),
    ("ForLoopActionUsage", _ACTION, "forLoops", True),
    ("MergeNode", _ACTION, "merges", False),
    ("DecisionNode", _ACTION, "decisions", False),
    ("JoinNode", _ACTION, "joins", False),
    ("ForkNode", _ACTION, "forks", False),
    ("TransitionUsage", f"{_ACTION} -StateDefinition -StateUsage", "transitions", True),
    ("TransitionUsage", _STATE, "stateTransitions", True),
    ("StateUsage -ExhibitStateUsage", _STATE, "substates", True),
    ("StateUsage -ExhibitStateUsage", _PART, "ownedStates", True),
    ("PerformActionUsage", _PART, "performedActions", False),
    ("PerformActionUsage", _ACTION, "Performances::Performance::enclosedPerformances", False),
    ("ExhibitStateUsage", _PART, "exhibitedStates", False),
    ("CalculationUsage", "CalculationDefinition CalculationUsage", "subcalculations", True),
    ("CaseUsage", "CaseDefinition CaseUsage", "subcases", True),
    ("AnalysisCaseUsage", "AnalysisCaseDefinition AnalysisCaseUsage", "subAnalysisCases", True),
    (
        "VerificationCaseUsage",
        "VerificationCaseDefinition VerificationCaseUsage",
        "subVerificationCases",
        True,
    ),
    ("UseCaseUsage", "UseCaseDefinition UseCaseUsage", "subUseCases", True),
    ("IncludeUseCaseUsage", "UseCaseDefinition UseCaseUsage", "includedUseCases", False),
    ("ConstraintUsage", _ITEM, "checkedConstraints", True),
    ("RequirementUsage", _REQUIREMENT, "subrequirements", True),
    ("ConcernUsage", _REQUIREMENT, "concerns", True),
    ("ViewpointUsage", "ViewDefinition ViewUsage", "viewpointSatisfactions", True),
    ("ViewUsage", "ViewDefinition ViewUsage", "subviews", False),
    ("RenderingUsage", "RenderingDefinition RenderingUsage", "subrenderings", False),
    ("ItemUsage", _ITEM, "subitems", True),
    ("PartUsage", _ITEM, "subparts", True),
    ("PortUsage", _PART, "ownedPorts", False),
    ("PortUsage", "PortDefinition PortUsage", "subports", True),
    ("OccurrenceUsage", _OCCURRENCE, "suboccurrences", True),
    ("EventOccurrenceUsage", _OCCURRENCE, "timeEnclosedOccurrences", False),
    ("Step", "Behavior Step", "subperformances", True),
    ("Step", "Behavior Step", "enclosedPerformances", False),
    ("Step", "Structure", "ownedPerformances", True),
)
"""The kinds of usages and of their owners, the feature of the base of the first kind of owners that
the usages specialise, and whether these must be composite."""

OWNER_BASES = tuple(
    OwnerBase(
        _select_kinds(kinds),
        _select_kinds(owners),
        feature if "::" in feature else f"{BASES[owners.split()[0]]}::{feature}",
        composite,
    )
    for kinds, owners, feature, composite in _OWNED_USAGES
)
"""The bases of usages by their owner."""
