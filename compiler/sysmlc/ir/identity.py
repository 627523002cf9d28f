"""Ids for what a pass or a front end makes: computed from origin and role, never random."""

from uuid import UUID, uuid5

_NAMESPACE = UUID("6f1d7a54-3f0c-5d3a-9a52-0c2f6f2d7b11")


def derived_id(origin: str, role: str) -> str:
    """Id of what plays ``role`` for the element ``origin``; the same on every machine."""
    return str(uuid5(_NAMESPACE, f"{origin}\x1f{role}"))
