"""Whether the writes of an activity can leave the ranges of their variables.

What the values on the way to a write rule out is not asked further. Of the rest all states are
looked at that the activity can reach, whatever the environment decides, unless they are too many.
"""

from enum import StrEnum
from functools import lru_cache

from sysmlc.logic import domains
from sysmlc.logic.activities.concurrency import Together
from sysmlc.logic.activities.saturation import reduced, search
from sysmlc.logic.activities.token_graph import Store, TokenGraph, Write
from sysmlc.logic.activities.value_analysis import MOST_VALUES, Spread

_REMEMBERED = 256
"""Answers that are kept: a process that compiles again finds those of what was not edited."""


class Can(StrEnum):
    """Whether something happens in some run."""

    YES = "can"
    NO = "cannot"
    PERHAPS = "may (it has too many states to tell)"


@lru_cache(_REMEMBERED)
def leaving(tokens: TokenGraph) -> tuple[tuple[Store, Write, Can], ...]:
    """Each write that has stops, and whether it comes to one."""
    could = [(store, one) for store in tokens.stores for one in store.writes if one.stops]
    together = Together(tokens)
    said = [(*one, _on_the_way(tokens, together, *one)) for one in could]
    found = search(tokens, [write for _, write, can in said if can is Can.PERHAPS])
    rest = Can.NO if found.is_complete else Can.PERHAPS
    return tuple(
        (store, write, Can.YES if write in found.writes else rest if can is Can.PERHAPS else can)
        for store, write, can in said
    )


def _on_the_way(tokens: TokenGraph, together: Together, store: Store, write: Write) -> Can:
    """What the values along the flows say."""
    if domains.size(store.variable.domain) > MOST_VALUES:
        return Can.PERHAPS
    spread = Spread(reduced(tokens, [write]), together, store)
    if not spread.may_stop(write):
        return Can.NO
    return Can.YES if spread.is_exact else Can.PERHAPS
