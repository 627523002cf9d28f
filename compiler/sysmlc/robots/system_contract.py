"""The contract of all robots together, C_S (MOOD4I thesis, 4.3.1), in three encodings.

``THESIS`` has sensors and free cells as inputs; ``COMMANDS`` leaves out what follows from the
positions; in ``MOVES`` a robot's position is its own choice: the command is the cell it goes to.
"""

from collections.abc import Callable, Iterator
from enum import StrEnum
from itertools import combinations, permutations

from sysmlc.logic import formula as f
from sysmlc.logic.contract import Conjunct, Contract, IntegerDomain, Owner, Variable
from sysmlc.logic.formula import Formula, Op
from sysmlc.robots import contract_terms as words
from sysmlc.robots.contract_terms import (
    define_free_cells,
    define_sensors,
    forbid_obstacle_cells,
    forbid_shared_cells,
)
from sysmlc.robots.robot_contract import counters, counting
from sysmlc.robots.study import STAY, WAYS, Robot, Study

_ENVIRONMENT, _SYSTEM = Owner.ENVIRONMENT, Owner.SYSTEM


class Encoding(StrEnum):
    """How a command and what it does are told."""

    THESIS = "thesis"
    COMMANDS = "commands"
    MOVES = "moves"


def system_contract(study: Study, encoding: Encoding = Encoding.THESIS) -> Contract:
    """The contract of the whole system: all robots reach their targets and never meet.

    With ``study.within`` each target is reached within so many steps of the moment in which the
    robot has it. Read as it stands the thesis's timer never begins again, so that the contract
    either cannot be kept or stops the environment; it begins anew with each target here.
    """
    return Contract(
        study.component,
        study.origin,
        tuple(_variables(study, encoding)),
        (*_ASSUMED[encoding](study), *timing(study)),
        (*_PROMISED[encoding](study), *_limits(study), *_goals(study)),
    )


def _variables(study: Study, encoding: Encoding) -> Iterator[Variable]:
    mover = _SYSTEM if encoding is Encoding.MOVES else _ENVIRONMENT
    for robot in study.robots:
        place, *sensors = words.places(study, robot, mover)
        yield place
        yield words.cells(words.target(robot), _ENVIRONMENT, study.grid, robot.origin)
        if study.within is not None:
            domain = IntegerDomain(0, study.within + 1)
            yield Variable(words.timer(robot), _ENVIRONMENT, domain, robot.origin)
        if encoding is Encoding.THESIS:
            yield from sensors
        if encoding is not Encoding.MOVES:
            yield words.commands(robot, _SYSTEM)
        yield from counters(study, robot)
    if encoding is Encoding.THESIS:
        yield from words.free_cells(study, _ENVIRONMENT)


# -- assumptions -------------------------------------------------------------------------------


def _assumed_in_thesis(study: Study) -> Iterator[Conjunct]:
    yield from words.starts(study.robots)
    sensed = (one for robot in study.robots for one in define_sensors(study, robot))
    yield from forbid_shared_cells(study)
    yield from words.in_all((*_placed(study), *define_free_cells(study), *sensed))
    for robot in study.robots:
        yield from words.motion(study, robot, is_total=True)
        yield from words.stable_target(study, robot)


def _assumed_of_commands(study: Study) -> Iterator[Conjunct]:
    yield from words.starts(study.robots)
    yield from _pairs(study, words.first)
    yield from words.in_all(_placed(study))
    for robot in study.robots:
        yield from words.motion(study, robot, is_total=True)
        yield words.stable_as_whole(robot)


def _assumed_of_moves(study: Study) -> Iterator[Conjunct]:
    for robot in study.robots:
        yield from words.in_all(words.targets_in_reach(study, robot))
        yield words.stable_as_whole(robot)


def _placed(study: Study) -> Iterator[Conjunct]:
    for robot in study.robots:
        yield from words.on_floor(study, robot)


def timing(study: Study) -> Iterator[Conjunct]:
    """Timers count the steps since a robot has its target."""
    for robot in study.robots if study.within is not None else ():
        yield from _timer(robot, (study.within or 0) + 1)


def _timer(robot: Robot, most: int) -> Iterator[Conjunct]:
    text = f"The timer of '{robot.name}' counts the steps since it has its target."
    count = words.timer(robot)
    yield words.first(words.is_(count, 0), robot.origin, text)
    anew = f.implies(words.reached(robot), f.primed(words.is_(count, 0)))
    yield words.each(anew, robot.origin, text)
    for number in range(most + 1):
        before = f.both(words.away(robot), words.is_(count, number))
        after = f.primed(words.is_(count, min(number + 1, most)))
        yield words.each(f.implies(before, after), robot.origin, text)


# -- guarantees --------------------------------------------------------------------------------


def _promised_in_thesis(study: Study) -> Iterator[Conjunct]:
    yield from _resting(study)
    for one in forbid_shared_cells(study):
        yield words.each(one.formula, one.origin, one.text)
    for robot in study.robots:
        yield from words.obedience(robot)
        yield from counting(study, robot)


def _promised_of_commands(study: Study) -> Iterator[Conjunct]:
    yield from _resting(study)
    yield from _pairs(study, words.each)
    for robot in study.robots:
        yield from _free_ways_only(study, robot)
        yield from counting(study, robot)


def _promised_of_moves(study: Study) -> Iterator[Conjunct]:
    yield from words.starts(study.robots)
    yield from forbid_obstacle_cells(study)
    yield from _pairs(study, words.first)
    for robot in study.robots:
        yield from _steps(study, robot)
        yield from counting(study, robot)
    yield from _never_into(study)
    for one in _pairs(study, words.each):
        yield words.each(f.primed(one.formula), one.origin, one.text)


def _resting(study: Study) -> Iterator[Conjunct]:
    for robot in study.robots:
        text = f"At first '{robot.name}' stays."
        yield words.first(words.is_(words.command(robot), STAY), robot.origin, text)


def _pairs(study: Study, said: Callable[[Formula, str, str], Conjunct]) -> Iterator[Conjunct]:
    """No two robots are in one cell, a conjunct for each two."""
    for one, other in combinations(study.robots, 2):
        text = f"'{one.name}' and '{other.name}' are never in one cell."
        yield said(_differ(other, one), other.origin, text)


def _differ(one: Robot, other: Robot, is_primed: bool = False) -> Formula:
    """Two robots are in different cells, with ``is_primed`` the first of them in the next step."""
    here, there = f.var(words.position(one)), f.var(words.position(other))
    return f.compare(Op.NE, f.primed(here) if is_primed else here, there)


def _free_ways_only(study: Study, robot: Robot) -> Iterator[Conjunct]:
    """No command into a wall, an obstacle or another robot."""
    text = f"'{robot.name}' goes only where nothing is."
    others = [one for one in study.robots if one != robot]
    for way in WAYS:
        for cell in study.grid.cells:
            goes = f.both(words.is_(words.command(robot), way), words.at(robot, cell))
            there = study.grid.after(cell, way)
            taken = [f.TRUE] if there is None else [words.at(other, there) for other in others]
            for one in taken:
                yield words.each(f.primed(f.negate(f.both(goes, one))), robot.origin, text)


def _steps(study: Study, robot: Robot) -> Iterator[Conjunct]:
    """From a cell a robot goes to a neighbour, or stays."""
    for cell in study.grid.cells:
        there = (cell, *(one for _, one in study.grid.neighbours(cell)))
        goes = f.primed(words.one_of(words.position(robot), there))
        text = f"From cell {cell} '{robot.name}' goes to a neighbour, or stays."
        yield words.each(f.implies(words.at(robot, cell), goes), robot.origin, text)


def _never_into(study: Study) -> Iterator[Conjunct]:
    """No robot goes into the cell that another one is about to leave."""
    for robot, other in permutations(study.robots, 2):
        text = f"'{robot.name}' does not go where '{other.name}' is."
        yield words.each(_differ(robot, other, is_primed=True), robot.origin, text)


def _limits(study: Study) -> Iterator[Conjunct]:
    for robot in study.robots if study.within is not None else ():
        text = f"'{robot.name}' reaches a target within {study.within} steps."
        limit = f.compare(Op.LE, f.var(words.timer(robot)), f.const(study.within or 0))
        yield words.each(limit, robot.origin, text)


def _goals(study: Study) -> Iterator[Conjunct]:
    for robot in study.robots:
        text = f"'{robot.name}' reaches its targets."
        yield words.again(words.reached(robot), robot.origin, text)


_ASSUMED = {
    Encoding.THESIS: _assumed_in_thesis,
    Encoding.COMMANDS: _assumed_of_commands,
    Encoding.MOVES: _assumed_of_moves,
}
_PROMISED = {
    Encoding.THESIS: _promised_in_thesis,
    Encoding.COMMANDS: _promised_of_commands,
    Encoding.MOVES: _promised_of_moves,
}
