"""Extension of a run of some robots to all robots, in which the others rest off all paths.

A counterexample with one or two robots becomes a run of the whole floor in this way. Callers check
the run against the contracts of all robots, conjunct by conjunct, so it need not always succeed.
"""

from collections.abc import Callable, Iterable, Iterator, Mapping, Sequence, Set
from functools import partial

from sysmlc.logic.contract import Conjunct, Contract
from sysmlc.logic.evaluate import find_violation
from sysmlc.logic.formula import Literal
from sysmlc.robots import contract_terms as terms
from sysmlc.robots.joint_contracts import liveness_conjuncts, safety_conjuncts
from sysmlc.robots.mission_contract import NONE
from sysmlc.robots.study import STAY, WAYS, Grid, Robot, Study
from sysmlc.synthesis.algebra.fair_systems import Trace

Values = Mapping[str, Literal]


Offers = Mapping[Robot, Set[str]]
"""The directions that are offered to resting robots."""


def extend_to_all_robots(
    study: Study, active_robots: Sequence[Robot], run: Trace, is_exact: bool = False
) -> Iterator[Trace]:
    """Yield extensions of a run of some robots to all robots; the other robots rest.

    C_E guarantees offers to resting robots, too. In the first extension each of them is always
    offered the same unused cell; in the second they are offered free cells in turn, with the loop
    repeated for each of them. With *is_exact* the sensors show every free cell, and there is one
    extension. If there is no room, an extension violates a contract (``violated_conjuncts``).
    """
    grid, resting_robots = (
        study.grid,
        [robot for robot in study.robots if robot not in active_robots],
    )
    used_cells = {cell for step in run.steps for cell in _occupied_cells(grid, step, active_robots)}
    nearby_cells = {neighbour for cell in used_cells for _, neighbour in grid.neighbours(cell)}
    parking, free_directions = _choose_parking(grid, used_cells | nearby_cells, resting_robots)
    offers: Offers = {robot: {way} for robot, way in free_directions.items()}
    offers_of_step = (
        (lambda step, turn: _free_ways(grid, step, parking)) if is_exact else lambda *_: offers
    )
    yield _extend_run(study, run, parking, offers_of_step, 1)
    cells = [cell for cell in reversed(grid.cells) if cell not in used_cells]
    parking = dict(zip(resting_robots, cells, strict=False))
    if not is_exact and len(parking) == len(resting_robots) > 0:
        yield _extend_run(
            study,
            run,
            parking,
            partial(_offer_in_turn, grid, active_robots, parking),
            len(resting_robots),
        )


def _occupied_cells(grid: Grid, step: Values, robots: Iterable[Robot]) -> Iterator[int]:
    """Yield the cells in which robots are or that are offered to them in a step."""
    for robot in robots:
        cell = int(step[terms.position(robot)])
        neighbours = grid.neighbours(cell)
        yield cell
        yield from (neighbour for way, neighbour in neighbours if step[terms.sensor(robot, way)])


def _choose_parking(
    grid: Grid, avoided: Set[int], robots: Iterable[Robot]
) -> tuple[dict[Robot, int], dict[Robot, str]]:
    """Return a cell for each robot to rest in, and the direction of an unused neighbour cell.

    Cells in *avoided* are not chosen. If no cell is left, the choice is arbitrary.
    """
    parking: dict[Robot, int] = {}
    free_directions: dict[Robot, str] = {}
    used_cells = set(avoided)
    for robot in robots:
        free_cells = [cell for cell in reversed(grid.cells) if cell not in used_cells]
        choices = (
            (cell, way, neighbour)
            for cell in free_cells
            for way, neighbour in grid.neighbours(cell)
            if neighbour not in used_cells
        )
        cell, way, offered_cell = next(choices, (grid.cells[-1], "", grid.cells[-1]))
        used_cells |= {cell, offered_cell}
        parking[robot], free_directions[robot] = cell, way
    return parking, free_directions


def _free_ways(grid: Grid, step: Values, parking: Mapping[Robot, int]) -> Offers:
    """Return all free directions of the resting robots in a step."""
    return {
        robot: {way for way, neighbour in grid.neighbours(cell) if step[terms.free(neighbour)]}
        for robot, cell in parking.items()
    }


def _offer_in_turn(
    grid: Grid,
    active_robots: Sequence[Robot],
    parking: Mapping[Robot, int],
    step: Values,
    turn: int,
) -> Offers:
    """Return for the robot in turn a free direction into a cell offered to no other robot."""
    offered = set(_occupied_cells(grid, step, active_robots))
    robot = [*parking][turn]
    neighbours = grid.neighbours(parking[robot])
    free_directions = [
        way
        for way, neighbour in neighbours
        if step[terms.free(neighbour)] and neighbour not in offered
    ]
    return {robot: set(free_directions[:1])}


def _extend_run(
    study: Study,
    run: Trace,
    parking: Mapping[Robot, int],
    offers_of_step: Callable[[Values, int], Offers],
    turns: int,
) -> Trace:
    """Return the run with the values of the resting robots, and with its loop once per turn."""
    loops = [(step, turn) for turn in range(turns) for step in run.steps[run.loop :]]
    steps = []
    for values, turn in (*((step, 0) for step in run.steps[: run.loop]), *loops):
        extended = _rest_values(study, values, parking)
        offers = offers_of_step(extended, turn)
        extended |= {
            terms.sensor(robot, way): way in offers.get(robot, ())
            for robot in parking
            for way in WAYS
        }
        steps.append(extended)
    return Trace(tuple(steps), run.loop)


def _rest_values(study: Study, values: Values, parking: Mapping[Robot, int]) -> dict[str, Literal]:
    """Return the values of a step with those of the resting robots and of all free cells."""
    extended = dict(values)
    for robot, cell in parking.items():
        extended |= {terms.position(robot): cell, terms.target(robot): cell}
        extended |= {terms.command(robot): STAY, terms.goal(robot): NONE}
        extended |= {terms.steps(robot): 0, terms.timer(robot): 0}
    occupied = {extended[terms.position(robot)] for robot in study.robots}
    return extended | {terms.free(cell): cell not in occupied for cell in study.grid.cells}


def violated_conjuncts(run: Trace, conjuncts: Iterable[Conjunct]) -> Iterator[Conjunct]:
    """Yield the conjuncts that a run violates."""
    return (rule for rule in conjuncts if find_violation(rule, run.steps, run.loop) is not None)


def satisfies_contract(run: Trace, contract: Contract) -> bool:
    """Whether a run satisfies the guarantees of a contract.

    Liveness guarantees need to hold only if all liveness assumptions do.
    """
    if any(violated_conjuncts(run, safety_conjuncts(contract.guarantees))):
        return False
    owes_liveness = not any(violated_conjuncts(run, liveness_conjuncts(contract.assumptions)))
    return not owes_liveness or not any(
        violated_conjuncts(run, liveness_conjuncts(contract.guarantees))
    )
