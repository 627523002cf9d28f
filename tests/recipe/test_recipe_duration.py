"""The time of a recipe encloses the times of its executions, which share machines."""

from itertools import permutations
from random import Random

import pytest

from sysmlc.recipe.model import Derived, Mode, Range, Recipe, SameMachine, SubTask, Task
from sysmlc.recipe.recipe_times import derive_recipe


def make_task(name, machine, time, *, longest=None):
    """Return a task with one service on one machine."""
    mode = Mode((machine,), time)
    derived = Derived(
        (SubTask(f"{name}::s", (mode,), runs=Range(1, 1)),),
        duration=Range(time, time if longest is None else longest),
    )
    return Task(name, equipment=(Mode((machine,)),), derived=derived)


def find_time(tasks, *precedence):
    duration = derive_recipe(Recipe("R", tuple(tasks), precedence)).duration
    return duration.min, duration.max


DRILL_A, DRILL_B = make_task("a", "drill", 4), make_task("b", "drill", 4)
BAKE = make_task("c", "oven", 50)
PREPARE = make_task("p", "robot", 10)


def test_tasks_on_different_machines_run_at_the_same_time():
    assert find_time([DRILL_A, DRILL_B, BAKE]) == (50, 50)


def test_tasks_on_one_machine_follow_one_another():
    assert find_time([DRILL_A, DRILL_B]) == (8, 8)


def test_tasks_before_others_do_not_add_up_what_runs_at_the_same_time():
    before = [("p", name) for name in "abc"]
    assert find_time([PREPARE, DRILL_A, DRILL_B, BAKE], *before) == (60, 60)


def test_ordered_tasks_on_one_machine_do_not_wait_for_one_another():
    assert find_time([DRILL_A, DRILL_B], ("a", "b")) == (8, 8)


def test_the_order_decides_if_one_of_two_tasks_has_a_successor():
    assert find_time([DRILL_A, DRILL_B, BAKE], ("a", "c")) == (54, 58)


def test_a_task_that_waits_with_a_machine_lets_others_wait_longer():
    held = make_task("h", "drill", 4)
    groups = (SameMachine(("h::s",), ("gripper",)),)
    derived = Derived(held.derived.sub_tasks, groups, held.derived.duration)
    both = Task("h", equipment=(Mode(("drill", "oven")),), derived=derived)
    assert find_time([DRILL_A, both, BAKE]) == (50, 58)


def list_schedule(tasks, precedence, order):
    """Return the makespan if tasks start in this order of preference, as soon as they can."""
    ends, free, clock = {}, {}, 0
    while len(ends) < len(tasks):
        for task in order:
            machine = task.equipment[0].machines[0]
            before = [ends.get(a, clock + 1) for a, b in precedence if b == task.id]
            is_ready = task.id not in ends and all(end <= clock for end in before)
            if is_ready and free.get(machine, 0) <= clock:
                ends[task.id] = free[machine] = clock + task.derived.duration.min
        clock += 1
    return max(ends.values())


@pytest.mark.parametrize("seed", range(150))
def test_the_times_of_all_orders_lie_between_minimum_and_maximum(seed):
    dice = Random(seed)
    tasks = [
        make_task(name, f"m{dice.randint(1, 3)}", dice.randint(1, 9))
        for name in "abcde"[: dice.randint(2, 5)]
    ]
    precedence = [
        (first.id, second.id)
        for number, first in enumerate(tasks)
        for second in tasks[number + 1 :]
        if dice.random() < 0.3
    ]
    low, high = find_time(tasks, *precedence)
    spans = {list_schedule(tasks, precedence, order) for order in permutations(tasks)}
    assert low <= min(spans) <= max(spans) <= high
