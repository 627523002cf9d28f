"""Identifiers for formulas, derived from the names in the model."""

import re
from functools import lru_cache

_RESERVED = frozenset(
    ["G", "F", "X", "U", "R", "W", "V", "true", "false", "TRUE", "FALSE", "mod", "M", "xor"]
)
"""Words with a meaning in one of the formula formats."""
_INVALID_CHARACTERS = re.compile(r"[^0-9A-Za-z_]+")
_SIGNS = re.compile(r"\W+")
_MAX_LENGTH = 40
_CACHED_NAMES = 1 << 12
"""Cache size: names of actions and states recur often."""


@lru_cache(_CACHED_NAMES)
def identifier(name: str, fallback: str = "x") -> str:
    """Return the name as an identifier that every target accepts: letters, digits, underscores."""
    # A shortcut for most names, which are identifiers already.
    is_plain = name.isascii() and name.isidentifier()
    text = name if is_plain else _INVALID_CHARACTERS.sub("_", name.strip())
    text = text.strip("_")[:_MAX_LENGTH].rstrip("_") or fallback
    text = f"_{text}" if text[0].isdigit() else text
    return f"{text}_" if text in _RESERVED else text


def spell_name(name: str) -> str:
    """Return the name of an action or state as formulas spell it: ``production_completed``.

    Blanks and signs are underscores; letters of all scripts stay.
    """
    return _SIGNS.sub("_", name.strip())


class Names:
    """Generates unique identifiers; the second ``x`` becomes ``x_2``."""

    def __init__(self, *taken: str) -> None:
        self._taken = {name.lower() for name in taken}

    def new(self, name: str, fallback: str = "x") -> str:
        """Return an unused identifier for the name; identifiers differ in more than case."""
        candidate = base = identifier(name, fallback)
        number, lower = 1, base.lower()
        while lower in self._taken:
            number += 1
            candidate = f"{base}_{number}"
            lower = candidate.lower()
        self._taken.add(lower)
        return candidate


def make_unique(names: list[str], fallback: str, *taken: str) -> tuple[str, ...]:
    """Return identifiers for the names in order, all different and none of *taken*."""
    source = Names(*taken)
    return tuple(source.new(name, fallback) for name in names)
