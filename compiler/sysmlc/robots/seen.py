"""What follows from the positions of robots: free cells, and what sensors show."""

from collections.abc import Iterator
from itertools import combinations

from sysmlc.logic import formula as f
from sysmlc.logic.contract import Conjunct
from sysmlc.robots import words
from sysmlc.robots.study import WAYS, Robot, Study


def apart(study: Study) -> Iterator[Conjunct]:
    """No two robots are in one cell (thesis 4.3.1)."""
    for one, other in combinations(study.robots, 2):
        text = f"'{one.name}' and '{other.name}' are never in one cell."
        for cell in study.grid.cells:
            both = f.both(words.at(other, cell), words.at(one, cell))
            yield words.first(f.negate(both), other.origin, text)


def free_cells(study: Study) -> Iterator[Conjunct]:
    """A cell is free when no robot is in it. (The thesis prints a double negation too many.)"""
    for cell in study.grid.cells:
        there = f.either(*(words.at(robot, cell) for robot in study.robots))
        text = f"Cell {cell} is free when no robot is in it."
        yield words.first(f.iff(f.var(words.free(cell)), f.negate(there)), study.origin, text)


def seen(study: Study, robot: Robot, is_exact: bool = True) -> Iterator[Conjunct]:
    """A sensor shows whether the next cell is free; unless ``is_exact`` it may hide that it is."""
    for way in WAYS:
        for cell in study.grid.cells:
            there = study.grid.after(cell, way)
            here, shown = words.at(robot, cell), f.var(words.sensor(robot, way))
            text = f"From cell {cell} '{robot.name}' sees what is {way} of it."
            if there is None:
                formula = f.implies(here, f.negate(shown))
            elif is_exact:
                formula = f.implies(here, f.iff(shown, f.var(words.free(there))))
            else:
                formula = f.implies(f.both(here, shown), f.var(words.free(there)))
            yield words.first(formula, robot.origin, text)


def no_obstacle(study: Study) -> Iterator[Conjunct]:
    """No robot is in the cell of an obstacle."""
    for cell, origin in zip(study.grid.blocked, study.obstacles, strict=True):
        for robot in study.robots:
            text = f"An obstacle is in cell {cell}."
            yield words.first(f.negate(words.at(robot, cell)), origin, text)
