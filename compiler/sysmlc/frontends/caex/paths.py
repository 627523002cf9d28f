"""Class paths of CAEX: ``Alias@Lib/Class/Nested``, parts in brackets where a name needs them."""

from functools import lru_cache
from typing import NamedTuple


class Path(NamedTuple):
    """A class path: alias of another file (or empty), and the names from the library down."""

    alias: str
    names: tuple[str, ...]


@lru_cache(65536)
def split(text: str) -> Path:
    """The parts of a class path.

    Brackets mean nothing but the name in them (AML.Engine brackets every part when one needs
    it), so that both spellings are equal.
    """
    if "[" not in text:
        alias, at, rest = text.partition("@")
        return Path(alias, tuple(rest.split("/"))) if at else Path("", tuple(text.split("/")))
    names = list(_bracketed(text))
    alias, at, first = names[0].partition("@") if not text.startswith("[") else ("", "", names[0])
    return Path(alias, (first, *names[1:])) if at else Path("", tuple(names))


def _bracketed(text: str) -> list[str]:
    names, name, depth = [], "", 0
    for sign in text:
        depth += (sign == "[") - (sign == "]")
        if sign == "/" and depth == 0:
            names.append(name)
            name = ""
        elif not (sign == "[" and depth == 1) and not (sign == "]" and depth == 0):
            name += sign
    return [*names, name]


def plain(identifier: str) -> str:
    """An id without braces and in lower case: writers differ in both."""
    return identifier.strip().strip("{}").lower()
