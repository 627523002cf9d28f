"""The shipped grammars, metamodels and templates."""

from functools import cache
from pathlib import Path

_PACKAGE = Path(__file__).parents[1]


@cache
def find_root() -> Path:
    """Return the folder that contains ``grammars``, ``metamodels`` and ``templates``.

    A wheel has them inside the package; in a checkout they lie two levels above it.
    """
    checkout = _PACKAGE.parents[1]
    return checkout if (checkout / "grammars").is_dir() else _PACKAGE


def path(*parts: str) -> Path:
    """Return the path of a shipped file or folder: ``path("grammars", "expression.lark")``."""
    return find_root().joinpath(*parts)


def read_text(*parts: str) -> str:
    """Return the content of a shipped text file."""
    return path(*parts).read_text(encoding="utf-8")
