"""What usages reference and redefine, and what connectors and expressions may refer to.

A feature is accessible to a connector or an expression if it belongs to a type around it.
"""

from collections.abc import Iterator, Mapping

from sysmlc.diagnostics import Rule, Severity, Sink, rule
from sysmlc.language.checks import memberships
from sysmlc.language.checks.findings import iter_stated
from sysmlc.language.metaclasses import FEATURES, TYPES, describe_kind, is_composite, kinds_of
from sysmlc.language.names import Model
from sysmlc.language.tree import Document, Node, Relation, make_subject

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
_USAGES = kinds_of("Usage")
_VALUES = kinds_of("AttributeUsage") | {"ReferenceUsage"}
_PORT_OWNERS = kinds_of("PortDefinition") | kinds_of("PortUsage")
RELATIONS = frozenset({"ReferenceSubsetting", "Redefinition", "Subsetting", "FeatureTyping"})
"""Kinds of relations that are checked."""
_DIRECTIONS = ("in", "out")
_Broken = tuple[Rule, Mapping[str, str | None]]
"""A rule, and the facts of its phrase."""


def check_references(model: Model, document: Document, node: Node, sink: Sink) -> None:
    """Report references to elements of another kind, direction or variation than required."""
    is_variation = bool(node.attributes.get("isVariation"))
    for relation, target in iter_stated(node, RELATIONS):
        broken: list[_Broken] = []
        if relation.kind == "ReferenceSubsetting":
            broken += _find_other_kind(node, relation, target)
        elif relation.kind == "Redefinition" and _has_other_direction(model, node, target):
            owner = model.name(target.owner) if target.owner else ""
            name = str(relation.reference)
            broken.append((OTHER_DIRECTION, {"name": name, "owner": owner}))
        # Usages; `specializations` checks definitions.
        if is_variation and target.attributes.get("isVariation"):
            facts_of_node = {"name": model.name(node) or node.kind, "owner": ""}
            broken.append((memberships.VARIATION_OF_VARIATION, facts_of_node))
        for broken_rule, facts in broken:
            place = make_subject(document, node, relation.reference.start)
            sink.report(broken_rule, place, notes=(), help="", cause="", **facts)


def refers_to_other_kind(node: Node) -> bool:
    """Whether ``check_references`` reports that a usage refers to one of another kind."""
    stated = iter_stated(node, frozenset({"ReferenceSubsetting"}))
    return any(True for stated_pair in stated for _ in _find_other_kind(node, *stated_pair))


def _find_other_kind(node: Node, relation: Relation, target: Node) -> Iterator[_Broken]:
    kinds, words = _REFERENCED_KINDS.get(node.kind, (_USAGES, ""))
    if target.kind in _USAGES and target.kind not in kinds:
        name = str(relation.reference)
        yield (
            OTHER_KIND,
            {
                "name": name,
                "found": describe_kind(target),
                "wanted": words,
                "advice": _advise_reference(node, target, name, words),
            },
        )


def _advise_reference(node: Node, target: Node, name: str, words: str) -> str:
    """Return what to write for a reference to an element of another kind than *words* says."""
    is_assignment = node.kind == "PerformActionUsage" and target.kind in _VALUES
    return f"to change it, write 'assign {name} := ...'" if is_assignment else f"reference {words}"


def _has_other_direction(model: Model, node: Node, target: Node) -> bool:
    """Whether a redefining feature has another direction than the redefined one."""
    general_direction, own_direction = (
        target.attributes.get("direction"),
        node.attributes.get("direction"),
    )
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


def check_usage(model: Model, document: Document, node: Node, sink: Sink) -> None:
    """Report a part of a port, and an individual with none or several individual types."""
    owner, name = node.owner, node.name or node.kind
    is_in_port = owner is not None and owner.kind in _PORT_OWNERS
    if is_in_port and node.kind != "PortUsage" and is_composite(node):
        place = make_subject(document, node, node.start)
        sink.report(PART_OF_PORT, place, name=name, owner=_name_of(model, owner))
    if node.attributes.get("isIndividual") and any(
        relation.kind == "FeatureTyping" for relation in node.relations
    ):
        types = [type_ for type_ in model.types(node) if type_.attributes.get("isIndividual")]
        if len(types) != 1:
            place = make_subject(document, node, node.start)
            sink.report(INDIVIDUAL, place, name=name, count=len(types))


def _name_of(model: Model, node: Node | None) -> str:
    return (model.name(node) or node.kind) if node is not None else ""


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
    """Return the uses of features that are not features of ``scope``."""
    return [use for use in uses if not _has_feature(model, scope, use[2])]
