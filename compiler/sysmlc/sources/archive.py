"""Archives (.mdzip, .kpar, .amlx) read entry by entry, with caps and without touching the disk."""

import io
import zipfile
import zlib
from collections.abc import Callable, Iterator
from typing import IO, TYPE_CHECKING
from zipfile import ZIP_DEFLATED, ZIP_STORED

from sysmlc.sources.error import Fault, SourceError
from sysmlc.sources.limits import DEFAULT_LIMITS, Limits
from sysmlc.sources.source import Source

if TYPE_CHECKING:
    from zipfile import ZipFile, ZipInfo

_MAGIC = (b"PK\x03\x04", b"PK\x05\x06")
_CHUNK = 1 << 20
_NO_TABLE = "File is not a zip file"
"""What zipfile says when the table at the end is missing, however the file starts."""
_CUT_SHORT = "its table of contents is missing, as when a download or a save was cut off"


def is_archive(data: bytes) -> bool:
    """Whether the bytes start as a zip archive does."""
    return data.startswith(_MAGIC)


def entries(
    archive: Source, wanted: Callable[[str], bool], limits: Limits = DEFAULT_LIMITS
) -> list[Source]:
    """The entries whose names are wanted, by name, as ``archive!entry``.

    Sizes are counted while reading: what the archive says about itself is not believed.
    Raises SourceError for a damaged archive, names that are absolute, lead upwards or occur
    twice, other methods than stored and deflate, encryption, and what exceeds the limits.
    """

    try:
        with zipfile.ZipFile(io.BytesIO(archive.data)) as opened:
            return list(_read_all(archive, opened, wanted, limits))
    except (zipfile.BadZipFile, zlib.error, EOFError, NotImplementedError, ValueError) as problem:
        reason = _CUT_SHORT if str(problem) == _NO_TABLE else str(problem)
        raise SourceError(f"damaged archive: {reason}", archive.name) from None


def names(archive: Source) -> list[str]:
    """Names of all entries, as the archive has them. Raises SourceError for a damaged archive."""

    try:
        with zipfile.ZipFile(io.BytesIO(archive.data)) as opened:
            return opened.namelist()
    except (zipfile.BadZipFile, NotImplementedError, ValueError) as problem:
        reason = _CUT_SHORT if str(problem) == _NO_TABLE else str(problem)
        raise SourceError(f"damaged archive: {reason}", archive.name) from None


def _read_all(
    archive: Source, opened: "ZipFile", wanted: Callable[[str], bool], limits: Limits
) -> Iterator[Source]:
    name, infos = archive.name, opened.infolist()
    _check_names(name, infos, limits)
    left = _allowance(len(archive.data), limits)
    chosen = [info for info in infos if not info.is_dir() and wanted(info.filename)]
    _check_declared(name, chosen, left, limits)
    for info in sorted(chosen, key=lambda entry: entry.filename):
        _check_method(name, info)
        with opened.open(info) as stream:
            data = _read(f"{name}!{info.filename}", stream, info, left, limits)
        left -= len(data)
        yield Source(f"{name}!{info.filename}", data)


def _allowance(packed: int, limits: Limits) -> int:
    """How many bytes all entries may hold."""
    return min(limits.total_size, max(packed * limits.total_ratio, limits.free_size))


def _check_declared(name: str, infos: list["ZipInfo"], left: int, limits: Limits) -> None:
    """Refuse what is too large by its own account before anything is unpacked."""
    for info in infos:
        if info.file_size > max(info.compress_size * limits.ratio, _CHUNK):
            raise _too_much(f"{name}!{info.filename}")
    if sum(info.file_size for info in infos) > left:
        raise _too_much(name)


def _too_much(name: str) -> SourceError:
    return SourceError("unpacks to more than the limits allow", name, fault=Fault.LIMIT)


def _check_names(name: str, infos: list["ZipInfo"], limits: Limits) -> None:
    if len(infos) > limits.entries:
        raise SourceError(f"more than {limits.entries} entries", name, fault=Fault.LIMIT)
    seen: set[str] = set()
    for info in infos:
        if info.orig_filename in seen or info.filename in seen:
            raise SourceError(f"two entries are named '{info.filename}'", name)
        seen.add(info.filename)
        if _leads_out(info.orig_filename) or _leads_out(info.filename):
            message = f"the name of entry '{info.filename}' leads out of the archive"
            raise SourceError(message, name, fault=Fault.REFUSED)


def _leads_out(entry: str) -> bool:
    path = entry.replace("\\", "/")
    return path.startswith("/") or path[1:2] == ":" or ".." in path.split("/") or "\0" in path


def _check_method(name: str, info: "ZipInfo") -> None:

    if info.compress_type not in (ZIP_STORED, ZIP_DEFLATED):
        message = f"entry '{info.filename}' is neither stored nor deflated"
        raise SourceError(message, name, fault=Fault.REFUSED)
    if info.flag_bits & 0x1:
        raise SourceError(f"entry '{info.filename}' is encrypted", name, fault=Fault.REFUSED)


def _read(name: str, stream: IO[bytes], info: "ZipInfo", left: int, limits: Limits) -> bytes:
    cap = min(left, max(info.compress_size * limits.ratio, _CHUNK), limits.file_size)
    pieces: list[bytes] = []
    size = 0
    while piece := stream.read(_CHUNK):
        size += len(piece)
        if size > cap:
            raise _too_much(name)
        pieces.append(piece)
    return b"".join(pieces)
