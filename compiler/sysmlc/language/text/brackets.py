"""`x [` at the start of a member: a declaration with a multiplicity, or a result with a unit.

One token ahead does not tell; what stands behind the closing bracket does.
"""

import re
from collections.abc import Iterator
from functools import cache

from sysmlc.language.text.scan import Tokens
from sysmlc.language.text.tables import Tables

_GO_ON = (
    "} ?? or and implies xor | & == != === !== < > <= >= .. + - * / % ^ ** istype hastype @ as @@ "
    "meta . .? -> # ("
)
"""What goes on with an expression, or ends the body that it is the result of."""


def settle(tables: Tables, tokens: Tokens) -> None:
    """Give brackets that belong to expressions, where a member starts, a type of their own."""
    words = tables.types.words
    for index in _openings(tables, tokens):
        closing = _closing(tokens, index, words["["], words["]"])
        if tokens.types[closing] in _following(tables):
            tokens.types[index] = tables.index


def _openings(tables: Tables, tokens: Tokens) -> Iterator[int]:
    for found in _pattern(tables).finditer(tokens.types):
        yield found.end() - 1


@cache
def _pattern(tables: Tables) -> re.Pattern[bytes]:
    words, types = tables.types.words, tables.types
    before = bytes([words[";"], words["{"], words["}"], types.body])
    name, bracket = bytes([types.name]), bytes([words["["]])
    return re.compile(b"(?<=[" + re.escape(before) + b"])" + re.escape(name + bracket))


@cache
def _following(tables: Tables) -> frozenset[int]:
    return frozenset(tables.types.words[word] for word in _GO_ON.split())


def _closing(tokens: Tokens, index: int, opening: int, closing: int) -> int:
    """The token after the bracket that closes the one at ``index``; the last one without."""
    depth = 0
    for at in range(index, len(tokens.types) - 1):
        kind = tokens.types[at]
        depth += (kind == opening) - (kind == closing)
        if depth == 0:
            return at + 1
    return len(tokens.types) - 1
