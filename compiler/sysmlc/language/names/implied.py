"""What an element specialises though its text does not say so: the candidates, by name.

The tables are in ``bases``; which candidates are needed beside the written ones, ``model`` decides.
"""

from functools import cache

from sysmlc.language.metaclasses import GENERALS, USAGES, is_composite, kinds_of
from sysmlc.language.names.base_types import (
    BASES,
    BINARY,
    BY_MEMBERSHIP,
    NEGATED,
    PLACES,
    REDEFINED_BY_MEMBERSHIP,
)
from sysmlc.language.names.symbols import FEATURES, TYPES
from sysmlc.language.tree import Node

_FEATURE_MEMBERSHIPS = kinds_of("FeatureMembership")
_CASES = kinds_of("CaseDefinition") | kinds_of("CaseUsage")
_CONNECTORS = kinds_of("Connector") | kinds_of("Association")
_COUNTED = _CONNECTORS | {"IfActionUsage"}
_PORTIONS = {
    "snapshot": "Occurrences::Occurrence::snapshots",
    "timeslice": "Occurrences::Occurrence::timeSlices",
}


def owning_type(node: Node) -> Node | None:
    """The type that owns ``node`` as its feature."""
    owner = node.owner
    owns = owner is not None and node.membership in _FEATURE_MEMBERSHIPS and owner.kind in TYPES
    return owner if owns else None


def is_part(node: Node) -> bool:
    """Whether the values of a feature are parts of what has it."""
    return is_composite(node) if node.kind in USAGES else bool(node.attributes.get("isComposite"))


def ends(node: Node) -> list[Node]:
    """The end features that a connector or association owns."""
    return [
        member
        for member in node.members
        if member.membership == "EndFeatureMembership" or member.attributes.get("isEnd")
    ]


_Like = tuple[object, ...]
_FACTS = ("isNegated", "portionKind", "isEnd", "isReference", "direction", "isComposite")


def like(node: Node) -> _Like:
    """What the candidates of ``node`` follow from: equal for nodes that have the same ones."""
    kind, owner, facts = node.kind, node.owner, node.attributes
    counted = 0
    if kind in _COUNTED:
        counted = _clauses(node) if kind == "IfActionUsage" else len(ends(node))
    said = tuple([facts.get(name) for name in _FACTS]) if facts else ()
    return kind, node.membership, node.role, owner.kind if owner else "", counted, said


def candidates(node: Node) -> list[tuple[str, str]]:
    """Kind of relation and qualified name of what ``node`` may implicitly specialise."""
    kind = node.kind
    if kind not in TYPES:
        return []
    if kind not in FEATURES:
        return [("Subclassification", name) for name in _bases(node)]
    role = by_role(node) if node.membership not in REDEFINED_BY_MEMBERSHIP else None
    if node.role == "trigger":
        return []
    names = [*([role] if role else []), *_placed(node), *_bases(node)]
    return [("Subsetting", name) for name in names]


def by_role(node: Node) -> str | None:
    """The feature that a member specialises because of its membership and role, by name."""
    membership = node.membership
    return BY_MEMBERSHIP.get((membership, node.role)) or BY_MEMBERSHIP.get((membership, ""))


def _bases(node: Node) -> list[str]:
    negated = NEGATED.get(node.kind) if node.attributes.get("isNegated") else None
    if negated:
        return [negated]
    if node.kind in _CONNECTORS:
        return _connector(node)
    if node.kind == "IfActionUsage" and _clauses(node) > 2:
        return ["Actions::ifThenElseActions"]
    return list(_defaults(node.kind))


def _clauses(node: Node) -> int:
    return sum(member.membership == "ParameterMembership" for member in node.members)


def _connector(node: Node) -> list[str]:
    count = len(ends(node))
    if node.kind == "FlowUsage" and count:
        return ["Flows::flows"]
    if node.kind == "Flow" and count:
        return ["Transfers::flowTransfers"]
    binary = BINARY.get(node.kind) if count == 2 else None
    return [binary] if binary else list(_defaults(node.kind))


@cache
def _defaults(kind: str) -> tuple[str, ...]:
    """The bases of the nearest metaclasses that have one."""
    if kind in BASES:
        return (BASES[kind],)
    names = (name for general in GENERALS.get(kind, ()) for name in _defaults(general))
    return tuple(dict.fromkeys(names))


@cache
def _places(kind: str, owner: str) -> tuple[tuple[str, bool], ...]:
    """The bases of a usage in an owner of that kind, and whether it must be a part for them."""
    return tuple((p.base, p.composite) for p in PLACES if kind in p.kinds and owner in p.owners)


def _placed(node: Node) -> list[str]:
    portion = _PORTIONS.get(str(node.attributes.get("portionKind", "")))
    found = [portion] if portion else []
    owner = owning_type(node)
    if owner is None:
        return found
    if node.membership == "ActorMembership":
        inside = "Cases::Case" if owner.kind in _CASES else "Requirements::RequirementCheck"
        return [*found, f"{inside}::actors"]
    places = _places(node.kind, owner.kind)
    part = bool(places) and any(needs for _, needs in places) and is_part(node)
    return [*found, *(base for base, needs in places if part or not needs)]
