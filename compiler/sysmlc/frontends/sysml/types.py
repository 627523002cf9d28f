"""Types of features: stated, or those of what they redefine or subset (KerML 1.0, 8.3.3.3.4)."""

from typing import TYPE_CHECKING

from sysmlc.language.tree import Node

if TYPE_CHECKING:
    from sysmlc.frontends.sysml.lowering import Lowering

_TYPES = frozenset({"FeatureTyping", "ConjugatedPortTyping"})
_FEATURES = frozenset({"Redefinition", "Subsetting", "ReferenceSubsetting"})


def types_of(low: "Lowering", node: Node) -> list[Node]:
    """Definitions that type a feature, those that it inherits when it states none."""
    return _types(low, node, set()) if node.relations else []


def _types(low: "Lowering", node: Node, seen: set[int]) -> list[Node]:
    if id(node) in seen:
        return []
    seen.add(id(node))
    for relation in node.relations:
        if relation.kind in _TYPES:
            stated = [low.target(node, one) for one in node.relations if one.kind in _TYPES]
            return [one for one in stated if one is not None]
    inherited: dict[int, Node] = {}
    for relation in node.relations:
        general = low.target(node, relation) if relation.kind in _FEATURES else None
        for type_ in () if general is None else _types(low, general, seen):
            inherited.setdefault(id(type_), type_)
    return list(inherited.values())
