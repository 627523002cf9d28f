"""Tools of all benchmarks: CPU time of processes, lines of a report, verdicts about budgets."""

import json
import os
import resource
import subprocess
import sys
import sysconfig
import time
from dataclasses import dataclass
from pathlib import Path

MEGABYTE = 1_000_000
SYSMLC = str(Path(sysconfig.get_path("scripts")) / "sysmlc")
"""Path of the command."""
_MILLISECONDS = 1000
_LARGE = 50 * MEGABYTE
_ADDITIONS = 1_000_000


@dataclass(frozen=True, slots=True)
class Row:
    """CPU time of each lap in ms/MB, and memory as a multiple of the size of the input."""

    times: dict[str, float]
    memory: float
    megabytes: float

    @property
    def total_time(self) -> float:
        """CPU time of all laps in ms/MB."""
        return sum(self.times.values())

    @property
    def as_text(self) -> str:
        """Total time, the time of each lap, and memory."""
        laps = " + ".join(f"{name} {time:.1f}" for name, time in self.times.items())
        return f"{self.total_time:6.1f} ms/MB ({laps}), memory {self.memory:.1f} x"


# -- processes -----------------------------------------------------------------------------------


def read_children_time() -> float:
    """Return the CPU time, user and system, of all child processes that have ended."""
    usage = resource.getrusage(resource.RUSAGE_CHILDREN)
    return usage.ru_utime + usage.ru_stime


def measure_command(command: list[str], *, is_checked: bool = True, **variables: str) -> float:
    """Return the CPU time of one process, start-up included.

    The process may write and use compiled modules, as it does for users. *variables* are added to
    its environment. Raises CalledProcessError for a nonzero exit code if *is_checked*.
    """
    environment = {**os.environ, **variables}
    environment.pop("PYTHONDONTWRITEBYTECODE", None)
    before = read_children_time()
    subprocess.run(command, check=is_checked, capture_output=True, env=environment)
    return read_children_time() - before


def measure_work(script: Path, work: str, path: Path, rounds: int, *arguments: str) -> Row:
    """Return the fastest of several processes that do the same work of a script (``work.py``)."""
    rows = (_run_work(script, work, path, arguments) for _ in range(rounds))
    return min(rows, key=lambda row: row.total_time)


def measure_fastest_laps(script: Path, work: str, path: Path, rounds: int) -> dict[str, float]:
    """Return the least CPU seconds of each lap among several processes that do the same work."""
    rows = [_run_work(script, work, path, ()) for _ in range(rounds)]
    return {
        name: min(row.times[name] * row.megabytes / _MILLISECONDS for row in rows)
        for name in rows[0].times
    }


def limit_rounds(path: Path, rounds: int) -> int:
    """Return the number of rounds for a file: one for a large file, which takes long."""
    return rounds if path.stat().st_size < _LARGE else 1


def _run_work(script: Path, work: str, path: Path, arguments: tuple[str, ...]) -> Row:
    command = [sys.executable, str(script), work, str(path), *arguments]
    measurement = json.loads(subprocess.run(command, check=True, capture_output=True).stdout)
    megabytes = measurement["size"] / MEGABYTE
    times = {
        name: _MILLISECONDS * seconds / megabytes for name, seconds in measurement["times"].items()
    }
    return Row(times, measurement["memory"] / measurement["size"], megabytes)


def run_calibration_loop() -> float:
    """Return the CPU time of a million additions, which shows how fast the machine is."""
    start = time.process_time()
    total = 0
    for number in range(_ADDITIONS):
        total += number
    return time.process_time() - start


# -- the report ----------------------------------------------------------------------------------


class Report:
    """Prints lines and remembers whether a budget was missed."""

    def __init__(self) -> None:
        self.is_good = True

    def print_line(self, name: str, text: str) -> None:
        """Print a line without a budget."""
        print(f"{name:<34} {text}", flush=True)

    def judge(self, name: str, text: str, value: float, limit: float, unit: str) -> None:
        """Print a line with a budget: the value must not exceed the limit."""
        is_met = value <= limit
        self.is_good &= is_met
        verdict = _describe_verdict(is_met)
        self.print_line(name, f"{text}  budget {limit:g} {unit}: {verdict}")

    def judge_by_ratio(
        self, name: str, text: str, value: float, limit: float, slowness: float, unit: str
    ) -> None:
        """Print a line with a budget in CPU time that was set on another machine.

        This machine takes *slowness* times as long, so the limit is multiplied by it. The line also
        states whether the value meets the limit itself; that does not count.
        """
        is_met = value <= limit * slowness
        self.is_good &= is_met
        scaled_value = f"= {value / slowness:.3g} on the machine of the budget"
        budget = f"budget {limit:g}, scaled {limit * slowness:.3g} {unit}"
        verdict = f"{_describe_verdict(is_met)} (unscaled {_describe_verdict(value <= limit)})"
        self.print_line(name, f"{text}  {scaled_value}  {budget}: {verdict}")

    def print_calibration(self) -> None:
        """Print the least time of several calibration loops."""
        seconds = min(run_calibration_loop() for _ in range(5))
        self.print_line("calibration loop", f"{seconds:6.3f} s")


def _describe_verdict(is_met: bool) -> str:
    return "met" if is_met else "MISSED"
