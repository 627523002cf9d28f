"""Lists of the grammar, bodies, and what has no value of its own."""

from typing import TypeVar

from sysmlc.language.text.scan import Tokens
from sysmlc.language.tree import Node

T = TypeVar("T")


def _first(_tokens: Tokens, _at: int, _begin: int, item: T) -> list[T]:
    return [item]


def _more(_tokens: Tokens, _at: int, _begin: int, items: list[T], item: T) -> list[T]:
    items.append(item)
    return items


def _items_first(_tokens: Tokens, _at: int, _begin: int, item: Node | list[Node]) -> list[Node]:
    return item if isinstance(item, list) else [item]


def _items_more(
    _tokens: Tokens, _at: int, _begin: int, items: list[Node], item: Node | list[Node]
) -> list[Node]:
    if isinstance(item, list):
        items += item
    else:
        items.append(item)
    return items


def _join(_tokens: Tokens, _at: int, _begin: int, items: list[T], more: list[T]) -> list[T]:
    items += more
    return items


def _same(_tokens: Tokens, _at: int, _begin: int, value: T) -> T:
    return value


def _nothing(_tokens: Tokens, _at: int, _begin: int, *_ignored: object) -> list[Node]:
    return []


def _result(tokens: Tokens, node: Node) -> Node:
    node.membership = "ResultExpressionMembership"
    tokens.special.append(node)
    return node


def _only_result(tokens: Tokens, _at: int, _begin: int, result: Node) -> list[Node]:
    return [_result(tokens, result)]


def _with_result(
    tokens: Tokens, _at: int, _begin: int, items: list[Node], result: Node
) -> list[Node]:
    items.append(_result(tokens, result))
    return items


ACTIONS = {
    "first": _first,
    "more": _more,
    "items_first": _items_first,
    "items_more": _items_more,
    "join": _join,
    "nothing": _nothing,
    "block": _same,
    "only_result": _only_result,
    "with_result": _with_result,
    "bracket": _same,
    "arguments": _same,
    "general": _same,
    "from": _nothing,
    "typed_by": _nothing,
}
