"""CPU seconds to decide contracts in GR(1), to make machines, cores, deadlines; to refine.

``python benchmarks/gr1.py CORPUS`` prints what issue 6 asks for (2 to 4), from files below
CORPUS/gr1 and generated grids; Python's start is not counted. ``--long`` adds what takes more than
a quarter of a minute. With ``--gr1c`` and ``--slugs`` those programs decide the same contracts in
the same run. Budgets count times as much longer as expat takes here than where they were set
(``xmi.py``); whether they hold as they stand is told beside. The robots' study is ``robots.py``.
"""

import argparse
import json
import sys
from collections.abc import Iterator
from dataclasses import dataclass
from functools import partial
from pathlib import Path

import gr1_work as work
from gr1_grid import holistic
from gr1_peers import FORMS, Peer
from measuring import Report
from xmi import slowness

PEER_LIMIT = 60.0
DIN = "din8580"
ACTIONS = ("turn", "move", "pick", "place", "compose", "decompose", "coordinator")
WHOLE = "assembly_holistic"
DECIDED = {
    **{f"{DIN}/{name}.json": 0.10 for name in ACTIONS},
    f"{DIN}/move.json": 0.2,
    f"{DIN}/{WHOLE}.json": 3.0,
    "robots/robot_9.json": 0.3,
    "robots/robot_16.json": 0.3,
    "robots/robot_25.json": 0.3,
    "robots/hol_16x2_thesis.json": 0.2,
    "robots/hol_25x2_thesis.json": 0.3,
    "robots/hol_16x3_thesis.json": 1.0,
    "tlsf_syntcomp/amba_gr_pb_6_pe_.tlsf": 15.0,
    "tlsf_syntcomp/gr_3.tlsf": 10.0,
}
GRIDS = {(5, 3): (8.0, 1.0), (4, 4): (30.0, 1.0)}
"""Sides and robots of generated contracts: budgets without and with symmetry."""
LONG_GRIDS = {(5, 4): (0.0, 20.0), (5, 5): (0.0, 250.0)}
MACHINE = 0.3
CORE, REFINEMENT = 2.0, 0.2
DEADLINES = {"hol_16x1_smart": 7, "hol_9x2_move_T4": 4, "hol_16x2_move_T5": 5}


@dataclass(frozen=True, slots=True)
class Run:
    """Where things are, how slow the machine is, whom to compare with."""

    report: Report
    corpus: Path
    slower: float
    peers: tuple[Peer, ...]

    def line(self, name: str, measured: tuple[float, str], limit: float, more: str = "") -> None:
        """A line with a budget."""
        seconds, said = measured
        text = f"{seconds:8.3f} s {said}{more}"
        self.report.scaled(name, text, seconds, limit, self.slower, "s")

    def text(self, name: str) -> str:
        """A file of the corpus."""
        return work.text_of(self.corpus / "gr1" / name)

    def others(self, name: str, text: str) -> str:
        """What other programs need."""
        return "".join(f", {peer.decided(name, text)}" for peer in self.peers)


def main() -> int:
    """Print a line a contract and question; 1 when a budget is missed by ratio."""
    given = _arguments()
    report = Report()
    slower = slowness(report, 3)
    peers = ((name, getattr(given, name)) for name in FORMS)
    known = tuple(Peer(name, program, PEER_LIMIT) for name, program in peers if program)
    run = Run(report, given.corpus, slower, known)
    for section in (decided, machines, cores, refinements, deadlines):
        section(run)
    grids(run, GRIDS | LONG_GRIDS if given.long else GRIDS)
    return 0 if report.is_good else 1


def _arguments() -> argparse.Namespace:
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("corpus", type=Path)
    parser.add_argument("--long", action="store_true")
    for name in FORMS:
        parser.add_argument(f"--{name}", default="", metavar="PROGRAM")
    return parser.parse_args()


def decided(run: Run) -> None:
    """Verdicts of files."""
    for name, limit in DECIDED.items():
        text = run.text(name)
        found = work.best(partial(work.decided, name, text))
        run.line(f"decide {name}", found, limit, run.others(name, text))


def grids(run: Run, known: dict[tuple[int, int], tuple[float, float]]) -> None:
    """Verdicts of generated grids; symmetry is found, so that there is one time for two budgets."""
    for (side, robots), (without, limit) in known.items():
        contract = holistic(side, robots)
        name, text = f"{contract['name']}.gr1.json", json.dumps(contract)
        found = work.best(partial(work.decided, name, text))
        budget = f" (without symmetry {without:g} s)" if without else ""
        run.line(f"decide {name}", found, limit, budget + run.others(name, text))


def machines(run: Run) -> None:
    """Actions with their machines, checked."""
    for action in ACTIONS:
        name = f"{DIN}/{action}.json"
        found = work.best(partial(work.made, name, run.text(name)))
        run.line(f"machine {name}", found, MACHINE)


def cores(run: Run) -> None:
    """Unrealizable variants with what cannot be kept together."""
    for name in _din(run):
        text = run.text(name)
        if json.loads(text)["status"] == "unrealizable":
            run.line(f"core {name}", work.best(partial(work.cored, name, text)), CORE)


def refinements(run: Run) -> None:
    """Each variant against the contract that it varies."""
    for name in _din(run):
        stem = Path(name).stem
        base = next(one for one in (*ACTIONS, WHOLE) if stem.startswith(one))
        if base != stem:
            found = work.best(partial(work.refined, run.text(name), run.text(f"{DIN}/{base}.json")))
            run.line(f"refine {stem} < {base}", found, REFINEMENT)


def _din(run: Run) -> Iterator[str]:
    return (f"{DIN}/{path.name}" for path in sorted((run.corpus / "gr1" / DIN).glob("*.json")))


def deadlines(run: Run) -> None:
    """Smallest deadlines: the values are what is asked for."""
    for name, bound in DEADLINES.items():
        seconds, found = work.bounded(f"{name}.gr1.json", run.text(f"robots/{name}.json"))
        run.report.is_good &= found == bound
        verdict = "as wanted" if found == bound else f"NOT the {bound} that is wanted"
        run.report.line(f"deadline {name}", f"{seconds:8.3f} s, {found}: {verdict}")


if __name__ == "__main__":
    sys.exit(main())
