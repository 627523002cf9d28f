"""What the benchmarks share: processes that are measured, lines of a report, budgets."""

import json
import subprocess
import sys
import time
from dataclasses import dataclass
from pathlib import Path

MEGABYTE = 1_000_000
_MILLI = 1000
_LARGE = 50 * MEGABYTE
_ADDITIONS = 1_000_000


@dataclass(frozen=True, slots=True)
class Row:
    """Least CPU time in ms/MB of each lap, and memory as a multiple of the size."""

    times: dict[str, float]
    memory: float
    megabytes: float

    @property
    def total(self) -> float:
        """CPU time of all laps in ms/MB."""
        return sum(self.times.values())

    @property
    def text(self) -> str:
        """Time, its laps, and memory."""
        laps = " + ".join(f"{name} {ms:.1f}" for name, ms in self.times.items())
        return f"{self.total:6.1f} ms/MB ({laps}), memory {self.memory:.1f} x"


def calibration() -> float:
    """CPU time of a million additions."""
    start = time.process_time()
    total = 0
    for number in range(_ADDITIONS):
        total += number
    return time.process_time() - start


def measure(script: Path, work: str, path: Path, rounds: int, *arguments: str) -> Row:
    """The best of several processes that do the same work of a script (``work.py``)."""
    rows = (_once(script, work, path, arguments) for _ in range(rounds))
    return min(rows, key=lambda row: row.total)


def rounds_for(path: Path, rounds: int) -> int:
    """One round for what takes long anyway."""
    return rounds if path.stat().st_size < _LARGE else 1


def _once(script: Path, work: str, path: Path, arguments: tuple[str, ...]) -> Row:
    command = [sys.executable, str(script), work, str(path), *arguments]
    done = json.loads(subprocess.run(command, check=True, capture_output=True).stdout)
    megabytes = done["size"] / MEGABYTE
    times = {lap: _MILLI * seconds / megabytes for lap, seconds in done["times"].items()}
    return Row(times, done["memory"] / done["size"], megabytes)


class Report:
    """Prints lines and remembers whether a budget was missed."""

    def __init__(self) -> None:
        self.is_good = True

    def line(self, name: str, text: str) -> None:
        """A line without a limit."""
        print(f"{name:<34} {text}", flush=True)

    def budget(self, name: str, text: str, value: float, limit: float, unit: str) -> None:
        """A line with a limit that the value must not exceed."""
        met = value <= limit
        self.is_good &= met
        self.line(name, f"{text}  budget {limit:g} {unit}: {'met' if met else 'MISSED'}")

    def scaled(
        self, name: str, text: str, value: float, limit: float, slower: float, unit: str
    ) -> None:
        """A line with a limit that holds where the budgets were set.

        It counts times ``slower``, as the floor does here; whether it holds as it stands, too, is
        told beside.
        """
        met, as_set = value <= limit * slower, value <= limit
        self.is_good &= met
        verdict = f"{'met' if met else 'MISSED'} ({'met' if as_set else 'missed'} as it stands)"
        here = f"budget {limit:g}, by ratio {limit * slower:.3g} {unit}"
        self.line(name, f"{text}  = {value / slower:.3g} where it was set  {here}: {verdict}")

    def calibration(self) -> None:
        """The line that tells how fast the machine is just now."""
        self.line("calibration loop", f"{min(calibration() for _ in range(5)):6.3f} s")
