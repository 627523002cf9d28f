"""Paths of elements: names from the top down, in brackets where a name holds a separator."""

from collections.abc import Iterable, Iterator
from posixpath import dirname, normpath
from unicodedata import normalize

_SEPARATORS = frozenset("/[]@:")


def split(path: str) -> tuple[str, ...]:
    """The names of a path; brackets mean nothing but the name in them, as in CAEX paths."""
    return tuple(_names(path)) if "[" in path else tuple(path.split("/"))


def _names(path: str) -> Iterator[str]:
    name, depth = "", 0
    for sign in path:
        depth += (sign == "[") - (sign == "]")
        if sign == "/" and depth == 0:
            yield name
            name = ""
        elif not (sign == "[" and depth == 1) and not (sign == "]" and depth == 0):
            name += sign
    yield name


def join(names: Iterable[str]) -> str:
    """The path of these names; AML.Engine brackets all when one needs it, we that one."""
    return "/".join(f"[{n}]" if _SEPARATORS.intersection(n) else n for n in names)


def beside(file: str, name: str) -> str:
    """Name in the unit of the file that ``file`` calls ``name``."""
    return normalize("NFC", normpath(f"{dirname(file) or '.'}/{name}"))
