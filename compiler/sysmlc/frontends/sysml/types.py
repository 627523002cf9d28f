"""Types of features: stated, or those of what they redefine or subset (KerML 1.0, 8.3.3.3.4)."""

from typing import TYPE_CHECKING

from sysmlc.language.tree import Node

if TYPE_CHECKING:
    from sysmlc.frontends.sysml.lowering import Lowering

_TYPES = frozenset({"FeatureTyping", "ConjugatedPortTyping"})
_FEATURES = frozenset({"Redefinition", "Subsetting", "ReferenceSubsetting"})


def types_of(low: "Lowering", node: Node) -> list[Node]:
    """Return the definitions that type a feature: its own or those of the features above it.

    The search is depth-first and follows a chain of redefinitions of any length.
    """
    types: dict[int, Node] = {}
    visited: set[int] = set()
    pending = [node]
    while pending:
        feature = pending.pop()
        if id(feature) in visited:
            continue
        visited.add(id(feature))
        typings = [relation for relation in feature.relations if relation.kind in _TYPES]
        for relation in typings:
            type_ = low.target(feature, relation)
            if type_ is not None:
                types.setdefault(id(type_), type_)
        if not typings:
            targets = [low.target(feature, r) for r in feature.relations if r.kind in _FEATURES]
            pending += [target for target in reversed(targets) if target is not None]
    return list(types.values())
