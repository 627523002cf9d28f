"""Missions of robots on the floors of tables 4.1 and 4.2 of the thesis, in CPU seconds.

Targets are chosen at random with a seed. Robots may start anywhere, and every start is simulated.
The report also states the figures of the thesis, which come from another machine and from contracts
with counters; there the environment was synthesised, too. All rows with the same floor share one
controller, because robots are alike and targets are no part of a controller.
``--slowness N`` is the time of this machine as a multiple of the machine of the budget.
"""

import argparse
import random
import sys
import time

from measuring import Report
from msgspec.structs import replace

from sysmlc.controllers.machine import Machine
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
"""Seconds of the thesis for the whole, for the parts, and for the validation, by the side of the
floor and the numbers of robots and targets."""
STATES = {
    (3, 2, 2): ("10,704,291", "2 x 2,664"),
    (4, 1, 2): ("3,435,704", "8,432"),
    (4, 2, 2): ("72,938,223", "2 x 8,432"),
    (4, 2, 4): ("72,938,223", "2 x 8,432"),
    (4, 2, 6): ("72,938,223", "2 x 8,432"),
}
"""States of the controllers of the thesis, for the whole and for the parts (table 4.2)."""
BUDGET = 30.0
"""Seconds of the largest mission, on the machine of the budget."""
MOST_STATES = 4
"""Budget of states of the controller of one robot on the smallest floor."""
SLOWNESS = 1.37
SEED = 1

Size = tuple[int, int, int]
"""Side of the floor, number of robots, number of targets."""


def main() -> int:
    """Print the measurements; return 1 when a budget is missed."""
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--slowness", type=float, default=SLOWNESS)
    parser.add_argument("--rows", type=int, default=len(ROWS), metavar="N", help="the first N only")
    options = parser.parse_args()
    report = Report()
    report.print_calibration()
    for size in STATES:
        _report_states(report, size)
    controllers: dict[int, tuple[Synthesis, float]] = {}
    for size in list(ROWS)[: options.rows]:
        if size[0] not in controllers:
            controllers[size[0]] = _synthesise_controller(size)
        _report_mission(report, size, controllers[size[0]], options.slowness)
    return 0 if report.is_good else 1


def make_floor(side: int, robots: int, targets: int) -> Study:
    """Return a square floor with robots that may start anywhere, and random targets."""
    cells = random.Random(SEED).sample(range(side * side), targets)
    return Study(
        f"floor_{side * side}x{robots}x{targets}",
        "",
        Grid(side, side),
        tuple(Robot(f"r{number}", f"r{number}") for number in range(robots)),
        tuple(Target(f"t{number}", f"t{number}", cell) for number, cell in enumerate(cells)),
    )


def _report_states(report: Report, size: Size) -> None:
    """Print the line of table 4.2: the states of the controllers of a floor.

    The whole is the contract C_S of all robots; a part is the contract C_R of a robot that is alone
    on the floor.
    """
    study = make_floor(*size)
    whole = _count_states(system_contract(study))
    part = _count_states(robot_contract(replace(study, robots=(ANY,)), ANY))
    whole_of_thesis, parts_of_thesis = STATES[size]
    name = f"states, {size[0] ** 2} cells x {size[1]} x {size[2]}"
    text = (
        f"whole {whole or 'no'} (thesis {whole_of_thesis}), "
        f"parts {size[1]} x {part or 'no'} (thesis {parts_of_thesis})"
    )
    if size[0] == 3:
        report.judge(name, text, part or MOST_STATES + 1, MOST_STATES, "states")
    else:
        report.print_line(name, text)


def _count_states(contract: Contract) -> int:
    """Return the number of states of the controller of a contract; 0 if there is no controller."""
    machine = synthesise_controller(contract, _ignore_origin, Sink(), Options()).machine
    return machine.size if isinstance(machine, Machine) else 0


def _synthesise_controller(size: Size) -> tuple[Synthesis, float]:
    """Return the controller of a floor, and the CPU time of the synthesis."""
    start = time.process_time()
    controller = synthesise_robot(make_floor(*size), _ignore_origin, Sink(), Options())
    return controller, time.process_time() - start


def _report_mission(
    report: Report, size: Size, controller_and_time: tuple[Synthesis, float], slowness: float
) -> None:
    """Print the line of table 4.1: a floor from its contract to a validated mission."""
    study = make_floor(*size)
    controller, synthesis_time = controller_and_time
    outcome, validation_time = _validate_mission(study, controller)
    whole, parts, validation = ROWS[size]
    allocation = outcome.chosen
    starts = f"{allocation.validation.starts:,} starts" if allocation else "no allocation"
    steps = f"{allocation.validation.steps} steps" if allocation and outcome.is_good else "FAILS"
    name = f"{size[0] ** 2} cells x {size[1]} x {size[2]}"
    text = (
        f"synthesis {synthesis_time:6.2f} s (thesis {parts}, whole {whole}), "
        f"validation {validation_time:6.2f} s ({validation}): {starts}, {steps}"
    )
    report.is_good &= outcome.is_good
    report.print_line(name, text)
    if size == (5, 5, 15):
        total = synthesis_time + validation_time
        report.judge_by_ratio(
            "the largest, every start", f"{total:.2f} s", total, BUDGET, slowness, "s"
        )
        _report_one_start(report, study, controller, synthesis_time)


def _report_one_start(
    report: Report, study: Study, controller: Synthesis, synthesis_time: float
) -> None:
    """Print the line of the floor with one random start per robot, as in a run of the thesis."""
    cells = random.Random(SEED + 1).sample(range(study.grid.size), len(study.robots))
    pairs = zip(study.robots, cells, strict=True)
    robots = tuple(replace(robot, start=cell) for robot, cell in pairs)
    outcome, validation_time = _validate_mission(replace(study, robots=robots), controller)
    steps = outcome.chosen.validation.steps if outcome.chosen else "no"
    seconds = synthesis_time + validation_time
    report.print_line("the largest, one start", f"{seconds:.2f} s, {steps} steps")


def _validate_mission(study: Study, controller: Synthesis) -> tuple[Outcome, float]:
    """Return the outcome of a mission whose allocation is simulated, and the CPU time."""
    start = time.process_time()
    answers = build_answers(study, controller)
    times = measure_travel_times(study, answers)
    outcome = Outcome(study, controller, travel_times_of(study, times), answers, times)
    outcome = allocate_mission(outcome, _ignore_origin, Sink())
    return outcome, time.process_time() - start


def _ignore_origin(origin: str) -> Subject:
    """Return an empty subject: the contracts of a study come from no model."""
    return Subject()


if __name__ == "__main__":
    sys.exit(main())
