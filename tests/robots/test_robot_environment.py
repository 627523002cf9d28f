"""The simulated environment and the robots satisfy every conjunct of their contracts.

A run ends in a loop in which all robots rest, so that liveness is checked as well.
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
    """Return the variables in each step, and the index of the step where the loop starts."""
    cells = range(study.grid.size)
    start_planes = tuple(tuple(int(cell == position) for cell in cells) for position in start)
    recorder = world(study, allocation, answers, RunSpace(1, 0, start_planes, difference))
    assert Simulation(recorder).run() is None
    period = len(study.robots)
    assert recorder.trace[-1] == recorder.trace[-1 - period]
    return recorder.trace[:-1], len(recorder.trace) - 1 - period


def list_violated_texts(contract, trace, loop, is_guarantee=True):
    """Return the texts of the conjuncts that a run violates."""
    conjuncts = contract.guarantees if is_guarantee else contract.assumptions
    return [
        conjunct.text for conjunct in conjuncts if find_violation(conjunct, trace, loop) is not None
    ]


def list_starts(study, count=7):
    """Return some of the starts, at equal distances in the list of all."""
    starts = list(permutations(study.grid.cells, len(study.robots)))
    return starts[:: max(1, len(starts) // count)]


@pytest.mark.parametrize("seed", range(1, 10))
def test_complete_runs_satisfy_all_contracts(seed):
    study, allocation = random_floor(seed)
    answers = greedy_answers(study)
    for start in list_starts(study):
        trace, loop = record_run(study, allocation, answers, start)
        environment = environment_contract(study)
        assert list_violated_texts(environment, trace, loop) == []
        assert list_violated_texts(environment, trace, loop, is_guarantee=False) == []
        assert list_violated_texts(system_contract(study), trace, loop) == []
        for robot in study.robots:
            shared = robot_contract(study, robot, is_alone=False)
            assert list_violated_texts(shared, trace, loop, is_guarantee=False) == []
            assert list_violated_texts(shared, trace, loop) == []


def test_runs_of_the_synthesised_machine_satisfy_the_contracts():
    study = floor(3, None, None, targets=(0, 8, 4))
    controller = synthesise_robot(study, lambda origin: Subject(), Sink(), Options())
    trace, loop = record_run(study, ((0, 2), (1,)), build_answers(study, controller), (4, 5))
    assert list_violated_texts(environment_contract(study), trace, loop) == []
    contract = robot_contract(study, study.robots[0], is_alone=False)
    assert list_violated_texts(contract, trace, loop) == []


class SilentWorld(RecordingWorld):
    """An environment that offers nothing to robots at rest."""

    def _offer_in_turn(self, number, memory, runs):
        return runs


def test_an_environment_without_offers_at_rest_violates_its_contract():
    study = floor(3, None, None, targets=(0, 8))
    run = record_run(study, ((0,), (1,)), greedy_answers(study), (4, 5), SilentWorld)
    assert list_violated_texts(environment_contract(study), *run) == [
        "Again and again a way is offered to 'r0', if one is free.",
        "Again and again a way is offered to 'r1', if one is free.",
    ]


def test_two_robots_get_the_cell_between_them_in_turn():
    study = floor(3, None, None, rows=1, targets=(0, 2))
    trace, loop = record_run(study, ((0,), (1,)), greedy_answers(study), (0, 2))
    assert list_violated_texts(environment_contract(study), trace, loop) == []
    offers_to_first = [step["r0_sensor_right"] for step in trace[loop:]]
    offers_to_second = [step["r1_sensor_left"] for step in trace[loop:]]
    assert sorted(zip(offers_to_first, offers_to_second, strict=True)) == [
        (False, True),
        (True, False),
    ]


@pytest.mark.parametrize("start", [(1, 5), (4, 5), (2, 6), (8, 0), (5, 3)])
def test_a_path_is_too_long_exactly_if_the_timer_exceeds_the_bound(start):
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
    """Yield in each step for how long a robot has had its target."""
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
