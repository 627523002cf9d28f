"""Prefixes and their order, cross features, `variant`, `return`, `then` (SysML 8.2.2.6, 9.3)."""

from collections.abc import Callable
from functools import partial

from sysmlc.language.text.builders.connections import End, make_end
from sysmlc.language.text.builders.declarations import (
    Names,
    Parts,
    make_element,
    make_multiplicity,
)
from sysmlc.language.text.builders.definitions import build_keywordless, finish_usage
from sysmlc.language.text.builders.nodes import (
    FEATURE,
    OWNING,
    make_node,
    omit_first,
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


Prefix = int | Node


def _check_prefixes(tokens: Tokens, prefixes: list[Prefix], node: Node) -> None:
    """Record a fault for prefixes that are out of order, or invalid for this declaration."""
    for prefix in prefixes:
        if isinstance(prefix, int) and not _is_allowed(tokens[prefix], node):
            word = tokens[prefix]
            text = f"'{word}' cannot stand before {_describe(node)}"
            fault = BuildFault("prefix", tokens.starts[prefix], text, f"take '{word}' away")
            tokens.build_faults.append(fault)
            return
    if len(prefixes) > 1:
        _check_order(tokens, prefixes)


def _check_order(tokens: Tokens, prefixes: list[Prefix]) -> None:
    last_rank, last_word = -1, ""
    for prefix in prefixes:
        word = "metadata" if isinstance(prefix, Node) else tokens[prefix]
        rank = _METADATA if isinstance(prefix, Node) else _RANKS.get(word, last_rank + 1)
        # KerML puts `const` before `end` (8.2.4.3.1), all others after it.
        if (last_word, word) == ("const", "end"):
            rank = last_rank + 1
        if rank < last_rank or (rank == last_rank != _METADATA):
            text = f"'{word}' stands after '{last_word}'"
            advice = f"write '{word}' before '{last_word}'"
            if rank == last_rank:
                text = f"'{word}' and '{last_word}' exclude one another"
                advice = "say only one of both"
            start = prefix.start if isinstance(prefix, Node) else tokens.starts[prefix]
            tokens.build_faults.append(BuildFault("prefix", start, text, advice))
            return
        last_rank, last_word = rank, word


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


_ATTRIBUTES_BY_PREFIX: dict[str, tuple[tuple[str, AttributeValue], ...]] = {
    "in": (("direction", "in"),),
    "out": (("direction", "out"),),
    "inout": (("direction", "inout"),),
    "derived": (("isDerived", True),),
    "abstract": (("isAbstract", True),),
    "variation": (("isVariation", True),),
    "constant": (("isConstant", True),),
    "composite": (("isComposite", True),),
    "portion": (("isPortion", True),),
    "var": (("isVariable", True),),
    "const": (("isConstant", True), ("isVariable", True)),
    "ref": (("isReference", True),),
    "end": (("isEnd", True),),
    "individual": (("isIndividual", True),),
    "snapshot": (("portionKind", "snapshot"), ("isPortion", True)),
    "timeslice": (("portionKind", "timeslice"), ("isPortion", True)),
    "standard": (("isStandard", True),),
}
_OCCURRENCE_PREFIXES = ("individual", "snapshot", "timeslice")


def apply_prefixes(tokens: Tokens, prefixes: list[Prefix], node: Node) -> Node:
    """Apply the prefixes of a member, and return it."""
    node.start = tokens.starts[tokens.begin]
    metadata = [prefix for prefix in prefixes if isinstance(prefix, Node)]
    words = [tokens[prefix] for prefix in prefixes if isinstance(prefix, int)]
    if words:
        _check_prefixes(tokens, prefixes, node)
    for word in words:
        node.attributes.update(_ATTRIBUTES_BY_PREFIX.get(word, ()))
        if word == "library":
            node.kind = "LibraryPackage"
        elif word == "member":
            node.membership = OWNING
        elif word == "ref":
            tokens.ref_usages.append(node)
    # `individual def` is an occurrence definition without a kind of its own (SysML 8.2.2.9).
    if node.kind == "Definition" and "individual" in words:
        node.kind = "OccurrenceDefinition"
    # Members of a relationship annotate it.
    if node.kind == "Dependency":
        for member in metadata:
            member.membership = "Annotation"
    return prepend_members(node, metadata) if metadata else node


def _build_prefixed_keywordless(tokens: Tokens, prefixes: list[Prefix], node: Node) -> Node:
    """Build a usage without keyword, whose kind depends on its prefixes."""
    if any(
        isinstance(prefix, int) and tokens[prefix] in _OCCURRENCE_PREFIXES for prefix in prefixes
    ):
        node.kind = "OccurrenceUsage"
    elif any(isinstance(prefix, Node) for prefix in prefixes):
        node.kind = "Usage"
    return apply_prefixes(tokens, prefixes, node)


def build_prefixed_nothing(
    kind: str,
    apply: Callable[[Tokens, list[Prefix], Node], Node],
    tokens: Tokens,
    prefixes: list[Prefix],
    body: list[Node],
) -> Node:
    """Build a member that has nothing but prefixes and a body."""
    return apply(tokens, prefixes, build_keywordless(kind, tokens, None, None, None, body))


def build_cross_feature(kind: str, tokens: Tokens, names: Names | None, parts: Parts) -> Node:
    """Build the declaration between `end` and the keyword of a usage (SysML 8.2.2.6.2)."""
    return make_element(kind, OWNING, tokens, names, parts)


def build_crossed(
    apply: Callable[[Tokens, list[Prefix], Node], Node],
    tokens: Tokens,
    prefixes: list[Prefix],
    cross: Node,
    further_prefixes: list[Prefix] | None,
    node: Node,
) -> Node:
    """Build a member with a cross feature; further prefixes may stand between the two."""
    node = apply(tokens, [*prefixes, *(further_prefixes or ())], node)
    return prepend_members(node, [cross])


def _build_variant(tokens: Tokens, node: Node) -> Node:
    node.membership = "VariantMembership"
    node.start = tokens.starts[tokens.begin]
    return node


def _build_variant_reference(
    tokens: Tokens, name: Reference, parts: Parts, body: list[Node]
) -> Node:
    parts = [Relation("ReferenceSubsetting", name), *(parts or ())]
    return build_keywordless("ReferenceUsage", tokens, None, parts, None, body)


def build_return(tokens: Tokens, node: Node) -> Node:
    """Build a result parameter."""
    node.membership = "ReturnParameterMembership"
    tokens.restricted_nodes.append(node)
    node.start = tokens.starts[tokens.begin]
    return node


def _make_source_succession(tokens: Tokens, bounds: Node | None) -> Node:
    """Return the succession whose source is the member before it (SysML 8.2.2.9.3)."""
    begin = tokens.begin
    node = make_node("SuccessionAsUsage", FEATURE, tokens, (begin, begin + 1))
    end = make_node("ReferenceUsage", "EndFeatureMembership", tokens, (begin, begin + 1))
    node.add_member(end)
    if bounds is not None:
        end.add_member(make_multiplicity(bounds, tokens, (begin + 1, begin + 2)))
    return node


def _build_then_member(tokens: Tokens, bounds: Node | None, node: Node) -> list[Node]:
    return [_make_source_succession(tokens, bounds), node]


def _build_then_end(tokens: Tokens, end: End, body: list[Node]) -> Node:
    node = _make_source_succession(tokens, None)
    node.add_member(make_end("ReferenceUsage", end, tokens))
    return finish_usage(tokens, node, body)


_build_cross = partial(build_cross_feature, "ReferenceUsage")
ACTIONS = {
    "prefixed": apply_prefixes,
    "prefixed_loose": _build_prefixed_keywordless,
    "prefixed_nothing": partial(
        build_prefixed_nothing, "ReferenceUsage", _build_prefixed_keywordless
    ),
    "cross": _build_cross,
    "cross_nameless": omit_first(_build_cross),
    "crossed": partial(build_crossed, apply_prefixes),
    "crossed_loose": partial(build_crossed, _build_prefixed_keywordless),
    "variant": _build_variant,
    "variant_reference": _build_variant_reference,
    "return": build_return,
    "then_member": _build_then_member,
    "then_end": _build_then_end,
}
