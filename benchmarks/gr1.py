"""CPU seconds to decide contracts in GR(1): reading, encoding and solving, without Python's start.

``python benchmarks/gr1.py CORPUS`` reads din8580, robots and tlsf_syntcomp below CORPUS/gr1;
``--long`` adds what takes more than half a minute. With ``--gr1c`` and ``--slugs`` those programs
decide the same contracts in the same run. The calibration loop makes machines comparable.
"""

import argparse
import json
import resource
import subprocess
import sys
import tempfile
import time
from pathlib import Path

from gr1_grid import holistic
from measuring import Report, calibration

from sysmlc.diagnostics import Sink, Subject
from sysmlc.logic import formats
from sysmlc.synthesis import Limits
from sysmlc.synthesis.decide import Options, decide

ROUNDS = 3
LONG = 5.0
"""Seconds from which on one round is enough."""
DIN = 0.10
BUDGETS = {
    "din8580/assembly_holistic.json": 3.0,
    "robots/hol_16x2_thesis.json": 0.2,
    "robots/hol_25x2_thesis.json": 0.3,
    "robots/hol_16x3_thesis.json": 1.0,
    "robots/robot_9.json": 0.3,
    "robots/robot_16.json": 0.3,
    "robots/robot_25.json": 0.3,
    "tlsf_syntcomp/amba_gr_pb_6_pe_.tlsf": 15.0,
    "tlsf_syntcomp/gr_3.tlsf": 10.0,
}
ACTIONS = ("turn", "move", "pick", "place", "compose", "decompose", "coordinator")
GRIDS = {(5, 3): 8.0, (4, 4): 30.0}
"""Sides and robots of generated contracts, with their budgets."""
LIMIT = 300.0


def main() -> int:
    """Print a line a contract; 1 when a budget is missed."""
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("corpus", type=Path)
    parser.add_argument("--long", action="store_true")
    parser.add_argument("--gr1c", default="", metavar="PROGRAM")
    parser.add_argument("--slugs", default="", metavar="PROGRAM")
    given = parser.parse_args()
    peers = [(name, getattr(given, name)) for name in PEERS if getattr(given, name)]
    report = Report()
    report.line("calibration loop", f"{calibration():.3f} s")
    for name, limit in _listed().items():
        path = given.corpus / "gr1" / name
        _measured(report, name, path.read_text(encoding="utf-8"), limit, peers)
    for (side, robots), limit in GRIDS.items() if given.long else ():
        contract = holistic(side, robots)
        _measured(report, f"{contract['name']}.gr1.json", json.dumps(contract), limit, peers)
    return 0 if report.is_good else 1


def _listed() -> dict[str, float]:
    return {f"din8580/{name}.json": DIN for name in ACTIONS} | BUDGETS


def _measured(
    report: Report, name: str, text: str, limit: float, peers: list[tuple[str, str]]
) -> None:
    """A line for a contract: the best of some rounds, and what other programs need."""
    runs = [_once(name, text)]
    while len(runs) < ROUNDS and runs[0][0] < LONG:
        runs.append(_once(name, text))
    seconds, words = min(runs)
    others = "".join(f", {peer} {_peer(peer, program, name, text)}" for peer, program in peers)
    report.budget(name, f"{seconds:8.3f} s {words}{others}", seconds, limit, "s")


def _once(name: str, text: str) -> tuple[float, str]:
    start = time.process_time()
    sink = Sink()
    (contract,) = formats.read(text, name, sink)
    options = Options(limits=Limits(seconds=LIMIT))
    verdict = decide(contract, lambda origin: Subject(), sink, options)
    seconds = time.process_time() - start
    words = {None: "not decided", True: "realizable", False: "unrealizable"}
    nodes = f", {verdict.figures.nodes:,} nodes" if verdict.figures else ""
    return seconds, f"{words[verdict.is_realizable]}{nodes}"


PEERS = {"gr1c": ("gr1c", ["-r"]), "slugs": ("slugsin", [])}
"""The form that a program reads, and its options to decide only."""


def _peer(peer: str, program: str, name: str, text: str) -> str:
    """CPU seconds of another program on the same contract, or why there are none."""
    form, arguments = PEERS[peer]
    (contract,) = formats.read(text, name, Sink())
    with tempfile.TemporaryDirectory() as folder:
        path = Path(folder, "contract")
        try:
            path.write_text(formats.write(contract, form), encoding="utf-8")
        except formats.NotExpressibleError as problem:
            return f"cannot be told: {problem.reason}"
        before = resource.getrusage(resource.RUSAGE_CHILDREN)
        try:
            command = [program, *arguments, str(path)]
            subprocess.run(command, capture_output=True, timeout=LIMIT, check=False)
        except (OSError, subprocess.TimeoutExpired) as problem:
            return f"did not answer ({type(problem).__name__})"
        after = resource.getrusage(resource.RUSAGE_CHILDREN)
    return f"{after.ru_utime + after.ru_stime - before.ru_utime - before.ru_stime:.3f} s"


if __name__ == "__main__":
    sys.exit(main())
