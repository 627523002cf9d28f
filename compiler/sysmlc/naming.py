"""File names for outputs, safe on every file system (design, section 6)."""

import hashlib
from collections.abc import Iterable
from urllib.parse import quote

_LIMIT = 120
_RESERVED = frozenset(
    ["con", "prn", "aux", "nul", *(f"{p}{n}" for p in ("com", "lpt") for n in range(10))]
)


def file_names(qualified_names: Iterable[str]) -> dict[str, str]:
    """File name without suffix for each qualified name.

    ``::`` becomes ``.``, other characters are percent-encoded, at most 120 bytes; names that
    collide without case all get ``~`` and six hex digits of their qualified name.
    """
    names = {name: _plain(name) for name in qualified_names}
    seen: dict[str, int] = {}
    for plain in names.values():
        seen[plain.lower()] = seen.get(plain.lower(), 0) + 1
    return {
        name: plain if seen[plain.lower()] == 1 else _distinct(plain, name)
        for name, plain in names.items()
    }


def _plain(name: str) -> str:
    encoded = quote(name.replace("::", "."), safe="-_.").replace("~", "%7E").strip(".") or "_"
    if encoded.split(".")[0].lower() in _RESERVED:
        encoded = f"_{encoded}"
    return encoded if len(encoded) <= _LIMIT else _distinct(encoded, name)


def _distinct(plain: str, name: str) -> str:
    digest = hashlib.sha256(name.encode("utf-8")).hexdigest()[:6]
    return f"{plain[: _LIMIT - 7]}~{digest}"
