"""Types, features, prefixes and members of KerML (8.2.3.4, 8.2.4, 8.2.5)."""

from collections.abc import Callable
from typing import ParamSpec

from sysmlc.language.text.builders import definitions, usages
from sysmlc.language.text.builders.connections import (
    ConnectorPart,
    End,
    Tail,
    apply_tail,
    split_ends_and_body,
)
from sysmlc.language.text.builders.declarations import (
    Names,
    SpecializationPart,
    apply_names,
    apply_specializations,
    apply_value,
    make_multiplicity,
)
from sysmlc.language.text.builders.definitions import (
    Keyword,
    build_keywordless_usage,
    finish_usage,
    read_keyword,
)
from sysmlc.language.text.builders.namespaces import build_metadata, build_prefix_metadata
from sysmlc.language.text.builders.nodes import (
    FEATURE,
    OWNING,
    add_members,
    make_node,
    prepend_members,
)
from sysmlc.language.text.builders.usages import Prefix, check_prefixes
from sysmlc.language.text.lexer import Tokens
from sysmlc.language.tree import AttributeValue, Node, Reference, Relation

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


def _join_words(tokens: Tokens, _stop: int, _begin: int, *words: int) -> str:
    return " ".join(tokens[word] for word in words)


def _build_type(
    tokens: Tokens,
    stop: int,
    begin: int,
    keyword: Keyword,
    sufficient: int | None,
    names: Names | None,
    parts: list[SpecializationPart] | None,
    body: list[Node],
) -> Node:
    kind = _TYPE_KINDS[read_keyword(tokens, keyword)]
    node = apply_names(make_node(kind, OWNING, tokens, begin, stop), names, tokens)
    if sufficient is not None:
        node.attributes["isSufficient"] = True
    apply_specializations(node, parts, tokens)
    # A specialisation between classifiers is a subclassification.
    if kind != "Type":
        for relation in node.relations:
            if relation.kind == "Specialization":
                relation.kind = "Subclassification"
    return add_members(node, body)


def _build_declaration(
    tokens: Tokens,
    stop: int,
    begin: int,
    keyword: Keyword,
    sufficient: int | None,
    names: Names | None,
    parts: list[SpecializationPart] | None,
    value: Node | None,
) -> Node:
    keywords = read_keyword(tokens, keyword).removesuffix(" true")
    is_negated = keywords.endswith(" false")
    kind = _FEATURE_KINDS[keywords.removesuffix(" false")]
    node = apply_names(make_node(kind, FEATURE, tokens, begin, stop), names, tokens)
    if is_negated:
        node.attributes["isNegated"] = True
    if sufficient is not None:
        node.attributes["isSufficient"] = True
    return apply_value(apply_specializations(node, parts, tokens), value)


def _build_connector(
    tokens: Tokens, stop: int, begin: int, keyword: Keyword, *rest: ConnectorPart
) -> Node:
    node = _build_declaration(tokens, stop, begin, keyword, None, None, None, None)
    ends, body = split_ends_and_body(rest)
    return finish_usage(apply_tail(node, Tail(ends=ends), tokens), tokens, stop, body)


def _build_sufficient_connector(
    tokens: Tokens, stop: int, begin: int, keyword: Keyword, _all: int, *rest: ConnectorPart
) -> Node:
    node = _build_connector(tokens, stop, begin, keyword, *rest)
    node.attributes["isSufficient"] = True
    return node


def _build_named_connector(
    tokens: Tokens,
    stop: int,
    _begin: int,
    node: Node,
    first: End,
    rest: list[End],
    body: list[Node],
) -> Node:
    return finish_usage(apply_tail(node, Tail(ends=[first, *rest]), tokens), tokens, stop, body)


def _build_nameless_binding(
    _tokens: Tokens,
    _stop: int,
    _begin: int,
    parts: list[SpecializationPart],
    further_parts: list[SpecializationPart] | None = None,
) -> tuple[None, list[SpecializationPart]]:
    return None, [*parts, *(further_parts or ())]


def _build_binding_name(
    tokens: Tokens, _stop: int, _begin: int, name: int, parts: list[SpecializationPart]
) -> tuple[Names, list[SpecializationPart]]:
    return Names(None, tokens.read_name(name), name), parts


def _build_bare_binding_name(
    tokens: Tokens, _stop: int, _begin: int, name: int
) -> tuple[Names, list[SpecializationPart]]:
    return Names(None, tokens.read_name(name), name), []


def _build_binding(
    tokens: Tokens,
    stop: int,
    begin: int,
    sufficient: int | None,
    name: tuple[Names | None, list[SpecializationPart]] | None,
    ends: list[End] | None,
    body: list[Node],
) -> Node:
    node = make_node("BindingConnector", FEATURE, tokens, begin, stop)
    if name is not None:
        apply_specializations(apply_names(node, name[0], tokens), name[1], tokens)
    if sufficient is not None:
        node.attributes["isSufficient"] = True
    return finish_usage(apply_tail(node, Tail(ends=ends or []), tokens), tokens, stop, body)


def _build_first_between(
    _tokens: Tokens, _stop: int, _begin: int, source: End, target: End
) -> Tail:
    return Tail("", "then", ends=[source, target])


def _build_namespace(
    tokens: Tokens, stop: int, begin: int, names: Names | None, body: list[Node]
) -> Node:
    return add_members(
        apply_names(make_node("Namespace", OWNING, tokens, begin, stop), names, tokens), body
    )


def _build_multiplicity_range(
    tokens: Tokens, stop: int, begin: int, names: Names | None, bounds: Node, body: list[Node]
) -> Node:
    return add_members(
        apply_names(make_multiplicity(bounds, tokens, begin, stop), names, tokens), body
    )


def _build_multiplicity_subset(
    tokens: Tokens, stop: int, begin: int, names: Names | None, subset: Reference, body: list[Node]
) -> Node:
    node = apply_names(make_node("Multiplicity", OWNING, tokens, begin, stop), names, tokens)
    node.relations.append(Relation("Subsetting", subset))
    return add_members(node, body)


_ATTRIBUTES_BY_PREFIX: dict[str, tuple[tuple[str, AttributeValue], ...]] = {
    "in": (("direction", "in"),),
    "out": (("direction", "out"),),
    "inout": (("direction", "inout"),),
    "derived": (("isDerived", True),),
    "abstract": (("isAbstract", True),),
    "composite": (("isComposite", True),),
    "portion": (("isPortion", True),),
    "var": (("isVariable", True),),
    "const": (("isConstant", True), ("isVariable", True)),
    "end": (("isEnd", True),),
    "standard": (("isStandard", True),),
}


def apply_prefixes(tokens: Tokens, begin: int, prefixes: list[Prefix], node: Node) -> Node:
    """Apply the prefixes of a member, and return it."""
    node.start = tokens.starts[begin]
    check_prefixes(tokens, prefixes, node)
    for prefix in prefixes:
        if isinstance(prefix, Node):
            continue
        word = tokens[prefix]
        if word == "library":
            node.kind = "LibraryPackage"
        elif word == "member":
            node.membership = OWNING
        else:
            node.attributes.update(_ATTRIBUTES_BY_PREFIX.get(word, ()))
    return prepend_members(node, [prefix for prefix in prefixes if isinstance(prefix, Node)])


def _build_prefixed(
    tokens: Tokens, _stop: int, begin: int, prefixes: list[Prefix], node: Node
) -> Node:
    return apply_prefixes(tokens, begin, prefixes, node)


def _build_prefixed_nothing(
    tokens: Tokens, stop: int, begin: int, prefixes: list[Prefix], body: list[Node]
) -> Node:
    feature = _turn_into_feature(
        build_keywordless_usage(tokens, stop, begin, None, None, None, body)
    )
    return apply_prefixes(tokens, begin, prefixes, feature)


def _turn_into_feature(node: Node) -> Node:
    node.kind = "Feature"
    return node


_Parameters = ParamSpec("_Parameters")


def _adapt(
    change: Callable[[Node], Node], build: Callable[_Parameters, Node]
) -> Callable[_Parameters, Node]:
    """Return a builder of SysML, adapted to the element of KerML with the same notation."""

    def build_adapted(*args: _Parameters.args, **kwargs: _Parameters.kwargs) -> Node:
        return change(build(*args, **kwargs))

    return build_adapted


def _make_sufficient(node: Node) -> Node:
    node.attributes["isSufficient"] = True
    return node


_build_keywordless_feature = _adapt(_turn_into_feature, build_keywordless_usage)


def _build_nameless_feature(
    tokens: Tokens,
    stop: int,
    begin: int,
    parts: list[SpecializationPart],
    value: Node | None,
    body: list[Node],
) -> Node:
    return _build_keywordless_feature(tokens, stop, begin, None, parts, value, body)


def _build_value_feature(
    tokens: Tokens, stop: int, begin: int, value: Node, body: list[Node]
) -> Node:
    return _build_keywordless_feature(tokens, stop, begin, None, None, value, body)


def _build_cross_feature(
    tokens: Tokens,
    stop: int,
    begin: int,
    names: Names | None,
    parts: list[SpecializationPart] | None,
) -> usages.CrossFeature:
    node = apply_names(make_node("Feature", OWNING, tokens, begin, stop), names, tokens)
    return usages.CrossFeature(apply_specializations(node, parts, tokens))


def _build_nameless_cross_feature(
    tokens: Tokens, stop: int, begin: int, parts: list[SpecializationPart]
) -> usages.CrossFeature:
    return _build_cross_feature(tokens, stop, begin, None, parts)


def _build_with_cross_feature(
    tokens: Tokens,
    _stop: int,
    begin: int,
    prefixes: list[Prefix],
    cross: usages.CrossFeature,
    *rest: Node | list[Prefix],
) -> Node:
    """Build a feature with a cross feature; further prefixes may stand between the two."""
    further_prefixes, node = rest[0], rest[-1]
    all_prefixes = prefixes
    if isinstance(further_prefixes, list):
        all_prefixes = [*prefixes, *further_prefixes]
    assert isinstance(node, Node)
    return prepend_members(apply_prefixes(tokens, begin, all_prefixes, node), [cross.node])


def _turn_into_metadata_feature(node: Node) -> Node:
    node.kind = "MetadataFeature"
    return node


ACTIONS = {
    "inv": _join_words,
    "assoc_struct": _join_words,
    "succession_flow": _join_words,
    "type": _build_type,
    "declared_all": _build_declaration,
    "usage": definitions.ACTIONS["usage"],
    "usage_ends": _build_connector,
    "usage_ends_all": _build_sufficient_connector,
    "usage_many_ends": _build_connector,
    "declared_many_ends": _build_named_connector,
    "bound_name": _build_binding_name,
    "bound_name_of": _build_bare_binding_name,
    "bound_nameless": _build_nameless_binding,
    "binding": _build_binding,
    "namespace": _build_namespace,
    "first_between": _build_first_between,
    "multiplicity_range": _build_multiplicity_range,
    "multiplicity_subset": _build_multiplicity_subset,
    "prefixed": _build_prefixed,
    "prefixed_loose": _build_prefixed,
    "prefixed_nothing": _build_prefixed_nothing,
    "loose": _build_keywordless_feature,
    "loose_all": _adapt(_make_sufficient, _build_keywordless_feature),
    "loose_nameless": _build_nameless_feature,
    "loose_value": _build_value_feature,
    "cross": _build_cross_feature,
    "cross_nameless": _build_nameless_cross_feature,
    "crossed": _build_with_cross_feature,
    "crossed_prefixed": _build_with_cross_feature,
    "crossed_prefixed_loose": _build_with_cross_feature,
    "metadata": _adapt(_turn_into_metadata_feature, build_metadata),
    "prefix_metadata": _adapt(_turn_into_metadata_feature, build_prefix_metadata),
    "return": usages.ACTIONS["return"],
    "visible_return": usages.ACTIONS["visible_return"],
}
