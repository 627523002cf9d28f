"""Lark's reader of grammars/expression.lark: slow to get ready, and right by construction."""

import re
from collections.abc import Callable
from functools import cache
from typing import TypeVar, cast

from lark import Lark, Token, Tree
from lark.exceptions import UnexpectedInput

from sysmlc import resources
from sysmlc.logic.expressions.expression import (
    Assignment,
    Binary,
    Call,
    Conditional,
    Expression,
    ExpressionError,
    Index,
    Invocation,
    Literal,
    Member,
    Name,
    Send,
    Statement,
    Unary,
)

_Node = Tree[Token]
_T = TypeVar("_T")
_SPELLING = {"&&": "and", "&": "and", "||": "or", "|": "or", "!": "not", "=": "==", "<>": "!="}
_ESCAPE = {"n": "\n"}


def oracle_expression(text: str) -> Expression:
    """What ``parse_expression`` should give. Raises ExpressionError at the same place."""
    return _read(text, "expression", lambda tree: _expression(_nodes(tree)[0]))


def oracle_effect(text: str) -> tuple[Statement, ...]:
    """What ``parse_effect`` should give. Raises ExpressionError at the same place."""
    return _read(text, "effect", lambda tree: tuple(_statement(node) for node in _nodes(tree)))


def _read(text: str, start: str, build: Callable[[_Node], _T]) -> _T:
    try:
        return build(_parser(start).parse(text))
    except UnexpectedInput as error:
        offset = _place(error, text)
        raise ExpressionError(_complaint(text, offset), offset) from None


def _place(error: UnexpectedInput, text: str) -> int:
    token = getattr(error, "token", None)
    at_end = token is not None and token.type == "$END"
    return len(text) if at_end or error.pos_in_stream is None else error.pos_in_stream


def _complaint(text: str, offset: int) -> str:
    rest = text[offset:].split()
    return f"'{rest[0][:20]}' is not expected here" if rest else "the text ends too early"


@cache
def _parser(start: str) -> Lark:
    return Lark(
        resources.text("grammars", "expression.lark"),
        parser="lalr",
        start=start,
        propagate_positions=True,
        maybe_placeholders=False,
    )


def _nodes(tree: _Node) -> list[_Node]:
    return [child for child in tree.children if isinstance(child, Tree)]


def _offset(tree: _Node) -> int:
    return tree.meta.start_pos


def _expression(tree: _Node) -> Expression:
    return _RULES[str(tree.data)](tree)


def _literal(tree: _Node) -> Expression:
    token = cast("Token", tree.children[0])
    return Literal(_VALUES[token.type](str(token)), _offset(tree))


def _qualified(tree: _Node) -> Name:
    return Name(tuple(_name(node) for node in _nodes(tree)), _offset(tree))


def _name(tree: _Node) -> str:
    token = cast("Token", tree.children[0])
    return _unquoted(str(token)) if token.type == "QUOTED_NAME" else str(token)


def _member(tree: _Node) -> Expression:
    base, name = _nodes(tree)
    return Member(_expression(base), _name(name), _offset(tree))


def _call(tree: _Node) -> Expression:
    function, *args = map(_expression, _nodes(tree))
    return Call(function, tuple(args), _offset(tree))


def _index(tree: _Node) -> Expression:
    base, index = map(_expression, _nodes(tree))
    return Index(base, index, _offset(tree))


def _unary(tree: _Node) -> Expression:
    return Unary(_operator(tree), _expression(_nodes(tree)[0]), _offset(tree))


def _binary(tree: _Node) -> Expression:
    left, right = map(_expression, _nodes(tree))
    return Binary(_operator(tree), left, right, _offset(tree))


def _conditional(tree: _Node) -> Expression:
    condition, then, otherwise = map(_expression, _nodes(tree))
    return Conditional(condition, then, otherwise, _offset(tree))


def _operator(tree: _Node) -> str:
    token = next(str(child) for child in tree.children if isinstance(child, Token)).lower()
    return _SPELLING.get(token, token)


def _statement(tree: _Node) -> Statement:
    if tree.data == "assignment":
        return _assignment(tree)
    if tree.data == "send":
        return _send(tree)
    return _invocation(tree)


def _assignment(tree: _Node) -> Statement:
    target, value = map(_expression, _nodes(tree))
    if not isinstance(target, Name | Member | Index):
        raise ExpressionError("only a feature can be assigned to", _offset(tree))
    return Assignment(target, value, _offset(tree))


def _send(tree: _Node) -> Statement:
    signal, *rest = _nodes(tree)
    receivers = [_expression(_nodes(node)[0]) for node in rest if node.data == "receiver"]
    args = tuple(_expression(node) for node in rest if node.data != "receiver")
    return Send(_qualified(signal), args, receivers[0] if receivers else None, _offset(tree))


def _invocation(tree: _Node) -> Statement:
    call = _expression(_nodes(tree)[0])
    if not isinstance(call, Name | Member | Call):
        raise ExpressionError("this is a value and does nothing", _offset(tree))
    return Invocation(call, _offset(tree))


def _unquoted(text: str) -> str:
    return re.sub(r"\\(.)", lambda found: _ESCAPE.get(found[1], found[1]), text[1:-1])


_VALUES: dict[str, Callable[[str], bool | int | float | str]] = {
    "TRUE": lambda _: True,
    "FALSE": lambda _: False,
    "INTEGER": int,
    "REAL": float,
    "STRING": _unquoted,
}
_RULES: dict[str, Callable[[_Node], Expression]] = {
    "literal": _literal,
    "qualified": _qualified,
    "member": _member,
    "call": _call,
    "index": _index,
    "unary": _unary,
    "binary": _binary,
    "conditional": _conditional,
}
