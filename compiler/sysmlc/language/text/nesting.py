"""A text that is nested deeper than any model is read up to there, and told."""

import re
from functools import cache
from itertools import accumulate

from sysmlc.language.text.build.operators import level
from sysmlc.language.text.scan import Tokens
from sysmlc.language.text.tables import Tables
from sysmlc.language.tree import Node

LIMIT = 200
"""Bodies, parentheses and brackets within one another; operators within one another too."""
ROW = 2_000
"""Operands of one row of operators (a + b + ...), which is flat in the text."""
_OPENING, _CLOSING = "{([", "})]"


def too_deep(tables: Tables, tokens: Tokens) -> int:
    """The token that opens one level too many, or -1."""
    words, types = tables.types.words, tokens.types
    if sum(types.count(words[symbol]) for symbol in _OPENING) <= LIMIT:
        return -1
    steps = [0] * 256
    for opening, closing in zip(_OPENING, _CLOSING, strict=True):
        steps[words[opening]], steps[words[closing]] = 1, -1
    depths = list(accumulate(map(steps.__getitem__, types)))
    if max(depths) <= LIMIT and min(depths) >= 0:
        return -1
    return _first_too_deep(types, steps)


def _first_too_deep(types: bytearray, steps: list[int]) -> int:
    """What closes more than is open counts for nothing."""
    depth = 0
    for index, kind in enumerate(types):
        depth = max(depth + steps[kind], 0)
        if depth > LIMIT:
            return index
    return -1


def has_long_expression(tables: Tables, tokens: Tokens) -> bool:
    """Whether so many tokens stand between the ends of members that operators may nest deep."""
    return _long(tables).search(tokens.types) is not None


@cache
def _long(tables: Tables) -> re.Pattern[bytes]:
    ends = bytes(tables.types.words[symbol] for symbol in ";{}")
    return re.compile(b"[^" + re.escape(ends) + b"]{%d}" % LIMIT)


def cut(root: Node) -> list[Node]:
    """Take expressions away that are nested deeper than the limit; those taken.

    Elements of a sequence and operands of one row of operators are beside one another, though
    the tree has them within one another. The time for names in a row grows with its square.
    """
    taken = []
    waiting = [(root, 0, 0)]
    while waiting:
        node, depth, row = waiting.pop()
        if (depth > LIMIT or row > ROW) and node.owner is not None:
            taken.append(_uproot(node))
            continue
        for member in reversed(node.members):
            if member.facts.get("operator") == "," == node.facts.get("operator"):
                waiting.append((member, depth, 0))
            elif _is_row(node, member):
                waiting.append((member, depth, row + 1))
            else:
                waiting.append((member, depth + 1, 0))
    return taken


def _is_row(node: Node, member: Node) -> bool:
    """Whether a left operand continues the row of operators that a binary operation ends."""
    if len(node.members) < 2 or member is not node.members[0] or len(member.members) < 2:
        return False
    operators = node.facts.get("operator"), member.facts.get("operator")
    levels = [level(one) for one in operators if isinstance(one, str)]
    return len(levels) == 2 and levels[0] == levels[1] != -1


def _uproot(node: Node) -> Node:
    """Remove the whole expression that a node is in from the element that has it."""
    while node.owner is not None and node.owner.membership == "ParameterMembership":
        node = node.owner
    if node.owner is not None and node in node.owner.members:
        node.owner.members.remove(node)
    return node
