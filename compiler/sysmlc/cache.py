"""The cache folder: what earlier runs found, by a digest of everything that it depends on.

Nothing in it is needed: an entry that is missing, damaged or cannot be written costs time only.
"""

import os
import zlib
from contextlib import suppress
from pathlib import Path

from sysmlc.values import dataclass

VARIABLE = "SYSMLC_CACHE"
"""Environment variable: another folder for the cache, or ``off``."""

_LIMIT = 512 * 2**20
_SUFFIX = ".entry"
_SUM = 4
"""Bytes of the check sum before an entry."""


@dataclass(frozen=True, slots=True)
class Cache:
    """Entries of bytes in a folder; the ones not used for longest go when it exceeds ``limit``.

    ``limit`` counts bytes on disk.
    """

    folder: Path
    limit: int = _LIMIT

    def get(self, key: str) -> bytes | None:
        """The entry, or None when there is none that is whole."""
        path = self._path(key)
        try:
            data = path.read_bytes()
            os.utime(path)
        except OSError:
            return None
        content = data[_SUM:]
        return content if content and data[:_SUM] == _check_sum(content) else None

    def put(self, key: str, data: bytes) -> None:
        """Keep an entry; in one step, so that no other process sees half of it."""
        from tempfile import mkstemp

        path = self._path(key)
        with suppress(OSError):
            path.parent.mkdir(parents=True, exist_ok=True)
            handle, temporary = mkstemp(dir=path.parent)
            with os.fdopen(handle, "wb") as stream:
                stream.write(_check_sum(data) + data)
            Path(temporary).replace(path)
            self._prune()

    def _path(self, key: str) -> Path:
        return self.folder / key[:2] / f"{key}{_SUFFIX}"

    def _prune(self) -> None:
        entries = [(path, path.stat()) for path in self.folder.glob(f"*/*{_SUFFIX}")]
        size = sum(stat.st_size for _, stat in entries)
        for path, stat in sorted(entries, key=lambda entry: entry[1].st_mtime_ns):
            if size <= self.limit:
                return
            path.unlink(missing_ok=True)
            size -= stat.st_size


def _check_sum(data: bytes) -> bytes:
    return zlib.crc32(data).to_bytes(_SUM, "big")


def default() -> Cache | None:
    """The cache of this user, or None when it is switched off."""
    chosen = os.environ.get(VARIABLE, "")
    if chosen.lower() == "off":
        return None
    return Cache(Path(chosen) if chosen else _user_folder())


def _user_folder() -> Path:
    from platformdirs import user_cache_path

    return user_cache_path("sysmlc", appauthor=False)
