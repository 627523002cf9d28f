"""A file read whole: only regular files, within the limits, and never half of one being saved."""

import os
import stat
import time
from pathlib import Path

from sysmlc.sources.error import Fault, SourceError
from sysmlc.sources.limits import Limits

_PAUSE = 0.1
"""Seconds before a file that changed while it was read is read again."""
_Seen = tuple[int, int]


def read_whole(path: Path, name: str, limits: Limits) -> bytes:
    """The bytes of a file that did not change while they were read; read again once if it did.

    Pipes and devices are not opened for reading: they may never end. Raises SourceError.
    """
    for is_last in (False, True):
        data, before, after = _attempt(path, name, limits)
        if before == after and len(data) == before[0]:
            return data
        if not is_last:
            time.sleep(_PAUSE)
    raise SourceError("changes while it is read", name, fault=Fault.CHANGING)


def _attempt(path: Path, name: str, limits: Limits) -> tuple[bytes, _Seen, _Seen]:
    try:
        with open(path, "rb", opener=_without_waiting) as stream:
            before = os.fstat(stream.fileno())
            _check(before, name, limits)
            data = stream.read(before.st_size + 1)
            return data, _make_state(before), _make_state(os.fstat(stream.fileno()))
    except OSError as problem:
        message = f"cannot be opened: {problem.strerror or type(problem).__name__}"
        raise SourceError(message, name, fault=Fault.MISSING) from None


def _without_waiting(path: str, flags: int) -> int:
    """Open a pipe that nobody writes to without waiting for a writer."""
    return os.open(path, flags | getattr(os, "O_NONBLOCK", 0))


def _check(found: os.stat_result, name: str, limits: Limits) -> None:
    if not stat.S_ISREG(found.st_mode):
        raise SourceError("is not a regular file", name, fault=Fault.MISSING)
    if found.st_size > limits.file_size:
        message = f"larger than {limits.file_size} bytes"
        raise SourceError(message, name, fault=Fault.LIMIT)


def _make_state(status: os.stat_result) -> _Seen:
    return status.st_size, status.st_mtime_ns
