"""Features that redefine others by position: ends, parameters, results, subjects, objectives.

KerML 8.4.4.1 (checkFeatureEndRedefinition, checkFeatureParameterRedefinition,
checkFeatureResultRedefinition), SysML 8.4 (subject and objective).
"""

from sysmlc.language.metaclasses import FEATURES, kinds_of
from sysmlc.language.names.base_types import REDEFINING_MEMBERSHIPS
from sysmlc.language.names.queries import GeneralizationQueries
from sysmlc.language.tree import Node

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
    """Return the features of ``scope`` with a role, in the order of the text."""
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
    """Return the features of ``scope`` with a role, inherited ones after its own."""
    features = list(lookup.own_features_of_role(scope, role))
    for general in lookup.all_generals(scope):
        inherited = lookup.features_of_role(general, role)
        features += inherited[len(features) :]
    return features
