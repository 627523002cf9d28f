"""CPU time of the parser and resolver of SysML v2, and of other tools in the same run.

    python benchmarks/sysml.py                  a generated model of 1 MB
    python benchmarks/sysml.py FOLDER ...       folders with .sysml and .kerml files too
    python benchmarks/sysml.py --copies         only copies of the ICE laboratory, pass by pass

If SYSMLC_CORPUS is set, the official files are measured, too. The other tools are measured if they
are installed (``pip install sysml tree-sitter-sysml``).

The line "resolve" is measured in a process that has parsed the library files that the texts
import, like a process that stays alive. The line "resolve, new process" includes parsing these
files, a fixed cost that is most of the time of a small folder; it has no budget.

The budgets were set on a machine where expat alone, the floor, took 9.0 ms/MB (``xmi.py``). They
are multiplied by the ratio of the floor in this run to that. The exit code is 1 when a budget is
missed.
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
from measuring import Report, Row
from xmi import measure_slowness

_WORK = Path(__file__).with_name("sysml_work.py")
_PEERS = ("tree-sitter", "toolkit")
_OFFICIAL = ("omg-release/sysml.library", "omg-release/training", "omg-release/examples", "ice-lab")
_LINKED = ("training", "examples", "ice-lab")
"""Folders whose files refer only to one another and to the installed library."""

PARSE = 1000.0
"""Budget from text to tree, in milliseconds of CPU time per megabyte."""

RESOLVE = 3333.0
"""Budget from text to a tree with resolved names, in milliseconds per megabyte, if the process has
parsed the library files."""

SMALL = 0.35
"""Budget of a process that checks a small file without imports, in seconds of CPU time."""

LIBRARY = 0.6
"""Budget of a process that checks a small file with imports from the standard library."""

OFFICIAL = 2.0
"""Budget in seconds to parse and resolve the 195 training and example files in one process."""

EDITED = 0.8
"""Budget in seconds of ``sysmlc watch``, from an edit of the ICE laboratory to all outputs."""

GROWTH = 1.2
"""Budget of each pass in one unit with twenty copies of the ICE laboratory, for each copy, as a
multiple of its time with five copies."""

_FEW, _MANY = 5, 20
_LEAST_SHARE = 0.01
"""Share of the whole time below which a pass is not judged, because noise decides."""

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


def generate_model(folder: Path, megabytes: float) -> None:
    """Write a model of about this size: a line of cells."""
    count = round(megabytes * measuring.MEGABYTE / len(_CELL))
    cells = "".join(_CELL.format(n=n) for n in range(count))
    (folder / "line.sysml").write_text(f"{_HEAD}{cells}}}\n", "utf-8")


def report_processes(report: Report, folder: Path, rounds: int, slowness: float) -> None:
    """Print the lines of whole processes, which have no cache."""

    def judge(name: str, seconds: float, limit: float) -> None:
        report.judge_by_ratio(name, f"{seconds:6.3f} s", seconds, limit, slowness, "s")

    alone = sysml_processes.measure_check(folder, sysml_processes.ALONE, rounds)
    judge("a file with no import", alone, SMALL)
    importing = sysml_processes.measure_check(folder, sysml_processes.WITH_LIBRARY, rounds)
    judge("with the library", importing, LIBRARY)
    corpus = os.environ.get("SYSMLC_CORPUS", "")
    if corpus:
        unit = sysml_processes.copy_official_files(Path(corpus), folder)
        row = measuring.measure_work(_WORK, "resolve-on-demand", unit, rounds)
        judge("all 195 parsed and resolved", row.total_time * row.megabytes / 1000, OFFICIAL)
        checked = sysml_processes.measure_sysmlc(["check", str(unit)], rounds)
        report.print_line("all 195 checked", f"{checked:6.3f} s")
        seconds = sysml_processes.measure_laboratory(Path(corpus), folder, rounds)
        report.print_line("ICE laboratory", f"{seconds:6.3f} s")
        for edit, cpu_time, elapsed in sysml_watching.measure_edits(Path(corpus), folder, rounds):
            judge(f"ICE laboratory, watched: {edit}", cpu_time, EDITED)
            report.print_line("", f"outputs {elapsed:.3f} s after the save")


def report_copies(report: Report, corpus: Path, folder: Path, rounds: int) -> None:
    """Print the time of each pass for one copy of the ICE laboratory among few and many copies."""
    few, many = (
        measuring.measure_fastest_laps(
            _WORK,
            "check-by-pass",
            sysml_processes.copy_laboratories(corpus, folder / str(count), count),
            rounds,
        )
        for count in (_FEW, _MANY)
    )
    for name in (*many, "check"):
        before = few[name] if name in few else sum(few.values())
        after = many[name] if name in many else sum(many.values())
        text = f"{before / _FEW:7.4f} s, {after / _MANY:7.4f} s"
        if after < _LEAST_SHARE * sum(many.values()):
            report.print_line(name, text)
        else:
            growth = after / _MANY / (before / _FEW)
            report.judge(name, f"{text}, {growth:.2f} times", growth, GROWTH, "times")


def report_folder(
    report: Report, name: str, folder: Path, rounds: int, slowness: float, *, is_linked: bool
) -> None:
    """Print the lines of one folder. Names are resolved only if *is_linked*."""

    def measure(work: str) -> Row:
        return measuring.measure_work(_WORK, work, folder, rounds)

    def judge(work: str, limit: float) -> None:
        row = measure(work)
        label, time = f"{name}: {work}", row.total_time
        report.judge_by_ratio(label, row.as_text, time, limit, slowness, "ms/MB")

    report.print_line(f"{name}: scan", measure("scan").as_text)
    judge("parse", PARSE)
    if is_linked:
        judge("resolve", RESOLVE)
        text = measure("resolve-on-demand").as_text
        report.print_line(f"{name}: resolve, new process", text)
    for peer in _PEERS:
        try:
            report.print_line(f"{name}: {peer}", measure(peer).as_text)
        except subprocess.CalledProcessError:
            report.print_line(f"{name}: {peer}", "not installed, or it failed")


def main() -> int:
    """Print the measurements; return 1 when a budget is missed."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("folders", nargs="*", type=Path)
    parser.add_argument("--rounds", type=int, default=3)
    parser.add_argument("--copies", action="store_true")
    options = parser.parse_args()
    rounds, report = options.rounds, Report()
    if options.copies:
        with tempfile.TemporaryDirectory() as name:
            report_copies(report, Path(os.environ["SYSMLC_CORPUS"]), Path(name), rounds)
        return 0 if report.is_good else 1
    report.print_calibration()
    with tempfile.TemporaryDirectory() as name:
        folder = Path(name)
        slowness = measure_slowness(report, rounds)
        generate_model(folder, 1.0)
        report_folder(report, "generated", folder, rounds, slowness, is_linked=True)
        report_processes(report, folder, rounds, slowness)
    for path in (*_list_official_folders(), *options.folders):
        is_linked = path.name in _LINKED
        report_folder(report, path.name, path, rounds, slowness, is_linked=is_linked)
    return 0 if report.is_good else 1


def _list_official_folders() -> list[Path]:
    corpus = os.environ.get("SYSMLC_CORPUS", "")
    return [Path(corpus) / "sysml2" / name for name in _OFFICIAL] if corpus else []


if __name__ == "__main__":
    sys.exit(main())
