"""The compiled environment and the robots keep their contracts: each conjunct, in whole runs.

A run ends in a loop in which all rest; so that what is to hold again and again is looked at, too.
"""

from itertools import permutations

import pytest
from greedy_machine import greedy_answers
from msgspec.structs import replace
from small_floors import floor
from test_robot_simulation import random_floor

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
        values = {}
        for number, (robot, body) in enumerate(zip(self.study.robots, self.bodies, strict=True)):
            (memory,) = [memory_state for memory_state, plane in body.memory.items() if plane]
            commands = [way for way, plane in body.commands.items() if plane]
            values[terms.position(robot)] = body.places.index(1)
            values[terms.target(robot)] = memory.goal
            values[terms.command(robot)] = commands[0] if commands else STAY
            values |= {terms.sensor(robot, way): (number, way) in self.offered for way in WAYS}
        return values | {
            terms.free(cell): not is_occupied for cell, is_occupied in enumerate(self.occupied)
        }


def record_run(study, allocation, answers, start, world=RecordingWorld):
    """What the variables are in each step, and the step to which the last one returns."""
    cells = range(study.grid.size)
    start_planes = tuple(tuple(int(cell == position) for cell in cells) for position in start)
    recorder = world(study, allocation, answers, RunSpace(1, 0, start_planes, difference))
    assert Simulation(recorder).run() is None
    period = len(study.robots)
    assert recorder.trace[-1] == recorder.trace[-1 - period]
    return recorder.trace[:-1], len(recorder.trace) - 1 - period


def list_violations(contract, trace, loop, is_promise=True):
    """The conjuncts that do not hold in a run."""
    conjuncts = contract.guarantees if is_promise else contract.assumptions
    return [
        conjunct.text for conjunct in conjuncts if find_violation(conjunct, trace, loop) is not None
    ]


def list_starts(study, count=7):
    """Some of the starts, far from one another."""
    starts = list(permutations(study.grid.cells, len(study.robots)))
    return starts[:: max(1, len(starts) // count)]


@pytest.mark.parametrize("seed", range(1, 10))
def test_all_contracts_are_kept_in_whole_runs(seed):
    study, allocation = random_floor(seed)
    answers = greedy_answers(study)
    for start in list_starts(study):
        trace, loop = record_run(study, allocation, answers, start)
        environment = environment_contract(study)
        assert list_violations(environment, trace, loop) == []
        assert list_violations(environment, trace, loop, is_promise=False) == []
        assert list_violations(system_contract(study), trace, loop) == []
        for robot in study.robots:
            shared = robot_contract(study, robot, is_alone=False)
            assert list_violations(shared, trace, loop, is_promise=False) == []
            assert list_violations(shared, trace, loop) == []


def test_the_synthesised_machine_keeps_them_as_well():
    study = floor(3, None, None, targets=(0, 8, 4))
    controller = synthesise_robot(study, lambda origin: Subject(), Sink(), Options())
    trace, loop = record_run(study, ((0, 2), (1,)), build_answers(study, controller), (4, 5))
    assert list_violations(environment_contract(study), trace, loop) == []
    assert (
        list_violations(robot_contract(study, study.robots[0], is_alone=False), trace, loop) == []
    )


class Silent(RecordingWorld):
    """An environment that offers nothing to robots at rest."""

    def _offer_in_turn(self, number, memory, runs):
        return runs


def test_without_a_turn_for_robots_at_rest_the_environment_breaks_its_promise():
    study = floor(3, None, None, targets=(0, 8))
    run = record_run(study, ((0,), (1,)), greedy_answers(study), (4, 5), Silent)
    assert list_violations(environment_contract(study), *run) == [
        "Again and again a way is offered to 'r0', if one is free.",
        "Again and again a way is offered to 'r1', if one is free.",
    ]


def test_two_robots_with_one_cell_between_them_have_it_in_turn():
    study = floor(3, None, None, rows=1, targets=(0, 2))
    trace, loop = record_run(study, ((0,), (1,)), greedy_answers(study), (0, 2))
    assert list_violations(environment_contract(study), trace, loop) == []
    rights = [step["r0_sensor_right"] for step in trace[loop:]]
    lefts = [step["r1_sensor_left"] for step in trace[loop:]]
    assert sorted(zip(rights, lefts, strict=True)) == [(False, True), (True, False)]


@pytest.mark.parametrize("start", [(1, 5), (4, 5), (2, 6), (8, 0), (5, 3)])
def test_ways_are_too_long_exactly_where_a_timer_of_the_system_says_so(start):
    study = floor(3, None, None, targets=(0, 8))
    answers = greedy_answers(study)
    trace, _ = record_run(study, ((0,), (1,)), answers, start)
    longest = max(iter_timers(study, trace))
    assert longest > 1
    for within, is_slow in ((longest, False), (longest - 1, True)):
        bounded = replace(study, within=within)
        world = World(bounded, ((0,), (1,)), answers, place_robots(study, start))
        failure = Simulation(world).run()
        assert (failure is not None and failure.is_slow) is is_slow


def iter_timers(study, trace):
    """How long robots have had their targets, in each step."""
    for robot in study.robots:
        timer = 0
        for step in trace:
            yield timer
            is_home = step[terms.position(robot)] == step[terms.target(robot)]
            timer = 0 if is_home else timer + 1


def place_robots(study, start):
    cells = range(study.grid.size)
    return RunSpace(
        1,
        0,
        tuple(tuple(int(cell == position) for cell in cells) for position in start),
        difference,
    )
