"""Robots on floors of the thesis's sizes (tables 4.1 and 4.2): synthesis, validation, states.

``python benchmarks/robots.py`` draws targets with a seed; robots may start anywhere, and every
start is simulated. CPU seconds. Beside ours stand the thesis's, measured on another machine, for
contracts with counters, and with the environment synthesised too; we generate no code yet. One
controller is made for each floor: robots are alike, and targets are no part of it.
``--slower N`` tells how much slower this machine is than the one for which the budget was set.
"""

import argparse
import random
import sys
import time

from measuring import Report
from msgspec.structs import replace

from sysmlc.diagnostics import Sink, Subject
from sysmlc.logic.contract import Contract
from sysmlc.robots.outcome import Outcome, allocate_mission
from sysmlc.robots.robot_contract import robot_contract
from sysmlc.robots.robot_controller import (
    ANY,
    build_answers,
    measure_travel_times,
    synthesise_robot,
    travel_times_of,
)
from sysmlc.robots.study import Grid, Robot, Study, Target
from sysmlc.robots.system_contract import system_contract
from sysmlc.synthesis.controller_synthesis import Synthesis, synthesise_controller
from sysmlc.synthesis.controllers.forms import Machine
from sysmlc.synthesis.decision import Options

ROWS = {
    (3, 2, 2): ("20.36", "6.85", "0.01"),
    (4, 1, 2): ("31.48", "20.54", "0.03"),
    (4, 2, 2): ("3924.18", "33.13", "0.02"),
    (4, 2, 4): ("3924.22", "33.17", "0.04"),
    (4, 2, 6): ("3924.60", "33.17", "0.07"),
    (4, 3, 6): ("6 h", "71.59", "0.04"),
    (4, 4, 6): ("6 h", "184.35", "0.05"),
    (4, 4, 8): ("6 h", "184.35", "0.06"),
    (5, 2, 4): ("6 h", "55.54", "0.08"),
    (5, 2, 6): ("6 h", "55.54", "0.09"),
    (5, 3, 9): ("6 h", "142.79", "0.12"),
    (5, 4, 12): ("6 h", "238.83", "0.17"),
    (5, 5, 15): ("6 h", "312.64", "0.21"),
}
"""Side, robots, targets: the thesis's seconds for the whole, the parts, and the validation."""
STATES = {
    (3, 2, 2): ("10,704,291", "2 x 2,664"),
    (4, 1, 2): ("3,435,704", "8,432"),
    (4, 2, 2): ("72,938,223", "2 x 8,432"),
    (4, 2, 4): ("72,938,223", "2 x 8,432"),
    (4, 2, 6): ("72,938,223", "2 x 8,432"),
}
"""The thesis's states of the machine for the whole, and of those for the parts (table 4.2)."""
BUDGET = 30.0
MOST_STATES = 4
SLOWER = 1.37
SEED = 1


def main() -> int:
    """Print a line for each floor; 1 when a budget is missed."""
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--slower", type=float, default=SLOWER)
    parser.add_argument("--rows", type=int, default=len(ROWS), metavar="N", help="the first N only")
    given = parser.parse_args()
    report = Report()
    report.calibration()
    for size in STATES:
        _states(report, size)
    made: dict[int, tuple[Synthesis, float]] = {}
    for size in list(ROWS)[: given.rows]:
        if size[0] not in made:
            made[size[0]] = _controller(size)
        _measured(report, size, made[size[0]], given.slower)
    return 0 if report.is_good else 1


def floor(side: int, robots: int, targets: int) -> Study:
    """A square floor with robots that start anywhere and targets that are drawn."""
    cells = random.Random(SEED).sample(range(side * side), targets)
    return Study(
        f"floor_{side * side}x{robots}x{targets}",
        "",
        Grid(side, side),
        tuple(Robot(f"r{at}", f"r{at}") for at in range(robots)),
        tuple(Target(f"t{at}", f"t{at}", cell) for at, cell in enumerate(cells)),
    )


def _states(report: Report, size: tuple[int, int, int]) -> None:
    """Table 4.2: machines of C_S for the whole, and of C_R, alone on the floor, for the parts."""
    study = floor(*size)
    whole = _size(system_contract(study))
    part = _size(robot_contract(replace(study, robots=(ANY,)), ANY))
    ours, theirs = (f"{whole or 'no'}", f"{size[1]} x {part or 'no'}"), STATES[size]
    name = f"states, {size[0] ** 2} cells x {size[1]} x {size[2]}"
    text = f"whole {ours[0]} (thesis {theirs[0]}), parts {ours[1]} (thesis {theirs[1]})"
    if size[0] == 3:
        report.budget(name, text, part or MOST_STATES + 1, MOST_STATES, "states")
    else:
        report.line(name, text)


def _size(contract: Contract) -> int:
    made = synthesise_controller(contract, _nowhere, Sink(), Options())
    return made.machine.size if isinstance(made.machine, Machine) else 0


def _controller(size: tuple[int, int, int]) -> tuple[Synthesis, float]:
    """The controller of a floor, which is that of all its rows, and the seconds that it took."""
    start = time.process_time()
    return synthesise_robot(floor(*size), _nowhere, Sink(), Options()), time.process_time() - start


def _measured(
    report: Report, size: tuple[int, int, int], made: tuple[Synthesis, float], slower: float
) -> None:
    """Table 4.1: a floor from its contract to a validated mission."""
    study = floor(*size)
    controller, synthesis = made
    done, seconds = _validated(study, controller)
    whole, parts, validation = ROWS[size]
    tried = done.chosen
    starts = f"{tried.validation.starts:,} starts" if tried else "no allocation"
    steps = f"{tried.validation.steps} steps" if tried and done.is_good else "FAILS"
    name = f"{size[0] ** 2} cells x {size[1]} x {size[2]}"
    text = (
        f"synthesis {synthesis:6.2f} s (thesis {parts}, whole {whole}), "
        f"validation {seconds:6.2f} s ({validation}): {starts}, {steps}"
    )
    report.is_good &= done.is_good
    report.line(name, text)
    if size == (5, 5, 15):
        total = synthesis + seconds
        report.scaled("the largest, every start", f"{total:.2f} s", total, BUDGET, slower, "s")
        _from_one_start(report, study, controller, synthesis)


def _from_one_start(report: Report, study: Study, controller: Synthesis, synthesis: float) -> None:
    """The same with robots that start where they are drawn, as one run of the thesis's may."""
    cells = random.Random(SEED + 1).sample(range(study.grid.size), len(study.robots))
    pairs = zip(study.robots, cells, strict=True)
    drawn = replace(study, robots=tuple(replace(one, start=cell) for one, cell in pairs))
    made, seconds = _validated(drawn, controller)
    steps = made.chosen.validation.steps if made.chosen else "no"
    report.line("the largest, one start", f"{synthesis + seconds:.2f} s, {steps} steps")


def _validated(study: Study, controller: Synthesis) -> tuple[Outcome, float]:
    start = time.process_time()
    answers = build_answers(study, controller)
    times = measure_travel_times(study, answers)
    made = Outcome(study, controller, travel_times_of(study, times), answers, times)
    made = allocate_mission(made, _nowhere, Sink())
    return made, time.process_time() - start


def _nowhere(origin: str) -> Subject:
    return Subject()


if __name__ == "__main__":
    sys.exit(main())
