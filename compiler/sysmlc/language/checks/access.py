"""Features that a connector or expression refers to belong to something around it."""

from sysmlc.diagnostics import Sink
from sysmlc.language.checks.rules import NOT_ACCESSIBLE
from sysmlc.language.metaclasses import kinds_of
from sysmlc.language.names import Model
from sysmlc.language.names.contents import FEATURES, TYPES
from sysmlc.language.names.unresolved import subject
from sysmlc.language.tree import Document, Node, Relation

_CONNECTORS = kinds_of("Connector")
_FEATURE_MEMBERSHIPS = kinds_of("FeatureMembership")
_FEATURELESS = kinds_of("EnumerationDefinition") | kinds_of("Namespace") - TYPES


def check(model: Model, document: Document, node: Node, sink: Sink) -> None:
    """Report a feature that nothing around the connector or expression has."""
    for relation in node.relations:
        if not relation.implied and _refers(node, relation):
            targets = relation.reference.targets
            first = targets[0] if targets else None
            if first is not None and not _is_accessible(model, node, first):
                place = subject(document, node, relation.reference.start)
                owner = model.name(first.owner) if first.owner else ""
                text = "::".join(relation.reference.chain[0])
                sink.report(NOT_ACCESSIBLE, place, name=text, owner=owner)


def _refers(node: Node, relation: Relation) -> bool:
    if relation.kind == "Membership":
        return node.kind == "FeatureReferenceExpression"
    owner = node.owner
    ends = owner is not None and owner.kind in _CONNECTORS
    return relation.kind == "ReferenceSubsetting" and ends


def _is_accessible(model: Model, node: Node, feature: Node) -> bool:
    """Whether a type around ``node`` has the feature: owns it or specialises its owner."""
    owner = feature.owner
    if feature.kind not in FEATURES or owner is None or owner.kind in _FEATURELESS:
        return True
    if feature.membership not in _FEATURE_MEMBERSHIPS or owner.kind not in TYPES:
        return True
    around = node.owner
    while around is not None:
        if around is owner or (around.kind in TYPES and owner in model.supers_of(around)):
            return True
        around = around.owner
    return False
