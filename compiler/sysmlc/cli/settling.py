"""Whether files are still being saved, judged by size and time, because tools save in pieces."""

import stat
import time
from collections.abc import Iterable, Mapping
from pathlib import Path

_STEP = 0.05
"""Seconds after which files are looked at again, if they are to rest for longer."""
_LONGEST = 30.0
"""Seconds after which files that never rest are compiled as they are."""

_FOLDER = (0, 0)
"""A folder looks the same whatever is in it: our own outputs may be."""

Stamps = Mapping[Path, tuple[int, int] | None]
"""Size and time of change of each file; None for one that is not there."""


def read_stamps(paths: Iterable[Path]) -> Stamps:
    """Return size and time of each file."""
    return {path: _read_stamp(path) for path in paths}


def wait_until_stable(paths: Iterable[Path], seconds: float) -> Stamps:
    """Wait until no file has changed for so many seconds; return size and time of each."""
    paths = list(paths)
    start = since = time.monotonic()
    last = read_stamps(paths)
    while time.monotonic() - since < seconds and time.monotonic() - start < _LONGEST:
        time.sleep(min(_STEP, seconds))
        current = read_stamps(paths)
        if current != last:
            last, since = current, time.monotonic()
    return last


def is_fresh(seen: Stamps, seconds: float) -> bool:
    """Whether a file is missing or was changed in the last seconds, so that it may be half
    saved.
    """
    current_time = time.time()
    return any(
        stamp is None or abs(current_time - stamp[1] / 1e9) < seconds for stamp in seen.values()
    )


def find_empty_files(seen: Stamps) -> frozenset[Path]:
    """Return the files that are empty or missing."""
    return frozenset(
        path
        for path, stamp in seen.items()
        if stamp is None or (stamp[0] == 0 and stamp != _FOLDER)
    )


def _read_stamp(path: Path) -> tuple[int, int] | None:
    try:
        status = path.stat()
    except OSError:
        return None
    return _FOLDER if stat.S_ISDIR(status.st_mode) else (status.st_size, status.st_mtime_ns)
