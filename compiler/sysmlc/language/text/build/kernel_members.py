"""What stands before members of KerML, and members without keyword (8.2.3.4, 8.2.4.3)."""

from sysmlc.language.text.build import usages
from sysmlc.language.text.build.definitions import lead, loose
from sysmlc.language.text.build.features import Part, specialize
from sysmlc.language.text.build.names import Names, call
from sysmlc.language.text.build.namespaces import metadata, prefix_metadata
from sysmlc.language.text.build.owning import OWNING, made
from sysmlc.language.text.build.prefixes import check
from sysmlc.language.text.build.usages import Prefix
from sysmlc.language.text.scan import Tokens
from sysmlc.language.tree import Fact, Node, Reference, Relation

_FACTS: dict[str, tuple[tuple[str, Fact], ...]] = {
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


def prefix(tokens: Tokens, begin: int, prefixes: list[Prefix], node: Node) -> Node:
    """Apply what stands before a member."""
    node.start = tokens.starts[begin]
    check(tokens, prefixes, node)
    for given in prefixes:
        if isinstance(given, Node):
            continue
        word = tokens[given]
        if word == "library":
            node.kind = "LibraryPackage"
        elif word == "member":
            node.membership = OWNING
        else:
            node.facts.update(_FACTS.get(word, ()))
    return lead(node, [given for given in prefixes if isinstance(given, Node)])


def _prefixed(tokens: Tokens, _at: int, begin: int, prefixes: list[Prefix], node: Node) -> Node:
    return prefix(tokens, begin, prefixes, node)


def _prefixed_nothing(
    tokens: Tokens, at: int, begin: int, prefixes: list[Prefix], body: list[Node]
) -> Node:
    return prefix(
        tokens, begin, prefixes, _feature(loose(tokens, at, begin, None, None, None, body))
    )


def _feature(node: Node) -> Node:
    node.kind = "Feature"
    return node


def _loose(
    tokens: Tokens,
    at: int,
    begin: int,
    names: Names | None,
    parts: list[Part] | None,
    value: Node | None,
    body: list[Node],
) -> Node:
    return _feature(loose(tokens, at, begin, names, parts, value, body))


def _loose_all(
    tokens: Tokens,
    at: int,
    begin: int,
    names: Names | None,
    parts: list[Part] | None,
    value: Node | None,
    body: list[Node],
) -> Node:
    node = _loose(tokens, at, begin, names, parts, value, body)
    node.facts["isSufficient"] = True
    return node


def _loose_nameless(
    tokens: Tokens, at: int, begin: int, parts: list[Part], value: Node | None, body: list[Node]
) -> Node:
    return _loose(tokens, at, begin, None, parts, value, body)


def _loose_value(tokens: Tokens, at: int, begin: int, value: Node, body: list[Node]) -> Node:
    return _loose(tokens, at, begin, None, None, value, body)


def _cross(
    tokens: Tokens, at: int, begin: int, names: Names | None, parts: list[Part] | None
) -> usages.Cross:
    node = call(made("Feature", OWNING, tokens, begin, at), names, tokens)
    return usages.Cross(specialize(node, parts, tokens))


def _cross_nameless(tokens: Tokens, at: int, begin: int, parts: list[Part]) -> usages.Cross:
    return _cross(tokens, at, begin, None, parts)


def _crossed(
    tokens: Tokens,
    _at: int,
    begin: int,
    prefixes: list[Prefix],
    cross: usages.Cross,
    *rest: Node | list[Prefix],
) -> Node:
    node, more = rest[-1], rest[0]
    given = [*prefixes, *more] if isinstance(more, list) else prefixes
    assert isinstance(node, Node)
    return lead(prefix(tokens, begin, given, node), [cross.node])


def _metadata(
    tokens: Tokens,
    at: int,
    begin: int,
    names: Names | None,
    typing: Relation,
    about: list[Reference] | None,
    body: list[Node],
) -> Node:
    node = metadata(tokens, at, begin, names, typing, about, body)
    node.kind = "MetadataFeature"
    return node


def _prefix_metadata(tokens: Tokens, at: int, begin: int, name: Reference) -> Node:
    node = prefix_metadata(tokens, at, begin, name)
    node.kind = "MetadataFeature"
    return node


ACTIONS = {
    "prefixed": _prefixed,
    "prefixed_loose": _prefixed,
    "prefixed_nothing": _prefixed_nothing,
    "loose": _loose,
    "loose_all": _loose_all,
    "loose_nameless": _loose_nameless,
    "loose_value": _loose_value,
    "cross": _cross,
    "cross_nameless": _cross_nameless,
    "crossed": _crossed,
    "crossed_prefixed": _crossed,
    "crossed_prefixed_loose": _crossed,
    "metadata": _metadata,
    "prefix_metadata": _prefix_metadata,
    "return": usages.ACTIONS["return"],
    "visible_return": usages.ACTIONS["visible_return"],
}
