"""Suggestions for unknown names."""

import re
from collections.abc import Iterable
from difflib import get_close_matches
from functools import lru_cache

from sysmlc.support.counts import list_first

_MAX_LISTED = 12
_CACHE_SIZE = 64
_MAX_EDITS = 3
_LETTERS_PER_EDIT = 3
"""There is at most one edit in three letters, as in rustc, and never more than three edits."""
_MAX_LENGTH = 80
"""Longer names are not compared, because the comparison takes quadratic time."""
_WORD = re.compile(r"[A-Z]*[a-z]+|[A-Z]+|\d+|[^\W\d_A-Za-z]+")


def find_similar(word: str, known: Iterable[str]) -> str:
    """Return the known name that *word* probably misspells, or an empty text if there is none.

    Such a name differs by at most one insertion, deletion, replacement or exchange of neighbours
    in three letters of the longer name, or it has the same words in another order or with other
    separators. Upper and lower case are equal. Names that only differ in numbers are not similar.
    """
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
    return f"known: {list_first(names, _MAX_LISTED)}"


@lru_cache(_CACHE_SIZE)
def _find_similar(word: str, names: tuple[str, ...]) -> str:
    if len(word) > _MAX_LENGTH:
        return ""
    folded, words = word.casefold(), _list_words(word)
    names_by_folded = {
        name.casefold(): name for name in names if abs(len(name) - len(word)) <= _MAX_EDITS
    }
    for other, name in names_by_folded.items():
        if other == folded or (words and _list_words(name) == words):
            return name
    # difflib is fast, but a long common beginning makes names similar that mean other things.
    matches = get_close_matches(folded, names_by_folded, n=3, cutoff=0.6)
    distances = {
        match: _count_edits(folded, match)
        for match in matches
        if not _differ_in_numbers(folded, match)
    }
    nearest = min(distances, key=lambda match: distances[match], default="")
    limit = min(max(len(word), len(nearest)) // _LETTERS_PER_EDIT, _MAX_EDITS)
    return names_by_folded[nearest] if nearest and distances[nearest] <= limit else ""


def _list_words(name: str) -> list[str]:
    """Return the words of a name in camel case or with separators, in alphabetical order."""
    return sorted(word.casefold() for word in _WORD.findall(name))


def _differ_in_numbers(name: str, other: str) -> bool:
    return re.sub(r"\d", "", name) == re.sub(r"\d", "", other)


def _count_edits(word: str, other: str) -> int:
    """Return the edit distance in which an exchange of two neighbours is one edit.

    This is the optimal string alignment distance (Damerau, CACM 7 (1964) 3).
    """
    before: list[int] = []
    previous = list(range(len(other) + 1))
    for row, letter in enumerate(word, start=1):
        current = [row]
        for column, other_letter in enumerate(other, start=1):
            edits = min(
                previous[column] + 1,
                current[-1] + 1,
                previous[column - 1] + (letter != other_letter),
            )
            is_exchange = (
                row > 1
                and column > 1
                and letter == other[column - 2]
                and other_letter == word[row - 2]
            )
            current.append(min(edits, before[column - 2] + 1) if is_exchange else edits)
        before, previous = previous, current
    return previous[-1]
