"""Grammars, metamodels and templates: where they are, in a checkout and in a wheel."""

from functools import cache
from pathlib import Path

_HERE = Path(__file__).parent


@cache
def root() -> Path:
    """Folder that holds ``grammars``, ``metamodels`` and ``templates``.

    A wheel carries them inside the package; in a checkout they are two levels up.
    """
    checkout = _HERE.parents[1]
    return checkout if (checkout / "grammars").is_dir() else _HERE


def path(*parts: str) -> Path:
    """Path of one shipped file or folder, for example ``path("grammars", "expression.lark")``."""
    return root().joinpath(*parts)


def text(*parts: str) -> str:
    """Content of one shipped text file."""
    return path(*parts).read_text(encoding="utf-8")
