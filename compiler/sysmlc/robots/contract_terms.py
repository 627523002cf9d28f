"""Variables of the contracts of a floor, and conjuncts that several contracts share."""

from collections.abc import Iterable, Iterator
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
from sysmlc.robots.study import COMMANDS, STAY, WAYS, Grid, Robot, Study, Target

# -- names of variables ------------------------------------------------------------------------


def position(robot: Robot) -> str:
    """Return the name of the variable for the cell in which the robot is."""
    return f"{robot.word}_position"


def target(robot: Robot) -> str:
    """Return the name of the variable for the cell that the robot shall reach."""
    return f"{robot.word}_target"


def command(robot: Robot) -> str:
    """Return the name of the variable for the command of the robot."""
    return f"{robot.word}_command"


def steps(robot: Robot) -> str:
    """Return the name of the variable for the cells that the robot has passed (thesis 4.3.1)."""
    return f"{robot.word}_steps"


def timer(robot: Robot) -> str:
    """Return the name of the variable for the number of steps since the robot got its target."""
    return f"{robot.word}_timer"


def place(robot: Robot) -> str:
    """Return the name of the variable for the target that the robot reached last."""
    return f"{robot.word}_place"


def goal(robot: Robot) -> str:
    """Return the name of the variable for the target that the robot shall reach next."""
    return f"{robot.word}_goal"


def clock(robot: Robot) -> str:
    """Return the name of the variable for the number of steps of the robot on its way."""
    return f"{robot.word}_clock"


def sensor(robot: Robot, way: str) -> str:
    """Return the name of the sensor that shows whether a direction is offered to the robot."""
    return f"{robot.word}_sensor_{way}"


def completion(target: Target) -> str:
    """Return the name of the variable that is true when a target has been reached."""
    return f"{target.word}_done"


def free(cell: int) -> str:
    """Return the name of the variable that is true while no robot is in a cell."""
    return f"free_{cell}"


# -- predicates --------------------------------------------------------------------------------


def equals(name: str, value: int | str) -> Formula:
    """Return the predicate that a variable has a value."""
    return f.eq(f.var(name), f.const(value))


def is_in_cell(robot: Robot, cell: int) -> Formula:
    """Return the predicate that a robot is in a cell."""
    return equals(position(robot), cell)


def is_in_any(name: str, values: Iterable[int]) -> Formula:
    """Return the predicate that a variable has one of the values."""
    return f.either(*(equals(name, value) for value in values))


def is_at_target(robot: Robot) -> Formula:
    """Return the predicate that a robot is in its target."""
    return f.eq(f.var(position(robot)), f.var(target(robot)))


def is_away_from_target(robot: Robot) -> Formula:
    """Return the predicate that a robot is not in its target."""
    return f.compare(Op.NE, f.var(position(robot)), f.var(target(robot)))


# -- variables ---------------------------------------------------------------------------------


def declare_cell(name: str, owner: Owner, grid: Grid, origin: str) -> Variable:
    """Declare a variable whose values are cells."""
    return Variable(name, owner, IntegerDomain(0, grid.size - 1), origin)


def declare_position_and_sensors(study: Study, robot: Robot, owner: Owner) -> Iterator[Variable]:
    """Declare position and sensors of a robot."""
    yield declare_cell(position(robot), owner, study.grid, robot.origin)
    for way in WAYS:
        yield Variable(sensor(robot, way), owner, BooleanDomain(), robot.origin)


def declare_command(robot: Robot, owner: Owner) -> Variable:
    """Declare the command of a robot."""
    return Variable(command(robot), owner, EnumerationDomain(COMMANDS), robot.origin)


def declare_free_cells(study: Study, owner: Owner) -> Iterator[Variable]:
    """Declare a Boolean for each cell that robots can enter."""
    for cell in study.grid.cells:
        yield Variable(free(cell), owner, BooleanDomain(), study.origin)


# -- conjuncts ---------------------------------------------------------------------------------


def initial_conjunct(formula: Formula, origin: str, text: str) -> Conjunct:
    """State that a formula holds in the first step."""
    return Conjunct(formula, Class.INIT, origin, text)


def safety_conjunct(formula: Formula, origin: str, text: str) -> Conjunct:
    """State that a formula holds in every step."""
    return Conjunct(formula, Class.SAFETY, origin, text)


def liveness_conjunct(formula: Formula, origin: str, text: str) -> Conjunct:
    """State that a formula holds infinitely often."""
    return Conjunct(formula, Class.LIVENESS, origin, text)


def repeat_in_every_step(conjuncts: Iterable[Conjunct]) -> Iterator[Conjunct]:
    """Yield each conjunct about the first step, then once more about every next step."""
    all_conjuncts = list(conjuncts)
    yield from all_conjuncts
    for conjunct in all_conjuncts:
        yield safety_conjunct(f.prime(conjunct.formula), conjunct.origin, conjunct.text)


def forbid_moves(robot: Robot) -> Conjunct:
    """State that a robot never moves."""
    text = f"'{robot.name}' stays."
    return safety_conjunct(equals(command(robot), STAY), robot.origin, text)


def define_starts(robots: Iterable[Robot]) -> Iterator[Conjunct]:
    """State the start positions of the robots that have one."""
    for robot in robots:
        if robot.start is not None:
            text = f"'{robot.name}' starts in cell {robot.start}."
            yield initial_conjunct(is_in_cell(robot, robot.start), robot.origin, text)


def place_on_floor(study: Study, robot: Robot) -> Iterator[Conjunct]:
    """State that a robot is not in an obstacle and that its targets are reachable."""
    for cell, origin in zip(study.grid.blocked, study.obstacles, strict=True):
        text = f"An obstacle is in cell {cell}."
        yield initial_conjunct(f.negate(is_in_cell(robot, cell)), origin, text)
    yield from require_reachable_targets(study, robot)


def require_reachable_targets(study: Study, robot: Robot) -> Iterator[Conjunct]:
    """State that targets are in cells that the robot can reach."""
    grid = study.grid
    # Obstacles may divide the floor into regions. Within one region only obstacles are unreachable,
    # and a conjunct for each of them is simpler.
    regions = list(dict.fromkeys(tuple(sorted(grid.distances(cell))) for cell in grid.cells))
    text = f"What '{robot.name}' is to reach can be reached."
    if len(regions) > 1:
        for region in regions:
            in_region = is_in_any(position(robot), region)
            yield initial_conjunct(
                f.implies(in_region, is_in_any(target(robot), region)), robot.origin, text
            )
    else:
        for cell in grid.blocked:
            yield initial_conjunct(f.negate(equals(target(robot), cell)), robot.origin, text)


def define_motion(study: Study, robot: Robot, is_total: bool) -> Iterator[Conjunct]:
    """State the effect of each command in each cell.

    With ``is_total`` a command into a wall or an obstacle leaves the robot in its cell. The thesis
    does not restrict the position after such a command.
    """
    for cell in study.grid.cells:
        for way in COMMANDS:
            next_cell = cell if way == STAY else study.grid.cell_after(cell, way)
            if next_cell is None and not is_total:
                continue
            before = f.both(is_in_cell(robot, cell), equals(command(robot), way))
            after = f.prime(is_in_cell(robot, cell if next_cell is None else next_cell))
            text = f"'{way}' moves '{robot.name}' on from cell {cell}."
            yield safety_conjunct(f.implies(before, after), robot.origin, text)


def hold_target_by_cell(study: Study, robot: Robot) -> Iterator[Conjunct]:
    """State that a target stays until it is reached, with one conjunct for each cell.

    The thesis does not state it, but if a target may change at any time, no robot can reach it.
    """
    text = f"The target of '{robot.name}' stays until it is reached."
    for cell in study.grid.cells:
        target_here = equals(target(robot), cell)
        yield safety_conjunct(
            f.implies(f.both(is_away_from_target(robot), target_here), f.prime(target_here)),
            robot.origin,
            text,
        )


def require_sensor_obedience(robot: Robot) -> Iterator[Conjunct]:
    """State that a robot moves only in directions that its sensors offer."""
    for way in WAYS:
        moves = equals(command(robot), way)
        text = f"'{robot.name}' goes {way} only when the way is free."
        yield safety_conjunct(
            f.prime(f.implies(moves, f.var(sensor(robot, way)))), robot.origin, text
        )


def forbid_shared_cells(study: Study) -> Iterator[Conjunct]:
    """State that no two robots are in one cell (thesis 4.3.1)."""
    for first, second in combinations(study.robots, 2):
        text = f"'{first.name}' and '{second.name}' are never in one cell."
        for cell in study.grid.cells:
            share_cell = f.both(is_in_cell(second, cell), is_in_cell(first, cell))
            yield initial_conjunct(f.negate(share_cell), second.origin, text)


def define_free_cells(study: Study) -> Iterator[Conjunct]:
    """State that a cell is free if no robot is in it.

    The formula in the thesis has one negation too many.
    """
    for cell in study.grid.cells:
        is_occupied = f.either(*(is_in_cell(robot, cell) for robot in study.robots))
        text = f"Cell {cell} is free when no robot is in it."
        yield initial_conjunct(f.iff(f.var(free(cell)), f.negate(is_occupied)), study.origin, text)


def define_sensors(study: Study, robot: Robot, is_exact: bool = True) -> Iterator[Conjunct]:
    """State what the sensors of a robot show.

    With ``is_exact`` a sensor is true if and only if the neighbour cell is free. Otherwise it may
    be false although the cell is free, because the cell is offered to another robot.
    """
    for way in WAYS:
        for cell in study.grid.cells:
            neighbour = study.grid.cell_after(cell, way)
            stands_here, sensor_value = is_in_cell(robot, cell), f.var(sensor(robot, way))
            text = f"From cell {cell} '{robot.name}' sees what is {way} of it."
            if neighbour is None:
                formula = f.implies(stands_here, f.negate(sensor_value))
            elif is_exact:
                formula = f.implies(stands_here, f.iff(sensor_value, f.var(free(neighbour))))
            else:
                formula = f.implies(f.both(stands_here, sensor_value), f.var(free(neighbour)))
            yield initial_conjunct(formula, robot.origin, text)


def forbid_obstacle_cells(study: Study) -> Iterator[Conjunct]:
    """State that no robot is in the cell of an obstacle."""
    for cell, origin in zip(study.grid.blocked, study.obstacles, strict=True):
        for robot in study.robots:
            text = f"An obstacle is in cell {cell}."
            yield initial_conjunct(f.negate(is_in_cell(robot, cell)), origin, text)
