"""Names, qualified names and feature chains (KerML 8.2.2.3, 8.2.3.4.1, 8.2.4.3.5)."""

from typing import NamedTuple

from sysmlc.language.text.scan import Tokens
from sysmlc.language.tree import Node, Reference


class Names(NamedTuple):
    """What an element is called, and the token that says it."""

    short: str | None
    name: str | None
    token: int


def call(node: Node, names: Names | None, tokens: Tokens) -> Node:
    """Give the node its names."""
    if names is not None:
        node.short, node.name = names.short, names.name
        node.name_start = tokens.starts[names.token]
    return node


def _named(tokens: Tokens, _at: int, begin: int, name: int, *_follow: object) -> Names:
    return Names(None, tokens.name(name), begin)


def _short_named(tokens: Tokens, _at: int, _begin: int, short: int, *_follow: object) -> Names:
    return Names(tokens.name(short), None, short)


def _both_named(
    tokens: Tokens, _at: int, _begin: int, short: int, name: int, *_follow: object
) -> Names:
    return Names(tokens.name(short), tokens.name(name), name)


def _simple(tokens: Tokens, _at: int, _begin: int, name: int) -> Reference:
    return Reference(((tokens.name(name),),), tokens.starts[name], tokens.ends[name])


def _global(tokens: Tokens, _at: int, begin: int, name: int) -> Reference:
    return Reference((("$", tokens.name(name)),), tokens.starts[begin], tokens.ends[name])


def _longer(tokens: Tokens, _at: int, _begin: int, before: Reference, name: int) -> Reference:
    before.chain = ((*before.chain[0], tokens.name(name)),)
    before.end = tokens.ends[name]
    return before


def _chain(_tokens: Tokens, _at: int, _begin: int, before: Reference, link: Reference) -> Reference:
    before.chain += link.chain
    before.end = link.end
    return before


ACTIONS = {
    "named": _named,
    "short_named": _short_named,
    "both_named": _both_named,
    "simple_name": _simple,
    "global_name": _global,
    "longer_name": _longer,
    "longer_chain": _chain,
}
