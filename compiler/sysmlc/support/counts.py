"""Numbers of things in messages."""


def count(number: int, noun: str) -> str:
    """Return a number with its noun in the singular or plural: ``1 step``, ``2 classes``."""
    if noun.endswith("y") and noun[-2:-1] not in "aeou":
        plural = f"{noun[:-1]}ies"
    else:
        plural = f"{noun}es" if noun.endswith("s") else f"{noun}s"
    return f"{number:,} {noun if number == 1 else plural}"
