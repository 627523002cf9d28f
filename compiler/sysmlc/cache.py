"""The cache folder: what earlier runs found, by a digest of everything that it depends on.

Nothing in it is needed: an entry that is missing, damaged or cannot be written costs time only.
"""

import os
import zlib
from _thread import get_ident
from collections.abc import Iterator
from contextlib import suppress
from pathlib import Path

from sysmlc.values import dataclass

VARIABLE = "SYSMLC_CACHE"
"""Environment variable: another folder for the cache, or ``off``."""

_LIMIT = 512 * 2**20
_SUFFIX = ".entry"
_SUM = 4
"""Bytes of the check sum before an entry."""

_TALLY = "tally"
"""File with a byte for each ``limit / 8192`` bytes that were put since the last look at sizes."""
_ROUND = 128
"""So many bytes of it, and entries are looked through: at 1/64 of the limit."""


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
            with path.open("rb", buffering=0) as stream:
                known, content = stream.read(_SUM), stream.readall()
            os.utime(path)
        except OSError:
            return None
        return content if content and known == _check_sum(content) else None

    def put(self, key: str, *parts: bytes | memoryview) -> None:
        """Keep an entry, of parts; in one step, so that no other process sees half of it."""
        path = self._path(key)
        temporary = f"{path}.{os.getpid()}.{get_ident()}"
        with suppress(OSError):
            path.parent.mkdir(parents=True, exist_ok=True)
            try:
                with open(temporary, "wb", opener=_private) as stream:
                    stream.writelines((_check_sum(*parts), *parts))
                os.replace(temporary, path)  # noqa: PTH105 - hundreds of files at once
            except BaseException:
                Path(temporary).unlink(missing_ok=True)
                raise
            self._count(sum(map(len, parts)))

    def _count(self, size: int) -> None:
        """Look through the entries, which takes its time, once after many were put."""
        with (self.folder / _TALLY).open("ab") as tally:
            tally.write(b"." * (1 + size * 64 * _ROUND // self.limit))
            if tally.tell() >= _ROUND:
                tally.truncate(0)
                self._prune()

    def _path(self, key: str) -> Path:
        return self.folder / key[:2] / f"{key}{_SUFFIX}"

    def _prune(self) -> None:
        entries = sorted(self._entries())
        size = sum(entry[1] for entry in entries)
        for _, of_entry, path in entries:
            if size <= self.limit:
                return
            Path(path).unlink(missing_ok=True)
            size -= of_entry

    def _entries(self) -> Iterator[tuple[int, int, str]]:
        """When each entry was used last, its size, its path."""
        for folder in os.scandir(self.folder):
            for entry in os.scandir(folder) if folder.is_dir() else ():
                if entry.name.endswith(_SUFFIX):
                    stat = entry.stat()
                    yield stat.st_mtime_ns, stat.st_size, entry.path


def _private(path: str, flags: int) -> int:
    return os.open(path, flags, 0o600)


def _check_sum(*parts: bytes | memoryview) -> bytes:
    found = 0
    for part in parts:
        found = zlib.crc32(part, found)
    return found.to_bytes(_SUM, "big")


def default() -> Cache | None:
    """The cache of this user, or None when it is switched off."""
    chosen = os.environ.get(VARIABLE, "")
    if chosen.lower() == "off":
        return None
    return Cache(Path(chosen) if chosen else _user_folder())


def _user_folder() -> Path:
    from platformdirs import user_cache_path

    return user_cache_path("sysmlc", appauthor=False)
