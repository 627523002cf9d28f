"""The cache: results of earlier runs in a private folder of the user.

An entry is found by a key, the digest of everything that its content depends on. A missing,
damaged or misplaced entry costs time only. Because an entry decides what a run reports, nobody else
may be able to write one: the folder belongs to the user, is closed to others, and lies outside the
project, whose files a stranger may have written.
"""

import hashlib
import os
import stat
from collections.abc import Iterable, Iterator
from contextlib import suppress
from pathlib import Path
from secrets import token_hex

from msgspec import Struct
from platformdirs import user_cache_path

VARIABLE = "SYSMLC_CACHE"
"""Environment variable: another folder for the cache, or ``off``."""

_LIMIT = 512 * 2**20
_SUFFIX = ".entry"
_FOLDER_MODE = 0o700
_FILE_MODE = 0o600
_WRITABLE_BY_OTHERS = stat.S_IWGRP | stat.S_IWOTH
_DIGEST_BYTES = hashlib.sha256().digest_size

_TALLY = "tally"
"""File with a byte for each ``limit / 8192`` bytes stored since entries were last evicted."""
_ROUND = 128
"""Entries are evicted when the tally has so many bytes: at 1/64 of the limit."""


class CacheError(Exception):
    """The folder must not be used as a cache; the message says why and what to do."""


class Cache(Struct, frozen=True):
    """Entries of bytes in a folder; the least recently used are evicted above ``limit`` bytes."""

    folder: Path
    limit: int = _LIMIT

    def get(self, key: str) -> bytes | None:
        """Return the content stored under *key*, or None if there is no intact entry."""
        path = self._path(key)
        try:
            data = path.read_bytes()
            os.utime(path)
        except OSError:
            return None
        digest, content = data[:_DIGEST_BYTES], data[_DIGEST_BYTES:]
        return content if digest == _compute_digest(key, content) else None

    def put(self, key: str, content: bytes) -> None:
        """Store *content* under *key* in one step, so that no process sees half an entry."""
        path = self._path(key)
        temporary = f"{path}.{token_hex(8)}"
        with suppress(OSError):
            path.parent.mkdir(mode=_FOLDER_MODE, exist_ok=True)
            try:
                with open(temporary, "xb", opener=_open_private) as stream:
                    stream.writelines((_compute_digest(key, content), content))
                os.replace(temporary, path)  # noqa: PTH105 - the other name is a text
            except BaseException:
                Path(temporary).unlink(missing_ok=True)
                raise
            self._count(len(content))

    def _count(self, size: int) -> None:
        """Note the size of a new entry; evict old ones once enough has been stored."""
        with open(self.folder / _TALLY, "ab", opener=_open_private) as tally:
            tally.write(b"." * (1 + size * 64 * _ROUND // self.limit))
            if tally.tell() >= _ROUND:
                tally.truncate(0)
                self._evict()

    def _path(self, key: str) -> Path:
        return self.folder / key[:2] / f"{key}{_SUFFIX}"

    def _evict(self) -> None:
        entries = sorted(self._entries())
        size = sum(entry[1] for entry in entries)
        for _, entry_size, path in entries:
            if size <= self.limit:
                return
            Path(path).unlink(missing_ok=True)
            size -= entry_size

    def _entries(self) -> Iterator[tuple[int, int, str]]:
        """Yield the time of last use, the size and the path of each entry."""
        for folder in os.scandir(self.folder):
            for entry in os.scandir(folder) if folder.is_dir() else ():
                if entry.name.endswith(_SUFFIX):
                    status = entry.stat()
                    yield status.st_mtime_ns, status.st_size, entry.path


def open_cache(project_roots: Iterable[Path]) -> Cache | None:
    """Return the cache of this user, or None if it is switched off or cannot be created.

    Raises CacheError for a folder that others could have written to: one inside *project_roots*, a
    symbolic link, or one that belongs to or is open to somebody else.
    """
    chosen = os.environ.get(VARIABLE, "")
    if chosen.lower() == "off":
        return None
    folder = Path(chosen).absolute() if chosen else _find_user_folder()
    _check_location(folder, project_roots)
    try:
        folder.parent.mkdir(parents=True, exist_ok=True)
        with suppress(FileExistsError):
            folder.mkdir(mode=_FOLDER_MODE)
        _check_owner(folder)
    except OSError:
        return None
    return Cache(folder)


def _check_location(folder: Path, project_roots: Iterable[Path]) -> None:
    resolved = folder.resolve()
    for root in project_roots:
        if resolved.is_relative_to(root.resolve()) or folder.is_relative_to(root.absolute()):
            raise CacheError(
                f"the cache folder '{folder}' lies inside the project '{root}', whose files are "
                f"not trusted; set {VARIABLE} to a folder elsewhere, or to 'off'"
            )


def _check_owner(folder: Path) -> None:
    """Raise CacheError unless *folder* is a folder that only this user can write to."""
    status = os.lstat(folder)
    if stat.S_ISLNK(status.st_mode):
        raise CacheError(
            f"the cache folder '{folder}' is a symbolic link; set {VARIABLE} to the folder itself"
        )
    # Windows has neither: there the user's profile is private.
    if not hasattr(os, "geteuid"):
        return
    if status.st_uid != os.geteuid():
        raise CacheError(
            f"the cache folder '{folder}' belongs to another user; set {VARIABLE} to a folder of "
            "your own"
        )
    if status.st_mode & _WRITABLE_BY_OTHERS:
        raise CacheError(
            f"the cache folder '{folder}' is writable by other users; run 'chmod 700' on it after "
            "deleting its content"
        )


def _open_private(path: str, flags: int) -> int:
    return os.open(path, flags, _FILE_MODE)


def _compute_digest(key: str, content: bytes) -> bytes:
    """Return the digest of an entry; with its key, so that an entry is no other entry's."""
    digest = hashlib.sha256(f"{len(key)}:{key}".encode())
    digest.update(content)
    return digest.digest()


def _find_user_folder() -> Path:

    return user_cache_path("sysmlc", appauthor=False)
