"""Writes files in one step, so that no reader and no crash sees half of a file."""

import os
import re
from pathlib import Path

_TEMPORARY = re.compile(r"\.sysmlc-[0-9a-f]{16}")
_MODE = 0o644
"""Permissions of a new file, before the user's mask is applied."""


def write(target: Path | str, data: bytes) -> None:
    """Create or replace the file *target* in one step.

    The content is on the disk before the file has its name, so that not even a power failure leaves
    half a file.
    """
    temporary = write_temporary(os.path.dirname(target), data)  # noqa: PTH120
    try:
        sync(temporary)
        os.replace(temporary, target)  # noqa: PTH105 - a Path for each file doubles the cost
    except BaseException:
        Path(temporary).unlink(missing_ok=True)
        raise


def write_temporary(folder: str, data: bytes) -> str:
    """Write *data* to a new file in *folder*, which is created if needed; return its path."""
    temporary = os.path.join(folder, f".sysmlc-{os.urandom(8).hex()}")  # noqa: PTH118
    handle = _open_new(temporary, folder)
    try:
        try:
            _write_all(handle, data)
        finally:
            os.close(handle)
    except BaseException:
        Path(temporary).unlink(missing_ok=True)
        raise
    return temporary


def is_temporary(name: str) -> bool:
    """Whether ``write_temporary`` chose this file name; a crash may leave such a file behind."""
    return _TEMPORARY.fullmatch(name) is not None


def sync(path: Path | str) -> None:
    """Wait until the content of a file, or the names in a folder, are on the disk.

    Windows can sync only files that are open for writing; there this function does nothing.
    """
    if os.name == "nt":
        return
    handle = os.open(path, os.O_RDONLY)
    try:
        os.fsync(handle)
    finally:
        os.close(handle)


def _write_all(handle: int, data: bytes) -> None:
    """Write *data* without a file object, whose creation takes as long as writing a small file."""
    written = os.write(handle, data)
    while written < len(data):
        data = data[written:]
        written = os.write(handle, data)


def _open_new(temporary: str, folder: str) -> int:
    """Open a new file for writing; create *folder* only if the first attempt fails."""
    flags = os.O_WRONLY | os.O_CREAT | os.O_EXCL | getattr(os, "O_BINARY", 0)
    try:
        return os.open(temporary, flags, _MODE)
    except FileNotFoundError:
        Path(folder).mkdir(parents=True, exist_ok=True)
        return os.open(temporary, flags, _MODE)
