"""Features that a connector or expression refers to belong to something around it."""

from collections.abc import Iterator

from sysmlc.diagnostics import Sink
from sysmlc.language.checks.rules import NOT_ACCESSIBLE
from sysmlc.language.metaclasses import FEATURES, TYPES, kinds_of
from sysmlc.language.names import Model
from sysmlc.language.tree import Document, Node, Relation, make_subject

_CONNECTORS = kinds_of("Connector")
_FEATURE_MEMBERSHIPS = kinds_of("FeatureMembership")
_FEATURELESS = kinds_of("EnumerationDefinition") | kinds_of("Namespace") - TYPES


KINDS = _CONNECTORS | {"FeatureReferenceExpression"}
"""Metaclasses that refer to features."""


def check(model: Model, document: Document, node: Node, sink: Sink) -> None:
    """Report features that nothing around the connector or expression has.

    A condition of a filter is about what is filtered (KerML 7.4.14), and that has the feature.
    """
    uses = list(_uses(node))
    if not uses:
        return
    scopes = [node, *_around(node)]
    if len({id(feature.owner) for *_, feature in uses}) == 1 and uses[0][2].owner in scopes:
        return
    if any(all(_has(model, scope, feature) for *_, feature in uses) for scope in scopes):
        return
    if not any(scope.membership == "ElementFilterMembership" for scope in scopes):
        far = [one for one in uses if not any(_has(model, scope, one[2]) for scope in scopes)]
        for user, relation, feature in far or _outside(model, scopes[1], uses):
            place = make_subject(document, user, relation.reference.start)
            owner = model.name(feature.owner) if feature.owner else ""
            text = "::".join(relation.reference.chain[0])
            sink.report(NOT_ACCESSIBLE, place, name=text, owner=owner)


def _uses(node: Node) -> Iterator[tuple[Node, Relation, Node]]:
    """What an expression or the ends of a connector refer to: user, relation, first feature."""
    if node.kind in _CONNECTORS:
        for end in node.members:
            yield from _of(end, "ReferenceSubsetting")
    elif node.kind == "FeatureReferenceExpression":
        yield from _of(node, "Membership")


def _of(node: Node, kind: str) -> Iterator[tuple[Node, Relation, Node]]:
    for relation in node.relations:
        targets = relation.reference.targets
        if relation.kind == kind and targets and _is_owned(targets[0]):
            yield node, relation, targets[0]


def _is_owned(feature: Node) -> bool:
    """Whether a feature has values only within what owns it."""
    owner = feature.owner
    if feature.kind not in FEATURES or owner is None or owner.kind in _FEATURELESS:
        return False
    return feature.membership in _FEATURE_MEMBERSHIPS and owner.kind in TYPES


def _around(node: Node) -> list[Node]:
    found = []
    around = node.owner
    while around is not None:
        found.append(around)
        around = around.owner
    return found


def _has(model: Model, scope: Node, feature: Node) -> bool:
    """Whether a type owns a feature or specialises its owner."""
    owner = feature.owner
    return scope is owner or (scope.kind in TYPES and owner in model.supertype_set(scope))


def _outside(
    model: Model, scope: Node, uses: list[tuple[Node, Relation, Node]]
) -> list[tuple[Node, Relation, Node]]:
    """Of ends that no one thing has all of, those that the nearest has not."""
    return [one for one in uses if not _has(model, scope, one[2])]
