"""Names, qualified names and feature chains (KerML 8.2.2.3, 8.2.3.4.1, 8.2.4.3.5)."""

from typing import NamedTuple

from sysmlc.language.text.lexer import Tokens
from sysmlc.language.tree import Node, Reference


class Names(NamedTuple):
    """The names of an element, and the token that has the name."""

    short_name: str | None
    name: str | None
    token: int


def apply_names(node: Node, names: Names | None, tokens: Tokens) -> Node:
    """Set the names of ``node``, and return it."""
    if names is not None:
        node.short_name, node.name = names.short_name, names.name
        node.name_start = tokens.starts[names.token]
    return node


def _build_name(tokens: Tokens, _stop: int, begin: int, name: int, *_follow: object) -> Names:
    return Names(None, tokens.read_name(name), begin)


def _build_short_name(
    tokens: Tokens, _stop: int, _begin: int, short: int, *_follow: object
) -> Names:
    return Names(tokens.read_name(short), None, short)


def _build_both_names(
    tokens: Tokens, _stop: int, _begin: int, short: int, name: int, *_follow: object
) -> Names:
    return Names(tokens.read_name(short), tokens.read_name(name), name)


def _build_simple_name(tokens: Tokens, _stop: int, _begin: int, name: int) -> Reference:
    return Reference(((tokens.read_name(name),),), tokens.starts[name], tokens.ends[name])


def _build_global_name(tokens: Tokens, _stop: int, begin: int, name: int) -> Reference:
    return Reference((("$", tokens.read_name(name)),), tokens.starts[begin], tokens.ends[name])


def _extend_name(
    tokens: Tokens, _stop: int, _begin: int, reference: Reference, name: int
) -> Reference:
    reference.chain = ((*reference.chain[0], tokens.read_name(name)),)
    reference.end = tokens.ends[name]
    return reference


def _extend_chain(
    _tokens: Tokens, _stop: int, _begin: int, reference: Reference, link: Reference
) -> Reference:
    reference.chain += link.chain
    reference.end = link.end
    return reference


ACTIONS = {
    "named": _build_name,
    "short_named": _build_short_name,
    "both_named": _build_both_names,
    "simple_name": _build_simple_name,
    "global_name": _build_global_name,
    "longer_name": _extend_name,
    "longer_chain": _extend_chain,
}
