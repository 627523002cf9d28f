"""Ids for what a pass or a front end makes: computed from origin and role, never random."""

from uuid import UUID, uuid5

_UNMISTAKABLE = 20
"""Length from which tools' ids are unique in the world: Papyrus writes 23 characters, MagicDraw
about 41, Enterprise Architect 43."""
ROOT = "eee_1045467100313_"
"""Start of the ids of MagicDraw's roots, the same in every project."""
_NAMESPACE = UUID("6f1d7a54-3f0c-5d3a-9a52-0c2f6f2d7b11")


def is_unmistakable(id: str) -> bool:
    """Whether an id of a file is of the kind that tools make, the same in no two models."""
    return len(id) >= _UNMISTAKABLE and not id.startswith(ROOT)


def derived_id(origin: str, role: str) -> str:
    """Id of what plays ``role`` for the element ``origin``; the same on every machine."""
    return str(uuid5(_NAMESPACE, f"{origin}\x1f{role}"))
