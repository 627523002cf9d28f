"""Whether files are still being saved: told by their sizes and times, as tools save in pieces."""

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


def stamps(paths: Iterable[Path]) -> Stamps:
    """How the files look now."""
    return {path: _stamp(path) for path in paths}


def rested(paths: Iterable[Path], seconds: float) -> Stamps:
    """Wait until no file changed for so many seconds; how they look then."""
    paths = list(paths)
    start = since = time.monotonic()
    last = stamps(paths)
    while time.monotonic() - since < seconds and time.monotonic() - start < _LONGEST:
        time.sleep(min(_STEP, seconds))
        current = stamps(paths)
        if current != last:
            last, since = current, time.monotonic()
    return last


def is_fresh(seen: Stamps, seconds: float) -> bool:
    """Whether a file is not there or was changed in the last seconds: it may be half saved."""
    now = time.time()
    return any(stamp is None or abs(now - stamp[1] / 1e9) < seconds for stamp in seen.values())


def blank(seen: Stamps) -> frozenset[Path]:
    """Files that are empty or not there."""
    return frozenset(
        path
        for path, stamp in seen.items()
        if stamp is None or (stamp[0] == 0 and stamp != _FOLDER)
    )


def _stamp(path: Path) -> tuple[int, int] | None:
    try:
        found = path.stat()
    except OSError:
        return None
    return _FOLDER if stat.S_ISDIR(found.st_mode) else (found.st_size, found.st_mtime_ns)
