"""CPU time of the parser and resolver of SysML v2, beside other tools in the same run.

    python benchmarks/sysml.py                  a generated model of 1 MB
    python benchmarks/sysml.py FOLDER ...       folders with .sysml and .kerml files too

With SYSMLC_CORPUS set the official files are measured too. The tools beside ours are measured
where they are installed (``pip install sysml tree-sitter-sysml``); another notation of the same
numbers is MB/s, 1000 / (ms/MB). Exit code 1 when a budget is missed.
"""

import argparse
import os
import subprocess
import sys
import tempfile
from pathlib import Path

import measuring
import sysml_processes
from measuring import Report

_WORK = Path(__file__).with_name("sysml_work.py")
_PEERS = ("tree-sitter", "toolkit")
_OFFICIAL = ("omg-release/sysml.library", "omg-release/training", "omg-release/examples", "ice-lab")
_LINKED = ("training", "examples", "ice-lab")
"""Folders whose names are found among their files and in the installed library."""

PARSE = 1000.0
"""Milliseconds of CPU time for each megabyte, from text to tree."""

RESOLVE = 3333.0
"""Milliseconds for each megabyte, from text to a tree whose names lead to elements."""

SMALL = 0.35
"""Seconds of CPU time of a whole process that checks a small file without imports."""

LIBRARY = 0.5
"""The same with the library of the standard, which is in the cache."""

FIRST = 3.0
"""The same when it is not."""

OFFICIAL = 2.0
"""Seconds to check the 195 training and example files in one process."""

EDITED = 0.3
"""Seconds to compile the ICE laboratory again after an edit of one line: a note, or a number."""

_CELL = """\
    part def Cell{n} :> Machine {{
        doc /* One cell of the line, with what it does and how it tells. */
        attribute speed : Real = {n}.5 * 2 + offset;
        attribute offset : Real default 0.0;
        port command : Command {{ in item order : Order; out item done : Done; }}
        part arm[1..2] : Robot {{ :>> load = (3, 4, 5); }}
        action serve {{
            in item tray : Tray;
            first start;
            then accept order : Order via command;
            then action mill : Mill {{ in part = serve.tray; }}
            then decide check;
            if speed > 3 and offset <= speed then mill;
            else done;
        }}
        state def Modes {{
            entry; then idle;
            state idle;
            transition first idle accept Start if speed > 0 do serve then busy;
            state busy;
        }}
        connect arm.tool to command;
    }}
"""
_HEAD = """\
package Line {
    attribute def Real; item def Order; item def Done; item def Tray; attribute def Start;
    port def Command { in item order : Order; out item done : Done; }
    part def Machine; action def Mill { in part; }
    part def Robot { attribute load : Real [*]; port tool; }
"""


def generate(folder: Path, megabytes: float) -> None:
    """Write a model of about this size: a line of cells."""
    number = round(megabytes * measuring.MEGABYTE / len(_CELL))
    cells = "".join(_CELL.format(n=n) for n in range(number))
    (folder / "line.sysml").write_text(f"{_HEAD}{cells}}}\n", "utf-8")


def processes(report: Report, folder: Path, rounds: int) -> None:
    """The lines of whole processes; what is edited is compiled with a cache that is warm."""
    _, seconds = sysml_processes.text(folder, sysml_processes.ALONE, rounds)
    _budget(report, "a file with no import", seconds, SMALL)
    first, seconds = sysml_processes.text(folder, sysml_processes.WITH_LIBRARY, rounds)
    _budget(report, "with the library, first", first, FIRST)
    _budget(report, "with the library, indexed", seconds, LIBRARY)
    corpus = os.environ.get("SYSMLC_CORPUS", "")
    if corpus:
        first, noted, seconds = sysml_processes.official(Path(corpus), folder, rounds)
        report.line("all official files, first", f"{first:6.3f} s")
        report.line("all official files, a note edited", f"{noted:6.3f} s")
        _budget(report, "all official files, a line edited", seconds, OFFICIAL)
        first, noted, seconds = sysml_processes.laboratory(Path(corpus), folder, rounds)
        report.line("ICE laboratory, first", f"{first:6.3f} s")
        _budget(report, "ICE laboratory, a note edited", noted, EDITED)
        _budget(report, "ICE laboratory, a number edited", seconds, EDITED)


def _budget(report: Report, name: str, seconds: float, limit: float) -> None:
    report.budget(name, f"{seconds:6.3f} s", seconds, limit, "s")


def measure(report: Report, name: str, folder: Path, rounds: int, *, linked: bool) -> None:
    """The lines of one folder; ``linked`` where all its names can be found."""
    rows = {
        work: measuring.measure(_WORK, work, folder, rounds)
        for work in ("scan", "parse", *(["resolve"] if linked else []))
    }
    report.line(f"{name}: scan", rows["scan"].text)
    for work, limit in (("parse", PARSE), ("resolve", RESOLVE)):
        if work in rows:
            text, total = rows[work].text, rows[work].total
            report.budget(f"{name}: {work}", text, total, limit, "ms/MB")
    for peer in _PEERS:
        try:
            report.line(f"{name}: {peer}", measuring.measure(_WORK, peer, folder, rounds).text)
        except subprocess.CalledProcessError:
            report.line(f"{name}: {peer}", "not installed, or it stopped")


def main() -> int:
    """Print the measurements; 1 when a budget is missed."""
    options = argparse.ArgumentParser(description=__doc__)
    options.add_argument("folders", nargs="*", type=Path)
    options.add_argument("--rounds", type=int, default=3)
    given = options.parse_args()
    report = Report()
    report.calibration()
    with tempfile.TemporaryDirectory() as name:
        folder = Path(name)
        generate(folder, 1.0)
        measure(report, "generated", folder, given.rounds, linked=True)
        processes(report, folder, given.rounds)
    for path in (*_official(), *given.folders):
        measure(report, path.name, path, given.rounds, linked=path.name in _LINKED)
    return 0 if report.is_good else 1


def _official() -> list[Path]:
    corpus = os.environ.get("SYSMLC_CORPUS", "")
    return [Path(corpus) / "sysml2" / name for name in _OFFICIAL] if corpus else []


if __name__ == "__main__":
    sys.exit(main())
