"""Implied generalization: candidates by qualified name, and redefinition by position.

KerML 8.4, SysML 8.4. ``base_types`` has the tables. ``model`` decides which candidates are needed
beside the stated generals. Ends, parameters, results, subjects and objectives redefine features by
their position (KerML 8.4.4.1: checkFeatureEndRedefinition, checkFeatureParameterRedefinition,
checkFeatureResultRedefinition).
"""

from functools import cache

from sysmlc.language.metaclasses import FEATURES, GENERALS, TYPES, USAGES, is_composite, kinds_of
from sysmlc.language.names.base_types import (
    BASES,
    BINARY_BASES,
    MEMBERSHIP_BASES,
    NEGATED_BASES,
    OWNER_BASES,
    REDEFINING_MEMBERSHIPS,
)
from sysmlc.language.names.queries import GeneralizationQueries
from sysmlc.language.tree import Node

_FEATURE_MEMBERSHIPS = kinds_of("FeatureMembership")
_CASES = kinds_of("CaseDefinition") | kinds_of("CaseUsage")
_CONNECTORS = kinds_of("Connector") | kinds_of("Association")
_WITH_COUNT = _CONNECTORS | {"IfActionUsage"}
_PORTIONS = {
    "snapshot": "Occurrences::Occurrence::snapshots",
    "timeslice": "Occurrences::Occurrence::timeSlices",
}


def find_owning_type(node: Node) -> Node | None:
    """Return the type that owns ``node`` as its feature."""
    owner = node.owner
    owns = owner is not None and node.membership in _FEATURE_MEMBERSHIPS and owner.kind in TYPES
    return owner if owns else None


def is_part(node: Node) -> bool:
    """Whether a feature is composite."""
    return is_composite(node) if node.kind in USAGES else bool(node.attributes.get("isComposite"))


def _find_ends(node: Node) -> list[Node]:
    """Return the end features that a connector or association owns."""
    return [
        member
        for member in node.members
        if member.membership == "EndFeatureMembership" or member.attributes.get("isEnd")
    ]


_Key = tuple[object, ...]
_KEY_ATTRIBUTES = ("isNegated", "portionKind", "isEnd", "isReference", "direction", "isComposite")


def make_key(node: Node) -> _Key:
    """Return a key that is equal for nodes with the same candidates."""
    kind, owner, facts = node.kind, node.owner, node.attributes
    count = 0
    if kind in _WITH_COUNT:
        count = _count_clauses(node) if kind == "IfActionUsage" else len(_find_ends(node))
    attributes_in_key = tuple([facts.get(name) for name in _KEY_ATTRIBUTES]) if facts else ()
    return kind, node.membership, node.role, owner.kind if owner else "", count, attributes_in_key


def list_candidates(node: Node) -> list[tuple[str, str]]:
    """Return the relation and the qualified name of each candidate of ``node``."""
    kind = node.kind
    if kind not in TYPES:
        return []
    if kind not in FEATURES:
        return [("Subclassification", name) for name in _list_bases(node)]
    role = find_role_base(node) if node.membership not in REDEFINING_MEMBERSHIPS else None
    if node.role == "trigger":
        return []
    names = [*([role] if role else []), *_list_placed_bases(node), *_list_bases(node)]
    return [("Subsetting", name) for name in names]


def find_role_base(node: Node) -> str | None:
    """Return the qualified name of the base of a member by its membership and role."""
    membership = node.membership
    return MEMBERSHIP_BASES.get((membership, node.role)) or MEMBERSHIP_BASES.get((membership, ""))


def _list_bases(node: Node) -> list[str]:
    negated = NEGATED_BASES.get(node.kind) if node.attributes.get("isNegated") else None
    if negated:
        return [negated]
    if node.kind in _CONNECTORS:
        return _list_connector_bases(node)
    if node.kind == "IfActionUsage" and _count_clauses(node) > 2:
        return ["Actions::ifThenElseActions"]
    return list(_list_default_bases(node.kind))


def _count_clauses(node: Node) -> int:
    return sum(member.membership == "ParameterMembership" for member in node.members)


def _list_connector_bases(node: Node) -> list[str]:
    count = len(_find_ends(node))
    if node.kind == "FlowUsage" and count:
        return ["Flows::flows"]
    if node.kind == "Flow" and count:
        return ["Transfers::flowTransfers"]
    binary = BINARY_BASES.get(node.kind) if count == 2 else None
    return [binary] if binary else list(_list_default_bases(node.kind))


@cache
def _list_default_bases(kind: str) -> tuple[str, ...]:
    """Return the base type of a metaclass, else those of its nearest general metaclasses."""
    if kind in BASES:
        return (BASES[kind],)
    names = (name for general in GENERALS.get(kind, ()) for name in _list_default_bases(general))
    return tuple(dict.fromkeys(names))


@cache
def _list_owner_bases(kind: str, owner: str) -> tuple[tuple[str, bool], ...]:
    """Return the bases of a usage by its owner, each with whether the usage must be composite."""
    return tuple(
        (p.base, p.composite) for p in OWNER_BASES if kind in p.kinds and owner in p.owners
    )


def _list_placed_bases(node: Node) -> list[str]:
    portion = _PORTIONS.get(str(node.attributes.get("portionKind", "")))
    bases = [portion] if portion else []
    owner = find_owning_type(node)
    if owner is None:
        return bases
    if node.membership == "ActorMembership":
        owner_base = "Cases::Case" if owner.kind in _CASES else "Requirements::RequirementCheck"
        return [*bases, f"{owner_base}::actors"]
    owner_bases = _list_owner_bases(node.kind, owner.kind)
    is_composite_part = (
        bool(owner_bases) and any(needs for _, needs in owner_bases) and is_part(node)
    )
    return [*bases, *(base for base, needs in owner_bases if is_composite_part or not needs)]


# -- redefinition by position ------------------------------------------------------------------

_ROLES = {
    "EndFeatureMembership": "end",
    "ParameterMembership": "parameter",
    "ReturnParameterMembership": "result",
    "SubjectMembership": "subject",
    "ObjectiveMembership": "objective",
}
"""The positional role that a membership gives its member."""
_SINGLE = frozenset({"subject", "objective"})
"""Roles of one feature. A superfluous one redefines the same inherited feature."""
_BEHAVING = kinds_of("Behavior") | kinds_of("Step")
_WITHOUT_POSITIONS = kinds_of("InstantiationExpression")


def find_role(feature: Node) -> str:
    """Return the positional role of a feature; empty if its position has no meaning."""
    if feature.membership != "FeatureMembership":
        return _ROLES.get(feature.membership, "")
    if not feature.attributes or feature.kind not in FEATURES:
        return ""
    if feature.attributes.get("isEnd"):
        return "end"
    owner = feature.owner
    counted = "direction" in feature.attributes and owner is not None and owner.kind in _BEHAVING
    return "parameter" if counted else ""


def may_redefine_by_position(feature: Node) -> bool:
    """Whether a feature may redefine another one without stating it."""
    if feature.membership not in REDEFINING_MEMBERSHIPS and not find_role(feature):
        return False
    return "Redefinition" not in [relation.kind for relation in feature.relations]


def find_own_features(scope: Node, role: str) -> list[Node]:
    """Return the features of ``scope`` with this positional role, in the order of the text."""
    return [member for member in scope.members if find_role(member) == role]


def find_redefined(feature: Node, lookup: GeneralizationQueries) -> list[Node]:
    """Return the features that ``feature`` redefines by its position."""
    owner, role = feature.owner, find_role(feature)
    if not role or owner is None or owner.kind in _WITHOUT_POSITIONS:
        return []
    # A second subject redefines the same feature as the first one, and is reported as superfluous.
    index = 0 if role in _SINGLE else lookup.own_features_of_role(owner, role).index(feature)
    redefined: list[Node] = []
    for general in lookup.all_generals(owner):
        features = lookup.features_of_role(general, role)
        if index < len(features) and features[index] not in redefined:
            redefined.append(features[index])
    return [general_feature for general_feature in redefined if general_feature is not feature]


def gather_features(scope: Node, role: str, lookup: GeneralizationQueries) -> list[Node]:
    """Return the features of ``scope`` with this positional role, in the order of the text."""
    features = list(lookup.own_features_of_role(scope, role))
    for general in lookup.all_generals(scope):
        inherited = lookup.features_of_role(general, role)
        features += inherited[len(features) :]
    return features
