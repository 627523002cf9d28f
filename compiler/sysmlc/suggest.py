"""Answers to unknown names: the known ones, the nearest first."""

from collections.abc import Iterable
from functools import lru_cache

_SHOWN = 12
_REMEMBERED = 64
"""Answers that are kept: a process that compiles again asks the same."""


def did_you_mean(word: str, known: Iterable[str]) -> str:
    """A clause for the end of a message: ``did you mean 'recipe'?``, else the known names."""
    names = sorted(set(known))
    near = _near(word, tuple(names))
    if near:
        return f"did you mean '{near}'?"
    if not names:
        return "there is none"
    more = f" and {len(names) - _SHOWN} more" if len(names) > _SHOWN else ""
    return f"known: {', '.join(names[:_SHOWN])}{more}"


@lru_cache(_REMEMBERED)
def _near(word: str, names: tuple[str, ...]) -> str:
    """The name that is most like a word; empty when none is."""
    from difflib import get_close_matches

    folded = {name.casefold(): name for name in names}
    near = get_close_matches(word.casefold(), folded, n=1, cutoff=0.6)
    return folded[near[0]] if near else ""
