"""What stands before members of KerML, and members without keyword (8.2.3.4, 8.2.4.3)."""

from collections.abc import Callable
from typing import ParamSpec

from sysmlc.language.text.build import usages
from sysmlc.language.text.build.definitions import lead, loose
from sysmlc.language.text.build.features import Part, specialize
from sysmlc.language.text.build.names import Names, call
from sysmlc.language.text.build.namespaces import metadata, prefix_metadata
from sysmlc.language.text.build.owning import OWNING, made
from sysmlc.language.text.build.prefixes import check
from sysmlc.language.text.build.usages import Prefix
from sysmlc.language.text.scan import Tokens
from sysmlc.language.tree import Fact, Node

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


_Said = ParamSpec("_Said")


def _as(change: Callable[[Node], Node], build: Callable[_Said, Node]) -> Callable[_Said, Node]:
    """The builder of an element of SysML, changed to that of KerML which is written alike."""

    def built(*said: _Said.args, **named: _Said.kwargs) -> Node:
        return change(build(*said, **named))

    return built


def _sufficient(node: Node) -> Node:
    node.facts["isSufficient"] = True
    return node


_loose = _as(_feature, loose)


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


def _metadata_feature(node: Node) -> Node:
    node.kind = "MetadataFeature"
    return node


ACTIONS = {
    "prefixed": _prefixed,
    "prefixed_loose": _prefixed,
    "prefixed_nothing": _prefixed_nothing,
    "loose": _loose,
    "loose_all": _as(_sufficient, _loose),
    "loose_nameless": _loose_nameless,
    "loose_value": _loose_value,
    "cross": _cross,
    "cross_nameless": _cross_nameless,
    "crossed": _crossed,
    "crossed_prefixed": _crossed,
    "crossed_prefixed_loose": _crossed,
    "metadata": _as(_metadata_feature, metadata),
    "prefix_metadata": _as(_metadata_feature, prefix_metadata),
    "return": usages.ACTIONS["return"],
    "visible_return": usages.ACTIONS["visible_return"],
}
