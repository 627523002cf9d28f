"""Semantic metadata: an element with such metadata specialises its base type (KerML 8.4.4.13)."""

from typing import TYPE_CHECKING

from sysmlc.language.names.contents import FEATURES
from sysmlc.language.names.filters import UndecidedError, evaluate
from sysmlc.language.names.results import named
from sysmlc.language.tree import Node

if TYPE_CHECKING:
    from sysmlc.language.names.lookup import Lookup

METADATA = frozenset({"MetadataUsage", "MetadataFeature"})
"""Members that may say what their owner specialises."""


def bases(node: Node, lookup: "Lookup") -> list[tuple[str, Node]]:
    """Kind of relation and target of what ``node`` specialises because of its metadata."""
    found: list[tuple[str, Node]] = []
    for member in node.members:
        if member.kind in METADATA:
            base = _base(member, lookup)
            if base is not None:
                found += _relations(node, base, lookup)
    return found


def _base(metadata: Node, lookup: "Lookup") -> Node | None:
    """The element that the ``baseType`` of a metadata usage names."""
    for feature in lookup.inside(metadata, "baseType"):
        for value in feature.members:
            if value.membership == "FeatureValue":
                return _named(value, metadata, lookup)
    return None


def _named(value: Node, metadata: Node, lookup: "Lookup") -> Node | None:
    """``x meta M`` names x; a conditional names what its condition about the element chooses."""
    while value.kind == "OperatorExpression" and value.members:
        chosen = 0
        if value.facts.get("operator") == "if":
            chosen = 1 if _holds(value.members[0], metadata, lookup) else 2
        if chosen >= len(value.members):
            return None
        value = value.members[chosen]
    return named(value, lookup)


def _holds(condition: Node, metadata: Node, lookup: "Lookup") -> bool:
    try:
        return metadata.owner is not None and evaluate(condition, metadata.owner, lookup) is True
    except UndecidedError:
        return False


def _relations(node: Node, base: Node, lookup: "Lookup") -> list[tuple[str, Node]]:
    if node.kind in FEATURES:
        return [("Subsetting" if base.kind in FEATURES else "FeatureTyping", base)]
    if base.kind not in FEATURES:
        return [("Subclassification", base)]
    types = (general for general in lookup.generals(base) if general.kind not in FEATURES)
    return [("Subclassification", general) for general in types]
