"""CPU seconds of ``sysmlc --version`` against a bare interpreter; the budget is 0.15 s.

The calibration loop makes numbers of different machines comparable: what counts is the ratio.
"""

import resource
import subprocess
import sys
import sysconfig
import time
from pathlib import Path

BUDGET = 0.15
ROUNDS = 10


def cpu(command: list[str]) -> float:
    """The least CPU time, user and system, of several runs."""
    return min(_once(command) for _ in range(ROUNDS))


def _once(command: list[str]) -> float:
    before = resource.getrusage(resource.RUSAGE_CHILDREN)
    subprocess.run(command, check=True, capture_output=True)
    after = resource.getrusage(resource.RUSAGE_CHILDREN)
    return after.ru_utime + after.ru_stime - before.ru_utime - before.ru_stime


def calibration() -> float:
    """CPU time of a million additions."""
    start = time.process_time()
    total = 0
    for number in range(1_000_000):
        total += number
    return time.process_time() - start


def main() -> int:
    """Print the measurements; 1 when the budget is exceeded."""
    sysmlc = str(Path(sysconfig.get_path("scripts")) / "sysmlc")
    bare = cpu([sys.executable, "-c", "pass"])
    version = cpu([sysmlc, "--version"])
    explain = cpu([sysmlc, "explain", "missing-file"])
    print(f"calibration loop      {calibration():.3f} s")
    print(f"python -c pass        {bare:.3f} s")
    print(f"sysmlc --version      {version:.3f} s  {version / bare:.1f} x bare, budget {BUDGET} s")
    print(f"sysmlc explain CODE   {explain:.3f} s  {explain / bare:.1f} x bare")
    return 0 if version <= BUDGET else 1


if __name__ == "__main__":
    sys.exit(main())
