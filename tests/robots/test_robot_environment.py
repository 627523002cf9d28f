"""The compiled environment and the robots keep their contracts: each conjunct, in whole runs.

A run ends in a loop in which all rest; so that what is to hold again and again is looked at, too.
"""

from itertools import permutations

import pytest
from greedy_machine import greedy_answers
from msgspec.structs import replace
from small_floors import floor
from test_robot_simulation import some_floor

from sysmlc.diagnostics import Sink, Subject
from sysmlc.logic.evaluate import find_violation
from sysmlc.robots import contract_terms as terms
from sysmlc.robots.environment_contract import environment_contract
from sysmlc.robots.robot_contract import robot_contract
from sysmlc.robots.robot_controller import build_answers, synthesise_robot
from sysmlc.robots.run_sets import RunSpace, difference
from sysmlc.robots.study import STAY, WAYS
from sysmlc.robots.system_contract import system_contract
from sysmlc.robots.validation import Simulation
from sysmlc.robots.world import World
from sysmlc.synthesis.decision import Options


class RecordingWorld(World):
    """A world of one run that records the contracts' variables in every step."""

    def _answer_all(self):
        self.offered = set()
        super()._answer_all()
        self.trace = [*getattr(self, "trace", ()), self.read_variables()]

    def _offer_and_answer(self, number, memory, goal, move, runs):
        if runs:
            self.offered.add((number, move[0]))
        super()._offer_and_answer(number, memory, goal, move, runs)

    def read_variables(self):
        found = {}
        for number, (robot, body) in enumerate(zip(self.study.robots, self.bodies, strict=True)):
            (memory,) = [one for one, plane in body.memory.items() if plane]
            commands = [way for way, plane in body.commands.items() if plane]
            found[terms.position(robot)] = body.places.index(1)
            found[terms.target(robot)] = memory.goal
            found[terms.command(robot)] = commands[0] if commands else STAY
            found |= {terms.sensor(robot, way): (number, way) in self.offered for way in WAYS}
        return found | {terms.free(cell): not one for cell, one in enumerate(self.occupied)}


def run_of(study, allocation, answers, start, world=RecordingWorld):
    """What the variables are in each step, and the step to which the last one returns."""
    cells = range(study.grid.size)
    placed = tuple(tuple(int(cell == one) for cell in cells) for one in start)
    made = world(study, allocation, answers, RunSpace(1, 0, placed, difference))
    assert Simulation(made).run() is None
    period = len(study.robots)
    assert made.trace[-1] == made.trace[-1 - period]
    return made.trace[:-1], len(made.trace) - 1 - period


def broken(contract, trace, loop, is_promise=True):
    """The conjuncts that do not hold in a run."""
    known = contract.guarantees if is_promise else contract.assumptions
    return [one.text for one in known if find_violation(one, trace, loop) is not None]


def starts_of(study, count=7):
    """Some of the starts, far from one another."""
    known = list(permutations(study.grid.cells, len(study.robots)))
    return known[:: max(1, len(known) // count)]


@pytest.mark.parametrize("seed", range(1, 10))
def test_all_contracts_are_kept_in_whole_runs(seed):
    study, allocation = some_floor(seed)
    answers = greedy_answers(study)
    for start in starts_of(study):
        trace, loop = run_of(study, allocation, answers, start)
        environment = environment_contract(study)
        assert broken(environment, trace, loop) == []
        assert broken(environment, trace, loop, is_promise=False) == []
        assert broken(system_contract(study), trace, loop) == []
        for robot in study.robots:
            shared = robot_contract(study, robot, is_alone=False)
            assert broken(shared, trace, loop, is_promise=False) == []
            assert broken(shared, trace, loop) == []


def test_the_synthesised_machine_keeps_them_as_well():
    study = floor(3, None, None, targets=(0, 8, 4))
    made = synthesise_robot(study, lambda origin: Subject(), Sink(), Options())
    trace, loop = run_of(study, ((0, 2), (1,)), build_answers(study, made), (4, 5))
    assert broken(environment_contract(study), trace, loop) == []
    assert broken(robot_contract(study, study.robots[0], is_alone=False), trace, loop) == []


class Silent(RecordingWorld):
    """An environment that offers nothing to robots at rest."""

    def _offer_in_turn(self, number, memory, runs):
        return runs


def test_without_a_turn_for_robots_at_rest_the_environment_breaks_its_promise():
    study = floor(3, None, None, targets=(0, 8))
    run = run_of(study, ((0,), (1,)), greedy_answers(study), (4, 5), Silent)
    assert broken(environment_contract(study), *run) == [
        "Again and again a way is offered to 'r0', if one is free.",
        "Again and again a way is offered to 'r1', if one is free.",
    ]


def test_two_robots_with_one_cell_between_them_have_it_in_turn():
    study = floor(3, None, None, rows=1, targets=(0, 2))
    trace, loop = run_of(study, ((0,), (1,)), greedy_answers(study), (0, 2))
    assert broken(environment_contract(study), trace, loop) == []
    rights = [one["r0_sensor_right"] for one in trace[loop:]]
    lefts = [one["r1_sensor_left"] for one in trace[loop:]]
    assert sorted(zip(rights, lefts, strict=True)) == [(False, True), (True, False)]


@pytest.mark.parametrize("start", [(1, 5), (4, 5), (2, 6), (8, 0), (5, 3)])
def test_ways_are_too_long_exactly_where_a_timer_of_the_system_says_so(start):
    study = floor(3, None, None, targets=(0, 8))
    answers = greedy_answers(study)
    trace, _ = run_of(study, ((0,), (1,)), answers, start)
    longest = max(timers(study, trace))
    assert longest > 1
    for within, is_slow in ((longest, False), (longest - 1, True)):
        bounded = replace(study, within=within)
        world = World(bounded, ((0,), (1,)), answers, placed(study, start))
        failure = Simulation(world).run()
        assert (failure is not None and failure.is_slow) is is_slow


def timers(study, trace):
    """How long robots have had their targets, in each step."""
    for robot in study.robots:
        timer = 0
        for one in trace:
            yield timer
            is_home = one[terms.position(robot)] == one[terms.target(robot)]
            timer = 0 if is_home else timer + 1


def placed(study, start):
    cells = range(study.grid.size)
    return RunSpace(
        1, 0, tuple(tuple(int(cell == one) for cell in cells) for one in start), difference
    )
