"""Prefixes and their order, cross features, `variant`, `return`, `then` (SysML 8.2.2.6, 9.3)."""

from typing import NamedTuple

from sysmlc.language.text.builders.connections import End, make_connector_end
from sysmlc.language.text.builders.declarations import (
    Names,
    SpecializationPart,
    apply_names,
    apply_specializations,
    make_multiplicity,
)
from sysmlc.language.text.builders.definitions import (
    build_keywordless_usage,
    finish_usage,
)
from sysmlc.language.text.builders.namespaces import apply_visibility
from sysmlc.language.text.builders.nodes import (
    FEATURE,
    OWNING,
    add_members,
    make_node,
    prepend_members,
)
from sysmlc.language.text.lexer import BuildFault, Tokens
from sysmlc.language.tree import AttributeValue, Node, Reference, Relation

_RANKS = {
    "member": 0,
    "end": 1,
    "standard": 1,
    "library": 2,
    "in": 2,
    "out": 2,
    "inout": 2,
    "derived": 3,
    "abstract": 4,
    "variation": 4,
    "constant": 5,
    "composite": 5,
    "portion": 5,
    "ref": 6,
    "var": 6,
    "const": 6,
    "individual": 7,
    "snapshot": 8,
    "timeslice": 8,
}
_METADATA = 9
_OF_DEFINITIONS = {"abstract", "variation", "individual"}
_OF_PACKAGES = {"standard", "library"}
_PACKAGES = {"Package", "LibraryPackage", "Namespace"}
_WITHOUT_PREFIXES = {
    "Comment": "a comment",
    "Documentation": "documentation",
    "TextualRepresentation": "a representation",
    "Dependency": "a dependency",
    "Membership": "an alias",
    "MembershipImport": "an import",
    "NamespaceImport": "an import",
    "MembershipExpose": "'expose'",
    "NamespaceExpose": "'expose'",
    "MetadataUsage": "metadata",
    "MetadataFeature": "metadata",
}
_TYPES = {
    "Type",
    "Classifier",
    "DataType",
    "Class",
    "Structure",
    "Metaclass",
    "Association",
    "AssociationStructure",
    "Interaction",
    "Behavior",
    "Function",
    "Predicate",
}


def check_prefixes(tokens: Tokens, prefixes: list[int | Node], node: Node) -> None:
    """Record a fault for prefixes that are out of order, or invalid for this declaration."""
    words = [(prefix, tokens[prefix]) for prefix in prefixes if isinstance(prefix, int)]
    for token, word in words:
        if word and not _is_allowed(word, node):
            text = f"'{word}' cannot stand before {_describe(node)}"
            _report_prefix(tokens, token, text, f"take '{word}' away")
            return
    if len(prefixes) > 1:
        _check_order(tokens, prefixes)


def _check_order(tokens: Tokens, prefixes: list[int | Node]) -> None:
    last_rank, last_word = -1, ""
    for prefix in prefixes:
        word = "metadata" if isinstance(prefix, Node) else tokens[prefix]
        rank = _METADATA if isinstance(prefix, Node) else _RANKS.get(word, last_rank + 1)
        # KerML puts `const` before `end` (8.2.4.3.1), all others after it.
        if (last_word, word) == ("const", "end"):
            rank = last_rank + 1
        if rank < last_rank or (rank == last_rank != _METADATA):
            start = prefix.start if isinstance(prefix, Node) else tokens.starts[prefix]
            _report_order(tokens, start, word, last_word, rank == last_rank)
            return
        last_rank, last_word = rank, word


def _report_order(
    tokens: Tokens, start: int, word: str, last_word: str, is_same_rank: bool
) -> None:
    if is_same_rank:
        text = f"'{word}' and '{last_word}' exclude one another"
        advice = "say only one of both"
    else:
        text = f"'{word}' stands after '{last_word}'"
        advice = f"write '{word}' before '{last_word}'"
    tokens.build_faults.append(BuildFault("prefix", start, text, advice))


def _report_prefix(tokens: Tokens, token: int, text: str, advice: str) -> None:
    tokens.build_faults.append(BuildFault("prefix", tokens.starts[token], text, advice))


def _is_allowed(word: str, node: Node) -> bool:
    if word in _OF_PACKAGES:
        return node.kind == "Package"
    if node.kind in _PACKAGES or node.kind in _WITHOUT_PREFIXES:
        return False
    if node.kind in _TYPES:
        return word == "abstract"
    if node.kind.endswith("Definition"):
        return word in _OF_DEFINITIONS
    return True


def _describe(node: Node) -> str:
    if node.kind in _WITHOUT_PREFIXES:
        return _WITHOUT_PREFIXES[node.kind]
    if node.kind in _PACKAGES:
        return "a package"
    return "a definition" if node.kind.endswith("Definition") else "this declaration"


Prefix = int | Node

_ATTRIBUTES_BY_PREFIX: dict[str, tuple[str, AttributeValue]] = {
    "in": ("direction", "in"),
    "out": ("direction", "out"),
    "inout": ("direction", "inout"),
    "derived": ("isDerived", True),
    "abstract": ("isAbstract", True),
    "variation": ("isVariation", True),
    "constant": ("isConstant", True),
    "ref": ("isReference", True),
    "end": ("isEnd", True),
    "individual": ("isIndividual", True),
    "snapshot": ("portionKind", "snapshot"),
    "timeslice": ("portionKind", "timeslice"),
    "standard": ("isStandard", True),
}
_OCCURRENCE_PREFIXES = ("individual", "snapshot", "timeslice")


def apply_prefixes(tokens: Tokens, begin: int, prefixes: list[Prefix], node: Node) -> Node:
    """Apply the prefixes of a member, and return it."""
    node.start = tokens.starts[begin]
    metadata = [prefix for prefix in prefixes if isinstance(prefix, Node)]
    words = [tokens[prefix] for prefix in prefixes if isinstance(prefix, int)]
    if words:
        check_prefixes(tokens, prefixes, node)
    for word in words:
        if word == "library":
            node.kind = "LibraryPackage"
            continue
        if word == "ref":
            tokens.ref_usages.append(node)
        if word not in _ATTRIBUTES_BY_PREFIX:
            continue
        name, value = _ATTRIBUTES_BY_PREFIX[word]
        node.attributes[name] = value
        if name == "portionKind":
            node.attributes["isPortion"] = True
    # `individual def` is an occurrence definition without a kind of its own (SysML 8.2.2.9).
    if node.kind == "Definition" and "individual" in words:
        node.kind = "OccurrenceDefinition"
    # Members of a relationship annotate it.
    if node.kind == "Dependency":
        for member in metadata:
            member.membership = "Annotation"
    return prepend_members(node, metadata) if metadata else node


def _build_prefixed(
    tokens: Tokens, _stop: int, begin: int, prefixes: list[Prefix], node: Node
) -> Node:
    return apply_prefixes(tokens, begin, prefixes, node)


def _build_prefixed_keywordless(
    tokens: Tokens, _stop: int, begin: int, prefixes: list[Prefix], node: Node
) -> Node:
    """Build a usage without keyword, whose kind depends on its prefixes."""
    if any(
        isinstance(prefix, int) and tokens[prefix] in _OCCURRENCE_PREFIXES for prefix in prefixes
    ):
        node.kind = "OccurrenceUsage"
    elif any(isinstance(prefix, Node) for prefix in prefixes):
        node.kind = "Usage"
    return apply_prefixes(tokens, begin, prefixes, node)


def _build_prefixed_nothing(
    tokens: Tokens, stop: int, begin: int, prefixes: list[Prefix], body: list[Node]
) -> Node:
    node = build_keywordless_usage(tokens, stop, begin, None, None, None, body)
    return _build_prefixed_keywordless(tokens, stop, begin, prefixes, node)


class CrossFeature(NamedTuple):
    """The declaration between `end` and the keyword of a usage (SysML 8.2.2.6.2)."""

    node: Node


def _build_cross_feature(
    tokens: Tokens,
    stop: int,
    begin: int,
    names: Names | None,
    parts: list[SpecializationPart] | None,
) -> CrossFeature:
    node = apply_names(make_node("ReferenceUsage", OWNING, tokens, begin, stop), names, tokens)
    return CrossFeature(apply_specializations(node, parts, tokens))


def _build_nameless_cross_feature(
    tokens: Tokens, stop: int, begin: int, parts: list[SpecializationPart]
) -> CrossFeature:
    return _build_cross_feature(tokens, stop, begin, None, parts)


def _build_with_cross_feature(
    tokens: Tokens, _stop: int, begin: int, prefixes: list[Prefix], cross: CrossFeature, node: Node
) -> Node:
    return prepend_members(apply_prefixes(tokens, begin, prefixes, node), [cross.node])


def _build_prefixed_with_cross_feature(
    tokens: Tokens,
    _stop: int,
    begin: int,
    prefixes: list[Prefix],
    cross: CrossFeature,
    further_prefixes: list[Prefix],
    node: Node,
) -> Node:
    return prepend_members(
        apply_prefixes(tokens, begin, [*prefixes, *further_prefixes], node), [cross.node]
    )


def _build_keywordless_with_cross_feature(
    tokens: Tokens,
    stop: int,
    begin: int,
    prefixes: list[Prefix],
    cross: CrossFeature,
    further_prefixes: list[Prefix],
    node: Node,
) -> Node:
    return prepend_members(
        _build_prefixed_keywordless(tokens, stop, begin, [*prefixes, *further_prefixes], node),
        [cross.node],
    )


def _build_variant(tokens: Tokens, _stop: int, begin: int, node: Node) -> Node:
    node.membership = "VariantMembership"
    node.start = tokens.starts[begin]
    return node


def _build_visible_variant(
    tokens: Tokens, stop: int, begin: int, visibility: int, node: Node
) -> Node:
    apply_visibility(tokens, stop, begin, visibility, node)
    return _build_variant(tokens, stop, begin, node)


def _build_variant_reference(
    tokens: Tokens,
    stop: int,
    begin: int,
    name: Reference,
    parts: list[SpecializationPart] | None,
    body: list[Node],
) -> Node:
    node = make_node("ReferenceUsage", FEATURE, tokens, begin, stop)
    node.relations.append(Relation("ReferenceSubsetting", name))
    return add_members(apply_specializations(node, parts, tokens), body)


def _build_return(tokens: Tokens, _stop: int, begin: int, node: Node) -> Node:
    node.membership = "ReturnParameterMembership"
    tokens.restricted_nodes.append(node)
    node.start = tokens.starts[begin]
    return node


def _build_visible_return(
    tokens: Tokens, stop: int, begin: int, visibility: int, node: Node
) -> Node:
    apply_visibility(tokens, stop, begin, visibility, node)
    return _build_return(tokens, stop, begin, node)


def _make_source_succession(tokens: Tokens, begin: int, bounds: Node | None) -> Node:
    """Return the succession whose source is the member before it (SysML 8.2.2.9.3)."""
    node = make_node("SuccessionAsUsage", FEATURE, tokens, begin, begin + 1)
    end = node.add_member(
        make_node("ReferenceUsage", "EndFeatureMembership", tokens, begin, begin + 1)
    )
    if bounds is not None:
        end.add_member(make_multiplicity(bounds, tokens, begin + 1, begin + 2))
    return node


def _build_then_member(
    tokens: Tokens, _stop: int, begin: int, bounds: Node | None, node: Node
) -> list[Node]:
    return [_make_source_succession(tokens, begin, bounds), node]


def _build_then_visible_member(
    tokens: Tokens, stop: int, begin: int, bounds: Node | None, visibility: int, node: Node
) -> list[Node]:
    apply_visibility(tokens, stop, visibility, visibility, node)
    return [_make_source_succession(tokens, begin, bounds), node]


def _build_then_end(tokens: Tokens, stop: int, begin: int, end: End, body: list[Node]) -> Node:
    node = _make_source_succession(tokens, begin, None)
    node.add_member(make_connector_end(end, tokens))
    return finish_usage(node, tokens, stop, body)


def _build_visible_then_end(
    tokens: Tokens, stop: int, begin: int, visibility: int, end: End, body: list[Node]
) -> Node:
    node = _build_then_end(tokens, stop, begin, end, body)
    apply_visibility(tokens, stop, begin, visibility, node)
    return node


ACTIONS = {
    "prefixed": _build_prefixed,
    "prefixed_loose": _build_prefixed_keywordless,
    "prefixed_nothing": _build_prefixed_nothing,
    "cross": _build_cross_feature,
    "cross_nameless": _build_nameless_cross_feature,
    "crossed": _build_with_cross_feature,
    "crossed_prefixed": _build_prefixed_with_cross_feature,
    "crossed_prefixed_loose": _build_keywordless_with_cross_feature,
    "variant": _build_variant,
    "visible_variant": _build_visible_variant,
    "variant_reference": _build_variant_reference,
    "return": _build_return,
    "visible_return": _build_visible_return,
    "then_member": _build_then_member,
    "then_visible_member": _build_then_visible_member,
    "then_end": _build_then_end,
    "visible_then_end": _build_visible_then_end,
}
