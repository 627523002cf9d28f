"""Who reaches which target: orders and 'same robot' are kept, the best is no worse than others."""

from itertools import permutations, product

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from small_floors import floor

from long_runs import examples
from sysmlc.robots.allocation import (
    allocate_greedily,
    allocate_optimally,
    neighbour_allocations,
    sort_targets,
)
from sysmlc.robots.schedule import START, build_schedule, respects_orders, shortest_travel_times


@st.composite
def missions(draw, most=4):
    """Floors of nine cells with targets, an order without circles, some of them carried."""
    count = draw(st.integers(1, most))
    targets = draw(st.permutations(range(9)))[:count]
    starts = draw(st.permutations(range(9)))[: draw(st.integers(1, 3))]
    pairs = [(one, other) for one in range(count) for other in range(one + 1, count)]
    chosen = draw(st.lists(st.sampled_from(pairs), unique=True, max_size=3)) if pairs else []
    orders, ends = [], set()
    for one, other in chosen:
        is_carried = draw(st.booleans()) and not ({("from", one), ("to", other)} & ends)
        if is_carried:
            ends |= {("from", one), ("to", other)}
        orders.append((one, other, is_carried))
    return floor(3, *starts, targets=targets, orders=orders)


def every_allocation(study):
    """All lists of targets for all robots."""
    count, robots = len(study.targets), len(study.robots)
    for owners in product(range(robots), repeat=count):
        for order in permutations(range(count)):
            yield tuple(tuple(t for t in order if owners[t] == r) for r in range(robots))


@settings(max_examples=examples(60), deadline=None)
@given(missions())
def test_the_best_is_the_best_of_all(study):
    travel = shortest_travel_times(study)
    made = [build_schedule(study, travel, one) for one in set(every_allocation(study))]
    costs = [one.cost for one in made if one is not None]
    found = allocate_optimally(study, travel)
    assert (found is not None) == bool(costs)
    if found is not None:
        assert found.is_proven
        assert found.schedule.cost == min(costs)


@settings(max_examples=examples(100), deadline=None)
@given(missions(most=7))
def test_orders_and_carrying_are_kept_and_the_best_is_no_worse(study):
    travel = shortest_travel_times(study)
    first, found = (
        allocate_greedily(study, travel),
        allocate_optimally(study, travel, max_nodes=300),
    )
    for schedule in (one for one in (first, found and found.schedule) if one):
        assert respects_orders(study, schedule.allocation)
        for order in study.orders:
            assert schedule.reached[order.earlier] < schedule.reached[order.later]
        owner = {t: r for r, own in enumerate(schedule.allocation) for t in own}
        assert all(owner[one] == owner[other] for one, other in study.carried_targets.items())
    if first is not None:
        assert found is not None
        assert found.schedule.cost <= first.cost


def test_what_is_near_an_allocation_is_done_in_order_too():
    study = floor(3, 0, 8, targets=(1, 2, 3, 4), orders=[(0, 1, True), (2, 3)])
    travel = shortest_travel_times(study)
    found = list(neighbour_allocations(study, travel, allocate_optimally(study, travel).schedule))
    assert found
    assert all(respects_orders(study, one.allocation) for one in found)


def test_costs_are_counted_once_and_robots_go_on_from_where_they_are():
    """As it is printed, paths begin at starts: the second robot would get the second target."""
    study = floor(4, 0, 15, targets=(1, 2, 3), rows=4)
    assert allocate_greedily(study, shortest_travel_times(study)).allocation == ((0, 1), (2,))
    line = floor(9, 0, 8, targets=(2, 3), rows=1)
    assert allocate_greedily(line, shortest_travel_times(line)).reached == (4, 7)


def test_costs_do_not_double_with_each_target():
    """With line 10 as it is printed the third target would go to the robot that is far away."""
    line = floor(12, 0, 11, targets=(1, 2, 3), rows=1)
    assert allocate_greedily(line, shortest_travel_times(line)).allocation == ((0, 1, 2), ())


def test_what_is_carried_stays_with_its_robot_though_another_one_is_nearer():
    line = floor(9, 0, 8, targets=(1, 7), orders=[(0, 1, True)], rows=1)
    assert allocate_greedily(line, shortest_travel_times(line)).allocation == ((0, 1), ())


def test_travel_times_are_those_of_shortest_ways_and_a_reaction():
    study = floor(3, 0, None, targets=(8, 0), blocked=(1, 4))
    travel = shortest_travel_times(study)
    assert travel.get(0, START, 0) == 4 + 2
    assert travel.get(0, START, 1) == 1
    assert travel.get(1, START, 1) == 8 - 2 + 2
    assert travel.get(0, 0, 0) is None


def test_targets_are_taken_in_an_order_that_keeps_theirs():
    study = floor(3, 0, targets=(1, 2, 3), orders=[(2, 0), (0, 1, True)])
    assert list(sort_targets(study)) == [2, 0, 1]


@pytest.mark.parametrize("allocation", [((0, 1), ()), ((1, 0), (2,)), ((0, 1), (2, 2))])
def test_an_allocation_that_misses_or_repeats_a_target_is_none(allocation):
    study = floor(3, 0, 8, targets=(1, 2, 3), orders=[(0, 1, True)])
    assert build_schedule(study, shortest_travel_times(study), allocation) is None
