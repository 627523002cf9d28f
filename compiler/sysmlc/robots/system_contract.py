"""The contract of all robots together, C_S (MOOD4I thesis, 4.3.1), in three encodings.

``THESIS`` has sensors and free cells as inputs. ``COMMANDS`` omits them, as they follow from the
positions. In ``MOVES`` a robot chooses its next position directly instead of giving a command.
"""

from collections.abc import Callable, Iterator
from enum import StrEnum
from itertools import combinations, permutations

from sysmlc.logic import formula as f
from sysmlc.logic.contract import Conjunct, Contract, IntegerDomain, Owner, Variable
from sysmlc.logic.formula import Formula, Op
from sysmlc.robots import contract_terms as terms
from sysmlc.robots.contract_terms import (
    define_free_cells,
    define_sensors,
    forbid_obstacle_cells,
    forbid_shared_cells,
)
from sysmlc.robots.robot_contract import count_steps, declare_counter
from sysmlc.robots.study import STAY, WAYS, Robot, Study
from sysmlc.support.counts import count

_ENVIRONMENT, _SYSTEM = Owner.ENVIRONMENT, Owner.SYSTEM


class Encoding(StrEnum):
    """Representation of commands and their effects in C_S."""

    THESIS = "thesis"
    COMMANDS = "commands"
    MOVES = "moves"


def system_contract(study: Study, encoding: Encoding = Encoding.THESIS) -> Contract:
    """Return the contract of the whole system: all robots reach their targets and never meet.

    With ``study.within`` each target is reached within this number of steps after its assignment.
    The timer of the thesis, taken literally, never restarts: the contract would be unrealizable or
    leave the environment without a next step. Here the timer restarts with each target.
    """
    return Contract(
        study.component,
        study.origin,
        tuple(_declare_variables(study, encoding)),
        (*_ASSUMPTIONS[encoding](study), *count_timers(study)),
        (*_GUARANTEES[encoding](study), *_limit_timers(study), *_reach_targets(study)),
    )


def _declare_variables(study: Study, encoding: Encoding) -> Iterator[Variable]:
    mover = _SYSTEM if encoding is Encoding.MOVES else _ENVIRONMENT
    for robot in study.robots:
        place, *sensors = terms.declare_position_and_sensors(study, robot, mover)
        yield place
        yield terms.declare_cell(terms.target(robot), _ENVIRONMENT, study.grid, robot.origin)
        if study.within is not None:
            domain = IntegerDomain(0, study.within + 1)
            yield Variable(terms.timer(robot), _ENVIRONMENT, domain, robot.origin)
        if encoding is Encoding.THESIS:
            yield from sensors
        if encoding is not Encoding.MOVES:
            yield terms.declare_command(robot, _SYSTEM)
        yield from declare_counter(study, robot)
    if encoding is Encoding.THESIS:
        yield from terms.declare_free_cells(study, _ENVIRONMENT)


# -- assumptions -------------------------------------------------------------------------------


def _thesis_assumptions(study: Study) -> Iterator[Conjunct]:
    yield from terms.define_starts(study.robots)
    sensor_conjuncts = (
        conjunct for robot in study.robots for conjunct in define_sensors(study, robot)
    )
    yield from forbid_shared_cells(study)
    yield from terms.repeat_in_every_step(
        (*_place_robots(study), *define_free_cells(study), *sensor_conjuncts)
    )
    for robot in study.robots:
        yield from terms.define_motion(study, robot, is_total=True)
        yield from terms.hold_target_by_cell(study, robot)


def _command_assumptions(study: Study) -> Iterator[Conjunct]:
    yield from terms.define_starts(study.robots)
    yield from _forbid_meeting(study, terms.initial_conjunct)
    yield from terms.repeat_in_every_step(_place_robots(study))
    for robot in study.robots:
        yield from terms.define_motion(study, robot, is_total=True)
        yield terms.hold_target(robot)


def _move_assumptions(study: Study) -> Iterator[Conjunct]:
    for robot in study.robots:
        yield from terms.repeat_in_every_step(terms.require_reachable_targets(study, robot))
        yield terms.hold_target(robot)


def _place_robots(study: Study) -> Iterator[Conjunct]:
    for robot in study.robots:
        yield from terms.place_on_floor(study, robot)


def count_timers(study: Study) -> Iterator[Conjunct]:
    """State that timers count the steps since the assignment of a target, if there is a limit."""
    if study.within is None:
        return
    for robot in study.robots:
        yield from _count_timer(robot, (study.within or 0) + 1)


def _count_timer(robot: Robot, max_count: int) -> Iterator[Conjunct]:
    """State that a timer counts up to *max_count*, and restarts when the robot is in its target."""
    text = f"The timer of '{robot.name}' counts the steps since it has its target."
    count = terms.timer(robot)
    yield terms.initial_conjunct(terms.equals(count, 0), robot.origin, text)
    reset = f.implies(terms.is_at_target(robot), f.prime(terms.equals(count, 0)))
    yield terms.safety_conjunct(reset, robot.origin, text)
    for number in range(max_count + 1):
        before = f.both(terms.is_away_from_target(robot), terms.equals(count, number))
        after = f.prime(terms.equals(count, min(number + 1, max_count)))
        yield terms.safety_conjunct(f.implies(before, after), robot.origin, text)


# -- guarantees --------------------------------------------------------------------------------


def _thesis_guarantees(study: Study) -> Iterator[Conjunct]:
    yield from _start_at_rest(study)
    for conjunct in forbid_shared_cells(study):
        yield terms.safety_conjunct(conjunct.formula, conjunct.origin, conjunct.text)
    for robot in study.robots:
        yield from terms.require_sensor_obedience(robot)
        yield from count_steps(study, robot)


def _command_guarantees(study: Study) -> Iterator[Conjunct]:
    yield from _start_at_rest(study)
    yield from _forbid_meeting(study, terms.safety_conjunct)
    for robot in study.robots:
        yield from _forbid_blocked_commands(study, robot)
        yield from count_steps(study, robot)


def _move_guarantees(study: Study) -> Iterator[Conjunct]:
    yield from terms.define_starts(study.robots)
    yield from forbid_obstacle_cells(study)
    yield from _forbid_meeting(study, terms.initial_conjunct)
    for robot in study.robots:
        yield from _move_to_neighbours(study, robot)
        yield from count_steps(study, robot)
    yield from _forbid_following(study)
    for conjunct in _forbid_meeting(study, terms.safety_conjunct):
        yield terms.safety_conjunct(f.prime(conjunct.formula), conjunct.origin, conjunct.text)


def _start_at_rest(study: Study) -> Iterator[Conjunct]:
    for robot in study.robots:
        text = f"At first '{robot.name}' stays."
        yield terms.initial_conjunct(terms.equals(terms.command(robot), STAY), robot.origin, text)


def _forbid_meeting(
    study: Study, make_conjunct: Callable[[Formula, str, str], Conjunct]
) -> Iterator[Conjunct]:
    """State for each pair of robots that they are in different cells."""
    for first, second in combinations(study.robots, 2):
        text = f"'{first.name}' and '{second.name}' are never in one cell."
        yield make_conjunct(_are_in_different_cells(second, first), second.origin, text)


def _are_in_different_cells(first: Robot, second: Robot, is_primed: bool = False) -> Formula:
    """Return the predicate that two robots are in different cells.

    With ``is_primed`` it compares the next cell of the first robot with the cell of the second.
    """
    first_position, second_position = f.var(terms.position(first)), f.var(terms.position(second))
    return f.compare(
        Op.NE, f.prime(first_position) if is_primed else first_position, second_position
    )


def _forbid_blocked_commands(study: Study, robot: Robot) -> Iterator[Conjunct]:
    """Forbid commands into a wall, an obstacle or another robot."""
    text = f"'{robot.name}' goes only where nothing is."
    other_robots = [other for other in study.robots if other != robot]
    for way in WAYS:
        for cell in study.grid.cells:
            moves = f.both(terms.equals(terms.command(robot), way), terms.is_in_cell(robot, cell))
            neighbour = study.grid.cell_after(cell, way)
            blocked = (
                [f.TRUE]
                if neighbour is None
                else [terms.is_in_cell(other_robot, neighbour) for other_robot in other_robots]
            )
            for condition in blocked:
                yield terms.safety_conjunct(
                    f.prime(f.negate(f.both(moves, condition))), robot.origin, text
                )


def _move_to_neighbours(study: Study, robot: Robot) -> Iterator[Conjunct]:
    """State that a robot moves to a neighbour cell or stays."""
    for cell in study.grid.cells:
        reachable = (cell, *(neighbour for _, neighbour in study.grid.neighbours(cell)))
        moves = f.prime(terms.is_in_any(terms.position(robot), reachable))
        text = f"From cell {cell} '{robot.name}' goes to a neighbour, or stays."
        yield terms.safety_conjunct(
            f.implies(terms.is_in_cell(robot, cell), moves), robot.origin, text
        )


def _forbid_following(study: Study) -> Iterator[Conjunct]:
    """State that no robot enters a cell that another robot is just leaving."""
    for robot, other_robot in permutations(study.robots, 2):
        text = f"'{robot.name}' does not go where '{other_robot.name}' is."
        yield terms.safety_conjunct(
            _are_in_different_cells(robot, other_robot, is_primed=True), robot.origin, text
        )


def _limit_timers(study: Study) -> Iterator[Conjunct]:
    if study.within is None:
        return
    for robot in study.robots:
        text = f"'{robot.name}' reaches a target within {count(study.within, 'step')}."
        limit = f.compare(Op.LE, f.var(terms.timer(robot)), f.const(study.within or 0))
        yield terms.safety_conjunct(limit, robot.origin, text)


def _reach_targets(study: Study) -> Iterator[Conjunct]:
    for robot in study.robots:
        text = f"'{robot.name}' reaches its targets."
        yield terms.liveness_conjunct(terms.is_at_target(robot), robot.origin, text)


_ASSUMPTIONS = {
    Encoding.THESIS: _thesis_assumptions,
    Encoding.COMMANDS: _command_assumptions,
    Encoding.MOVES: _move_assumptions,
}
_GUARANTEES = {
    Encoding.THESIS: _thesis_guarantees,
    Encoding.COMMANDS: _command_guarantees,
    Encoding.MOVES: _move_guarantees,
}
