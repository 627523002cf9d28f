"""How long a robot has a target before it is there: what C_S bounds with ``within``."""

from sysmlc.robots.answers import Answers, Memory
from sysmlc.robots.paths import hop
from sysmlc.robots.study import Grid


def is_slow(grid: Grid, answers: Answers, cell: int, goal: int, within: int) -> bool:
    """Whether a robot that is given a target has it for more steps than that.

    It is not stopped on its way (``traffic``), so that the steps are those of one that is alone.
    """
    known = Memory(cell, cell)
    for _ in range(within + 1):
        step = hop(grid, known.cell, goal)
        if step is None:
            return known.cell != goal
        answer = answers.get(known, goal, step[0])
        if answer is None:
            return False
        known = answer.memory
    return True
