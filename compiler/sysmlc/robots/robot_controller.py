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
from sysmlc.synthesis.controller_synthesis import Synthesis, synthesised
from sysmlc.synthesis.decision import Options, Place

ANY = Robot("robot", "robot")
"""A robot that stands for all: they differ in names and starts, which no machine depends on."""


def controller_contract(study: Study) -> Contract:
    """What the machine keeps: the contract of a robot among others, from any start.

    Step counters are left to the simulation: as states of the machine they would multiply them.
    """
    alone = replace(study, robots=(ANY,), counted=0)
    made = robot_contract(alone, ANY, is_alone=False)
    return replace(made, component=f"{study.component}.robot", origin=study.origin)


def synthesise(study: Study, place: Place, sink: Sink, options: Options) -> Synthesis:
    """Make the machine; what fails is reported."""
    return synthesised(controller_contract(study), place, sink, options)


def answers_of(study: Study, made: Synthesis) -> tuple[Answers, ...]:
    """The answers of all robots; nothing without a machine."""
    if made.machine is None:
        return ()
    return (Answers(made.machine, ANY, study.grid),) * len(study.robots)


Times = Mapping[int, Mapping[int, int]]
"""By target cell the steps from each other cell from which a robot gets there."""


def measured(study: Study, answers: Sequence[Answers]) -> Times:
    """How long a robot with nobody else on the floor travels from any cell to any other."""
    cells = study.grid.cells if answers else ()
    return {cell: _times(study, cell, answers[0]) for cell in cells}


def travels(study: Study, times: Times) -> TravelTimes:
    """The steps that robots travel between their starts and targets."""
    found: dict[tuple[int, int, int], int] = {}
    for goal, target in enumerate(study.targets):
        known = times.get(target.cell, {})
        for robot in range(len(study.robots)):
            places = {START: possible_starts(study, robot)}
            places |= {at: (one.cell,) for at, one in enumerate(study.targets) if at != goal}
            for place, cells in places.items():
                steps = [known[cell] for cell in cells if cell in known]
                if steps and len(steps) == len(cells):
                    found[robot, place, goal] = max(steps)
    return TravelTimes(found, is_simulated=True)


def simulated(study: Study, answers: Sequence[Answers]) -> TravelTimes:
    """The same, measured now."""
    return travels(study, measured(study, answers))


def _times(study: Study, cell: int, answers: Answers) -> dict[int, int]:
    """The steps to a cell from each other one from which a robot gets there."""
    target = Target("", "", cell)
    alone = replace(study, robots=(ANY,), targets=(target,), orders=(), deadline=None)
    cells = study.grid.cells
    starts = [0] * study.grid.size
    for at, start in enumerate(cells):
        starts[start] = 1 << at
    runs = RunSpace((1 << len(cells)) - 1, 0, (tuple(starts),), difference)
    world = World(alone, ((0,),), (answers,), runs)
    found: dict[int, int] = {}
    for time in range(1, 4 * study.grid.size):
        world.step()
        arrived = difference(world.done[0], world.wrong)
        found |= {
            start: time
            for at, start in enumerate(cells)
            if arrived >> at & 1 and start not in found
        }
        if len(found) == len(cells):
            break
    return found
