"""The common controller of all robots, synthesised from their contract, and its travel times."""

from collections.abc import Mapping, Sequence

from msgspec.structs import replace

from sysmlc.diagnostics import Sink
from sysmlc.logic.contract import Contract
from sysmlc.robots.answers import Answers
from sysmlc.robots.robot_contract import robot_contract
from sysmlc.robots.run_sets import RunSpace, difference
from sysmlc.robots.schedule import START, TravelTimes
from sysmlc.robots.study import Robot, Study, Target, possible_starts
from sysmlc.robots.world import World
from sysmlc.synthesis.controller_synthesis import Synthesis, synthesise_controller
from sysmlc.synthesis.decision import Options, Place

ANY = Robot("robot", "robot")
"""A robot that represents all robots: controllers do not depend on names and starts."""


def controller_contract(study: Study) -> Contract:
    """Return the contract of the controller: a robot among others, from any start.

    Step counters are omitted, because each value of a counter would be another state of the
    machine.
    """
    single_robot_study = replace(study, robots=(ANY,), counter_size=0)
    contract = robot_contract(single_robot_study, ANY, is_alone=False)
    return replace(contract, component=f"{study.component}.robot", origin=study.origin)


def synthesise_robot(study: Study, place: Place, sink: Sink, options: Options) -> Synthesis:
    """Synthesise the common controller of the robots; failures are reported."""
    return synthesise_controller(controller_contract(study), place, sink, options)


def build_answers(study: Study, synthesis: Synthesis) -> tuple[Answers, ...]:
    """Return the memoised answers for each robot, or an empty tuple without a controller."""
    if synthesis.machine is None:
        return ()
    return (Answers(synthesis.machine, ANY, study.grid),) * len(study.robots)


Times = Mapping[int, Mapping[int, int]]
"""For each target cell, the steps from every cell from which a robot reaches it."""


def measure_travel_times(study: Study, answers: Sequence[Answers]) -> Times:
    """Simulate a robot alone on the floor, and return its travel times between all cells."""
    cells = study.grid.cells if answers else ()
    return {cell: _measure_times_to(study, cell, answers[0]) for cell in cells}


def travel_times_of(study: Study, times: Times) -> TravelTimes:
    """Return the travel times of the robots between starts and targets.

    A robot that may start in several cells has the longest of their times.
    """
    journeys: dict[tuple[int, int, int], int] = {}
    for goal, target in enumerate(study.targets):
        steps_by_start = times.get(target.cell, {})
        for robot in range(len(study.robots)):
            starts_by_place = {START: possible_starts(study, robot)}
            starts_by_place |= {
                number: (other_target.cell,)
                for number, other_target in enumerate(study.targets)
                if number != goal
            }
            for place, cells in starts_by_place.items():
                steps = [steps_by_start[cell] for cell in cells if cell in steps_by_start]
                if steps and len(steps) == len(cells):
                    journeys[robot, place, goal] = max(steps)
    return TravelTimes(journeys, is_simulated=True)


def _measure_times_to(study: Study, cell: int, answers: Answers) -> dict[int, int]:
    """Return the steps to *cell* from every cell from which a robot reaches it."""
    # One simulation for all cells: each run has another start.
    target = Target("", "", cell)
    single_robot_study = replace(study, robots=(ANY,), targets=(target,), orders=(), deadline=None)
    cells = study.grid.cells
    run_sets = [0] * study.grid.size
    for number, start in enumerate(cells):
        run_sets[start] = 1 << number
    runs = RunSpace((1 << len(cells)) - 1, 0, (tuple(run_sets),), difference)
    world = World(single_robot_study, ((0,),), (answers,), runs)
    times: dict[int, int] = {}
    # Cells from which the target is unreachable never arrive.
    for time in range(1, 4 * study.grid.size):
        world.step()
        arrived = difference(world.done[0], world.wrong)
        times |= {
            start: time
            for number, start in enumerate(cells)
            if arrived >> number & 1 and start not in times
        }
        if len(times) == len(cells):
            break
    return times
