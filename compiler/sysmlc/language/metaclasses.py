"""The metaclasses of KerML and SysML v2: which specialises which (KerML 1.0 8.3, SysML 2.0 8.3).

``is_composite`` and ``is_end`` are attributes of usages that follow from their metaclass and owner.
"""

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
"""Generals before each colon, and after it the metaclasses that specialise all of them."""


def _parse_table(table: str) -> dict[str, tuple[str, ...]]:
    generals_of: dict[str, tuple[str, ...]] = {"Element": ()}
    for line in table.replace("\n    ", " ").splitlines():
        generals, _, specials = line.partition(":")
        generals_of.update(dict.fromkeys(specials.split(), tuple(generals.split())))
    return generals_of


GENERALS = _parse_table(_GENERALS)
"""Direct generals of each metaclass; ``Element`` has none."""


def _compute_closure(generals: dict[str, tuple[str, ...]]) -> dict[str, frozenset[str]]:
    closure: dict[str, frozenset[str]] = {}

    def close(kind: str) -> frozenset[str]:
        if kind not in closure:
            closure[kind] = frozenset({kind}).union(*map(close, generals[kind]))
        return closure[kind]

    for kind in generals:
        close(kind)
    return closure


ALL_GENERALS = _compute_closure(GENERALS)
"""Each metaclass with everything that it specialises, itself included."""
_NO_KINDS: frozenset[str] = frozenset()


def is_a(kind: str, general: str) -> bool:
    """Whether a metaclass is ``general`` or specialises it; False for an unknown metaclass."""
    return general in ALL_GENERALS.get(kind, _NO_KINDS)


def kinds_of(general: str) -> frozenset[str]:
    """Return ``general`` and all metaclasses that specialise it."""
    return frozenset(kind for kind, generals in ALL_GENERALS.items() if general in generals)


FEATURES = kinds_of("Feature")
TYPES = kinds_of("Type")
NAMESPACES = kinds_of("Namespace")
USAGES = kinds_of("Usage")
EXPRESSIONS_WITHOUT_BODY = (
    kinds_of("InstantiationExpression")
    | kinds_of("LiteralExpression")
    | {"FeatureReferenceExpression", "MetadataAccessExpression", "NullExpression"}
)
"""Expressions that declare nothing: they only make up a larger expression."""
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

RELATIONSHIP_ENDS = {
    "Dependency": ("client", "supplier"),
    "Specialization": ("specific", "general"),
    "Subclassification": ("subclassifier", "superclassifier"),
    "FeatureTyping": ("typedFeature", "type"),
    "Subsetting": ("subsettingFeature", "subsettedFeature"),
    "Redefinition": ("redefiningFeature", "redefinedFeature"),
    "Conjugation": ("conjugatedType", "originalType"),
    "Disjoining": ("typeDisjoined", "disjoiningType"),
    "FeatureInverting": ("featureInverted", "invertingFeature"),
    "TypeFeaturing": ("featureOfType", "featuringType"),
}
"""Relationships that may be elements of their own, with their ends in the order of the text."""


def is_composite(node: Node) -> bool:
    """Whether a usage is composite: not ``ref``, and not referential by its kind or place.

    Referential are attributes, events and performances, binding and succession connectors,
    parameters, ends, usages that no type owns as a feature, and ports except within ports (SysML
    2.0, 8.2.2.6.2, note 1).
    """
    if node.kind in _REFERENTIAL or node.attributes.get("isReference") or is_end(node):
        return False
    if node.membership not in _FEATURE_MEMBERSHIPS or node.membership in _PARAMETERS:
        return False
    # A feature with a direction is passed, not contained.
    if "direction" in node.attributes:
        return False
    owner = node.owner.kind if node.owner else ""
    if is_a(node.kind, "PortUsage"):
        return owner in _PORT_OWNERS
    return owner not in _ATTRIBUTES


def is_end(node: Node) -> bool:
    """Whether a feature is an end, by its attribute or its membership."""
    return node.membership == "EndFeatureMembership" or node.attributes.get("isEnd") is True


def describe_kind(node: Node) -> str:
    """Return the kind of an element in words: ``a part definition``."""
    if is_a(node.kind, "Package"):
        return "a package"
    words = "".join(f" {c.lower()}" if c.isupper() else c for c in node.kind).strip()
    words = words.removesuffix(" usage")
    has_vowel_sound = words[0] in "aeiou" and not words.startswith("use")
    return f"{'an' if has_vowel_sound else 'a'} {words}"
