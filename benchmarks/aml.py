"""CPU time and memory of the CAEX front end on generated plants, and on real ones.

    python benchmarks/aml.py --sizes 5 50

All numbers of one run are of one machine in one state: what counts are the ratios to lxml and
to expat, and the calibration loop. Every number is the least of several processes. With
SYSMLC_CORPUS set three real plants are measured too. Exit code 1 when a budget is missed.
"""

import argparse
import os
import sys
import tempfile
from pathlib import Path

from aml_model import write
from measuring import Report, Row, measure, rounds_for

_WORK = Path(__file__).with_name("aml_work.py")
_REAL = (
    "dev/amlsec_casestudy_d.aml",
    "dev/amlsec_casestudy_a.aml",
    "dev/mtp_wago_ecockpit.aml",
)

BUDGET = 50.0
"""Milliseconds of CPU time for each megabyte, from AutomationML to the resolved graph."""

LXML = 6.0
"""How many times the CPU time of ``lxml.etree.parse``, from 5 MB on."""

MEMORY = 14.0
"""Peak of the resident memory, as a multiple of the file's size, from 5 MB on."""

LINEAR = 1.2
"""How many times as long a megabyte of the largest file may take as one of the smallest."""

_SMALL = 10.0
"""Megabytes up to which the whole command is measured, too."""

_LARGE = 4.0
"""Megabytes from which on ratios and memory say something: start-up no longer counts."""


def report_file(report: Report, path: Path, rounds: int) -> Row:
    """Lines about one file; the row of ours."""
    rounds = rounds_for(path, rounds)
    ours = measure(_WORK, "ours", path, rounds)
    name = f"{path.name} ({ours.megabytes:.1f} MB)"
    report.budget(name, ours.text, ours.total, BUDGET, "ms/MB")
    if ours.megabytes < _SMALL:
        whole = measure(_WORK, "check", path, rounds)
        report.line("  sysmlc check, imports included", f"{whole.total:6.0f} ms/MB")
    for work in ("lxml", "expat"):
        other = measure(_WORK, work, path, rounds)
        ratio = ours.total / other.total
        text = f"{other.total:6.1f} ms/MB, memory {other.memory:.1f} x; ours is {ratio:.1f} x"
        if work == "lxml" and ours.megabytes > _LARGE:
            report.budget(f"  {work}", text, ratio, LXML, "x")
        else:
            report.line(f"  {work}", text)
    return ours


def report_generated(report: Report, options: argparse.Namespace, folder: Path) -> None:
    """Lines about generated plants of all sizes."""
    totals = []
    for size in sorted(options.sizes):
        path = folder / f"plant{size:g}.aml"
        with path.open("wb") as stream:
            write(stream, size, options.seed)
        ours = report_file(report, path, options.rounds)
        path.unlink()
        totals.append(ours.total)
        if ours.megabytes > _LARGE:
            report.budget("  memory", f"{ours.memory:6.1f} x", ours.memory, MEMORY, "x")
    if len(totals) > 1:
        ratio = totals[-1] / totals[0]
        report.budget("largest to smallest", f"{ratio:6.2f} x per MB", ratio, LINEAR, "x")


def report_real(report: Report, options: argparse.Namespace) -> None:
    """Lines about the plants of the corpus that are there."""
    corpus = Path(os.environ.get("SYSMLC_CORPUS", "")) / "aml"
    for name in _REAL if "SYSMLC_CORPUS" in os.environ else ():
        report_file(report, corpus / name, options.rounds)


def main() -> int:
    """Print the measurements; 1 when a budget is missed."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--sizes", type=float, nargs="+", default=[5.0, 50.0], metavar="MB")
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
