"""Tables: relationships with their ends, and what names other elements (KerML 1.0, 8.3)."""

from sysmlc.language.metaclasses import kinds_of

RELATIONS = {
    "Specialization": "general",
    "Subclassification": "superclassifier",
    "FeatureTyping": "type",
    "ConjugatedPortTyping": "conjugatedPortDefinition",
    "Subsetting": "subsettedFeature",
    "Redefinition": "redefinedFeature",
    "ReferenceSubsetting": "referencedFeature",
    "CrossSubsetting": "crossedFeature",
    "Conjugation": "originalType",
    "Disjoining": "disjoiningType",
    "Unioning": "unioningType",
    "Intersecting": "intersectingType",
    "Differencing": "differencingType",
    "FeatureChaining": "chainingFeature",
    "FeatureInverting": "invertingFeature",
    "TypeFeaturing": "featuringType",
    "Annotation": "annotatedElement",
}
"""Relationships that an element owns towards others, and the feature that says to which."""

ENDS = {
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
"""Relationships that stand for themselves, and their ends in the order of the text."""

NAMING = (
    kinds_of("InstantiationExpression")
    | kinds_of("FeatureReferenceExpression")
    | kinds_of("MetadataAccessExpression")
    | {"AssignmentActionUsage", "TransitionUsage"}
)
"""Elements whose memberships name what they refer to."""

OWN_ENDS = {
    "Specialization": "specific",
    "Subclassification": "subclassifier",
    "FeatureTyping": "typedFeature",
    "ConjugatedPortTyping": "typedFeature",
    "Subsetting": "subsettingFeature",
    "Redefinition": "redefiningFeature",
    "Conjugation": "conjugatedType",
    "Disjoining": "typeDisjoined",
    "FeatureInverting": "featureInverted",
    "TypeFeaturing": "featureOfType",
}
"""The feature by which an owned relationship names its owner, where the owner does not say it."""
