"""Accessibility: features that connectors and expressions refer to belong to a type around them."""

from collections.abc import Iterator

from sysmlc.diagnostics import Severity, Sink, rule
from sysmlc.language.metaclasses import FEATURES, TYPES, kinds_of
from sysmlc.language.names import Model
from sysmlc.language.tree import Document, Node, Relation, make_subject

NOT_ACCESSIBLE = rule(
    "SM225",
    "feature-not-accessible",
    Severity.ERROR,
    "'{name}' is a feature of '{owner}', and nothing around here is one",
    help="use dot notation: the part, a dot, '{name}'",
)

_CONNECTORS = kinds_of("Connector")
_FEATURE_MEMBERSHIPS = kinds_of("FeatureMembership")
_WITHOUT_FEATURES = kinds_of("EnumerationDefinition") | kinds_of("Namespace") - TYPES


KINDS = _CONNECTORS | {"FeatureReferenceExpression"}
"""Metaclasses that are checked."""


def check_accessibility(model: Model, document: Document, node: Node, sink: Sink) -> None:
    """Report features that no type around the connector or expression has.

    A condition of a filter is about the filtered elements (KerML 7.4.14), which have the feature.
    """
    uses = list(_iter_uses(node))
    if not uses:
        return
    scopes = [node, *_list_owners(node)]
    # The common case, decided without supertypes.
    if len({id(feature.owner) for *_, feature in uses}) == 1 and uses[0][2].owner in scopes:
        return
    if any(all(_has_feature(model, scope, feature) for *_, feature in uses) for scope in scopes):
        return
    if not any(scope.membership == "ElementFilterMembership" for scope in scopes):
        inaccessible = [
            use for use in uses if not any(_has_feature(model, scope, use[2]) for scope in scopes)
        ]
        for user, relation, feature in inaccessible or _find_outside(model, scopes[1], uses):
            place = make_subject(document, user, relation.reference.start)
            owner = model.name(feature.owner) if feature.owner else ""
            text = "::".join(relation.reference.chain[0])
            sink.report(NOT_ACCESSIBLE, place, name=text, owner=owner)


def _iter_uses(node: Node) -> Iterator[tuple[Node, Relation, Node]]:
    """Yield the references of an expression or of connector ends: user, relation, first feature."""
    if node.kind in _CONNECTORS:
        for end in node.members:
            yield from _iter_uses_by(end, "ReferenceSubsetting")
    elif node.kind == "FeatureReferenceExpression":
        yield from _iter_uses_by(node, "Membership")


def _iter_uses_by(node: Node, kind: str) -> Iterator[tuple[Node, Relation, Node]]:
    for relation in node.relations:
        targets = relation.reference.targets
        if relation.kind == kind and targets and _needs_owner(targets[0]):
            yield node, relation, targets[0]


def _needs_owner(feature: Node) -> bool:
    """Whether a feature has values only within the type that owns it."""
    owner = feature.owner
    if feature.kind not in FEATURES or owner is None or owner.kind in _WITHOUT_FEATURES:
        return False
    return feature.membership in _FEATURE_MEMBERSHIPS and owner.kind in TYPES


def _list_owners(node: Node) -> list[Node]:
    owners = []
    owner = node.owner
    while owner is not None:
        owners.append(owner)
        owner = owner.owner
    return owners


def _has_feature(model: Model, scope: Node, feature: Node) -> bool:
    """Whether a type owns a feature or specialises its owner."""
    owner = feature.owner
    return scope is owner or (scope.kind in TYPES and owner in model.supertype_set(scope))


def _find_outside(
    model: Model, scope: Node, uses: list[tuple[Node, Relation, Node]]
) -> list[tuple[Node, Relation, Node]]:
    """Return the uses of features that the nearest scope does not have."""
    return [use for use in uses if not _has_feature(model, scope, use[2])]
