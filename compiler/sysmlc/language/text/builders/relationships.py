"""Relationships of KerML: owned ones, and those that are elements of their own (8.2.4)."""

from collections.abc import Callable

from sysmlc.language.text.builders.declarations import Names, apply_names
from sysmlc.language.text.builders.nodes import OWNING, add_members, make_node
from sysmlc.language.text.lexer import Tokens
from sysmlc.language.tree import Node, Reference, Relation


def _pass_on_name(_tokens: Tokens, _stop: int, _begin: int, names: Names | None) -> Names | None:
    return names


def _make_relations_builder(kind: str) -> Callable[..., list[Relation]]:
    """Return a builder of one relation to each of the names after a keyword."""

    def relations(
        _tokens: Tokens, _stop: int, _begin: int, names: Reference | list[Reference]
    ) -> list[Relation]:
        references = names if isinstance(names, list) else [names]
        return [Relation(kind, name) for name in references]

    return relations


def _make_relationship_builder(kind: str, source: str, target: str) -> Callable[..., Node]:
    """Return a builder of an element that is a relationship with two ends."""

    def relationship(
        tokens: Tokens,
        stop: int,
        begin: int,
        names: Names | None,
        first: Reference,
        *remaining: Reference | list[Node],
    ) -> Node:
        node = apply_names(make_node(kind, OWNING, tokens, begin, stop), names, tokens)
        node.relations.append(Relation(source, first))
        *_, second, body = remaining
        assert isinstance(second, Reference)
        assert isinstance(body, list)
        node.relations.append(Relation(target, second))
        return add_members(node, body)

    return relationship


_build_named_featuring = _make_relationship_builder(
    "TypeFeaturing", "featureOfType", "featuringType"
)


def _build_featuring(
    tokens: Tokens, stop: int, begin: int, first: Reference, second: Reference, body: list[Node]
) -> Node:
    return _build_named_featuring(tokens, stop, begin, None, first, second, body)


def _build_chaining(_tokens: Tokens, _stop: int, _begin: int, chain: Reference) -> list[Relation]:
    """Build a feature chain: a relation to each of its links."""
    return [
        Relation("FeatureChaining", Reference((link,), chain.start, chain.end))
        for link in chain.chain
    ]


ACTIONS = {
    "relationship_name": _pass_on_name,
    "of": _pass_on_name,
    "specializations": _make_relations_builder("Specialization"),
    "conjugation_part": _make_relations_builder("Conjugation"),
    "disjoining_part": _make_relations_builder("Disjoining"),
    "unioning_part": _make_relations_builder("Unioning"),
    "intersecting_part": _make_relations_builder("Intersecting"),
    "differencing_part": _make_relations_builder("Differencing"),
    "chaining_part": _build_chaining,
    "inverting_part": _make_relations_builder("FeatureInverting"),
    "featuring_part": _make_relations_builder("TypeFeaturing"),
    "specialization": _make_relationship_builder("Specialization", "specific", "general"),
    "subclassification": _make_relationship_builder(
        "Subclassification", "subclassifier", "superclassifier"
    ),
    "feature_typing": _make_relationship_builder("FeatureTyping", "typedFeature", "type"),
    "subsetting": _make_relationship_builder("Subsetting", "subsettingFeature", "subsettedFeature"),
    "redefinition": _make_relationship_builder(
        "Redefinition", "redefiningFeature", "redefinedFeature"
    ),
    "conjugation": _make_relationship_builder("Conjugation", "conjugatedType", "originalType"),
    "disjoining": _make_relationship_builder("Disjoining", "typeDisjoined", "disjoiningType"),
    "feature_inverting": _make_relationship_builder(
        "FeatureInverting", "featureInverted", "invertingFeature"
    ),
    "named_type_featuring": _build_named_featuring,
    "type_featuring": _build_featuring,
}
