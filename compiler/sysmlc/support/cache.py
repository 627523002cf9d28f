"""The cache: results of earlier runs in a private folder of the user.

The key of an entry is the digest of everything that its content depends on. A missing or damaged
entry only costs time. Because an entry decides what a run reports, nobody else may be able to write
one: the folder belongs to the user, is closed to others, and lies outside the project, whose files
may be untrusted.
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
"""Environment variable whose value is the folder of the cache, or ``off``."""

_LIMIT = 512 * 2**20
"""Bytes of all entries."""
_SUFFIX = ".entry"
_FOLDER_MODE = 0o700
_FILE_MODE = 0o600
_WRITABLE_BY_OTHERS = stat.S_IWGRP | stat.S_IWOTH
_DIGEST_BYTES = hashlib.sha256().digest_size

_TALLY = "tally"
"""File whose length measures what was stored since entries were last evicted.

It has one byte for each ``limit / 8192`` bytes, so that a process need not list all entries.
"""
_TALLY_LENGTH = 128
"""Bytes of the tally at which entries are evicted: when 1/64 of the limit was stored."""


class CacheError(Exception):
    """The folder is not safe as a cache; the message gives the reason and what to do."""


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
            self._record_size(len(content))

    def _record_size(self, size: int) -> None:
        """Add the size of a new entry to the tally; evict entries when the tally is full."""
        with open(self.folder / _TALLY, "ab", opener=_open_private) as tally:
            tally.write(b"." * (1 + size * 64 * _TALLY_LENGTH // self.limit))
            if tally.tell() >= _TALLY_LENGTH:
                tally.truncate(0)
                self._evict()

    def _path(self, key: str) -> Path:
        return self.folder / key[:2] / f"{key}{_SUFFIX}"

    def _evict(self) -> None:
        """Remove the least recently used entries until the others are within the limit."""
        entries = sorted(self._iter_entries())
        total = sum(size for _, size, _ in entries)
        for _, size, path in entries:
            if total <= self.limit:
                return
            Path(path).unlink(missing_ok=True)
            total -= size

    def _iter_entries(self) -> Iterator[tuple[int, int, str]]:
        """Yield the time of last use, the size and the path of each entry."""
        for folder in os.scandir(self.folder):
            if folder.is_dir():
                for entry in os.scandir(folder):
                    if entry.name.endswith(_SUFFIX):
                        status = entry.stat()
                        yield status.st_mtime_ns, status.st_size, entry.path


def open_cache(project_roots: Iterable[Path]) -> Cache | None:
    """Return the cache of this user, or None if it is switched off or cannot be created.

    Raises CacheError for a folder to which others could have written: it is inside one of the
    *project_roots*, is a symbolic link, belongs to another user or is writable by others.
    """
    setting = os.environ.get(VARIABLE, "")
    if setting.lower() == "off":
        return None
    folder = Path(setting).absolute() if setting else user_cache_path("sysmlc", appauthor=False)
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
    # Windows has no such owner and mode: there the profile of the user is private.
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
    """Return the digest of key and content, so that a file under a wrong key is no valid entry."""
    digest = hashlib.sha256(f"{len(key)}:{key}".encode())
    digest.update(content)
    return digest.digest()
