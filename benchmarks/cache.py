"""CPU seconds of ``sysmlc check`` on an unchanged model; the budget is 10 ms for each megabyte.

    python benchmarks/cache.py --sizes 1 10

The time of a tiny model, unchanged too, is taken off: it is start-up, which benchmarks/startup.py
measures. The first run and SHA-256 of the same bytes stand beside it for comparison.
"""

import argparse
import hashlib
import os
import resource
import subprocess
import sys
import sysconfig
import tempfile
import time
from pathlib import Path

from xmi_model import MEGABYTE, write

BUDGET = 10.0
"""Milliseconds of CPU time for each megabyte of unchanged input."""

_TINY = (
    '<xmi:XMI xmlns:xmi="http://www.omg.org/spec/XMI/20131001" '
    'xmlns:uml="http://www.eclipse.org/uml2/5.0.0/UML">'
    '<uml:Model xmi:id="m" name="Tiny"/></xmi:XMI>'
)


def cpu(path: Path, cache: Path) -> float:
    """CPU time of one process, user and system."""
    command = [str(Path(sysconfig.get_path("scripts")) / "sysmlc"), "check", str(path)]
    before = resource.getrusage(resource.RUSAGE_CHILDREN)
    env = {**os.environ, "SYSMLC_CACHE": str(cache), "PYTHONDONTWRITEBYTECODE": ""}
    done = subprocess.run(command, capture_output=True, env=env)
    after = resource.getrusage(resource.RUSAGE_CHILDREN)
    if done.returncode > 1:
        sys.exit(done.stderr.decode())
    return after.ru_utime + after.ru_stime - before.ru_utime - before.ru_stime


def hashing(path: Path) -> float:
    """CPU time of SHA-256 over the file."""
    data = path.read_bytes()
    start = time.process_time()
    hashlib.sha256(data).hexdigest()
    return time.process_time() - start


def measured(path: Path, cache: Path, start_up: float, rounds: int) -> bool:
    """Print the lines about one file; whether the budget is met."""
    megabytes = path.stat().st_size / MEGABYTE
    cold = cpu(path, cache)
    warm = min(cpu(path, cache) for _ in range(rounds)) - start_up
    each = 1000 * warm / megabytes
    met = "met" if each <= BUDGET else "MISSED"
    print(f"{path.name:<12} first run      {cold:7.2f} s")
    print(f"{'':<12} unchanged      {warm:7.3f} s  {each:.1f} ms/MB, budget {BUDGET:g}: {met}")
    print(f"{'':<12} SHA-256 alone  {hashing(path):7.3f} s", flush=True)
    return each <= BUDGET


def main() -> int:
    """Print the measurements; 1 when the budget is missed."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--sizes", type=float, nargs="+", default=[1.0, 10.0], metavar="MB")
    parser.add_argument("--rounds", type=int, default=5)
    options = parser.parse_args()
    with tempfile.TemporaryDirectory() as name:
        # A cache inside the folder of the models would be refused.
        folder, cache = Path(name, "models"), Path(name, "cache")
        folder.mkdir()
        tiny = folder / "tiny.uml"
        tiny.write_text(_TINY, encoding="utf-8")
        cpu(tiny, cache)
        start_up = min(cpu(tiny, cache) for _ in range(options.rounds))
        print(f"{'tiny.uml':<12} unchanged      {start_up:7.3f} s  (start-up, taken off below)")
        good = True
        for size in options.sizes:
            path = folder / f"plant{size:g}.uml"
            with path.open("wb") as stream:
                write(stream, size)
            good &= measured(path, cache, start_up, options.rounds)
    return 0 if good else 1


if __name__ == "__main__":
    sys.exit(main())
