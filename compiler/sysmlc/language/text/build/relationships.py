"""Relationships of KerML: owned ones, and those that stand for themselves (8.2.4)."""

from collections.abc import Callable

from sysmlc.language.text.build.names import Names, call
from sysmlc.language.text.build.owning import OWNING, made, own
from sysmlc.language.text.scan import Tokens
from sysmlc.language.tree import Node, Reference, Relation


def _name(_tokens: Tokens, _at: int, _begin: int, names: Names | None) -> Names | None:
    return names


def _each(kind: str) -> Callable[..., list[Relation]]:
    """Of names after a word: a relationship to each."""

    def relations(
        _tokens: Tokens, _at: int, _begin: int, names: Reference | list[Reference]
    ) -> list[Relation]:
        given = names if isinstance(names, list) else [names]
        return [Relation(kind, name) for name in given]

    return relations


def _between(kind: str, source: str, target: str) -> Callable[..., Node]:
    """An element that is a relationship, with the names of its ends."""

    def relationship(
        tokens: Tokens,
        at: int,
        begin: int,
        names: Names | None,
        first: Reference,
        *rest: Reference | list[Node],
    ) -> Node:
        node = call(made(kind, OWNING, tokens, begin, at), names, tokens)
        node.relations.append(Relation(source, first))
        *_, second, body = rest
        assert isinstance(second, Reference)
        assert isinstance(body, list)
        node.relations.append(Relation(target, second))
        return own(node, body)

    return relationship


_named_featuring = _between("TypeFeaturing", "featureOfType", "featuringType")


def _featuring(
    tokens: Tokens, at: int, begin: int, first: Reference, second: Reference, body: list[Node]
) -> Node:
    return _named_featuring(tokens, at, begin, None, first, second, body)


def _chaining(_tokens: Tokens, _at: int, _begin: int, chain: Reference) -> list[Relation]:
    """A feature is a chain itself: a relationship to each link."""
    return [
        Relation("FeatureChaining", Reference((link,), chain.start, chain.end))
        for link in chain.chain
    ]


ACTIONS = {
    "relationship_name": _name,
    "of": _name,
    "specializations": _each("Specialization"),
    "conjugation_part": _each("Conjugation"),
    "disjoining_part": _each("Disjoining"),
    "unioning_part": _each("Unioning"),
    "intersecting_part": _each("Intersecting"),
    "differencing_part": _each("Differencing"),
    "chaining_part": _chaining,
    "inverting_part": _each("FeatureInverting"),
    "featuring_part": _each("TypeFeaturing"),
    "specialization": _between("Specialization", "specific", "general"),
    "subclassification": _between("Subclassification", "subclassifier", "superclassifier"),
    "feature_typing": _between("FeatureTyping", "typedFeature", "type"),
    "subsetting": _between("Subsetting", "subsettingFeature", "subsettedFeature"),
    "redefinition": _between("Redefinition", "redefiningFeature", "redefinedFeature"),
    "conjugation": _between("Conjugation", "conjugatedType", "originalType"),
    "disjoining": _between("Disjoining", "typeDisjoined", "disjoiningType"),
    "feature_inverting": _between("FeatureInverting", "featureInverted", "invertingFeature"),
    "named_type_featuring": _named_featuring,
    "type_featuring": _featuring,
}
