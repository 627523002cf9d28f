"""Ids for what a pass or a front end makes: computed from origin and role, never random."""

import re
from hashlib import sha1

_MADE_BY_TOOLS = re.compile(
    r"_[\w-]{22}|_\w+_\d+_\d+_\d+|EA(ID|PK)_[0-9A-F]{8}_\w+|eee_\d+_\d+_\d+", re.ASCII
)
_UNMISTAKABLE = 20
"""Length from which tools' ids are unique in the world: Papyrus writes 23 characters, MagicDraw
about 41, Enterprise Architect 43."""
ROOT = "eee_1045467100313_"
"""Start of the ids of MagicDraw's roots, the same in every project."""
_NAMESPACE = bytes.fromhex("6f1d7a543f0c5d3a9a520c2f6f2d7b11")
_VARIANT = dict(zip("0123456789abcdef", "89ab" * 4, strict=True))
"""Digit of a UUID in which two bits say that it is one of RFC 9562."""


def is_unmistakable(id: str) -> bool:
    """Whether an id of a file is of the kind that tools make, the same in no two models."""
    return len(id) >= _UNMISTAKABLE and not id.startswith(ROOT)


def is_made_by_tools(id: str) -> bool:
    """Whether it is an id as Eclipse, MagicDraw and Enterprise Architect make them, and no word."""
    return _MADE_BY_TOOLS.fullmatch(id) is not None


def derived_id(origin: str, role: str) -> str:
    """Id of what plays ``role`` for the element ``origin``; the same on every machine.

    A UUID of version 5 (RFC 9562, 5.5), made here because ``uuid.uuid5`` takes three times as long.
    """
    name = f"{origin}\x1f{role}".encode()
    found = sha1(_NAMESPACE + name, usedforsecurity=False).hexdigest()
    variant = _VARIANT[found[16]]
    return f"{found[:8]}-{found[8:12]}-5{found[13:16]}-{variant}{found[17:20]}-{found[20:32]}"
