"""CPU time of the parser and resolver of SysML v2, beside other tools in the same run.

    python benchmarks/sysml.py                  a generated model of 1 MB
    python benchmarks/sysml.py FOLDER ...       folders with .sysml and .kerml files too

With SYSMLC_CORPUS set the official files are measured too. The tools beside ours are measured
where they are installed (``pip install sysml tree-sitter-sysml``); another notation of the same
numbers is MB/s, 1000 / (ms/MB).

The budgets were set on a machine where expat alone, the floor, took 9.0 ms/MB (``xmi.py``): here
they count times as much longer as expat takes in this run. Whether they hold as they stand is
told beside. Exit code 1 when a budget is missed.
"""

import argparse
import os
import subprocess
import sys
import tempfile
from pathlib import Path

import measuring
import sysml_processes
import sysml_watching
import xmi
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

LIBRARY = 0.6
"""The same with the library of the standard."""

OFFICIAL = 2.0
"""Seconds to check the 195 training and example files in one process."""

EDITED = 0.8
"""Seconds of ``sysmlc watch`` for an edit of one line of the ICE laboratory, to all outputs."""

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


def processes(report: Report, folder: Path, rounds: int, slower: float) -> None:
    """The lines of whole processes, which have no cache."""

    def budget(name: str, seconds: float, limit: float) -> None:
        report.scaled(name, f"{seconds:6.3f} s", seconds, limit, slower, "s")

    budget(
        "a file with no import",
        sysml_processes.text(folder, sysml_processes.ALONE, rounds),
        SMALL,
    )
    budget(
        "with the library",
        sysml_processes.text(folder, sysml_processes.WITH_LIBRARY, rounds),
        LIBRARY,
    )
    corpus = os.environ.get("SYSMLC_CORPUS", "")
    if corpus:
        unit = sysml_processes.gather(Path(corpus), folder)
        whole = measuring.measure(_WORK, "resolve", unit, rounds)
        budget("all 195 parsed and resolved", whole.total * whole.megabytes / 1000, OFFICIAL)
        checked = sysml_processes.measure(["check", str(unit)], rounds)
        report.line("all 195 checked", f"{checked:6.3f} s")
        seconds = sysml_processes.laboratory(Path(corpus), folder, rounds)
        report.line("ICE laboratory", f"{seconds:6.3f} s")
        measured = sysml_watching.laboratory(Path(corpus), folder, rounds)
        for what, (seconds, clock) in zip(sysml_processes.LABORATORY, measured, strict=False):
            budget(f"ICE laboratory, watched: {what}", seconds, EDITED)
            report.line("", f"outputs {clock:.3f} s after the save")


def measure(
    report: Report, name: str, folder: Path, rounds: int, slower: float, *, linked: bool
) -> None:
    """The lines of one folder; ``linked`` where all its names can be found."""
    rows = {
        work: measuring.measure(_WORK, work, folder, rounds)
        for work in ("scan", "parse", *(["resolve"] if linked else []))
    }
    report.line(f"{name}: scan", rows["scan"].text)
    for work, limit in (("parse", PARSE), ("resolve", RESOLVE)):
        if work in rows:
            text, total = rows[work].text, rows[work].total
            report.scaled(f"{name}: {work}", text, total, limit, slower, "ms/MB")
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
        slower = xmi.slowness(report, given.rounds)
        generate(folder, 1.0)
        measure(report, "generated", folder, given.rounds, slower, linked=True)
        processes(report, folder, given.rounds, slower)
    for path in (*_official(), *given.folders):
        measure(report, path.name, path, given.rounds, slower, linked=path.name in _LINKED)
    return 0 if report.is_good else 1


def _official() -> list[Path]:
    corpus = os.environ.get("SYSMLC_CORPUS", "")
    return [Path(corpus) / "sysml2" / name for name in _OFFICIAL] if corpus else []


if __name__ == "__main__":
    sys.exit(main())
