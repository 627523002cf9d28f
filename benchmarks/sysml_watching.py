"""Seconds of ``sysmlc watch`` for each edit of the ICE laboratory: the process stays.

CPU seconds until the process has said what became of the outputs and has come to rest, and seconds
of a clock from the save until it said so. What it used is read from Linux; elsewhere there is
nothing to tell.
"""

import os
import subprocess
import sysconfig
import time
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path

from sysml_processes import LABORATORY, Edit, copied

_PROCESSES = Path("/proc")
_TICKS = os.sysconf("SC_CLK_TCK")
_REST = 0.1
_IDLE = 0.01
"""Seconds that a process may use in those of rest: it looks at files now and then."""


class Watched:
    """A process that compiles again at every save."""

    def __init__(self, process: subprocess.Popen[str]) -> None:
        self._process = process

    def used(self) -> float:
        """CPU time so far, user and system, also of threads that are no more."""
        return sum(map(_read_ticks, _iter_processes(self._process.pid))) / _TICKS

    def told(self) -> float:
        """Wait for the line that ends a rebuild; the time by a clock."""
        assert self._process.stdout is not None
        for line in self._process.stdout:
            if line.endswith(("changed\n", "errors\n")):
                break
        return time.monotonic()

    def settle(self) -> float:
        """Wait for rest; CPU time so far."""
        before, used = -1.0, self.used()
        while used - before > _IDLE:
            time.sleep(_REST)
            before, used = used, self.used()
        return before


def _iter_processes(pid: int) -> Iterator[int]:
    """Yield a process and its descendants: the command runs in a child that has the limits."""
    yield pid
    for children in (_PROCESSES / str(pid) / "task").glob("*/children"):
        for child in children.read_text().split():
            yield from _iter_processes(int(child))


def _read_ticks(pid: int) -> int:
    try:
        fields = (_PROCESSES / str(pid) / "stat").read_text().rpartition(")")[2].split()
    except OSError:
        return 0
    return int(fields[11]) + int(fields[12])


@contextmanager
def watching(unit: Path, folder: Path) -> Iterator[Watched]:
    """``sysmlc watch`` of a unit, built once."""
    script = str(Path(sysconfig.get_path("scripts")) / "sysmlc")
    command = [script, "watch", str(unit), "-o", str(folder / "watched"), "--keep-going"]
    with subprocess.Popen(
        command, stdout=subprocess.PIPE, stderr=subprocess.DEVNULL, text=True
    ) as process:
        try:
            watched = Watched(process)
            watched.told()
            watched.settle()
            yield watched
        finally:
            process.terminate()


def laboratory(corpus: Path, folder: Path, rounds: int) -> list[tuple[float, float]]:
    """For each of the edits the least of ``rounds``, of CPU and by a clock; empty where it cannot
    be told.
    """
    if not _PROCESSES.is_dir():
        return []
    unit = copied(corpus, folder / "watched-ice")
    found = []
    with watching(unit, folder) as watched:
        for file, edit in LABORATORY.values():
            both = [_rebuilt(watched, unit / file, edit) for _ in range(rounds)]
            found.append((min(cpu for cpu, _ in both), min(clock for _, clock in both)))
    return found


def _rebuilt(watched: Watched, file: Path, edit: Edit) -> tuple[float, float]:
    before, text = watched.used(), file.read_text("utf-8")
    edited = edit(text)
    start = time.monotonic()
    file.write_text(edited, "utf-8")
    clock = watched.told() - start
    return watched.settle() - before, clock
