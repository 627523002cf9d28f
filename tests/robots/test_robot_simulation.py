"""Simulation of many runs at once: each run equals a plain simulation from its start."""

import random
from itertools import permutations

import pytest
from greedy_machine import greedy_answers
from msgspec.structs import replace
from plain_world import PlainWorld
from small_floors import floor

from sysmlc.robots import validation as validation_module
from sysmlc.robots.merging import StateSet
from sysmlc.robots.run_sets import digit_patterns, starts_without_collision
from sysmlc.robots.validation import (
    Simulation,
    iter_start_chunks,
    symbolic_starts,
    validate_allocation,
    validate_symbolically,
)
from sysmlc.robots.world import World

STEPS = 60


def random_floor(seed):
    """Return a floor with two or three robots, and an allocation of its targets in turn."""
    generator = random.Random(seed)
    side, rows, robots = generator.choice([(3, 3, 2), (3, 2, 2), (3, 3, 3), (4, 2, 3)])
    cells = list(range(side * rows))
    blocked = (4,) if generator.random() < 0.3 and rows == 3 else ()
    targets = generator.sample(
        [target for target in cells if target not in blocked], generator.randint(2, 4)
    )
    orders = [(0, 1)] if generator.random() < 0.5 else []
    study = floor(
        side, *(None,) * robots, targets=targets, orders=orders, blocked=blocked, rows=rows
    )
    numbers = range(len(targets))
    return study, tuple(
        tuple(target for target in numbers if target % robots == robot) for robot in range(robots)
    )


@pytest.mark.parametrize("seed", range(12))
def test_every_run_equals_the_plain_simulation(seed):
    study, allocation = random_floor(seed)
    answers = greedy_answers(study)
    (runs,) = iter_start_chunks(study)
    world = World(study, allocation, answers, runs)
    starts = list(permutations(study.grid.cells, len(study.robots)))
    plain_worlds = {start: PlainWorld(study, allocation, start) for start in starts}
    bits = {start: _bit(runs, start) for start in starts}
    assert runs.all.bit_count() == len(starts)
    for _ in range(STEPS):
        world.step()
        for start, plain_world in plain_worlds.items():
            plain_world.step()
            assert plain_world.read_state() == _read_state(world, bits[start])
    assert world.wrong == 0


def _bit(runs, start):
    bit = runs.all
    for robot, cell in zip(runs.starts, start, strict=True):
        bit &= robot[cell]
    assert bit.bit_count() == 1
    return bit


def _read_state(world, bit):
    cells = tuple(
        next(cell for cell, runs_at in enumerate(body.places) if runs_at & bit)
        for body in world.bodies
    )
    return cells, frozenset(target for target, runs_at in enumerate(world.done) if runs_at & bit)


@pytest.mark.parametrize("seed", range(6))
def test_decision_diagrams_give_the_same_validation(seed):
    study, allocation = random_floor(seed)
    answers = greedy_answers(study)
    assert validate_symbolically(study, allocation, answers) == validate_allocation(
        study, allocation, answers
    )


def test_starts_are_all_placements_of_robots_in_different_cells():
    starts = digit_patterns((3, 3))
    assert [f"{pattern:09b}" for pattern in starts[0]] == ["001001001", "010010010", "100100100"]
    assert [f"{pattern:09b}" for pattern in starts[1]] == ["000000111", "000111000", "111000000"]
    assert starts_without_collision(starts, (1 << 9) - 1).bit_count() == 6
    runs, count = symbolic_starts(floor(3, None, 4, None))
    assert count == 8 * 7
    assert runs.starts[1][3] == runs.none


def test_only_robots_without_a_start_have_several():
    (runs,) = iter_start_chunks(floor(3, 0, None))
    assert runs.all.bit_count() == 8
    (runs,) = iter_start_chunks(floor(3, 0, 1))
    assert runs.all.bit_count() == 1


def test_simulation_in_chunks_gives_the_same_validation(monkeypatch):
    study, allocation = random_floor(3)
    unmerged = validate_allocation(study, allocation, greedy_answers(study))
    monkeypatch.setattr(validation_module, "MAX_CHUNK_RUNS", 16)
    assert validate_allocation(study, allocation, greedy_answers(study)) == unmerged


def merge_early(monkeypatch, steps, max_runs=1 << 17):
    """Merge equal states from step *steps* on, with at most *most* runs at once."""
    monkeypatch.setattr(validation_module, "FIRST_MERGE_STEP", steps)
    monkeypatch.setattr(validation_module, "MIN_MERGED_STARTS", 0)
    monkeypatch.setattr(validation_module, "MAX_CHUNK_RUNS", max_runs)


@pytest.mark.parametrize("seed", range(12))
def test_merging_equal_states_does_not_change_the_result(seed, monkeypatch):
    study, allocation = random_floor(seed)
    answers = greedy_answers(study)
    unmerged = validate_allocation(study, allocation, answers)
    for steps, max_runs in ((1, 1 << 17), (3, 1 << 17), (2, 40), (5, 16)):
        merge_early(monkeypatch, steps, max_runs)
        validation = validate_allocation(study, allocation, answers)
        if unmerged.is_good:
            assert validation == unmerged
        else:
            assert (validation.is_good, validation.steps, validation.late) == (
                False,
                unmerged.steps,
                unmerged.late,
            )


def test_many_runs_have_the_same_state():
    study, allocation = random_floor(3)
    (runs,) = iter_start_chunks(study)
    world = World(study, allocation, greedy_answers(study), runs)
    assert Simulation(world).run(until=6) is None
    states = StateSet(len(study.robots))
    states.add(world, range(runs.all.bit_length()))
    assert 1 < len(states) < runs.all.bit_count() / 2
    (batch,) = states.batches(1 << 17, world)
    restored = World(study, allocation, greedy_answers(study), batch.runs, batch.state, 6)
    for bit, origin in enumerate(batch.origins):
        assert _read_state(restored, 1 << bit) == _read_state(world, 1 << origin)


@pytest.mark.parametrize("deadline", [7, 9, 11, 13])
def test_a_failing_state_leads_back_to_a_start_that_fails(deadline, monkeypatch):
    study = floor(3, None, None, None, targets=(0, 8, 4, 2), deadline=deadline)
    allocation = ((0, 3), (1,), (2,))
    answers = greedy_answers(study)
    merge_early(monkeypatch, 2, 50)
    validation = validate_allocation(study, allocation, answers)
    assert validation.late is not None
    robots = zip(study.robots, validation.failed, strict=True)
    placed = replace(study, robots=tuple(replace(robot, start=cell) for robot, cell in robots))
    revalidation = validate_allocation(placed, allocation, answers)
    assert (revalidation.failed, revalidation.late, revalidation.steps) == (
        validation.failed,
        validation.late,
        deadline,
    )


def test_robots_that_cannot_pass_one_another_fail_with_a_start():
    study = floor(3, None, None, rows=1, targets=(0, 2), deadline=30)
    validation = validate_allocation(study, ((0,), (1,)), greedy_answers(study))
    assert not validation.is_good
    first, second = validation.failed
    assert first > second


def test_a_deadline_that_is_too_short_names_the_target_that_is_late():
    study = floor(3, 0, targets=(8,), deadline=5)
    validation = validate_allocation(study, ((0,),), greedy_answers(study))
    assert (validation.is_good, validation.late, validation.steps) == (False, 0, 5)
    study = floor(3, 0, targets=(8,), deadline=6)
    assert validate_allocation(study, ((0,),), greedy_answers(study)).is_good
