"""The contract of the environment, C_E (MOOD4I thesis, 4.3.3): it moves robots, offers free cells.

In the form of the thesis it is unrealizable for two or more robots: the sensors of two robots show
the same free cell, both enter it, and C_E must exclude that. So a cell is offered to one of them.
"""

from collections.abc import Iterator
from itertools import combinations, permutations

from sysmlc.logic import formula as f
from sysmlc.logic.contract import Conjunct, Contract, Owner
from sysmlc.logic.formula import Formula
from sysmlc.robots import contract_terms as terms
from sysmlc.robots.contract_terms import (
    define_free_cells,
    define_sensors,
    forbid_obstacle_cells,
    forbid_shared_cells,
)
from sysmlc.robots.study import STAY, WAYS, Robot, Study


def environment_contract(study: Study, is_literal: bool = False) -> Contract:
    """Return C_E: commands move the robots, sensors show free cells, no cell is shared.

    A free cell next to two robots is offered to one of them. With *is_literal* the sensors of both
    show that it is free, as in the thesis.
    """
    sensed = [
        conjunct for robot in study.robots for conjunct in define_sensors(study, robot, is_literal)
    ]
    rules = [*forbid_shared_cells(study), *define_free_cells(study), *sensed]
    if not is_literal:
        rules += _offer_once(study)
    name = f"{study.component}.environment"
    return Contract(
        f"{name}.literal" if is_literal else name,
        study.origin,
        (
            *(terms.declare_command(robot, Owner.ENVIRONMENT) for robot in study.robots),
            *(
                variable
                for robot in study.robots
                for variable in terms.declare_position_and_sensors(study, robot, Owner.SYSTEM)
            ),
            *terms.declare_free_cells(study, Owner.SYSTEM),
        ),
        tuple(_list_assumptions(study)),
        (
            *terms.define_starts(study.robots),
            *forbid_obstacle_cells(study),
            *terms.repeat_in_every_step(rules),
            *(
                conjunct
                for robot in study.robots
                for conjunct in terms.define_motion(study, robot, False)
            ),
            *(() if is_literal else _guarantee_offers(study)),
        ),
    )


def _list_assumptions(study: Study) -> Iterator[Conjunct]:
    for robot in study.robots:
        text = f"At first '{robot.name}' stays."
        yield terms.initial_conjunct(terms.equals(terms.command(robot), STAY), robot.origin, text)
    for robot in study.robots:
        for way in WAYS:
            moves = terms.equals(terms.command(robot), way)
            text = f"'{robot.name}' goes {way} only when the way is free."
            formula = f.implies(moves, f.var(terms.sensor(robot, way)))
            yield terms.safety_conjunct(formula, robot.origin, text)


def _entries_of(study: Study, cell: int) -> Iterator[tuple[int, str]]:
    """Yield the neighbours of a cell, by number, with the commands that lead into the cell."""
    opposite = dict(zip(WAYS, ("down", "up", "right", "left"), strict=True))
    yield from sorted((neighbour, opposite[way]) for way, neighbour in study.grid.neighbours(cell))


def _offer_once(study: Study) -> Iterator[Conjunct]:
    """State that no cell is offered to two robots."""
    for first, second in combinations(study.robots, 2):
        text = f"No cell is offered to both '{first.name}' and '{second.name}'."
        for cell in study.grid.cells:
            for (second_cell, second_way), (first_cell, first_way) in permutations(
                _entries_of(study, cell), 2
            ):
                offered = f.both(
                    terms.is_in_cell(second, second_cell),
                    f.var(terms.sensor(second, second_way)),
                    terms.is_in_cell(first, first_cell),
                    f.var(terms.sensor(first, first_way)),
                )
                yield terms.initial_conjunct(f.negate(offered), second.origin, text)


def _guarantee_offers(study: Study) -> Iterator[Conjunct]:
    """State that each robot is infinitely often offered a direction, or is enclosed by others."""
    for robot in study.robots:
        text = f"Again and again a way is offered to '{robot.name}', if one is free."
        offers = (f.var(terms.sensor(robot, way)) for way in WAYS)
        yield terms.liveness_conjunct(
            f.either(*offers, *_blocked_positions(study, robot)), robot.origin, text
        )


def _blocked_positions(study: Study, robot: Robot) -> Iterator[Formula]:
    """Yield for each cell the predicate that the robot is in it and enclosed by other robots."""
    # There must be enough other robots to occupy all neighbour cells.
    for cell in study.grid.cells:
        neighbours = [neighbour for _, neighbour in study.grid.neighbours(cell)]
        if len(neighbours) < len(study.robots):
            occupied = (f.negate(f.var(terms.free(neighbour))) for neighbour in neighbours)
            yield f.both(terms.is_in_cell(robot, cell), *occupied)
