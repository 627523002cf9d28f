"""CPU time and memory of the CAEX front end on generated plants, and on real ones.

    python benchmarks/aml.py --sizes 5 50

Compare the ratios to lxml and expat, which are measured in the same run: times depend on the
machine. Each figure is the least of several processes. If SYSMLC_CORPUS is set, three real plants
are measured, too. The exit code is 1 when a budget is missed.
"""

import argparse
import os
import sys
import tempfile
from pathlib import Path

from aml_model import write_plant
from measuring import Report, Row, limit_rounds, measure_work

_WORK = Path(__file__).with_name("xml_work.py")
_REAL = (
    "dev/amlsec_casestudy_d.aml",
    "dev/amlsec_casestudy_a.aml",
    "dev/mtp_wago_ecockpit.aml",
)

LXML = 10.0
"""Budget from AutomationML to the resolved graph: multiple of the time of ``lxml.etree.parse``."""

MEMORY = 14.0
"""Budget of the peak of the resident memory: multiple of the size of a file of at least 5 MB."""

LINEAR = 1.2
"""Budget of the time per megabyte of the largest file: multiple of that of the smallest file."""

_LEAST_ROUNDS = 3

_SMALL = 10.0
"""Megabytes; for smaller files ``sysmlc check`` is measured, too."""

_LARGE = 4.0
"""Megabytes; only larger files are judged, because start-up distorts the figures of small ones."""


def report_file(report: Report, path: Path, rounds: int, *, is_judged: bool = True) -> Row:
    """Print the lines of one file and return the row of sysmlc."""
    rounds = max(limit_rounds(path, rounds), _LEAST_ROUNDS)
    sysmlc = measure_work(_WORK, "aml", path, rounds)
    report.print_line(f"{path.name} ({sysmlc.megabytes:.1f} MB)", sysmlc.as_text)
    if sysmlc.megabytes < _SMALL:
        check = measure_work(_WORK, "check", path, rounds)
        report.print_line("  sysmlc check, imports included", f"{check.total_time:6.0f} ms/MB")
    for work in ("lxml", "expat"):
        peer = measure_work(_WORK, work, path, rounds)
        ratio = sysmlc.total_time / peer.total_time
        text = f"{peer.total_time:6.1f} ms/MB, memory {peer.memory:.1f} x; sysmlc {ratio:.1f} x"
        if work == "lxml" and sysmlc.megabytes > _LARGE and is_judged:
            report.judge(f"  {work}", text, ratio, LXML, "x")
        else:
            report.print_line(f"  {work}", text)
    return sysmlc


def report_generated(report: Report, options: argparse.Namespace, folder: Path) -> None:
    """Print the lines of generated plants of all sizes."""
    rows = []
    for size in sorted(options.sizes):
        path = folder / f"plant{size:g}.aml"
        with path.open("wb") as stream:
            write_plant(stream, size, options.seed)
        row = report_file(report, path, options.rounds)
        path.unlink()
        if row.megabytes > _LARGE:
            report.judge("  memory", f"{row.memory:6.1f} x", row.memory, MEMORY, "x")
        rows.append(row)
    if len(rows) > 1:
        ratio = rows[-1].total_time / rows[0].total_time
        report.judge("largest to smallest", f"{ratio:6.2f} x per MB", ratio, LINEAR, "x")


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
    report.print_calibration()
    with tempfile.TemporaryDirectory() as folder:
        report_generated(report, options, Path(folder))
        report_real(report, options)
    return 0 if report.is_good else 1


if __name__ == "__main__":
    sys.exit(main())
