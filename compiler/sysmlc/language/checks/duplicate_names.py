"""Distinct names: members of a namespace have different names (KerML 8.3.2.4)."""

from collections.abc import Iterator

from sysmlc.diagnostics import Severity, rule
from sysmlc.language.checks.findings import DECLARED_TYPES, Finding, name_of
from sysmlc.language.metaclasses import kinds_of
from sysmlc.language.names import Model
from sysmlc.language.names.implied import find_role
from sysmlc.language.names.members import is_in_library
from sysmlc.language.tree import Node

DUPLICATE = rule(
    "SM280",
    "same-name",
    Severity.WARNING,
    "'{owner}' has {count} members with the name '{name}'",
    help="{advice}",
)
HIDING = rule(
    "SM284",
    "hides-inherited",
    Severity.WARNING,
    "'{name}' of '{owner}' hides the '{name}' that it inherits from '{general}'",
    help="redefine the inherited feature (':>> {name}'), or give the new feature another name",
)
HIDING_LIBRARY = rule(
    "SM648",
    "hides-library-feature",
    Severity.WARNING,
    "'{name}' of '{owner}' is a new feature; it gives no value to the '{name}' of the library's "
    "'{general}'",
    help="redefine the inherited feature (':>> {name}'), or give the new feature another name",
)
_DISTINGUISH = "give them different names, or remove all but one"
_ATTRIBUTES = kinds_of("AttributeUsage") | {"ReferenceUsage"}
_BEHAVIOURS = kinds_of("ActionDefinition") | kinds_of("ActionUsage")
NEW_FEATURE = rule(
    "SM292",
    "value-of-new-feature",
    Severity.WARNING,
    "'{name}' of '{owner}' is a new feature; it changes nothing of the '{name}' of '{outer}'",
    help="to change that one, write 'assign {name} := ...;'; for a new feature, write its kind: "
    "'attribute {name} ...'",
)
MEMBERSHIPS = frozenset({"FeatureMembership", "OwningMembership", "EndFeatureMembership"})
"""Memberships of checked members. Parameters of cases are those of the included case."""
_METADATA = kinds_of("MetadataFeature")
"""Their bodies give values to attributes and declare nothing (SysML 2.0, 8.2.2.27)."""


def check_names(model: Model, node: Node) -> Iterator[Finding]:
    """Report members that share a name or short name."""
    members_by_name: dict[str, list[Node]] = {}
    for member in node.members:
        for name in dict.fromkeys(filter(None, (member.name, member.short_name))):
            members_by_name.setdefault(name, []).append(member)
    for name, members in members_by_name.items():
        if len(members) > 1:
            bare = [member for member in members if _is_bare(member)]
            advice = _advise_bare(name, node) if bare else _DISTINGUISH
            for member in bare if 0 < len(bare) < len(members) else members:
                facts = {"owner": name_of(model, node), "count": str(len(members)), "name": name}
                yield Finding(DUPLICATE, member.name_start, facts | {"advice": advice})


def check_new_features(model: Model, node: Node) -> Iterator[Finding]:
    """Report members such as ``n := n + 1;`` of an action that an attribute around it hides."""
    for member in node.members:
        has_value = any(part.membership == "FeatureValue" for part in member.members)
        if not has_value or not _is_bare(member) or member.name is None:
            continue
        outer = _find_outer_feature(node, member.name)
        if outer is not None and not any(True for _ in model.lookup.inherited(node, member.name)):
            facts = {"owner": name_of(model, node), "name": member.name, "outer": outer}
            yield Finding(NEW_FEATURE, member.name_start, facts)


def _find_outer_feature(node: Node, name: str) -> str | None:
    """Return the name of the innermost element around a step that owns an attribute *name*."""
    scope = node.owner
    while scope is not None and scope.owner is not None:
        for member in scope.members:
            if member.name == name and member.kind in _ATTRIBUTES:
                return scope.name or scope.kind
        scope = scope.owner
    return None


def _is_bare(member: Node) -> bool:
    """Whether a member is declared by its name without a keyword: ``x = 3;``, ``x;``."""
    return member.kind == "ReferenceUsage" and member.start == member.name_start


def _advise_bare(name: str, owner: Node) -> str:
    """Return what to write in place of a declaration that is probably not meant as one."""
    if owner.kind in _BEHAVIOURS:
        return (
            f"a name without a keyword declares a new feature: write 'assign {name} := ...;' to "
            f"change the value, 'then {name};' to perform an action"
        )
    return f"a name without a keyword declares a new feature: write '{name}' once, with its value"


def check_inherited(model: Model, node: Node) -> Iterator[Finding]:
    """Report members with the name of an inherited member that they do not redefine.

    Names such as `start` or `shape` that everything inherits from the standard library may be
    reused, but not those of other libraries, whose features are there to be redefined.
    Parameters of steps are those of the performed behaviour, by position or name (see
    ``behaviors``).
    """
    inherited_members = model.lookup.inherited
    # Metadata bodies redefine attributes by name.
    if node.owner is not None and (node.owner.kind in _METADATA or node.kind in _METADATA):
        return
    for member in node.members:
        name = member.name
        if name is None or member.membership not in MEMBERSHIPS or find_role(member) == "parameter":
            continue
        for hit in inherited_members(node, name):
            is_meant = hit.name in (name, None) and not _is_in_standard_library(hit)
            if is_meant and not _redefines(model, member, hit):
                general = name_of(model, hit.owner)
                facts = {"owner": name_of(model, node), "name": name, "general": general}
                rule = HIDING_LIBRARY if is_in_library(hit) else HIDING
                yield Finding(rule, member.name_start, facts)
                break


def _is_in_standard_library(node: Node) -> bool:
    owners = [node]
    while owners[-1].owner is not None:
        owners.append(owners[-1].owner)
    return any(owner.attributes.get("isStandard") for owner in owners)


def _redefines(model: Model, member: Node, hit: Node) -> bool:
    """Whether a member redefines an inherited one, or a feature that the inherited one redefines.

    KerML 1.0, 8.3.3.1.10, removeRedefinedFeatures. The inherited member may be an alias.
    """
    element, redefined = model.lookup.resolve_alias(hit), model.lookup.redefined_features(member)
    if element is None or element is member or element in redefined:
        return True
    return bool(redefined) and not redefined.isdisjoint(model.lookup.redefined_features(element))


CHECKS = (
    (_BEHAVIOURS, check_new_features),
    (kinds_of("Namespace"), check_names),
    (DECLARED_TYPES, check_inherited),
)
