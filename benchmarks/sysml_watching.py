"""Seconds of ``sysmlc watch`` for each edit of the ICE laboratory.

The CPU time of an edit ends when the process is idle, the elapsed time when it has reported its
outputs. The CPU time of a running process is read from the ``/proc`` of Linux; other systems are
not measured.
"""

import os
import subprocess
import time
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path

from measuring import SYSMLC
from sysml_processes import EDITS, Edit, copy_laboratory

_PROCESSES = Path("/proc")
_TICKS = os.sysconf("SC_CLK_TCK")
_INTERVAL = 0.1
"""Seconds during which an idle process is observed."""
_IDLE = 0.01
"""CPU seconds that an idle process may use in an interval, because it polls files."""


class WatchProcess:
    """A process of ``sysmlc watch``, which compiles the unit at every save."""

    def __init__(self, process: subprocess.Popen[str]) -> None:
        self._process = process

    def read_cpu_time(self) -> float:
        """Return the CPU time so far, user and system, including threads that have ended."""
        return sum(map(_read_ticks, _iter_processes(self._process.pid))) / _TICKS

    def wait_for_outputs(self) -> float:
        """Wait for the line that ends a rebuild; return the time of a monotonic clock."""
        assert self._process.stdout is not None
        for line in self._process.stdout:
            if line.endswith(("changed\n", "errors\n")):
                break
        return time.monotonic()

    def wait_until_idle(self) -> float:
        """Wait until the process uses no CPU time; return the CPU time before the last interval."""
        before, after = -1.0, self.read_cpu_time()
        while after - before > _IDLE:
            time.sleep(_INTERVAL)
            before, after = after, self.read_cpu_time()
        return before


def _iter_processes(pid: int) -> Iterator[int]:
    """Yield a process and its descendants: ``sysmlc`` compiles in a child with limits."""
    yield pid
    for children in (_PROCESSES / str(pid) / "task").glob("*/children"):
        for child in children.read_text().split():
            yield from _iter_processes(int(child))


def _read_ticks(pid: int) -> int:
    """Return the CPU time of a process in clock ticks; 0 if the process has ended."""
    try:
        fields = (_PROCESSES / str(pid) / "stat").read_text().rpartition(")")[2].split()
    except OSError:
        return 0
    return int(fields[11]) + int(fields[12])


@contextmanager
def start_watch(unit: Path, folder: Path) -> Iterator[WatchProcess]:
    """Start ``sysmlc watch`` of a unit, wait for the first build, and end the process on exit."""
    command = [SYSMLC, "watch", str(unit), "-o", str(folder / "watched"), "--keep-going"]
    with subprocess.Popen(
        command, stdout=subprocess.PIPE, stderr=subprocess.DEVNULL, text=True
    ) as process:
        try:
            watch = WatchProcess(process)
            watch.wait_for_outputs()
            watch.wait_until_idle()
            yield watch
        finally:
            process.terminate()


def measure_edits(corpus: Path, folder: Path, rounds: int) -> list[tuple[str, float, float]]:
    """Return the name, the least CPU time and the least elapsed time of each edit.

    The list is empty if the system has no ``/proc``.
    """
    if not _PROCESSES.is_dir():
        return []
    unit = copy_laboratory(corpus, folder / "watched-ice")
    results = []
    with start_watch(unit, folder) as watch:
        for name, (file, edit) in EDITS.items():
            times = [_measure_edit(watch, unit / file, edit) for _ in range(rounds)]
            cpu_times, elapsed_times = zip(*times, strict=True)
            results.append((name, min(cpu_times), min(elapsed_times)))
    return results


def _measure_edit(watch: WatchProcess, file: Path, edit: Edit) -> tuple[float, float]:
    """Return CPU time and elapsed time from saving an edit."""
    before, edited = watch.read_cpu_time(), edit(file.read_text("utf-8"))
    start = time.monotonic()
    file.write_text(edited, "utf-8")
    elapsed = watch.wait_for_outputs() - start
    return watch.wait_until_idle() - before, elapsed
