"""Derived minimum and maximum enclose the times that the interpreter measures."""

from random import Random

import pytest
from random_tasks import TaskGraph, derive_task, iter_executions

from long_runs import quick_first

GRAPHS = 20
"""Task graphs of one test; all tests together have 1,000."""


@pytest.mark.parametrize("batch", quick_first(range(1000 // GRAPHS)))
def test_derived_times_and_runs_enclose_those_of_random_executions(batch):
    for number in range(batch * GRAPHS, (batch + 1) * GRAPHS):
        dice = Random(number)
        graph = TaskGraph(dice)
        derived = derive_task(graph).derived
        assert derived.duration.max is not None, number
        runs = {sub_task.node.rpartition("::")[2]: sub_task.runs for sub_task in derived.sub_tasks}
        for execution in iter_executions(graph, dice, 10):
            assert derived.duration.min <= execution.clock <= derived.duration.max, number
            for service, count in execution.runs.items():
                assert runs[service].min <= count <= runs[service].max, (number, service)
