"""Features and relationships of the metaclasses in interchange (KerML 1.0, 8.3; SysML 2.0, 8.3)."""

from functools import cache

from sysmlc.language.metaclasses import ALL_GENERALS, RELATIONSHIP_ENDS, kinds_of

_STATED = {
    "Element": "declaredName declaredShortName elementId aliasIds isImpliedIncluded"
    " ownedRelationship owningRelationship",
    "Relationship": "isImplied ownedRelatedElement owningRelatedElement source target",
    "Annotation": "annotatedElement",
    "Comment": "body locale",
    "ConjugatedPortTyping": "conjugatedPortDefinition",
    "Conjugation": "conjugatedType originalType",
    "CrossSubsetting": "crossedFeature",
    "Definition": "isVariation",
    "Dependency": "client supplier",
    "Differencing": "differencingType",
    "Disjoining": "disjoiningType typeDisjoined",
    "Feature": "direction isComposite isConstant isDerived isEnd isOrdered isPortion isUnique"
    " isVariable",
    "FeatureChaining": "chainingFeature",
    "FeatureInverting": "featureInverted invertingFeature",
    "FeatureTyping": "type typedFeature",
    "FeatureValue": "isDefault isInitial",
    "Import": "isImportAll isRecursive visibility",
    "Intersecting": "intersectingType",
    "Invariant": "isNegated",
    "LibraryPackage": "isStandard",
    "LiteralBoolean": "value",
    "LiteralInteger": "value",
    "LiteralRational": "value",
    "LiteralString": "value",
    "Membership": "memberElement memberName memberShortName visibility",
    "MembershipImport": "importedMembership",
    "NamespaceImport": "importedNamespace",
    "OccurrenceDefinition": "isIndividual",
    "OccurrenceUsage": "isIndividual portionKind",
    "OperatorExpression": "operator",
    "PortConjugation": "originalPortDefinition",
    "Redefinition": "redefinedFeature redefiningFeature",
    "ReferenceSubsetting": "referencedFeature",
    "RequirementConstraintMembership": "kind",
    "RequirementDefinition": "reqId",
    "RequirementUsage": "reqId",
    "Specialization": "general specific",
    "StateDefinition": "isParallel",
    "StateSubactionMembership": "kind",
    "StateUsage": "isParallel",
    "Subclassification": "subclassifier superclassifier",
    "Subsetting": "subsettedFeature subsettingFeature",
    "TextualRepresentation": "body language",
    "TransitionFeatureMembership": "kind",
    "TriggerInvocationExpression": "kind",
    "Type": "isAbstract isSufficient",
    "TypeFeaturing": "featureOfType featuringType",
    "Unioning": "unioningType",
    "Usage": "isVariation",
}
"""The features of each metaclass, with ids and ownership, without derived features."""

_DERIVED = """
action actionDefinition actorParameter allocation allocationDefinition analysisCaseDefinition
annotatedElement annotatingElement annotation argument assertedConstraint association
associationEnd assumedConstraint attributeDefinition behavior bodyAction bound calculation
calculationDefinition caseDefinition chainingFeature concernDefinition condition
conjugatedPortDefinition connectionDefinition connectionEnd connectorEnd constraintDefinition
crossFeature crossingFeature defaultFeaturingType definition differencingType directedFeature
directedUsage doAction documentation documentedElement effectAction elseAction endFeature
endOwningType entryAction enumeratedValue enumerationDefinition eventOccurrence exhibitedState
exitAction exposedElement expression feature featureChained featureMembership featureTarget
featureWithValue featuringType filterCondition flowDefinition flowEnd framedConcern function
guardExpression ifArgument importOwningNamespace importedElement importedMembership
includedUseCase individualDefinition inheritedFeature inheritedMembership input instantiatedType
interaction interfaceDefinition interfaceEnd intersectingType isConjugated isLibraryElement
isModelLevelEvaluable isReference itemDefinition loopVariable lowerBound mayTimeVary member
memberElementId membership membershipOwningNamespace metaclass metadataDefinition multiplicity
name nestedAction nestedAllocation nestedAnalysisCase nestedAttribute nestedCalculation
nestedCase nestedConcern nestedConnection nestedConstraint nestedEnumeration nestedFlow
nestedInterface nestedItem nestedMetadata nestedOccurrence nestedPart nestedPort nestedReference
nestedRendering nestedRequirement nestedState nestedTransition nestedUsage nestedUseCase
nestedVerificationCase nestedView nestedViewpoint objectiveRequirement occurrenceDefinition
operand originalPortDefinition output ownedAction ownedActorParameter ownedAllocation
ownedAnalysisCase ownedAnnotatingElement ownedAnnotatingRelationship ownedAnnotation
ownedAttribute ownedCalculation ownedCase ownedConcern ownedConjugator ownedConnection
ownedConstraint ownedCrossSubsetting ownedDifferencing ownedDisjoining ownedElement
ownedEndFeature ownedEnumeration ownedFeature ownedFeatureChaining ownedFeatureInverting
ownedFeatureMembership ownedFlow ownedImport ownedInterface ownedIntersecting ownedItem
ownedMember ownedMemberElement ownedMemberElementId ownedMemberFeature ownedMemberName
ownedMemberParameter ownedMemberShortName ownedMembership ownedMetadata
ownedObjectiveRequirement ownedOccurrence ownedPart ownedPort ownedPortConjugator
ownedRedefinition ownedReference ownedReferenceSubsetting ownedRendering ownedRequirement
ownedResultExpression ownedSpecialization ownedStakeholderParameter ownedState
ownedSubclassification ownedSubjectParameter ownedSubsetting ownedTransition ownedTypeFeaturing
ownedTyping ownedUnioning ownedUsage ownedUseCase ownedVariantUsage ownedVerificationCase
ownedView ownedViewpoint owner owningAnnotatedElement owningAnnotatingElement
owningAnnotatingRelationship owningClassifier owningDefinition owningFeature
owningFeatureMembership owningFeatureOfType owningMembership owningNamespace owningType
owningUsage parameter partDefinition payloadArgument payloadFeature payloadParameter payloadType
performedAction portDefinition predicate qualifiedName receiverArgument referencedConcern
referencedConstraint referencedElement referencedRendering referencingFeature referent
relatedElement relatedFeature relatedType rendering renderingDefinition representedElement
requiredConstraint requirementDefinition result resultExpression satisfiedRequirement
satisfiedViewpoint satisfyingFeature senderArgument seqArgument shortName source sourceFeature
sourceOutputFeature sourceType stakeholderParameter state stateDefinition step subjectParameter
succession target targetArgument targetFeature targetInputFeature targetType
terminatedOccurrenceArgument text textualRepresentation thenAction transitionFeature
triggerAction type typeDifferenced typeIntersected typeUnioned unioningType untilArgument
upperBound usage useCaseDefinition useCaseIncluded value valueExpression variant
variantMembership verificationCaseDefinition verifiedRequirement view viewCondition
viewDefinition viewRendering viewpointDefinition viewpointStakeholder whileArgument
"""
"""Derived features, which files may contain and the reader ignores."""

ABSTRACT = (
    "ConnectorAsUsage ControlNode Element Expose Import InstantiationExpression"
    " LoopActionUsage Relationship"
)
"""Abstract metaclasses."""


@cache
def _list_derived() -> frozenset[str]:
    return frozenset(_DERIVED.split())


@cache
def list_features(kind: str) -> frozenset[str]:
    """Return the features that elements of the metaclass may have, inherited ones included."""
    return frozenset(
        feature for general in ALL_GENERALS[kind] for feature in _STATED.get(general, "").split()
    )


def has_feature(kind: str, feature: str) -> bool:
    """Whether the metaclass has the feature, or the feature is derived in some metaclass."""
    return feature in list_features(kind) or feature in _list_derived()


@cache
def is_concrete(kind: str) -> bool:
    """Whether elements can be of this metaclass: known and not abstract."""
    return kind in ALL_GENERALS and kind not in ABSTRACT.split()


RELATION_TARGETS = {
    **{kind: target for kind, (_, target) in RELATIONSHIP_ENDS.items() if kind != "Dependency"},
    "ConjugatedPortTyping": "conjugatedPortDefinition",
    "ReferenceSubsetting": "referencedFeature",
    "CrossSubsetting": "crossedFeature",
    "Unioning": "unioningType",
    "Intersecting": "intersectingType",
    "Differencing": "differencingType",
    "FeatureChaining": "chainingFeature",
    "Annotation": "annotatedElement",
}
"""Owned relationships, and the feature that refers to their target."""
REFERRING_KINDS = (
    kinds_of("InstantiationExpression")
    | kinds_of("FeatureReferenceExpression")
    | kinds_of("MetadataAccessExpression")
    | {"AssignmentActionUsage", "TransitionUsage"}
)
"""Elements that refer to others by a membership."""

OWN_ENDS = {kind: end for kind, (end, _) in RELATIONSHIP_ENDS.items() if kind != "Dependency"} | {
    "ConjugatedPortTyping": "typedFeature"
}
"""The feature by which an owned relationship refers to its owner."""
