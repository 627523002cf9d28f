"""Suggestions for unknown names."""

from collections.abc import Iterable
from difflib import get_close_matches
from functools import lru_cache

_MAX_LISTED = 12
_CACHE_SIZE = 64


def find_similar(word: str, known: Iterable[str]) -> str:
    """Return the known name that is most similar to *word*, or an empty text if none is."""
    return _find_similar(word, tuple(sorted(set(known))))


def did_you_mean(word: str, known: Iterable[str]) -> str:
    """Return the advice at the end of a message about the unknown *word*.

    It is ``did you mean 'recipe'?`` if a similar name is known, else a list of the known names.
    """
    names = sorted(set(known))
    similar = _find_similar(word, tuple(names))
    if similar:
        return f"did you mean '{similar}'?"
    if not names:
        return "there is none"
    rest = f" and {len(names) - _MAX_LISTED} more" if len(names) > _MAX_LISTED else ""
    return f"known: {', '.join(names[:_MAX_LISTED])}{rest}"


@lru_cache(_CACHE_SIZE)
def _find_similar(word: str, names: tuple[str, ...]) -> str:
    """Return the name that is most similar to *word*, or an empty text if none is."""
    names_by_folded = {name.casefold(): name for name in names}
    matches = get_close_matches(word.casefold(), names_by_folded, n=1, cutoff=0.6)
    return names_by_folded[matches[0]] if matches else ""
