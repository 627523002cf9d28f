"""The contract of the environment, C_E (MOOD4I thesis, 4.3.3): what moves robots and shows ways.

As the thesis has it, it cannot be kept by two robots or more: both may be told that one cell is
free and go there. Either it is assumed that they do not, or the cell is offered to one of them.
"""

from collections.abc import Iterator
from enum import StrEnum
from itertools import combinations, permutations

from sysmlc.logic import formula as f
from sysmlc.logic.contract import Conjunct, Contract, Owner
from sysmlc.logic.formula import Formula
from sysmlc.robots import contract_terms as words
from sysmlc.robots.contract_terms import (
    define_free_cells,
    define_sensors,
    forbid_obstacle_cells,
    forbid_shared_cells,
)
from sysmlc.robots.study import STAY, WAYS, Robot, Study


class Sharing(StrEnum):
    """What becomes of a free cell next to two robots."""

    LITERAL = "literal"
    """Both are told that it is free (thesis)."""
    ASSUMED = "assumed"
    """Both are told so, and it is assumed that they do not go there together."""
    ARBITRATED = "arbitrated"
    """It is offered to one of them."""


def environment_contract(study: Study, sharing: Sharing = Sharing.ARBITRATED) -> Contract:
    """What robots can rely on: motion by command, sensors, cells that are never shared."""
    is_exact = sharing is not Sharing.ARBITRATED
    sensed = [one for robot in study.robots for one in define_sensors(study, robot, is_exact)]
    rules = [*forbid_shared_cells(study), *define_free_cells(study), *sensed]
    if not is_exact:
        rules += _offered_once(study)
    name = f"{study.component}.environment"
    return Contract(
        name if sharing is Sharing.ARBITRATED else f"{name}.{sharing}",
        study.origin,
        (
            *(words.commands(robot, Owner.ENVIRONMENT) for robot in study.robots),
            *(one for robot in study.robots for one in words.places(study, robot, Owner.SYSTEM)),
            *words.free_cells(study, Owner.SYSTEM),
        ),
        tuple(_assumed(study, sharing)),
        (
            *words.starts(study.robots),
            *forbid_obstacle_cells(study),
            *words.in_all(rules),
            *(one for robot in study.robots for one in words.motion(study, robot, False)),
            *(() if is_exact else _ways_offered(study)),
        ),
    )


def _assumed(study: Study, sharing: Sharing) -> Iterator[Conjunct]:
    for robot in study.robots:
        text = f"At first '{robot.name}' stays."
        yield words.first(words.is_(words.command(robot), STAY), robot.origin, text)
    for robot in study.robots:
        for way in WAYS:
            goes = words.is_(words.command(robot), way)
            text = f"'{robot.name}' goes {way} only when the way is free."
            formula = f.implies(goes, f.var(words.sensor(robot, way)))
            yield words.each(formula, robot.origin, text)
    if sharing is Sharing.ASSUMED:
        yield from _never_together(study)


def _never_together(study: Study) -> Iterator[Conjunct]:
    for one, other in combinations(study.robots, 2):
        text = f"'{one.name}' and '{other.name}' do not go to one cell."
        for cell in study.grid.cells:
            both = f.both(_goes_to(study, other, cell), _goes_to(study, one, cell))
            yield words.each(f.negate(both), other.origin, text)


def _goes_to(study: Study, robot: Robot, cell: int) -> Formula:
    found = [f.both(words.at(robot, cell), words.is_(words.command(robot), STAY))]
    for near, way in _from(study, cell):
        found.append(f.both(words.at(robot, near), words.is_(words.command(robot), way)))
    return f.either(*found)


def _from(study: Study, cell: int) -> Iterator[tuple[int, str]]:
    """Neighbours of a cell, by number, with the commands that lead from them into it."""
    back = dict(zip(WAYS, ("down", "up", "right", "left"), strict=True))
    yield from sorted((near, back[way]) for way, near in study.grid.neighbours(cell))


def _offered_once(study: Study) -> Iterator[Conjunct]:
    for one, other in combinations(study.robots, 2):
        text = f"No cell is offered to both '{one.name}' and '{other.name}'."
        for cell in study.grid.cells:
            for (near, way), (far, back) in permutations(_from(study, cell), 2):
                offered = f.both(
                    words.at(other, near),
                    f.var(words.sensor(other, way)),
                    words.at(one, far),
                    f.var(words.sensor(one, back)),
                )
                yield words.first(f.negate(offered), other.origin, text)


def _ways_offered(study: Study) -> Iterator[Conjunct]:
    """Again and again a robot that is not shut in is offered a way."""
    for robot in study.robots:
        text = f"Again and again a way is offered to '{robot.name}', if one is free."
        shown = (f.var(words.sensor(robot, way)) for way in WAYS)
        yield words.again(f.either(*shown, *_shut_in(study, robot)), robot.origin, text)


def _shut_in(study: Study, robot: Robot) -> Iterator[Formula]:
    for cell in study.grid.cells:
        near = [there for _, there in study.grid.neighbours(cell)]
        if len(near) < len(study.robots):
            taken = (f.negate(f.var(words.free(there))) for there in near)
            yield f.both(words.at(robot, cell), *taken)
