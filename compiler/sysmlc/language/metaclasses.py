"""The metaclasses of KerML and SysML v2: which specialises which, and what follows for elements.

KerML 1.0, 8.3; SysML 2.0, 8.3 and 8.2.2.6.2, note 1."""

from sysmlc.language.tree import Node

_GENERALS = """\
Element: AnnotatingElement Namespace Relationship
AnnotatingElement: Comment TextualRepresentation
Namespace: Package Type
Relationship: Annotation Conjugation Dependency Differencing Disjoining FeatureChaining
    FeatureInverting Import Intersecting Membership Specialization TypeFeaturing Unioning
Comment: Documentation
Conjugation: PortConjugation
Import: Expose MembershipImport NamespaceImport
Membership: OwningMembership
Package: LibraryPackage
Specialization: FeatureTyping Subclassification Subsetting
Type: Classifier Feature
Classifier: Class DataType Definition
Classifier Relationship: Association
Feature: FlowEnd Multiplicity PayloadFeature Step Usage
Feature AnnotatingElement: MetadataFeature
Feature Relationship: Connector
FeatureTyping: ConjugatedPortTyping
MembershipImport Expose: MembershipExpose
NamespaceImport Expose: NamespaceExpose
OwningMembership: ElementFilterMembership FeatureMembership FeatureValue VariantMembership
Subsetting: CrossSubsetting Redefinition ReferenceSubsetting
Class: Behavior Structure
Connector: BindingConnector Succession
Connector Step: Flow
Definition Class: OccurrenceDefinition
Definition DataType: AttributeDefinition
FeatureMembership: EndFeatureMembership ObjectiveMembership ParameterMembership
    RequirementConstraintMembership ResultExpressionMembership StateSubactionMembership
    TransitionFeatureMembership ViewRenderingMembership
Multiplicity: MultiplicityRange
Step: Expression
Usage: AttributeUsage OccurrenceUsage ReferenceUsage
Usage Connector: ConnectorAsUsage
Association Behavior: Interaction
Association Structure: AssociationStructure
AttributeDefinition: EnumerationDefinition
AttributeUsage: EnumerationUsage
Behavior: Function
ConnectorAsUsage BindingConnector: BindingConnectorAsUsage
ConnectorAsUsage Succession: SuccessionAsUsage
Expression: BooleanExpression FeatureReferenceExpression InstantiationExpression
    LiteralExpression MetadataAccessExpression NullExpression
Flow Succession: SuccessionFlow
OccurrenceDefinition Behavior: ActionDefinition
OccurrenceDefinition Structure: ItemDefinition PortDefinition
OccurrenceUsage: EventOccurrenceUsage ItemUsage PortUsage
OccurrenceUsage Step: ActionUsage
ParameterMembership: ActorMembership ReturnParameterMembership StakeholderMembership
    SubjectMembership
RequirementConstraintMembership: FramedConcernMembership RequirementVerificationMembership
Structure: Metaclass
ActionDefinition: StateDefinition
ActionDefinition Function: CalculationDefinition
ActionDefinition Interaction: FlowDefinition
ActionUsage: AcceptActionUsage AssignmentActionUsage ControlNode IfActionUsage LoopActionUsage
    SendActionUsage StateUsage TerminateActionUsage TransitionUsage
ActionUsage EventOccurrenceUsage: PerformActionUsage
ActionUsage Expression: CalculationUsage
BooleanExpression: Invariant
ConnectorAsUsage ActionUsage Flow: FlowUsage
Function: Predicate
InstantiationExpression: ConstructorExpression InvocationExpression
ItemDefinition: PartDefinition
ItemDefinition Metaclass: MetadataDefinition
ItemUsage: PartUsage
ItemUsage MetadataFeature: MetadataUsage
LiteralExpression: LiteralBoolean LiteralInfinity LiteralInteger LiteralRational LiteralString
OccurrenceUsage BooleanExpression: ConstraintUsage
PortDefinition: ConjugatedPortDefinition
CalculationDefinition: CaseDefinition
CalculationUsage: CaseUsage
ConnectorAsUsage PartUsage: ConnectionUsage
ConstraintUsage: RequirementUsage
ConstraintUsage Invariant: AssertConstraintUsage
ControlNode: DecisionNode ForkNode JoinNode MergeNode
FlowUsage SuccessionFlow: SuccessionFlowUsage
InvocationExpression: OperatorExpression TriggerInvocationExpression
LoopActionUsage: ForLoopActionUsage WhileLoopActionUsage
OccurrenceDefinition Predicate: ConstraintDefinition
PartDefinition: RenderingDefinition ViewDefinition
PartDefinition AssociationStructure: ConnectionDefinition
PartUsage: RenderingUsage ViewUsage
StateUsage PerformActionUsage: ExhibitStateUsage
CaseDefinition: AnalysisCaseDefinition UseCaseDefinition VerificationCaseDefinition
CaseUsage: AnalysisCaseUsage UseCaseUsage VerificationCaseUsage
ConnectionDefinition: AllocationDefinition InterfaceDefinition
ConnectionUsage: AllocationUsage InterfaceUsage
ConstraintDefinition: RequirementDefinition
OperatorExpression: CollectExpression FeatureChainExpression IndexExpression SelectExpression
RequirementUsage: ConcernUsage ViewpointUsage
RequirementUsage AssertConstraintUsage: SatisfyRequirementUsage
RequirementDefinition: ConcernDefinition ViewpointDefinition
UseCaseUsage PerformActionUsage: IncludeUseCaseUsage
"""
"""Generals before the colon, the metaclasses that specialise all of them after it."""


def _read(table: str) -> dict[str, tuple[str, ...]]:
    read: dict[str, tuple[str, ...]] = {"Element": ()}
    for line in table.replace("\n    ", " ").splitlines():
        generals, _, specials = line.partition(":")
        read.update(dict.fromkeys(specials.split(), tuple(generals.split())))
    return read


GENERALS = _read(_GENERALS)
"""Direct generals of each metaclass; ``Element`` has none."""


def _close(generals: dict[str, tuple[str, ...]]) -> dict[str, frozenset[str]]:
    closed: dict[str, frozenset[str]] = {}

    def close(kind: str) -> frozenset[str]:
        if kind not in closed:
            closed[kind] = frozenset({kind}).union(*map(close, generals[kind]))
        return closed[kind]

    for kind in generals:
        close(kind)
    return closed


ALL_GENERALS = _close(GENERALS)
"""Each metaclass with all that it specialises, itself included."""
_NOTHING: frozenset[str] = frozenset()


def is_a(kind: str, general: str) -> bool:
    """Whether a metaclass is ``general`` or specialises it; an unknown one is nothing."""
    return general in ALL_GENERALS.get(kind, _NOTHING)


def kinds_of(general: str) -> frozenset[str]:
    """All metaclasses that are ``general`` or specialise it."""
    return frozenset(kind for kind, all_of in ALL_GENERALS.items() if general in all_of)


USAGES = kinds_of("Usage")
_REFERENTIAL = (
    kinds_of("ReferenceUsage")
    | kinds_of("AttributeUsage")
    | kinds_of("EventOccurrenceUsage")
    | kinds_of("BindingConnectorAsUsage")
    | kinds_of("SuccessionAsUsage")
)
_FEATURE_MEMBERSHIPS = kinds_of("FeatureMembership")
_PARAMETERS = kinds_of("ParameterMembership")
_PORT_OWNERS = kinds_of("PortDefinition") | kinds_of("PortUsage")
_ATTRIBUTES = kinds_of("AttributeDefinition") | kinds_of("AttributeUsage")


def is_composite(node: Node) -> bool:
    """Whether a usage is a composite feature: not ``ref``, and nothing makes it referential.

    Referential are attributes, events and performances, binding and succession connectors,
    parameters, ends, what no type owns as a feature, and ports except within ports.
    """
    if node.kind in _REFERENTIAL or node.attributes.get("isReference") or is_end(node):
        return False
    if node.membership not in _FEATURE_MEMBERSHIPS or node.membership in _PARAMETERS:
        return False
    if "direction" in node.attributes:
        return False
    owner = node.owner.kind if node.owner else ""
    if is_a(node.kind, "PortUsage"):
        return owner in _PORT_OWNERS
    return owner not in _ATTRIBUTES


def is_end(node: Node) -> bool:
    """Whether a feature is an end: it says so, or its membership does."""
    return node.membership == "EndFeatureMembership" or node.attributes.get("isEnd") is True
