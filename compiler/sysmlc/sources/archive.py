"""Reads entries of archives (.mdzip, .kpar, .amlx) in memory, within limits of size."""

import io
import zipfile
import zlib
from collections.abc import Callable, Iterator, Sequence
from contextlib import contextmanager
from typing import IO
from zipfile import ZIP_DEFLATED, ZIP_STORED, ZipFile, ZipInfo

from sysmlc.sources.source import DEFAULT_LIMITS, Fault, Limits, Source, SourceError

_MAGIC = (b"PK\x03\x04", b"PK\x05\x06")
_CHUNK = 1 << 20
_NO_TABLE = "File is not a zip file"
"""The message of zipfile for an archive without the table at its end."""
_SYSTEM_FILES = frozenset({"Thumbs.db", "ehthumbs.db", "desktop.ini"})
_CUT_SHORT = "its table of contents is missing, as when a download or a save was cut off"


def is_archive(data: bytes) -> bool:
    """Whether the bytes start as a zip archive does."""
    return data.startswith(_MAGIC)


def read_entries(
    archive: Source, wanted: Callable[[str], bool], limits: Limits = DEFAULT_LIMITS
) -> list[Source]:
    """Return the *wanted* entries, sorted by name, as sources ``archive!entry``.

    Sizes are counted while reading, because the sizes that an archive declares may be wrong.
    Raises SourceError for a damaged archive, for a name that is absolute, leads upwards or occurs
    twice, for an encrypted entry, for a compression method other than stored and deflate, and for
    a size above the limits.
    """
    with _open_archive(archive) as zip_file:
        return list(_iter_entries(archive, zip_file, wanted, limits))


def list_entry_names(archive: Source) -> list[str]:
    """Return the names of all entries, in the archive's order.

    Raises SourceError for a damaged archive.
    """
    with _open_archive(archive) as zip_file:
        return zip_file.namelist()


def is_system_entry(entry: str) -> bool:
    """Whether an operating system or an editor added the entry: ``.DS_Store``, ``Thumbs.db``."""
    *folders, name = entry.split("/")
    is_hidden = any(part.startswith(".") for part in (*folders, name) if part not in (".", ".."))
    is_kept = name.endswith((".rels", ".json"))
    return "__MACOSX" in folders or name in _SYSTEM_FILES or (is_hidden and not is_kept)


@contextmanager
def _open_archive(archive: Source) -> Iterator[ZipFile]:
    """Open an archive; the errors of zipfile become SourceError."""
    try:
        with ZipFile(io.BytesIO(archive.data)) as zip_file:
            yield zip_file
    except (zipfile.BadZipFile, zlib.error, EOFError, NotImplementedError, ValueError) as problem:
        reason = _CUT_SHORT if str(problem) == _NO_TABLE else str(problem)
        raise SourceError(f"damaged archive: {reason}", archive.name) from None


def _iter_entries(
    archive: Source, zip_file: ZipFile, wanted: Callable[[str], bool], limits: Limits
) -> Iterator[Source]:
    entries = zip_file.infolist()
    _check_names(archive.name, entries, limits)
    remaining = _compute_total_limit(len(archive.data), limits)
    selected = [entry for entry in entries if not entry.is_dir() and wanted(entry.filename)]
    _check_declared_sizes(archive.name, selected, remaining, limits)
    for entry in sorted(selected, key=lambda entry: entry.filename):
        _check_method(archive.name, entry)
        name = f"{archive.name}!{entry.filename}"
        size_limit = min(remaining, _compute_entry_limit(entry, limits), limits.file_size)
        with zip_file.open(entry) as stream:
            data = _read_stream(stream, name, size_limit)
        remaining -= len(data)
        yield Source(name, data)


def _compute_total_limit(packed_size: int, limits: Limits) -> int:
    """Return the number of bytes that all entries together may unpack to."""
    return min(limits.total_size, max(packed_size * limits.total_ratio, limits.free_size))


def _compute_entry_limit(entry: ZipInfo, limits: Limits) -> int:
    """Return the number of bytes that an entry may unpack to."""
    return max(entry.compress_size * limits.ratio, _CHUNK)


def _check_declared_sizes(
    name: str, entries: Sequence[ZipInfo], total_limit: int, limits: Limits
) -> None:
    """Refuse entries that are too large by their declared size before anything is unpacked."""
    for entry in entries:
        if entry.file_size > _compute_entry_limit(entry, limits):
            raise _make_size_error(f"{name}!{entry.filename}")
    if sum(entry.file_size for entry in entries) > total_limit:
        raise _make_size_error(name)


def _make_size_error(name: str) -> SourceError:
    return SourceError("unpacks to more than the limits allow", name, fault=Fault.LIMIT)


def _check_names(name: str, entries: Sequence[ZipInfo], limits: Limits) -> None:
    if len(entries) > limits.entries:
        raise SourceError(f"more than {limits.entries} entries", name, fault=Fault.LIMIT)
    visited: set[str] = set()
    for entry in entries:
        if entry.orig_filename in visited or entry.filename in visited:
            raise SourceError(f"two entries are named '{entry.filename}'", name)
        visited.add(entry.filename)
        if _leads_out(entry.orig_filename) or _leads_out(entry.filename):
            message = f"the name of entry '{entry.filename}' leads out of the archive"
            raise SourceError(message, name, fault=Fault.REFUSED)


def _leads_out(entry_name: str) -> bool:
    """Whether the name is absolute or leads upwards, on POSIX or on Windows."""
    path = entry_name.replace("\\", "/")
    return path.startswith("/") or path[1:2] == ":" or ".." in path.split("/") or "\0" in path


def _check_method(name: str, entry: ZipInfo) -> None:
    if entry.compress_type not in (ZIP_STORED, ZIP_DEFLATED):
        message = f"entry '{entry.filename}' is neither stored nor deflated"
        raise SourceError(message, name, fault=Fault.REFUSED)
    if entry.flag_bits & 0x1:
        raise SourceError(f"entry '{entry.filename}' is encrypted", name, fault=Fault.REFUSED)


def _read_stream(stream: IO[bytes], name: str, size_limit: int) -> bytes:
    chunks: list[bytes] = []
    size = 0
    while chunk := stream.read(_CHUNK):
        size += len(chunk)
        if size > size_limit:
            raise _make_size_error(name)
        chunks.append(chunk)
    return b"".join(chunks)
