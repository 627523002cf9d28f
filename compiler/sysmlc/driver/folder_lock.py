"""A lock on an output folder: of two builds at once, one waits for the other."""

import errno
import os
import time
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path

_PATIENCE = 10.0
"""Seconds to wait for another process that writes to the same folder."""
_PAUSE = 0.05


@contextmanager
def lock_folder(folder: Path) -> Iterator[None]:
    """Exclude other processes that publish to *folder*, where the system can lock folders.

    Raises OSError if another process does not end.
    """
    try:
        import fcntl
    except ImportError:
        yield
        return
    handle = os.open(folder, os.O_RDONLY)
    try:
        end = time.monotonic() + _PATIENCE
        while True:
            try:
                fcntl.flock(handle, fcntl.LOCK_EX | fcntl.LOCK_NB)
            except BlockingIOError:
                if time.monotonic() > end:
                    reason = "another sysmlc is writing to the folder"
                    raise OSError(errno.EBUSY, reason, str(folder)) from None
                time.sleep(_PAUSE)
            except OSError:
                break  # a file system without locks
            else:
                break
        yield
    finally:
        os.close(handle)
