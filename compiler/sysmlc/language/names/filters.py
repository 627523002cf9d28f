"""Filters of imports: conditions about metadata, decided where they are constant (KerML 8.3.2.4.3)."""

from typing import TYPE_CHECKING

from sysmlc.language.tree import Node

if TYPE_CHECKING:
    from sysmlc.language.names.lookup import Lookup

_Truth = bool | None
"""None: not decided here, so nothing is kept out."""
_METADATA = frozenset({"MetadataUsage", "MetadataFeature"})


def passes(condition: Node, hit: Node, lookup: "Lookup") -> bool:
    """Whether a member may be imported; one that is not decided may."""
    element = lookup.element(hit)
    return element is None or _holds(condition, element, lookup) is not False


def _holds(condition: Node, element: Node, lookup: "Lookup") -> _Truth:
    operator = condition.facts.get("operator")
    operands = [m for m in condition.members if m.membership == "ParameterMembership"]
    if operator in ("and", "&"):
        return _both([_holds(o, element, lookup) for o in operands])
    if operator in ("or", "|"):
        found = _both([_negated(_holds(o, element, lookup)) for o in operands])
        return _negated(found)
    if operator == "not" and operands:
        return _negated(_holds(operands[0], element, lookup))
    if operator in ("@", "hastype", "istype"):
        return _classified(condition, element, lookup)
    return _value(condition, element, lookup)


def _both(truths: list[_Truth]) -> _Truth:
    if False in truths:
        return False
    return None if None in truths else True


def _negated(truth: _Truth) -> _Truth:
    return None if truth is None else not truth


def _classified(condition: Node, element: Node, lookup: "Lookup") -> _Truth:
    """``@M``: the element has metadata of that type, or its metaclass is that one."""
    for member in condition.members:
        for relation in member.relations:
            if relation.kind == "FeatureTyping":
                wanted = lookup.target(member, relation)
                return None if wanted is None else _has(element, wanted, lookup)
    return None


def _has(element: Node, wanted: Node, lookup: "Lookup") -> _Truth:
    package = wanted.owner.owner if wanted.owner and wanted.owner.owner else wanted.owner
    if package is not None and package.name in ("SysML", "KerML"):
        from sysmlc.language.metaclasses import is_a

        return is_a(element.kind, wanted.name or "")
    return any(lookup.conforms(m, wanted) for m in metadata(element))


def metadata(element: Node) -> list[Node]:
    """The metadata that an element owns."""
    return [member for member in element.members if member.kind in _METADATA]


def _value(condition: Node, element: Node, lookup: "Lookup") -> _Truth:
    """``M::x``: the literal that the element's metadata gives to a Boolean attribute."""
    for relation in condition.relations:
        if relation.kind == "Membership":
            feature = lookup.target(condition, relation)
            return None if feature is None else _given(feature, element, lookup)
    value = condition.facts.get("value")
    return value if isinstance(value, bool) else None


def _given(feature: Node, element: Node, lookup: "Lookup") -> _Truth:
    for usage in metadata(element):
        for member in usage.members:
            if feature in lookup.redefined(member):
                return _literal(member)
        if feature.owner is not None and lookup.conforms(usage, feature.owner):
            return _literal(feature)
    return False


def _literal(feature: Node) -> _Truth:
    for member in feature.members:
        if member.membership == "FeatureValue":
            value = member.facts.get("value")
            return value if isinstance(value, bool) else None
    return None
