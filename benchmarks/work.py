"""Measurement of one work in a process of its own: its CPU time and its memory.

A script of works is called ``python SCRIPT WORK PATH [ARGUMENT...]``. It prints JSON: the CPU
seconds (user and system) of each lap without start-up, the growth of the resident memory to its
peak in bytes, and the size of the input in bytes.
"""

import json
import resource
import sys
import time
from collections.abc import Callable, Mapping
from contextlib import suppress
from pathlib import Path

_KILOBYTE = 1024


class Measurement:
    """CPU time and memory from the creation of the measurement on."""

    def __init__(self) -> None:
        self._start = time.process_time()
        self._memory = _read_peak_memory()
        self.times: dict[str, float] = {}

    def end_lap(self, name: str) -> None:
        """Store the CPU time since the end of the last lap."""
        end = time.process_time()
        self.times[name] = end - self._start
        self._start = end

    def memory_growth(self) -> int:
        """Return the growth of the peak of the resident memory so far."""
        return _read_peak_memory() - self._memory


Work = Callable[..., tuple[Measurement, int]]
"""A function of a path and further arguments: returns the measurement and the size of the input."""


def _read_peak_memory() -> int:
    """Return the peak of the resident memory of this process in bytes."""
    # The peak of `getrusage` is at least that of the parent process, from which this one is forked.
    with suppress(OSError):
        lines = Path("/proc/self/status").read_text().splitlines()
        peak = next((line for line in lines if line.startswith("VmHWM:")), "")
        if peak:
            return int(peak.split()[1]) * _KILOBYTE
    return resource.getrusage(resource.RUSAGE_SELF).ru_maxrss * _KILOBYTE


def run_work(works: Mapping[str, Work]) -> int:
    """Do the work that the command line names, once."""
    name, path, *arguments = sys.argv[1:]
    measurement, size = works[name](Path(path), *arguments)
    memory = measurement.memory_growth()
    json.dump({"times": measurement.times, "memory": memory, "size": size}, sys.stdout)
    return 0
