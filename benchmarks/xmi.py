"""CPU time and memory of the XMI front end on generated models, and on real ones.

    python benchmarks/xmi.py --sizes 1 10 100 --metamodel PATH/uml.ecore

All numbers of one run come from one machine in one state: the ratios to lxml, expat and pyecore
count. Every number is the least of several processes. Where SYSMLC_CORPUS is set, four real models
are measured as well. The exit code is 1 when a budget is missed.
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

LXML = 8.0
"""Multiple of the CPU time of ``lxml.etree.parse``, from XMI to the resolved graph."""

MEMORY = 10.0
"""Peak of the resident memory, as a multiple of the file's size, from 10 MB on."""

ALL_OUTPUTS = 2.0
"""Seconds of CPU time of a whole process, from a model of 1 MB to all outputs."""

PYECORE = 8.0
"""How many times less CPU time than pyecore."""

FLOOR = 9.0
"""Milliseconds for each megabyte that expat alone took of 10 MB in Papyrus' dialect where the
budgets of SysML v2 and of synthesis were set."""

_LARGE = 5.0
"""Megabytes from which on ratios to lxml and memory are judged."""


def measure(work: str, path: Path, rounds: int, metamodel: str = "") -> Row:
    """Return the best of several processes that do the same."""
    return measuring.measure(_WORK, work, path, rounds, metamodel)


def all_outputs(path: Path, rounds: int) -> float:
    """Return the CPU seconds of ``sysmlc`` from the model to all files, start-up included."""
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


def slowness(report: Report, rounds: int) -> float:
    """Return how many times longer expat alone takes here than where other budgets were set."""
    with tempfile.TemporaryDirectory() as folder:
        path = Path(folder, "floor.uml")
        with path.open("wb") as stream:
            write(stream, 10, 1, "papyrus")
        floor = measure("expat", path, rounds).total
    ratio = floor / FLOOR
    text = f"{floor:6.1f} ms/MB, {FLOOR:g} where the budgets were set: {ratio:.2f} x as long here"
    report.line("floor: expat alone, 10 MB", text)
    return ratio


def generated(options: argparse.Namespace, folder: Path) -> Iterator[tuple[str, Path]]:
    """Generate the files; each is removed before the next is written."""
    for dialect in options.dialects:
        for size in sorted(options.sizes):
            path = folder / f"plant{size:g}{_SUFFIX[dialect]}"
            with path.open("wb") as stream:
                write(stream, size, options.seed, dialect)
            yield dialect, path
            path.unlink()


def report_file(report: Report, path: Path, rounds: int, *, is_judged: bool = True) -> Row:
    """Print the lines of one file and return the row of sysmlc."""
    rounds = rounds_for(path, rounds)
    ours = measure("ours", path, rounds)
    report.line(f"{path.name} ({ours.megabytes:.1f} MB)", ours.text)
    for work in ("lxml", "expat") if path.suffix != ".mdzip" else ():
        peer = measure(work, path, rounds)
        ratio = ours.total / peer.total
        text = f"{peer.total:6.1f} ms/MB, memory {peer.memory:.1f} x; ours is {ratio:.1f} x"
        if work == "lxml" and ours.megabytes > _LARGE and is_judged:
            report.budget(f"  {work}", text, ratio, LXML, "x")
        else:
            report.line(f"  {work}", text)
    return ours


def report_pyecore(report: Report, path: Path, ours: Row, metamodel: str) -> None:
    """Print the line about pyecore, which reads only the dialect of Eclipse."""
    if not metamodel:
        report.line("  pyecore", "was not run: no --metamodel")
        return
    other = measure("pyecore", path, 1, metamodel)
    ratio = other.total / ours.total
    text = f"{other.total:6.1f} ms/MB, memory {other.memory:.1f} x; {ratio:.1f} x as long as ours"
    report.budget("  pyecore", text, PYECORE / ratio, 1.0, f"({PYECORE:g} x)")


def report_generated(report: Report, options: argparse.Namespace, folder: Path) -> None:
    """Print the lines of generated files of all sizes and dialects."""
    totals: dict[str, list[float]] = {}
    for dialect, path in generated(options, folder):
        ours = report_file(report, path, options.rounds)
        totals.setdefault(dialect, []).append(ours.total)
        if dialect == "magicdraw":
            continue
        if ours.megabytes > _LARGE:
            report.budget("  memory", f"{ours.memory:6.1f} x", ours.memory, MEMORY, "x")
        if ours.megabytes < 50:
            report_pyecore(report, path, ours, options.metamodel)
        if ours.megabytes < 2:
            seconds = all_outputs(path, options.rounds)
            report.budget("  to all outputs", f"{seconds:6.2f} s", seconds, ALL_OUTPUTS, "s")
    for dialect, rows in totals.items():
        if len(rows) > 1:
            report.line(f"{dialect}: largest to smallest", f"{rows[-1] / rows[0]:6.2f} x per MB")


def report_real(report: Report, options: argparse.Namespace) -> None:
    """Print the lines of the corpus's models; the budgets apply to generated models only."""
    corpus = Path(os.environ.get("SYSMLC_CORPUS", "")) / "xmi"
    for name in _REAL if "SYSMLC_CORPUS" in os.environ else ():
        report_file(report, corpus / name, options.rounds, is_judged=False)


def main() -> int:
    """Print the measurements; return 1 when a budget is missed."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--sizes", type=float, nargs="+", default=[1.0, 10.0], metavar="MB")
    parser.add_argument("--dialects", nargs="+", choices=sorted(_SUFFIX), default=sorted(_SUFFIX))
    parser.add_argument("--metamodel", default="", help="UML.ecore, to measure pyecore with")
    parser.add_argument("--seed", type=int, default=1)
    parser.add_argument("--rounds", type=int, default=5)
    options = parser.parse_args()
    report = Report()
    report.calibration()
    with tempfile.TemporaryDirectory() as folder:
        report_generated(report, options, Path(folder))
        report_real(report, options)
    return 0 if report.is_good else 1


if __name__ == "__main__":
    sys.exit(main())
