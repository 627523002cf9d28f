"""Prefixes, cross features, `variant`, `return`, `then` before members (SysML 8.2.2.6, 9.3)."""

from typing import NamedTuple

from sysmlc.language.text.build.definitions import lead, loose, whole
from sysmlc.language.text.build.ends import End, end_feature
from sysmlc.language.text.build.features import Part, multiplicity, specialize
from sysmlc.language.text.build.names import Names, call
from sysmlc.language.text.build.namespaces import visible
from sysmlc.language.text.build.owning import FEATURE, OWNING, made, own
from sysmlc.language.text.build.prefixes import check
from sysmlc.language.text.scan import Tokens
from sysmlc.language.tree import Fact, Node, Reference, Relation

Prefix = int | Node

_FACTS: dict[str, tuple[str, Fact]] = {
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
_OCCURRENCE = ("individual", "snapshot", "timeslice")


def prefix(tokens: Tokens, begin: int, prefixes: list[Prefix], node: Node) -> Node:
    """Apply what stands before a member."""
    node.start = tokens.starts[begin]
    metadata = [given for given in prefixes if isinstance(given, Node)]
    words = [tokens[given] for given in prefixes if isinstance(given, int)]
    if words:
        check(tokens, prefixes, node)
    for word in words:
        if word == "library":
            node.kind = "LibraryPackage"
            continue
        if word == "ref":
            tokens.referential.append(node)
        if word not in _FACTS:
            continue
        name, value = _FACTS[word]
        node.facts[name] = value
        if name == "portionKind":
            node.facts["isPortion"] = True
    if node.kind == "Definition" and "individual" in words:
        node.kind = "OccurrenceDefinition"
    if node.kind == "Dependency":
        for member in metadata:
            member.membership = "Annotation"
    return lead(node, metadata) if metadata else node


def _prefixed(tokens: Tokens, _at: int, begin: int, prefixes: list[Prefix], node: Node) -> Node:
    return prefix(tokens, begin, prefixes, node)


def _prefixed_loose(
    tokens: Tokens, _at: int, begin: int, prefixes: list[Prefix], node: Node
) -> Node:
    """Without keyword, the prefixes decide what it is."""
    if any(isinstance(given, int) and tokens[given] in _OCCURRENCE for given in prefixes):
        node.kind = "OccurrenceUsage"
    elif any(isinstance(given, Node) for given in prefixes):
        node.kind = "Usage"
    return prefix(tokens, begin, prefixes, node)


def _prefixed_nothing(
    tokens: Tokens, at: int, begin: int, prefixes: list[Prefix], body: list[Node]
) -> Node:
    node = loose(tokens, at, begin, None, None, None, body)
    return _prefixed_loose(tokens, at, begin, prefixes, node)


class Cross(NamedTuple):
    """What stands between `end` and the keyword of a usage (SysML 8.2.2.6.2)."""

    node: Node


def _cross(
    tokens: Tokens, at: int, begin: int, names: Names | None, parts: list[Part] | None
) -> Cross:
    node = call(made("ReferenceUsage", OWNING, tokens, begin, at), names, tokens)
    return Cross(specialize(node, parts, tokens))


def _cross_nameless(tokens: Tokens, at: int, begin: int, parts: list[Part]) -> Cross:
    return _cross(tokens, at, begin, None, parts)


def _crossed(
    tokens: Tokens, _at: int, begin: int, prefixes: list[Prefix], cross: Cross, node: Node
) -> Node:
    return lead(prefix(tokens, begin, prefixes, node), [cross.node])


def _crossed_prefixed(
    tokens: Tokens,
    _at: int,
    begin: int,
    prefixes: list[Prefix],
    cross: Cross,
    more: list[Prefix],
    node: Node,
) -> Node:
    return lead(prefix(tokens, begin, [*prefixes, *more], node), [cross.node])


def _crossed_prefixed_loose(
    tokens: Tokens,
    at: int,
    begin: int,
    prefixes: list[Prefix],
    cross: Cross,
    more: list[Prefix],
    node: Node,
) -> Node:
    return lead(_prefixed_loose(tokens, at, begin, [*prefixes, *more], node), [cross.node])


def _variant(tokens: Tokens, _at: int, begin: int, node: Node) -> Node:
    node.membership = "VariantMembership"
    node.start = tokens.starts[begin]
    return node


def _visible_variant(tokens: Tokens, at: int, begin: int, visibility: int, node: Node) -> Node:
    visible(tokens, at, begin, visibility, node)
    return _variant(tokens, at, begin, node)


def _variant_reference(
    tokens: Tokens,
    at: int,
    begin: int,
    name: Reference,
    parts: list[Part] | None,
    body: list[Node],
) -> Node:
    node = made("ReferenceUsage", FEATURE, tokens, begin, at)
    node.relations.append(Relation("ReferenceSubsetting", name))
    return own(specialize(node, parts, tokens), body)


def _return(tokens: Tokens, _at: int, begin: int, node: Node) -> Node:
    node.membership = "ReturnParameterMembership"
    tokens.special.append(node)
    node.start = tokens.starts[begin]
    return node


def _visible_return(tokens: Tokens, at: int, begin: int, visibility: int, node: Node) -> Node:
    visible(tokens, at, begin, visibility, node)
    return _return(tokens, at, begin, node)


def _source(tokens: Tokens, begin: int, bounds: Node | None) -> Node:
    """The succession that begins at what stands before (SysML 8.2.2.9.3)."""
    node = made("SuccessionAsUsage", FEATURE, tokens, begin, begin + 1)
    end = node.own(made("ReferenceUsage", "EndFeatureMembership", tokens, begin, begin + 1))
    if bounds is not None:
        end.own(multiplicity(bounds, tokens, begin + 1, begin + 2))
    return node


def _then_member(
    tokens: Tokens, _at: int, begin: int, bounds: Node | None, node: Node
) -> list[Node]:
    return [_source(tokens, begin, bounds), node]


def _then_visible_member(
    tokens: Tokens, at: int, begin: int, bounds: Node | None, visibility: int, node: Node
) -> list[Node]:
    visible(tokens, at, visibility, visibility, node)
    return [_source(tokens, begin, bounds), node]


def _then_end(tokens: Tokens, at: int, begin: int, end: End, body: list[Node]) -> Node:
    node = _source(tokens, begin, None)
    node.own(end_feature(end, tokens))
    return whole(node, tokens, at, body)


def _visible_then_end(
    tokens: Tokens, at: int, begin: int, visibility: int, end: End, body: list[Node]
) -> Node:
    node = _then_end(tokens, at, begin, end, body)
    visible(tokens, at, begin, visibility, node)
    return node


ACTIONS = {
    "prefixed": _prefixed,
    "prefixed_loose": _prefixed_loose,
    "prefixed_nothing": _prefixed_nothing,
    "cross": _cross,
    "cross_nameless": _cross_nameless,
    "crossed": _crossed,
    "crossed_prefixed": _crossed_prefixed,
    "crossed_prefixed_loose": _crossed_prefixed_loose,
    "variant": _variant,
    "visible_variant": _visible_variant,
    "variant_reference": _variant_reference,
    "return": _return,
    "visible_return": _visible_return,
    "then_member": _then_member,
    "then_visible_member": _then_visible_member,
    "then_end": _then_end,
    "visible_then_end": _visible_then_end,
}
