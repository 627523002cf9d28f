"""Features that redefine others by their position: ends, parameters, results, subjects.

KerML 8.4.4.1 (checkFeatureEndRedefinition, checkFeatureParameterRedefinition,
checkFeatureResultRedefinition), SysML 8.4 (subject and objective).
"""

from sysmlc.language.metaclasses import kinds_of
from sysmlc.language.names.base_types import REDEFINED_BY_MEMBERSHIP
from sysmlc.language.names.queries import GeneralizationQueries
from sysmlc.language.names.symbols import FEATURES
from sysmlc.language.tree import Node

_ROLES = {
    "EndFeatureMembership": "end",
    "ParameterMembership": "parameter",
    "ReturnParameterMembership": "result",
    "SubjectMembership": "subject",
    "ObjectiveMembership": "objective",
}
"""How a membership makes its member redefine others."""
_SINGLE = frozenset({"subject", "objective"})
"""Roles of one feature: what an owner has too many of redefines the first of its generals too."""
_BEHAVING = kinds_of("Behavior") | kinds_of("Step")
_SKIPPED = kinds_of("InstantiationExpression")


def role(feature: Node) -> str:
    """Among which features of its owner a feature is counted; empty for one that is not."""
    if feature.membership != "FeatureMembership":
        return _ROLES.get(feature.membership, "")
    if not feature.attributes or feature.kind not in FEATURES:
        return ""
    if feature.attributes.get("isEnd"):
        return "end"
    owner = feature.owner
    counted = "direction" in feature.attributes and owner is not None and owner.kind in _BEHAVING
    return "parameter" if counted else ""


def counts(feature: Node) -> bool:
    """Whether a feature may redefine another though the text does not say so."""
    if feature.membership not in REDEFINED_BY_MEMBERSHIP and not role(feature):
        return False
    return "Redefinition" not in [one.kind for one in feature.relations]


def own(scope: Node, wanted: str) -> list[Node]:
    """The features of ``scope`` with that role, in the order of the text."""
    return [member for member in scope.members if role(member) == wanted]


def redefined(feature: Node, lookup: GeneralizationQueries) -> list[Node]:
    """What a feature without a written redefinition redefines by its position."""
    owner, wanted = feature.owner, role(feature)
    if not wanted or owner is None or owner.kind in _SKIPPED:
        return []
    index = 0 if wanted in _SINGLE else lookup.own_of_role(owner, wanted).index(feature)
    found: list[Node] = []
    for general in lookup.all_generals(owner):
        features = lookup.at_positions(general, wanted)
        if index < len(features) and features[index] not in found:
            found.append(features[index])
    return [one for one in found if one is not feature]


def gather(scope: Node, wanted: str, lookup: GeneralizationQueries) -> list[Node]:
    """The features of ``scope`` with that role, those that it inherits after its own."""
    features = list(lookup.own_of_role(scope, wanted))
    for general in lookup.all_generals(scope):
        inherited = lookup.at_positions(general, wanted)
        features += inherited[len(features) :]
    return features
