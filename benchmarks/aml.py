"""CPU time and memory of the CAEX front end on generated plants, and on real ones.

    python benchmarks/aml.py --sizes 5 50

All numbers of one run come from one machine in one state: the ratios to lxml and to expat count.
Every number is the least of several processes. Where SYSMLC_CORPUS is set, three real plants are
measured as well. The exit code is 1 when a budget is missed.
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

LXML = 8.0
"""Multiple of the CPU time of ``lxml.etree.parse``, from AutomationML to the resolved graph."""

MEMORY = 14.0
"""Peak of the resident memory, as a multiple of the file's size, from 5 MB on."""

LINEAR = 1.2
"""Largest ratio of the time for a megabyte of the largest file to one of the smallest file."""

_LEAST_ROUNDS = 3

_SMALL = 10.0
"""Megabytes up to which the whole command is measured, too."""

_LARGE = 4.0
"""Megabytes from which on the time to start no longer distorts ratios and memory."""


def report_file(report: Report, path: Path, rounds: int, *, is_judged: bool = True) -> Row:
    """Print the lines of one file and return the row of sysmlc."""
    rounds = max(rounds_for(path, rounds), _LEAST_ROUNDS)
    ours = measure(_WORK, "ours", path, rounds)
    report.line(f"{path.name} ({ours.megabytes:.1f} MB)", ours.text)
    if ours.megabytes < _SMALL:
        whole = measure(_WORK, "check", path, rounds)
        report.line("  sysmlc check, imports included", f"{whole.total:6.0f} ms/MB")
    for work in ("lxml", "expat"):
        peer = measure(_WORK, work, path, rounds)
        ratio = ours.total / peer.total
        text = f"{peer.total:6.1f} ms/MB, memory {peer.memory:.1f} x; ours is {ratio:.1f} x"
        if work == "lxml" and ours.megabytes > _LARGE and is_judged:
            report.budget(f"  {work}", text, ratio, LXML, "x")
        else:
            report.line(f"  {work}", text)
    return ours


def report_generated(report: Report, options: argparse.Namespace, folder: Path) -> None:
    """Print the lines of generated plants of all sizes."""
    rows = []
    for size in sorted(options.sizes):
        path = folder / f"plant{size:g}.aml"
        with path.open("wb") as stream:
            write(stream, size, options.seed)
        row = report_file(report, path, options.rounds)
        path.unlink()
        if row.megabytes > _LARGE:
            report.budget("  memory", f"{row.memory:6.1f} x", row.memory, MEMORY, "x")
        rows.append(row)
    if len(rows) > 1:
        ratio = rows[-1].total / rows[0].total
        report.budget("largest to smallest", f"{ratio:6.2f} x per MB", ratio, LINEAR, "x")


def report_real(report: Report, options: argparse.Namespace) -> None:
    """Print the lines of the corpus's plants; the budgets apply to generated plants only."""
    corpus = Path(os.environ.get("SYSMLC_CORPUS", "")) / "aml"
    for name in _REAL if "SYSMLC_CORPUS" in os.environ else ():
        report_file(report, corpus / name, options.rounds, is_judged=False)


def main() -> int:
    """Print the measurements; return 1 when a budget is missed."""
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
