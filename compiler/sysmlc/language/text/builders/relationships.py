"""Relationships of KerML: owned ones, and those that are elements of their own (8.2.4)."""

from functools import partial

from sysmlc.language.metaclasses import RELATIONSHIP_ENDS
from sysmlc.language.text.builders.declarations import Names, build_relations, make_element
from sysmlc.language.text.builders.nodes import OWNING, add_members, omit_first
from sysmlc.language.text.lexer import Tokens
from sysmlc.language.tree import Node, Reference, Relation


def _build_relationship(
    kind: str,
    tokens: Tokens,
    names: Names | None,
    first: Reference,
    *remaining: Reference | list[Node],
) -> Node:
    """Build an element that is a relationship with two ends."""
    *_, second, body = remaining
    assert isinstance(second, Reference)
    assert isinstance(body, list)
    source, target = RELATIONSHIP_ENDS[kind]
    ends = [Relation(source, first), Relation(target, second)]
    return add_members(make_element(kind, OWNING, tokens, names, [*ends]), body)


def _build_chaining(_tokens: Tokens, chain: Reference) -> list[Relation]:
    """Build a feature chain: a relation to each of its links."""
    return [
        Relation("FeatureChaining", Reference((link,), chain.start, chain.end))
        for link in chain.chain
    ]


_build_featuring = partial(_build_relationship, "TypeFeaturing")
ACTIONS = {
    "specializations": partial(build_relations, "Specialization"),
    "conjugation_part": partial(build_relations, "Conjugation"),
    "disjoining_part": partial(build_relations, "Disjoining"),
    "unioning_part": partial(build_relations, "Unioning"),
    "intersecting_part": partial(build_relations, "Intersecting"),
    "differencing_part": partial(build_relations, "Differencing"),
    "chaining_part": _build_chaining,
    "inverting_part": partial(build_relations, "FeatureInverting"),
    "featuring_part": partial(build_relations, "TypeFeaturing"),
    "specialization": partial(_build_relationship, "Specialization"),
    "subclassification": partial(_build_relationship, "Subclassification"),
    "feature_typing": partial(_build_relationship, "FeatureTyping"),
    "subsetting": partial(_build_relationship, "Subsetting"),
    "redefinition": partial(_build_relationship, "Redefinition"),
    "conjugation": partial(_build_relationship, "Conjugation"),
    "disjoining": partial(_build_relationship, "Disjoining"),
    "feature_inverting": partial(_build_relationship, "FeatureInverting"),
    "named_type_featuring": _build_featuring,
    "type_featuring": omit_first(_build_featuring),
}
