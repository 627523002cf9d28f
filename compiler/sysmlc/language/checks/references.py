"""What usages reference and redefine, and what connectors and expressions may refer to.

A feature is accessible to a connector or an expression if it belongs to a type around it.
"""

from collections.abc import Iterator

from sysmlc.diagnostics import Severity, rule
from sysmlc.language.checks import memberships
from sysmlc.language.checks.findings import Finding, iter_stated, name_of
from sysmlc.language.metaclasses import (
    FEATURES,
    TYPES,
    USAGES,
    describe_kind,
    is_composite,
    kinds_of,
)
from sysmlc.language.names import Model
from sysmlc.language.tree import Node, Relation

OTHER_KIND = rule(
    "SM236",
    "references-other-kind",
    Severity.ERROR,
    "'{name}' is {found}, but {wanted} is required here",
    help="{advice}",
)
PART_OF_PORT = rule(
    "SM237",
    "part-of-port",
    Severity.ERROR,
    "'{name}' is a part of the port '{owner}'",
    help="write 'ref' before it, or give it a direction",
)
OTHER_DIRECTION = rule(
    "SM238",
    "other-direction",
    Severity.ERROR,
    "the direction of '{name}' differs from that of its definition in '{owner}'",
    help="use the same direction, or none",
)
INDIVIDUAL = rule(
    "SM239",
    "individual-types",
    Severity.ERROR,
    "the individual '{name}' has {count} individual definitions, but must have exactly one",
    help="type it by one 'individual def'",
)


_REFERENCED_KINDS = {
    "IncludeUseCaseUsage": (kinds_of("UseCaseUsage"), "a use case"),
    "ExhibitStateUsage": (kinds_of("StateUsage"), "a state"),
    "PerformActionUsage": (kinds_of("Step"), "an action"),
    "EventOccurrenceUsage": (kinds_of("OccurrenceUsage") | kinds_of("Step"), "an occurrence"),
}
_VALUES = kinds_of("AttributeUsage") | {"ReferenceUsage"}
_PORT_OWNERS = kinds_of("PortDefinition") | kinds_of("PortUsage")
RELATIONS = frozenset({"ReferenceSubsetting", "Redefinition", "Subsetting", "FeatureTyping"})
"""Kinds of relations that are checked."""
_DIRECTIONS = ("in", "out")


def check_references(model: Model, node: Node) -> Iterator[Finding]:
    """Report references to elements of another kind, direction or variation than required."""
    is_variation = bool(node.attributes.get("isVariation"))
    for relation, target in iter_stated(node, RELATIONS):
        start, name = relation.reference.start, str(relation.reference)
        if relation.kind == "ReferenceSubsetting":
            yield from _find_other_kind(node, relation, target)
        elif relation.kind == "Redefinition" and _has_other_direction(model, node, target):
            owner = model.name(target.owner) if target.owner else ""
            yield Finding(OTHER_DIRECTION, start, {"name": name, "owner": owner})
        # Usages; `specializations` checks definitions.
        if is_variation and target.attributes.get("isVariation"):
            facts = {"name": name_of(model, node), "owner": ""}
            yield Finding(memberships.VARIATION_OF_VARIATION, start, facts)


def refers_to_other_kind(node: Node) -> bool:
    """Whether ``check_references`` reports that a usage refers to one of another kind."""
    stated = iter_stated(node, frozenset({"ReferenceSubsetting"}))
    return any(True for stated_pair in stated for _ in _find_other_kind(node, *stated_pair))


def _find_other_kind(node: Node, relation: Relation, target: Node) -> Iterator[Finding]:
    kinds, words = _REFERENCED_KINDS.get(node.kind, (USAGES, ""))
    if target.kind in USAGES and target.kind not in kinds:
        name, advice = str(relation.reference), f"reference {words}"
        if node.kind == "PerformActionUsage" and target.kind in _VALUES:
            advice = f"to change it, write 'assign {name} := ...'"
        facts = {"name": name, "found": describe_kind(target), "wanted": words, "advice": advice}
        yield Finding(OTHER_KIND, relation.reference.start, facts)


def _has_other_direction(model: Model, node: Node, target: Node) -> bool:
    """Whether a redefining feature has another direction than the redefined one."""
    general_direction = target.attributes.get("direction")
    own_direction = node.attributes.get("direction")
    return (
        general_direction in _DIRECTIONS
        and own_direction not in (None, general_direction)
        and not _is_conjugated(model, node)
    )


def _is_conjugated(model: Model, node: Node) -> bool:
    """Whether the owner, or a general of it, is conjugated."""
    supers = model.all_supertypes(node.owner) if node.owner is not None else ()
    return any(
        relation.kind == "ConjugatedPortTyping"
        for general in supers
        for relation in general.relations
    )


def check_usage(model: Model, node: Node) -> Iterator[Finding]:
    """Report a part of a port, and an individual with none or several individual types."""
    owner, name = node.owner, node.name or node.kind
    is_in_port = owner is not None and owner.kind in _PORT_OWNERS
    if is_in_port and node.kind != "PortUsage" and is_composite(node):
        yield Finding(PART_OF_PORT, node.start, {"name": name, "owner": name_of(model, owner)})
    if node.attributes.get("isIndividual") and node.find_relation("FeatureTyping"):
        types = [type_ for type_ in model.types(node) if type_.attributes.get("isIndividual")]
        if len(types) != 1:
            yield Finding(INDIVIDUAL, node.start, {"name": name, "count": len(types)})


# -- accessibility -----------------------------------------------------------------------------

NOT_ACCESSIBLE = rule(
    "SM225",
    "feature-not-accessible",
    Severity.ERROR,
    "'{name}' is a feature of '{owner}', which is not the type of any enclosing element",
    help="use dot notation: the part, a dot, '{name}'",
)

_CONNECTORS = kinds_of("Connector")
_FEATURE_MEMBERSHIPS = kinds_of("FeatureMembership")
_WITHOUT_FEATURES = kinds_of("EnumerationDefinition") | kinds_of("Namespace") - TYPES


REFERRING_KINDS = _CONNECTORS | {"FeatureReferenceExpression"}
"""Metaclasses that are checked."""


def check_accessibility(model: Model, node: Node) -> Iterator[Finding]:
    """Report features that no type around the connector or expression has.

    A condition of a filter is about the filtered elements (KerML 7.4.14), which have the feature.
    """
    uses = list(_iter_uses(node))
    if not uses:
        return
    scopes = [node]
    while (owner := scopes[-1].owner) is not None:
        scopes.append(owner)
    # The common case, decided without supertypes.
    if len({id(feature.owner) for *_, feature in uses}) == 1 and uses[0][2].owner in scopes:
        return
    if any(all(_has_feature(model, scope, feature) for *_, feature in uses) for scope in scopes):
        return
    if not any(scope.membership == "ElementFilterMembership" for scope in scopes):
        inaccessible = [
            use for use in uses if not any(_has_feature(model, scope, use[2]) for scope in scopes)
        ]
        for user, relation, feature in inaccessible or [
            use for use in uses if not _has_feature(model, scopes[1], use[2])
        ]:
            name_of_owner = model.name(feature.owner) if feature.owner else ""
            facts = {"name": "::".join(relation.reference.chain[0]), "owner": name_of_owner}
            yield Finding(NOT_ACCESSIBLE, relation.reference.start, facts, user)


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


def _has_feature(model: Model, scope: Node, feature: Node) -> bool:
    """Whether a type owns a feature or specialises its owner."""
    owner = feature.owner
    return scope is owner or (scope.kind in TYPES and owner in model.supertype_set(scope))
