"""CPU seconds of synthesis: verdicts, controllers, unrealizable cores, refinements, deadlines.

``python benchmarks/gr1.py CORPUS`` measures contracts in files below CORPUS/gr1 and contracts of
generated grids. The start of Python does not count. ``--long`` adds contracts that take over 15 s.
``python benchmarks/gr1.py --families`` measures whole processes that decide generated elevators,
arbiters, counters and production lines, with their variables declared in several orders.
With ``--gr1c`` and ``--slugs`` those programs decide the same contracts in the same run. The
budgets are multiplied by the ratio in the line "floor" (``xmi.py``). Missions of robots are
measured by ``robots.py``. The exit code is 1 when a budget is missed.
"""

import argparse
import json
import sys
import tempfile
from collections.abc import Iterator
from dataclasses import dataclass
from functools import partial
from pathlib import Path

import gr1_work as work
from gr1_families import ORDERS, build_families, reorder_variables
from gr1_grid import build_contract
from gr1_peers import FORMATS, Peer
from measuring import SYSMLC, Report, measure_command
from xmi import measure_slowness

PEER_LIMIT = 60.0
"""Seconds that another program may run."""
DIN = "din8580"
ACTIONS = ("turn", "move", "pick", "place", "compose", "decompose", "coordinator")
HOLISTIC = "assembly_holistic"
VERDICT_BUDGETS = {
    **{f"{DIN}/{name}.json": 0.10 for name in ACTIONS},
    f"{DIN}/move.json": 0.2,
    f"{DIN}/{HOLISTIC}.json": 3.0,
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
"""Budgets without and with symmetry, by the side of a generated grid and the number of robots."""
LONG_GRIDS = {(5, 4): (0.0, 20.0), (5, 5): (0.0, 250.0)}
MACHINE = 0.3
CORE, REFINEMENT = 2.0, 0.2
"""Budgets of a controller, of an unrealizable core, and of a check of refinement."""
DEADLINES = {"hol_16x1_smart": 7, "hol_9x2_move_T4": 4, "hol_16x2_move_T5": 5}
"""Expected smallest deadline of each contract."""


@dataclass(frozen=True, slots=True)
class Run:
    """The report, the folder of contracts, the slowness of the machine, and programs to compare."""

    report: Report
    corpus: Path
    slowness: float
    peers: tuple[Peer, ...]

    def judge(
        self, name: str, measurement: tuple[float, str], limit: float, remark: str = ""
    ) -> None:
        """Print a line with a budget for seconds and their result."""
        seconds, result = measurement
        text = f"{seconds:8.3f} s {result}{remark}"
        self.report.judge_by_ratio(name, text, seconds, limit, self.slowness, "s")

    def read_text(self, name: str) -> str:
        """Return the text of a file of the corpus."""
        return (self.corpus / "gr1" / name).read_text(encoding="utf-8")

    def run_peers(self, name: str, text: str, own_seconds: float = 0.0) -> str:
        """Return times and verdicts of the other programs."""
        return "".join(f", {peer.decide(name, text, own_seconds)}" for peer in self.peers)


def main() -> int:
    """Print the measurements; return 1 when a budget is missed."""
    options = _parse_arguments()
    report = Report()
    slowness = measure_slowness(report, 3)
    programs = ((name, getattr(options, name)) for name in FORMATS)
    peers = tuple(Peer(name, program, PEER_LIMIT) for name, program in programs if program)
    run = Run(report, options.corpus or Path(), slowness, peers)
    if options.families:
        report_families(run)
    if options.corpus is None:
        return 0 if report.is_good else 1
    report_verdicts(run)
    report_controllers(run)
    report_cores(run)
    report_refinements(run)
    report_deadlines(run)
    report_grids(run, GRIDS | LONG_GRIDS if options.long else GRIDS)
    return 0 if report.is_good else 1


def _parse_arguments() -> argparse.Namespace:
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("corpus", type=Path, nargs="?")
    parser.add_argument("--long", action="store_true")
    parser.add_argument("--families", action="store_true")
    for name in FORMATS:
        parser.add_argument(f"--{name}", default="", metavar="PROGRAM")
    options = parser.parse_args()
    if options.corpus is None and not options.families:
        parser.error("give a folder of contracts, or --families")
    return options


def report_families(run: Run) -> None:
    """Print the lines of whole processes that decide generated contracts."""
    with tempfile.TemporaryDirectory() as folder:
        for family in build_families():
            for order in ORDERS:
                contract = reorder_variables(family.contract, order)
                path, text = Path(folder, f"{family.name}.gr1.json"), json.dumps(contract)
                path.write_text(text, encoding="utf-8")
                command = [SYSMLC, "synth", str(path), "--realizable"]
                seconds = min(measure_command(command) for _ in range(work.ROUNDS))
                remark = run.run_peers(path.name, text, seconds)
                run.judge(f"{family.name} {order}", (seconds, ""), family.limit, remark)


def report_verdicts(run: Run) -> None:
    """Print the lines of verdicts on files."""
    for name, limit in VERDICT_BUDGETS.items():
        text = run.read_text(name)
        measurement = work.measure_best(partial(work.decide_contract, name, text))
        run.judge(f"decide {name}", measurement, limit, run.run_peers(name, text))


def report_grids(run: Run, budgets: dict[tuple[int, int], tuple[float, float]]) -> None:
    """Print the lines of verdicts on generated grids.

    The solver finds the symmetry by itself, so the budget without symmetry is only printed.
    """
    for (side, robots), (without, limit) in budgets.items():
        contract = build_contract(side, robots)
        name, text = f"{contract['name']}.gr1.json", json.dumps(contract)
        measurement = work.measure_best(partial(work.decide_contract, name, text))
        remark = f" (budget without symmetry {without:g} s)" if without else ""
        run.judge(f"decide {name}", measurement, limit, remark + run.run_peers(name, text))


def report_controllers(run: Run) -> None:
    """Print the lines of controllers for actions, verified."""
    for action in ACTIONS:
        name = f"{DIN}/{action}.json"
        text = run.read_text(name)
        measurement = work.measure_best(partial(work.synthesise_contract, name, text))
        run.judge(f"controller {name}", measurement, MACHINE)


def report_cores(run: Run) -> None:
    """Print the lines of unrealizable cores."""
    for name in _iter_din_names(run):
        text = run.read_text(name)
        if json.loads(text)["status"] == "unrealizable":
            measurement = work.measure_best(partial(work.find_core, name, text))
            run.judge(f"core {name}", measurement, CORE)


def report_refinements(run: Run) -> None:
    """Print the lines of checks whether a variant refines its base contract."""
    for name in _iter_din_names(run):
        stem = Path(name).stem
        base = next(action for action in (*ACTIONS, HOLISTIC) if stem.startswith(action))
        if base != stem:
            texts = run.read_text(name), run.read_text(f"{DIN}/{base}.json")
            measurement = work.measure_best(partial(work.check_refinement, *texts))
            run.judge(f"refine {stem} < {base}", measurement, REFINEMENT)


def _iter_din_names(run: Run) -> Iterator[str]:
    return (f"{DIN}/{path.name}" for path in sorted((run.corpus / "gr1" / DIN).glob("*.json")))


def report_deadlines(run: Run) -> None:
    """Print the lines of smallest deadlines, which must have the expected values."""
    for name, bound in DEADLINES.items():
        text = run.read_text(f"robots/{name}.json")
        seconds, deadline = work.measure_deadline(f"{name}.gr1.json", text)
        run.report.is_good &= deadline == bound
        verdict = "as expected" if deadline == bound else f"NOT the expected {bound}"
        run.report.print_line(f"deadline {name}", f"{seconds:8.3f} s, {deadline}: {verdict}")


if __name__ == "__main__":
    sys.exit(main())
