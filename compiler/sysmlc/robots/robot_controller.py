"""The controller of the robots: one machine, synthesised from their contract, for all of them."""

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
"""A robot that represents all: controllers do not depend on names and starts."""


def controller_contract(study: Study) -> Contract:
    """Return the contract of the controller: a robot among others, from any start.

    Step counters are left to the simulation, because as states of the machine they would multiply
    them.
    """
    single_robot_study = replace(study, robots=(ANY,), counter_size=0)
    contract = robot_contract(single_robot_study, ANY, is_alone=False)
    return replace(contract, component=f"{study.component}.robot", origin=study.origin)


def synthesise_robot(study: Study, place: Place, sink: Sink, options: Options) -> Synthesis:
    """Synthesise the controller; failures are reported."""
    return synthesise_controller(controller_contract(study), place, sink, options)


def build_answers(study: Study, synthesis: Synthesis) -> tuple[Answers, ...]:
    """Return the answers of all robots, or nothing without a controller."""
    if synthesis.machine is None:
        return ()
    return (Answers(synthesis.machine, ANY, study.grid),) * len(study.robots)


Times = Mapping[int, Mapping[int, int]]
"""By target cell, the steps from each other cell from which a robot reaches it."""


def measure_travel_times(study: Study, answers: Sequence[Answers]) -> Times:
    """Measure how long a robot that is alone on the floor travels between all cells."""
    cells = study.grid.cells if answers else ()
    return {cell: _measure_times_to(study, cell, answers[0]) for cell in cells}


def travel_times_of(study: Study, times: Times) -> TravelTimes:
    """Return the travel times of the robots between their starts and targets."""
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


def simulate_travel_times(study: Study, answers: Sequence[Answers]) -> TravelTimes:
    """Measure the travel times between starts and targets."""
    return travel_times_of(study, measure_travel_times(study, answers))


def _measure_times_to(study: Study, cell: int, answers: Answers) -> dict[int, int]:
    """Return the steps to a cell from each other cell from which a robot reaches it."""
    target = Target("", "", cell)
    single_robot_study = replace(study, robots=(ANY,), targets=(target,), orders=(), deadline=None)
    cells = study.grid.cells
    run_sets = [0] * study.grid.size
    for number, start in enumerate(cells):
        run_sets[start] = 1 << number
    runs = RunSpace((1 << len(cells)) - 1, 0, (tuple(run_sets),), difference)
    world = World(single_robot_study, ((0,),), (answers,), runs)
    times: dict[int, int] = {}
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
