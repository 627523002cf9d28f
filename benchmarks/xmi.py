"""CPU time and memory of the XMI front end on generated models, and on real ones.

    python benchmarks/xmi.py --sizes 1 10 100 --metamodel PATH/uml.ecore

All numbers of one run are of one machine in one state: what counts are the ratios to lxml, to
expat and to pyecore, and the calibration loop. Every number is the least of several processes.
With SYSMLC_CORPUS set four real models are measured too. Exit code 1 when a budget is missed.
The budgets were set on a machine where expat alone, the floor, took 9.0 ms/MB: here they count
times as much longer as expat takes in this run. Whether they hold as they stand is told beside.
"""

import argparse
import os
import resource
import subprocess
import sys
import sysconfig
import tempfile
from collections.abc import Iterator
from pathlib import Path

import measuring
from measuring import Report, Row, rounds_for
from xmi_model import write

_WORK = Path(__file__).with_name("xmi_work.py")
_REAL = (
    "papyrus/Alf.library.uml",
    "papyrus/fUML-Tests.uml",
    "magicdraw/fUML-Tests.mdxml",
    "magicdraw/Tank_control_2.mdzip",
)
_SUFFIX = {"papyrus": ".uml", "magicdraw": ".xml"}

BUDGET = {"papyrus": 60.0, "magicdraw": 30.0}
"""Milliseconds of CPU time for each megabyte, from XML to the resolved graph."""

MEMORY = 8.0
"""Peak of the resident memory, as a multiple of the file's size, from 10 MB on."""

ALL_OUTPUTS = 0.6
"""Seconds of CPU time of a whole process, from a model of 1 MB to all outputs."""

FLOOR = 9.0
"""Milliseconds for each megabyte that expat alone took of 10 MB in Papyrus' dialect where the
budgets were set."""

PYECORE = 15.0
"""How many times less CPU time than pyecore."""


def measure(work: str, path: Path, rounds: int, metamodel: str = "") -> Row:
    """The best of several processes that do the same."""
    return measuring.measure(_WORK, work, path, rounds, metamodel)


def all_outputs(path: Path, rounds: int) -> float:
    """CPU seconds of ``sysmlc`` from the model to all files, start-up included."""
    sysmlc = str(Path(sysconfig.get_path("scripts")) / "sysmlc")
    seconds = []
    for _ in range(rounds):
        with tempfile.TemporaryDirectory() as folder:
            before = resource.getrusage(resource.RUSAGE_CHILDREN)
            command = [sysmlc, str(path), "--no-cache", "-o", folder]
            env = {**os.environ, "PYTHONDONTWRITEBYTECODE": ""}
            subprocess.run(command, check=True, capture_output=True, env=env)
            after = resource.getrusage(resource.RUSAGE_CHILDREN)
        user = after.ru_utime - before.ru_utime
        seconds.append(user + after.ru_stime - before.ru_stime)
    return min(seconds)


def slowness(report: Report, options: argparse.Namespace, folder: Path) -> float:
    """How many times longer expat alone takes here than where the budgets were set."""
    path = folder / "floor.uml"
    with path.open("wb") as stream:
        write(stream, 10, options.seed, "papyrus")
    floor = measure("expat", path, options.rounds).total
    path.unlink()
    ratio = floor / FLOOR
    text = f"{floor:6.1f} ms/MB, {FLOOR:g} where the budgets were set: {ratio:.2f} x as long here"
    report.line("floor: expat alone, 10 MB", text)
    return ratio


def generated(options: argparse.Namespace, folder: Path) -> Iterator[tuple[str, Path]]:
    """The generated files, each removed when the next is made."""
    for dialect in options.dialects:
        for size in sorted(options.sizes):
            path = folder / f"plant{size:g}{_SUFFIX[dialect]}"
            with path.open("wb") as stream:
                write(stream, size, options.seed, dialect)
            yield dialect, path
            path.unlink()


def report_file(
    report: Report, path: Path, budget: float, slower: float, options: argparse.Namespace
) -> Row:
    """Lines about one file, on a machine that is slower; the row of ours."""
    rounds = rounds_for(path, options.rounds)
    ours = measure("ours", path, rounds)
    name = f"{path.name} ({ours.megabytes:.1f} MB)"
    report.scaled(name, ours.text, ours.total, budget, slower, "ms/MB")
    if path.suffix != ".mdzip":
        for work in ("lxml", "expat"):
            other = measure(work, path, rounds)
            ratio = f"ours is {ours.total / other.total:.1f} x"
            report.line(
                f"  {work}", f"{other.total:6.1f} ms/MB, memory {other.memory:.1f} x; {ratio}"
            )
    return ours


def report_pyecore(report: Report, path: Path, ours: Row, metamodel: str) -> None:
    """The line about pyecore, which reads only the dialect of Eclipse."""
    if not metamodel:
        report.line("  pyecore", "was not run: no --metamodel")
        return
    other = measure("pyecore", path, 1, metamodel)
    ratio = other.total / ours.total
    text = f"{other.total:6.1f} ms/MB, memory {other.memory:.1f} x; {ratio:.1f} x as long as ours"
    report.budget("  pyecore", text, PYECORE / ratio, 1.0, f"({PYECORE:g} x)")


def report_generated(
    report: Report, slower: float, options: argparse.Namespace, folder: Path
) -> None:
    """Lines about generated files of all sizes and dialects."""
    totals: dict[str, list[float]] = {}
    for dialect, path in generated(options, folder):
        ours = report_file(report, path, BUDGET[dialect], slower, options)
        totals.setdefault(dialect, []).append(ours.total)
        if ours.megabytes > 5 and dialect == "papyrus":
            report.budget("  memory", f"{ours.memory:6.1f} x", ours.memory, MEMORY, "x")
        if dialect == "papyrus" and ours.megabytes < 50:
            report_pyecore(report, path, ours, options.metamodel)
        if dialect == "papyrus" and ours.megabytes < 2:
            seconds = all_outputs(path, options.rounds)
            report.scaled(
                "  to all outputs", f"{seconds:6.2f} s", seconds, ALL_OUTPUTS, slower, "s"
            )
    for dialect, rows in totals.items():
        if len(rows) > 1:
            report.line(f"{dialect}: largest to smallest", f"{rows[-1] / rows[0]:6.2f} x per MB")


def report_real(report: Report, slower: float, options: argparse.Namespace) -> None:
    """Lines about the models of the corpus that are there."""
    corpus = Path(os.environ.get("SYSMLC_CORPUS", "")) / "xmi"
    for name in _REAL if "SYSMLC_CORPUS" in os.environ else ():
        # Drawings that can be skipped are inside XML alone, in an archive they are other entries.
        is_skipping = name.endswith("xml")
        budget = BUDGET["magicdraw" if is_skipping else "papyrus"]
        report_file(report, corpus / name, budget, slower, options)


def main() -> int:
    """Print the measurements; 1 when a budget is missed."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--sizes", type=float, nargs="+", default=[1.0, 10.0], metavar="MB")
    parser.add_argument("--dialects", nargs="+", choices=sorted(BUDGET), default=sorted(BUDGET))
    parser.add_argument("--metamodel", default="", help="UML.ecore, to measure pyecore with")
    parser.add_argument("--seed", type=int, default=1)
    parser.add_argument("--rounds", type=int, default=5)
    options = parser.parse_args()
    report = Report()
    report.calibration()
    with tempfile.TemporaryDirectory() as folder:
        slower = slowness(report, options, Path(folder))
        report_generated(report, slower, options, Path(folder))
    report_real(report, slower, options)
    return 0 if report.is_good else 1


if __name__ == "__main__":
    sys.exit(main())
