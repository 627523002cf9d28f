"""CPU seconds of ``sysmlc --version`` and of a bare interpreter; the budget is 0.15 s.

Machines differ in speed, so compare the ratio of the two, or the ratio to the calibration loop.
"""

import sys

from measuring import SYSMLC, measure_command, run_calibration_loop

BUDGET = 0.15
ROUNDS = 10


def measure_least(command: list[str]) -> float:
    """Return the least CPU time of several runs."""
    return min(measure_command(command) for _ in range(ROUNDS))


def main() -> int:
    """Print the measurements; return 1 when the budget is exceeded."""
    bare = measure_least([sys.executable, "-c", "pass"])
    version = measure_least([SYSMLC, "--version"])
    explain = measure_least([SYSMLC, "explain", "missing-file"])
    print(f"calibration loop      {run_calibration_loop():.3f} s")
    print(f"python -c pass        {bare:.3f} s")
    print(f"sysmlc --version      {version:.3f} s  {version / bare:.1f} x bare, budget {BUDGET} s")
    print(f"sysmlc explain CODE   {explain:.3f} s  {explain / bare:.1f} x bare")
    return 0 if version <= BUDGET else 1


if __name__ == "__main__":
    sys.exit(main())
