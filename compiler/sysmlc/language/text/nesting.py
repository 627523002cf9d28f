"""Limits on nesting: deeper parts of a text are not read, and the limit is reported.

The limits keep parsing and name resolution of hostile texts within the stack and in linear time.
"""

import re
from functools import cache
from itertools import accumulate

from sysmlc.language.text.builders.operators import find_precedence
from sysmlc.language.text.lalr import Tables
from sysmlc.language.text.lexer import Tokens
from sysmlc.language.tree import Node

MAX_DEPTH = 200
"""Depth of bodies, parentheses and brackets, and depth of operators."""
MAX_OPERANDS = 2_000
"""Operands of operators of one precedence (a + b + ...), which are a deep tree of a flat text."""
_OPENING, _CLOSING = "{([", "})]"


def find_too_deep(tables: Tables, tokens: Tokens) -> int:
    """Return the index of the token that opens one level too many, or -1."""
    words, types = tables.types.words, tokens.types
    if sum(types.count(words[symbol]) for symbol in _OPENING) <= MAX_DEPTH:
        return -1
    steps = [0] * 256
    for opening, closing in zip(_OPENING, _CLOSING, strict=True):
        steps[words[opening]], steps[words[closing]] = 1, -1
    # Fast for almost all texts; only one with superfluous closing tokens needs the slow count.
    depths = list(accumulate(map(steps.__getitem__, types)))
    if max(depths) <= MAX_DEPTH and min(depths) >= 0:
        return -1
    return _find_first_too_deep(types, steps)


def _find_first_too_deep(types: bytearray, steps: list[int]) -> int:
    """Like ``find_too_deep``; a superfluous closing token does not lower the depth below 0."""
    depth = 0
    for index, token_type in enumerate(types):
        depth = max(depth + steps[token_type], 0)
        if depth > MAX_DEPTH:
            return index
    return -1


def has_long_expression(tables: Tables, tokens: Tokens) -> bool:
    """Whether a member has so many tokens in a row that its operators may nest too deep."""
    return _long_member_pattern(tables).search(tokens.types) is not None


@cache
def _long_member_pattern(tables: Tables) -> re.Pattern[bytes]:
    ends = bytes(tables.types.words[symbol] for symbol in ";{}")
    return re.compile(b"[^" + re.escape(ends) + b"]{%d}" % MAX_DEPTH)


def remove_deep_expressions(root: Node) -> list[Node]:
    """Remove expressions that are nested deeper than the limits, and return them.

    Elements of a sequence and operands of operators of one precedence are siblings, although the
    tree nests them. The number of such operands is limited because the time to resolve names in
    them grows with its square.
    """
    removed = []
    stack = [(root, 0, 0)]
    while stack:
        node, depth, operands = stack.pop()
        if (depth > MAX_DEPTH or operands > MAX_OPERANDS) and node.owner is not None:
            removed.append(_remove_expression(node))
            continue
        for member in reversed(node.members):
            if member.attributes.get("operator") == "," == node.attributes.get("operator"):
                stack.append((member, depth, 0))
            elif _has_same_precedence(node, member):
                stack.append((member, depth, operands + 1))
            else:
                stack.append((member, depth + 1, 0))
    return removed


def _has_same_precedence(node: Node, member: Node) -> bool:
    """Whether ``member`` is the left operand of ``node`` and both operators bind equally."""
    if len(node.members) < 2 or member is not node.members[0] or len(member.members) < 2:
        return False
    operators = node.attributes.get("operator"), member.attributes.get("operator")
    levels = [find_precedence(operator) for operator in operators if isinstance(operator, str)]
    return len(levels) == 2 and levels[0] == levels[1] != -1


def _remove_expression(node: Node) -> Node:
    """Remove the whole expression that contains ``node`` from its owner, and return it."""
    while node.owner is not None and node.owner.membership == "ParameterMembership":
        node = node.owner
    if node.owner is not None and node in node.owner.members:
        node.owner.members.remove(node)
    return node
