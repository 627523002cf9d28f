"""Allocations of targets to robots: they respect orders, and the optimal one is the best."""

from itertools import permutations, product

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from small_floors import floor

from long_runs import examples
from sysmlc.robots.allocation import (
    allocate_as_printed,
    allocate_greedily,
    allocate_optimally,
    neighbour_allocations,
    sort_targets,
)
from sysmlc.robots.schedule import START, build_schedule, respects_orders, shortest_travel_times


@st.composite
def missions(draw, max_targets=4):
    """Floors of nine cells with targets, with acyclic orders, some of which carry an item."""
    count = draw(st.integers(1, max_targets))
    targets = draw(st.permutations(range(9)))[:count]
    starts = draw(st.permutations(range(9)))[: draw(st.integers(1, 3))]
    pairs = [(earlier, later) for earlier in range(count) for later in range(earlier + 1, count)]
    chosen = draw(st.lists(st.sampled_from(pairs), unique=True, max_size=3)) if pairs else []
    orders, ends = [], set()
    for earlier, later in chosen:
        is_carried = draw(st.booleans()) and not ({("from", earlier), ("to", later)} & ends)
        if is_carried:
            ends |= {("from", earlier), ("to", later)}
        orders.append((earlier, later, is_carried))
    return floor(3, *starts, targets=targets, orders=orders)


def iter_allocations(study):
    """Yield all assignments of ordered targets to robots."""
    count, robots = len(study.targets), len(study.robots)
    for owners in product(range(robots), repeat=count):
        for order in permutations(range(count)):
            yield tuple(
                tuple(target for target in order if owners[target] == robot)
                for robot in range(robots)
            )


@settings(max_examples=examples(60), deadline=None)
@given(missions())
def test_the_optimal_allocation_has_the_lowest_cost_of_all(study):
    travel = shortest_travel_times(study)
    schedules = [
        build_schedule(study, travel, allocation) for allocation in set(iter_allocations(study))
    ]
    costs = [schedule.cost for schedule in schedules if schedule is not None]
    optimum = allocate_optimally(study, travel)
    assert (optimum is not None) == bool(costs)
    if optimum is not None:
        assert optimum.is_proven
        assert optimum.schedule.cost == min(costs)


@settings(max_examples=examples(100), deadline=None)
@given(missions(max_targets=7))
def test_allocations_respect_orders_and_the_optimum_is_no_worse_than_the_greedy_one(study):
    travel = shortest_travel_times(study)
    first, optimum = (
        allocate_greedily(study, travel),
        allocate_optimally(study, travel, max_nodes=300),
    )
    for schedule in filter(None, (first, optimum and optimum.schedule)):
        assert respects_orders(study, schedule.allocation)
        for order in study.orders:
            assert schedule.reached[order.earlier] < schedule.reached[order.later]
        owner = {
            target: robot for robot, targets in enumerate(schedule.allocation) for target in targets
        }
        assert all(
            owner[earlier] == owner[later] for earlier, later in study.carried_targets.items()
        )
    if first is not None:
        assert optimum is not None
        assert optimum.schedule.cost <= first.cost


def test_neighbours_of_an_allocation_respect_orders():
    study = floor(3, 0, 8, targets=(1, 2, 3, 4), orders=[(0, 1, True), (2, 3)])
    travel = shortest_travel_times(study)
    optimum = allocate_optimally(study, travel).schedule
    neighbours = list(neighbour_allocations(study, travel, optimum))
    assert neighbours
    assert all(respects_orders(study, schedule.allocation) for schedule in neighbours)


def test_paths_start_where_the_robot_is_after_its_last_target():
    """In the printed algorithm paths begin at starts, so the second robot would get target 1."""
    study = floor(4, 0, 15, targets=(1, 2, 3), rows=4)
    assert allocate_greedily(study, shortest_travel_times(study)).allocation == ((0, 1), (2,))
    corridor = floor(9, 0, 8, targets=(2, 3), rows=1)
    assert allocate_greedily(corridor, shortest_travel_times(corridor)).reached == (4, 7)


def test_costs_of_earlier_targets_count_once():
    """With line 10 of the printed algorithm, the distant robot would get the third target."""
    corridor = floor(12, 0, 11, targets=(1, 2, 3), rows=1)
    allocation = allocate_greedily(corridor, shortest_travel_times(corridor)).allocation
    assert allocation == ((0, 1, 2), ())


def test_a_carried_item_stays_with_its_robot_even_if_another_is_nearer():
    corridor = floor(9, 0, 8, targets=(1, 7), orders=[(0, 1, True)], rows=1)
    assert allocate_greedily(corridor, shortest_travel_times(corridor)).allocation == ((0, 1), ())


def test_travel_times_are_those_of_shortest_paths_and_a_reaction():
    study = floor(3, 0, None, targets=(8, 0), blocked=(1, 4))
    travel = shortest_travel_times(study)
    assert travel.get(0, START, 0) == 4 + 2
    assert travel.get(0, START, 1) == 1
    assert travel.get(1, START, 1) == 8 - 2 + 2
    assert travel.get(0, 0, 0) is None


def test_targets_are_sorted_by_their_orders():
    study = floor(3, 0, targets=(1, 2, 3), orders=[(2, 0), (0, 1, True)])
    assert list(sort_targets(study)) == [2, 0, 1]


@pytest.mark.parametrize("allocation", [((0, 1), ()), ((1, 0), (2,)), ((0, 1), (2, 2))])
def test_an_allocation_that_misses_or_repeats_a_target_has_no_schedule(allocation):
    study = floor(3, 0, 8, targets=(1, 2, 3), orders=[(0, 1, True)])
    assert build_schedule(study, shortest_travel_times(study), allocation) is None


def test_algorithm_1_as_printed_doubles_costs_and_starts_every_path_at_the_robot():
    """On six cells in a row r0 should take t3 too, but its printed costs are too high."""
    study = floor(6, 0, 5, targets=(0, 2, 1, 3), rows=1)
    travel = shortest_travel_times(study)
    assert allocate_greedily(study, travel).allocation == ((0, 1, 3), (2,))
    printed_schedule = allocate_as_printed(study, travel)
    assert printed_schedule.allocation == ((0, 1), (2, 3))
    assert printed_schedule.duration > allocate_greedily(study, travel).duration


@settings(max_examples=examples(100), deadline=None)
@given(missions(max_targets=7))
def test_algorithm_1_as_printed_gives_a_possible_allocation_or_none(study):
    schedule = allocate_as_printed(study, shortest_travel_times(study))
    assert schedule is None or respects_orders(study, schedule.allocation)
