"""Numbers and lists of things in messages."""

from collections.abc import Sequence


def count(number: int, noun: str) -> str:
    """Return a number with its noun in the singular or plural: ``1 step``, ``2 classes``."""
    if noun.endswith("y") and noun[-2:-1] not in "aeou":
        plural = f"{noun[:-1]}ies"
    else:
        plural = f"{noun}es" if noun.endswith("s") else f"{noun}s"
    return f"{number:,} {noun if number == 1 else plural}"


def list_first(texts: Sequence[str], limit: int) -> str:
    """Return the first *limit* texts, and how many there are besides: ``a, b and 3 more``."""
    more = f" and {len(texts) - limit} more" if len(texts) > limit else ""
    return f"{', '.join(texts[:limit])}{more}"
