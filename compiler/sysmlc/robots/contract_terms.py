"""Variables of the contracts of a floor, and what is said of them again and again."""

from collections.abc import Callable, Iterable, Iterator
from itertools import combinations

from sysmlc.logic import formula as f
from sysmlc.logic.contract import (
    BooleanDomain,
    Class,
    Conjunct,
    EnumerationDomain,
    IntegerDomain,
    Owner,
    Variable,
)
from sysmlc.logic.formula import Formula, Op
from sysmlc.robots import contract_terms as words
from sysmlc.robots.study import COMMANDS, STAY, WAYS, Grid, Robot, Study, Target


def _of(what: str) -> Callable[[Robot], str]:
    """The name of something of a robot."""
    return lambda robot: f"{robot.word}_{what}"


position = _of("position")
"""The cell that a robot is in."""
target = _of("target")
"""The cell that it is to reach."""
command = _of("command")
"""What it does."""
steps = _of("steps")
"""How many cells it has gone (thesis 4.3.1)."""
timer = _of("timer")
"""How many steps it has had its target."""
place = _of("place")
"""The target that it reached last."""
goal = _of("goal")
"""The target that it is to reach next."""
clock = _of("clock")
"""How many steps it has been on its way."""


def sensor(robot: Robot, way: str) -> str:
    """Whether the cell next to it on that side is offered to it."""
    return f"{robot.word}_sensor_{way}"


def done(target: Target) -> str:
    """Whether a target has been reached."""
    return f"{target.word}_done"


def free(cell: int) -> str:
    """Whether no robot is in a cell."""
    return f"free_{cell}"


def is_(name: str, value: int | str) -> Formula:
    """That a variable has a value."""
    return f.eq(f.var(name), f.const(value))


def at(robot: Robot, cell: int) -> Formula:
    """That a robot is in a cell."""
    return is_(position(robot), cell)


def one_of(name: str, values: Iterable[int]) -> Formula:
    """That a variable has one of some values."""
    return f.either(*(is_(name, value) for value in values))


# -- variables ---------------------------------------------------------------------------------


def cells(name: str, owner: Owner, grid: Grid, origin: str) -> Variable:
    """A variable whose values are cells."""
    return Variable(name, owner, IntegerDomain(0, grid.size - 1), origin)


def places(study: Study, robot: Robot, owner: Owner) -> Iterator[Variable]:
    """Position and sensors of a robot."""
    yield cells(position(robot), owner, study.grid, robot.origin)
    for way in WAYS:
        yield Variable(sensor(robot, way), owner, BooleanDomain(), robot.origin)


def commands(robot: Robot, owner: Owner) -> Variable:
    """The command of a robot."""
    return Variable(command(robot), owner, EnumerationDomain(COMMANDS), robot.origin)


def free_cells(study: Study, owner: Owner) -> Iterator[Variable]:
    """A Boolean for each cell that robots can be in."""
    for cell in study.grid.cells:
        yield Variable(free(cell), owner, BooleanDomain(), study.origin)


# -- conjuncts ---------------------------------------------------------------------------------


def first(formula: Formula, origin: str, text: str) -> Conjunct:
    """What holds in the first step."""
    return Conjunct(formula, Class.INIT, origin, text)


def each(formula: Formula, origin: str, text: str) -> Conjunct:
    """What holds in every step."""
    return Conjunct(formula, Class.SAFETY, origin, text)


def again(formula: Formula, origin: str, text: str) -> Conjunct:
    """What holds again and again."""
    return Conjunct(formula, Class.LIVENESS, origin, text)


def in_all(conjuncts: Iterable[Conjunct]) -> Iterator[Conjunct]:
    """What holds in one step, said of the first and of every next one."""
    known = list(conjuncts)
    yield from known
    for one in known:
        yield each(f.primed(one.formula), one.origin, one.text)


def stays(robot: Robot) -> Conjunct:
    """A robot stays for ever."""
    text = f"'{robot.name}' stays."
    return each(is_(command(robot), STAY), robot.origin, text)


def starts(robots: Iterable[Robot]) -> Iterator[Conjunct]:
    """Where robots are at first, as far as that is given."""
    for robot in robots:
        if robot.start is not None:
            text = f"'{robot.name}' starts in cell {robot.start}."
            yield first(at(robot, robot.start), robot.origin, text)


def on_floor(study: Study, robot: Robot) -> Iterator[Conjunct]:
    """A robot is not in an obstacle, and targets are where it can go."""
    for cell, origin in zip(study.grid.blocked, study.obstacles, strict=True):
        text = f"An obstacle is in cell {cell}."
        yield first(f.negate(at(robot, cell)), origin, text)
    yield from targets_in_reach(study, robot)


def targets_in_reach(study: Study, robot: Robot) -> Iterator[Conjunct]:
    """Targets are in cells to which a way leads."""
    grid = study.grid
    regions = list(dict.fromkeys(tuple(sorted(grid.distances(cell))) for cell in grid.cells))
    text = f"What '{robot.name}' is to reach can be reached."
    if len(regions) > 1:
        for region in regions:
            here = one_of(position(robot), region)
            yield first(f.implies(here, one_of(target(robot), region)), robot.origin, text)
    else:
        for cell in grid.blocked:
            yield first(f.negate(is_(target(robot), cell)), robot.origin, text)


def motion(study: Study, robot: Robot, is_total: bool) -> Iterator[Conjunct]:
    """Commands move the robot; with ``is_total`` one into a wall or obstacle leaves it there."""
    for cell in study.grid.cells:
        for way in COMMANDS:
            there = cell if way == STAY else study.grid.after(cell, way)
            if there is None and not is_total:
                continue
            before = f.both(at(robot, cell), is_(command(robot), way))
            after = f.primed(at(robot, cell if there is None else there))
            text = f"'{way}' moves '{robot.name}' on from cell {cell}."
            yield each(f.implies(before, after), robot.origin, text)


def stable_target(study: Study, robot: Robot) -> Iterator[Conjunct]:
    """A target stays until it is reached: without that none could be (not said in the thesis)."""
    text = f"The target of '{robot.name}' stays until it is reached."
    for cell in study.grid.cells:
        here = is_(target(robot), cell)
        yield each(f.implies(f.both(away(robot), here), f.primed(here)), robot.origin, text)


def stable_as_whole(robot: Robot) -> Conjunct:
    """The same in one formula."""
    text = f"The target of '{robot.name}' stays until it is reached."
    goal = f.var(target(robot))
    return each(f.implies(away(robot), f.eq(f.primed(goal), goal)), robot.origin, text)


def obedience(robot: Robot) -> Iterator[Conjunct]:
    """A robot goes only where its sensor says that it can."""
    for way in WAYS:
        goes = is_(command(robot), way)
        text = f"'{robot.name}' goes {way} only when the way is free."
        yield each(f.primed(f.implies(goes, f.var(sensor(robot, way)))), robot.origin, text)


def reached(robot: Robot) -> Formula:
    """That a robot is in its target."""
    return f.eq(f.var(position(robot)), f.var(target(robot)))


def away(robot: Robot) -> Formula:
    """That a robot is not in its target."""
    return f.compare(Op.NE, f.var(position(robot)), f.var(target(robot)))


def forbid_shared_cells(study: Study) -> Iterator[Conjunct]:
    """No two robots are in one cell (thesis 4.3.1)."""
    for one, other in combinations(study.robots, 2):
        text = f"'{one.name}' and '{other.name}' are never in one cell."
        for cell in study.grid.cells:
            both = f.both(words.at(other, cell), words.at(one, cell))
            yield words.first(f.negate(both), other.origin, text)


def define_free_cells(study: Study) -> Iterator[Conjunct]:
    """A cell is free when no robot is in it. (The thesis prints a double negation too many.)"""
    for cell in study.grid.cells:
        there = f.either(*(words.at(robot, cell) for robot in study.robots))
        text = f"Cell {cell} is free when no robot is in it."
        yield words.first(f.iff(f.var(words.free(cell)), f.negate(there)), study.origin, text)


def define_sensors(study: Study, robot: Robot, is_exact: bool = True) -> Iterator[Conjunct]:
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


def forbid_obstacle_cells(study: Study) -> Iterator[Conjunct]:
    """No robot is in the cell of an obstacle."""
    for cell, origin in zip(study.grid.blocked, study.obstacles, strict=True):
        for robot in study.robots:
            text = f"An obstacle is in cell {cell}."
            yield words.first(f.negate(words.at(robot, cell)), origin, text)
