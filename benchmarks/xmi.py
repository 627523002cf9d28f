"""CPU time and memory of the XMI front end on generated models, and on real ones.

    python benchmarks/xmi.py --sizes 1 10 100 --metamodel PATH/uml.ecore

Compare the ratios to lxml, expat and pyecore, which are measured in the same run: times depend on
the machine. Each figure is the least of several processes. If SYSMLC_CORPUS is set, four real
models are measured, too. The exit code is 1 when a budget is missed.
"""

import argparse
import os
import sys
import tempfile
from collections.abc import Iterator
from pathlib import Path

from measuring import SYSMLC, Report, Row, limit_rounds, measure_command, measure_work
from xmi_model import write_model

_WORK = Path(__file__).with_name("xml_work.py")
_REAL = (
    "papyrus/Alf.library.uml",
    "papyrus/fUML-Tests.uml",
    "magicdraw/fUML-Tests.mdxml",
    "magicdraw/Tank_control_2.mdzip",
)
_SUFFIX = {"papyrus": ".uml", "magicdraw": ".xml"}

LXML = 11.0
"""Budget from XMI to the resolved graph: multiple of the time of ``lxml.etree.parse``."""

MEMORY = 10.0
"""Budget of the peak of the resident memory: multiple of the size of a file of 10 MB or more."""

ALL_OUTPUTS = 2.0
"""Budget of a whole process from a model of 1 MB to all outputs, in seconds of CPU time."""

PYECORE = 8.0
"""Budget of the comparison: pyecore takes at least this multiple of the time of sysmlc."""

FLOOR = 9.0
"""Speed of the machine on which the budgets of SysML v2 and of synthesis were set: milliseconds per
megabyte of expat alone, for 10 MB in the dialect of Papyrus."""

_LARGE = 5.0
"""Megabytes; the ratio to lxml and the memory of larger files are judged."""


def measure_all_outputs(path: Path, rounds: int) -> float:
    """Return the CPU seconds of ``sysmlc`` from the model to all files, start-up included."""
    seconds = []
    for _ in range(rounds):
        with tempfile.TemporaryDirectory() as folder:
            seconds.append(measure_command([SYSMLC, str(path), "--no-cache", "-o", folder]))
    return min(seconds)


def measure_slowness(report: Report, rounds: int) -> float:
    """Return the time of expat as a multiple of ``FLOOR``, and print it.

    Budgets in CPU time are multiplied by it, see ``Report.judge_by_ratio``.
    """
    with tempfile.TemporaryDirectory() as folder:
        path = Path(folder, "floor.uml")
        with path.open("wb") as stream:
            write_model(stream, 10, 1, "papyrus")
        floor = measure_work(_WORK, "expat", path, rounds).total_time
    ratio = floor / FLOOR
    text = f"{floor:6.1f} ms/MB, {ratio:.2f} x the {FLOOR:g} of the machine of the budgets"
    report.print_line("floor: expat alone, 10 MB", text)
    return ratio


def generate_files(options: argparse.Namespace, folder: Path) -> Iterator[tuple[str, Path]]:
    """Yield dialect and path of each generated file; it is removed before the next is written."""
    for dialect in options.dialects:
        for size in sorted(options.sizes):
            path = folder / f"plant{size:g}{_SUFFIX[dialect]}"
            with path.open("wb") as stream:
                write_model(stream, size, options.seed, dialect)
            yield dialect, path
            path.unlink()


def report_file(report: Report, path: Path, rounds: int, *, is_judged: bool = True) -> Row:
    """Print the lines of one file and return the row of sysmlc."""
    rounds = limit_rounds(path, rounds)
    sysmlc = measure_work(_WORK, "xmi", path, rounds)
    report.print_line(f"{path.name} ({sysmlc.megabytes:.1f} MB)", sysmlc.as_text)
    for work in ("lxml", "expat") if path.suffix != ".mdzip" else ():
        peer = measure_work(_WORK, work, path, rounds)
        ratio = sysmlc.total_time / peer.total_time
        text = f"{peer.total_time:6.1f} ms/MB, memory {peer.memory:.1f} x; sysmlc {ratio:.1f} x"
        if work == "lxml" and sysmlc.megabytes > _LARGE and is_judged:
            report.judge(f"  {work}", text, ratio, LXML, "x")
        else:
            report.print_line(f"  {work}", text)
    return sysmlc


def report_pyecore(report: Report, path: Path, sysmlc: Row, metamodel: str) -> None:
    """Print the line of pyecore, which reads only the dialect of Eclipse and Papyrus."""
    if not metamodel:
        report.print_line("  pyecore", "not measured: --metamodel is missing")
        return
    peer = measure_work(_WORK, "pyecore", path, 1, metamodel)
    ratio = peer.total_time / sysmlc.total_time
    text = f"{peer.total_time:6.1f} ms/MB, memory {peer.memory:.1f} x; {ratio:.1f} x sysmlc"
    report.judge("  pyecore", text, PYECORE / ratio, 1.0, f"({PYECORE:g} x)")


def report_generated(report: Report, options: argparse.Namespace, folder: Path) -> None:
    """Print the lines of generated files of all sizes and dialects."""
    totals: dict[str, list[float]] = {}
    for dialect, path in generate_files(options, folder):
        sysmlc = report_file(report, path, options.rounds)
        totals.setdefault(dialect, []).append(sysmlc.total_time)
        if dialect == "magicdraw":
            continue
        if sysmlc.megabytes > _LARGE:
            report.judge("  memory", f"{sysmlc.memory:6.1f} x", sysmlc.memory, MEMORY, "x")
        if sysmlc.megabytes < 50:
            report_pyecore(report, path, sysmlc, options.metamodel)
        if sysmlc.megabytes < 2:
            seconds = measure_all_outputs(path, options.rounds)
            report.judge("  to all outputs", f"{seconds:6.2f} s", seconds, ALL_OUTPUTS, "s")
    for dialect, times in totals.items():
        if len(times) > 1:
            report.print_line(
                f"{dialect}: largest to smallest", f"{times[-1] / times[0]:6.2f} x per MB"
            )


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
    report.print_calibration()
    with tempfile.TemporaryDirectory() as folder:
        report_generated(report, options, Path(folder))
        report_real(report, options)
    return 0 if report.is_good else 1


if __name__ == "__main__":
    sys.exit(main())
