"""Types, features, prefixes and members of KerML (8.2.3.4, 8.2.4, 8.2.5)."""

from functools import partial

from sysmlc.language.text.builders.connections import (
    End,
    Tail,
    build_tail_of_ends,
    build_usage_with_tail,
)
from sysmlc.language.text.builders.declarations import (
    Names,
    Parts,
    apply_names,
    make_element,
    make_multiplicity,
)
from sysmlc.language.text.builders.definitions import (
    Keyword,
    build_keywordless,
    finish_usage,
    join_words,
    read_keyword,
)
from sysmlc.language.text.builders.namespaces import (
    build_metadata,
    build_namespace,
    build_prefix_metadata,
)
from sysmlc.language.text.builders.nodes import FEATURE, OWNING, add_members, omit_first
from sysmlc.language.text.builders.usages import (
    apply_prefixes,
    build_cross_feature,
    build_crossed,
    build_prefixed_nothing,
    build_return,
)
from sysmlc.language.text.lexer import Tokens
from sysmlc.language.tree import Node, Reference, Relation

_TYPE_KINDS = {
    "type": "Type",
    "classifier": "Classifier",
    "datatype": "DataType",
    "class": "Class",
    "struct": "Structure",
    "metaclass": "Metaclass",
    "assoc": "Association",
    "assoc struct": "AssociationStructure",
    "interaction": "Interaction",
    "behavior": "Behavior",
    "function": "Function",
    "predicate": "Predicate",
}
_FEATURE_KINDS = {
    "feature": "Feature",
    "step": "Step",
    "expr": "Expression",
    "bool": "BooleanExpression",
    "inv": "Invariant",
    "connector": "Connector",
    "succession": "Succession",
    "flow": "Flow",
    "succession flow": "SuccessionFlow",
}


def _build_type(
    tokens: Tokens,
    keyword: Keyword,
    sufficient: int | None,
    names: Names | None,
    parts: Parts,
    body: list[Node],
) -> Node:
    kind = _TYPE_KINDS[read_keyword(tokens, keyword)]
    node = _mark_sufficient(make_element(kind, OWNING, tokens, names, parts), sufficient)
    # A specialisation between classifiers is a subclassification.
    if kind != "Type":
        for relation in node.relations:
            if relation.kind == "Specialization":
                relation.kind = "Subclassification"
    return add_members(node, body)


def _mark_sufficient(node: Node, sufficient: int | None) -> Node:
    if sufficient is not None:
        node.attributes["isSufficient"] = True
    return node


def _build_declaration(
    tokens: Tokens,
    keyword: Keyword,
    sufficient: int | None,
    names: Names | None = None,
    parts: Parts = None,
    value: Node | None = None,
) -> Node:
    keywords = read_keyword(tokens, keyword).removesuffix(" true")
    kind = _FEATURE_KINDS[keywords.removesuffix(" false")]
    node = make_element(kind, FEATURE, tokens, names, parts, value)
    if keywords.endswith(" false"):
        node.attributes["isNegated"] = True
    return _mark_sufficient(node, sufficient)


def _build_connector(
    tokens: Tokens, keyword: Keyword, sufficient: int | None, ends: list[End], body: list[Node]
) -> Node:
    node = _build_declaration(tokens, keyword, sufficient)
    return build_usage_with_tail(tokens, node, Tail(ends=ends), body)


def _build_named_connector(tokens: Tokens, node: Node, ends: list[End], body: list[Node]) -> Node:
    return build_usage_with_tail(tokens, node, Tail(ends=ends), body)


def _build_binding(
    tokens: Tokens,
    sufficient: int | None,
    heading: tuple[Names | None, Parts] | None,
    ends: list[End] | None,
    body: list[Node],
) -> Node:
    names, parts = heading or (None, None)
    node = make_element("BindingConnector", FEATURE, tokens, names, parts)
    tail = Tail(ends=ends or [])
    return build_usage_with_tail(tokens, _mark_sufficient(node, sufficient), tail, body)


def _build_multiplicity_range(
    tokens: Tokens, names: Names | None, bounds: Node, body: list[Node]
) -> Node:
    return add_members(apply_names(make_multiplicity(bounds, tokens), names, tokens), body)


def _build_multiplicity_subset(
    tokens: Tokens, names: Names | None, subset: Reference, body: list[Node]
) -> Node:
    parts: Parts = [Relation("Subsetting", subset)]
    return add_members(make_element("Multiplicity", OWNING, tokens, names, parts), body)


def _build_sufficient_feature(
    tokens: Tokens, names: Names, parts: Parts, value: Node | None, body: list[Node]
) -> Node:
    node = build_keywordless("Feature", tokens, names, parts, value, body)
    return _mark_sufficient(node, tokens.begin)


_build_keywordless_feature = partial(build_keywordless, "Feature")
_build_cross = partial(build_cross_feature, "Feature")
ACTIONS = {
    "inv": join_words,
    "assoc_struct": join_words,
    "succession_flow": join_words,
    "type": _build_type,
    "declared_all": _build_declaration,
    "usage": finish_usage,
    "usage_ends": _build_connector,
    "declared_many_ends": _build_named_connector,
    "binding": _build_binding,
    "namespace": partial(build_namespace, "Namespace"),
    "first_between": partial(build_tail_of_ends, "", "then"),
    "multiplicity_range": _build_multiplicity_range,
    "multiplicity_subset": _build_multiplicity_subset,
    "prefixed": apply_prefixes,
    "prefixed_loose": apply_prefixes,
    "prefixed_nothing": partial(build_prefixed_nothing, "Feature", apply_prefixes),
    "loose": _build_keywordless_feature,
    "loose_all": _build_sufficient_feature,
    "loose_nameless": omit_first(_build_keywordless_feature),
    "loose_value": omit_first(_build_keywordless_feature, 2),
    "cross": _build_cross,
    "cross_nameless": omit_first(_build_cross),
    "crossed": partial(build_crossed, apply_prefixes),
    "crossed_loose": partial(build_crossed, apply_prefixes),
    "metadata": partial(build_metadata, "MetadataFeature"),
    "prefix_metadata": partial(build_prefix_metadata, "MetadataFeature"),
    "return": build_return,
}
