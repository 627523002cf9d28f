"""Identifiers for formulas out of the modeller's names."""

import re
from functools import lru_cache

_RESERVED = frozenset(
    ["G", "F", "X", "U", "R", "W", "V", "true", "false", "TRUE", "FALSE", "mod", "M", "xor"]
)


_OTHERS = re.compile(r"[^0-9A-Za-z_]+")
_REMEMBERED = 1 << 12
"""Names that are kept: those of actions and states come again and again."""


@lru_cache(_REMEMBERED)
def identifier(name: str, fallback: str = "x") -> str:
    """The name as an identifier that every target reads: letters, digits, underscores."""
    # Most names are identifiers as they are.
    is_plain = name.isascii() and name.isidentifier()
    text = name if is_plain else _OTHERS.sub("_", name.strip())
    text = text.strip("_")[:40].rstrip("_") or fallback
    text = f"_{text}" if text[0].isdigit() else text
    return f"{text}_" if text in _RESERVED else text


class Names:
    """Gives out identifiers, each once; the second ``x`` is ``x_2``."""

    def __init__(self, *taken: str) -> None:
        self._taken = {name.lower() for name in taken}

    def new(self, name: str, fallback: str = "x") -> str:
        """A free identifier for the name; names that differ only in case count as equal."""
        made = base = identifier(name, fallback)
        number, lower = 1, base.lower()
        while lower in self._taken:
            number += 1
            made = f"{base}_{number}"
            lower = made.lower()
        self._taken.add(lower)
        return made


def unique(names: list[str], fallback: str, *taken: str) -> tuple[str, ...]:
    """Identifiers for names in order, all different and none of the taken ones."""
    source = Names(*taken)
    return tuple(source.new(name, fallback) for name in names)
