"""Aliases: short names for the elements of one diagram, the same in every run."""

import re
from collections import Counter
from collections.abc import KeysView
from functools import lru_cache

_REMEMBERED = 1 << 12
"""Names whose words are kept: those of states and actions come again and again."""


class Aliases:
    """Assigns an alias to each key: words of its name and a number, never a keyword of PlantUML.

    The number counts equal words in the order of the diagram, so that an element that is added
    elsewhere changes no other line.
    """

    def __init__(self) -> None:
        self._of: dict[str, str] = {}
        self._taken: Counter[str] = Counter()

    def make(self, key: str, name: str, otherwise: str) -> str:
        """Return the alias of *key*, made from *name* or, if that has no letters, from
        *otherwise*.
        """
        if key not in self._of:
            words = _normalize(name) or _normalize(otherwise) or "e"
            self._taken[words] += 1
            self._of[key] = f"{words}_{self._taken[words]}"
        return self._of[key]

    def __contains__(self, key: object) -> bool:
        return key in self._of

    def __getitem__(self, key: str) -> str:
        return self._of[key]

    def keys(self) -> KeysView[str]:
        """Return the keys that have an alias."""
        return self._of.keys()


@lru_cache(_REMEMBERED)
def _normalize(name: str) -> str:
    return re.sub(r"[^a-z0-9]+", "_", name.lower())[:24].strip("_")
