"""CPU seconds of ``sysmlc check`` on an unchanged model; the budget is 10 ms for each megabyte.

    python benchmarks/cache.py --sizes 1 10

The time of a tiny unchanged model is subtracted, because it is start-up, which ``startup.py``
measures. The report also states the times of the first run and of SHA-256 over the same bytes.
"""

import argparse
import hashlib
import sys
import tempfile
import time
from pathlib import Path
from subprocess import CalledProcessError

from measuring import MEGABYTE, SYSMLC, measure_command
from xmi_model import write_model

BUDGET = 10.0
"""Milliseconds of CPU time for each megabyte of unchanged input."""

_TINY = (
    '<xmi:XMI xmlns:xmi="http://www.omg.org/spec/XMI/20131001" '
    'xmlns:uml="http://www.eclipse.org/uml2/5.0.0/UML">'
    '<uml:Model xmi:id="m" name="Tiny"/></xmi:XMI>'
)


def measure_check(path: Path, cache: Path) -> float:
    """Return the CPU time of one process that checks the file with this cache."""
    try:
        return measure_command([SYSMLC, "check", str(path)], SYSMLC_CACHE=str(cache))
    except CalledProcessError as problem:
        sys.exit(problem.stderr.decode())


def measure_hash(path: Path) -> float:
    """Return the CPU time of SHA-256 over the file."""
    data = path.read_bytes()
    start = time.process_time()
    hashlib.sha256(data).hexdigest()
    return time.process_time() - start


def report_file(path: Path, cache: Path, start_up: float, rounds: int) -> bool:
    """Print the lines of one file; return whether the budget is met."""
    megabytes = path.stat().st_size / MEGABYTE
    first = measure_check(path, cache)
    unchanged = min(measure_check(path, cache) for _ in range(rounds)) - start_up
    ratio = 1000 * unchanged / megabytes
    verdict = "met" if ratio <= BUDGET else "MISSED"
    rate = f"{ratio:.1f} ms/MB, budget {BUDGET:g}: {verdict}"
    print(f"{path.name:<12} first run      {first:7.2f} s")
    print(f"{'':<12} unchanged      {unchanged:7.3f} s  {rate}")
    print(f"{'':<12} SHA-256 alone  {measure_hash(path):7.3f} s", flush=True)
    return ratio <= BUDGET


def main() -> int:
    """Print the measurements; return 1 when the budget is missed."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--sizes", type=float, nargs="+", default=[1.0, 10.0], metavar="MB")
    parser.add_argument("--rounds", type=int, default=5)
    options = parser.parse_args()
    with tempfile.TemporaryDirectory() as name:
        # sysmlc refuses a cache inside the folder of the models.
        folder, cache = Path(name, "models"), Path(name, "cache")
        folder.mkdir()
        tiny = folder / "tiny.uml"
        tiny.write_text(_TINY, encoding="utf-8")
        measure_check(tiny, cache)
        start_up = min(measure_check(tiny, cache) for _ in range(options.rounds))
        print(f"{'tiny.uml':<12} unchanged      {start_up:7.3f} s  (start-up, subtracted below)")
        is_good = True
        for size in options.sizes:
            path = folder / f"plant{size:g}.uml"
            with path.open("wb") as stream:
                write_model(stream, size)
            is_good &= report_file(path, cache, start_up, options.rounds)
    return 0 if is_good else 1


if __name__ == "__main__":
    sys.exit(main())
