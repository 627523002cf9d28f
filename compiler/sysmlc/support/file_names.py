"""Names of output files that are valid on every file system (design, section 6)."""

import hashlib
from collections.abc import Iterable
from urllib.parse import quote

_MAX_BYTES = 120
_RESERVED_ON_WINDOWS = frozenset(
    ["con", "prn", "aux", "nul", *(f"{p}{n}" for p in ("com", "lpt") for n in range(10))]
)


def assign_file_names(qualified_names: Iterable[str]) -> dict[str, str]:
    """Return the file name, without suffix, of each qualified name.

    ``::`` becomes ``.``; other special characters are percent-encoded; a name has at most 120
    bytes. Names that differ only in case all get ``~`` and six hexadecimal digits of the digest of
    their qualified name.
    """
    encoded_names = {name: _encode(name) for name in qualified_names}
    counts: dict[str, int] = {}
    for encoded in encoded_names.values():
        counts[encoded.lower()] = counts.get(encoded.lower(), 0) + 1
    return {
        name: encoded if counts[encoded.lower()] == 1 else _append_digest(encoded, name)
        for name, encoded in encoded_names.items()
    }


def _encode(name: str) -> str:
    encoded = quote(name.replace("::", "."), safe="-_.").replace("~", "%7E").strip(".") or "_"
    # Windows reserves these names with any suffix.
    if encoded.split(".")[0].lower() in _RESERVED_ON_WINDOWS:
        encoded = f"_{encoded}"
    return encoded if len(encoded) <= _MAX_BYTES else _append_digest(encoded, name)


def _append_digest(encoded: str, name: str) -> str:
    digest = hashlib.sha256(name.encode("utf-8")).hexdigest()[:6]
    return f"{encoded[: _MAX_BYTES - 7]}~{digest}"
