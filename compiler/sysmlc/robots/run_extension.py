"""A run of some robots as a run of all: the others rest where they are in nobody's way.

What is decided for one or two robots so becomes a run of the whole floor, and is held to the
contracts of all robots, conjunct by conjunct, before it is told.
"""

from collections.abc import Callable, Iterable, Iterator, Mapping, Sequence, Set
from functools import partial

from sysmlc.logic.contract import Conjunct, Contract
from sysmlc.logic.evaluate import find_violation
from sysmlc.logic.formula import Literal
from sysmlc.robots import contract_terms as words
from sysmlc.robots.joint_contracts import liveness_conjuncts, safety_conjuncts
from sysmlc.robots.mission_contract import NONE
from sysmlc.robots.study import STAY, WAYS, Grid, Robot, Study
from sysmlc.synthesis.algebra.traces import Trace

Values = Mapping[str, Literal]


Offers = Mapping[Robot, Set[str]]
"""The ways that robots at rest are shown."""


def extend_to_all_robots(
    study: Study, few: Sequence[Robot], run: Trace, is_exact: bool = False
) -> Iterator[Trace]:
    """Extend a run of a few robots to all robots: the others rest in nobody's way.

    First each of the others is always offered a cell next to it. Then the others are offered a free
    cell in turn, in a loop that is repeated for each of them. With *is_exact* they are offered
    every free cell. If there is no room for them, the result violates a contract
    (``violated_conjuncts``).
    """
    grid, others = study.grid, [one for one in study.robots if one not in few]
    used = {cell for step in run.steps for cell in _occupied_cells(grid, step, few)}
    near = {there for cell in used for _, there in grid.neighbours(cell)}
    rests, doors = _choose_parking(grid, used | near, others)
    shown: Offers = {one: {way} for one, way in doors.items()}
    ways = (lambda step, turn: _free_ways(grid, step, rests)) if is_exact else lambda *_: shown
    yield _extend_run(study, run, rests, ways, 1)
    cells = [cell for cell in reversed(grid.cells) if cell not in used]
    rests = dict(zip(others, cells, strict=False))
    if not is_exact and len(rests) == len(others) > 0:
        yield _extend_run(study, run, rests, partial(_offer_in_turn, grid, few, rests), len(others))


def _occupied_cells(grid: Grid, step: Values, few: Iterable[Robot]) -> Iterator[int]:
    """The cells that robots are in, and those that are offered to them."""
    for robot in few:
        here = int(step[words.position(robot)])
        ways = grid.neighbours(here)
        yield here
        yield from (there for way, there in ways if step[words.sensor(robot, way)])


def _choose_parking(
    grid: Grid, avoided: Set[int], others: Iterable[Robot]
) -> tuple[dict[Robot, int], dict[Robot, str]]:
    """Cells apart from some, each with a way into a cell that is nobody else's."""
    rests: dict[Robot, int] = {}
    doors: dict[Robot, str] = {}
    taken = set(avoided)
    for robot in others:
        free = [cell for cell in reversed(grid.cells) if cell not in taken]
        found = (
            (cell, way, there)
            for cell in free
            for way, there in grid.neighbours(cell)
            if there not in taken
        )
        cell, way, door = next(found, (grid.cells[-1], "", grid.cells[-1]))
        taken |= {cell, door}
        rests[robot], doors[robot] = cell, way
    return rests, doors


def _free_ways(grid: Grid, step: Values, rests: Mapping[Robot, int]) -> Offers:
    """All ways that are free."""
    return {
        one: {way for way, there in grid.neighbours(cell) if step[words.free(there)]}
        for one, cell in rests.items()
    }


def _offer_in_turn(
    grid: Grid, few: Sequence[Robot], rests: Mapping[Robot, int], step: Values, turn: int
) -> Offers:
    """A free way for one of the robots at rest, into a cell that is offered to nobody."""
    offered = set(_occupied_cells(grid, step, few))
    robot = [*rests][turn]
    near = grid.neighbours(rests[robot])
    free = [way for way, there in near if step[words.free(there)] and there not in offered]
    return {robot: set(free[:1])}


def _extend_run(
    study: Study,
    run: Trace,
    rests: Mapping[Robot, int],
    ways: Callable[[Values, int], Offers],
    turns: int,
) -> Trace:
    """The run with a loop for each turn, and what is said of robots at rest in each step."""
    loops = [(step, turn) for turn in range(turns) for step in run.steps[run.loop :]]
    steps = []
    for known, turn in (*((one, 0) for one in run.steps[: run.loop]), *loops):
        now = _rest_values(study, known, rests)
        offers = ways(now, turn)
        now |= {words.sensor(one, way): way in offers.get(one, ()) for one in rests for way in WAYS}
        steps.append(now)
    return Trace(tuple(steps), run.loop)


def _rest_values(study: Study, known: Values, rests: Mapping[Robot, int]) -> dict[str, Literal]:
    now = dict(known)
    for robot, cell in rests.items():
        now |= {words.position(robot): cell, words.target(robot): cell}
        now |= {words.command(robot): STAY, words.goal(robot): NONE}
        now |= {words.steps(robot): 0, words.timer(robot): 0}
    taken = {now[words.position(one)] for one in study.robots}
    return now | {words.free(cell): cell not in taken for cell in study.grid.cells}


def violated_conjuncts(run: Trace, conjuncts: Iterable[Conjunct]) -> Iterator[Conjunct]:
    """The conjuncts that do not hold in a run."""
    return (one for one in conjuncts if find_violation(one, run.steps, run.loop) is not None)


def satisfies_contract(run: Trace, contract: Contract) -> bool:
    """Whether a run keeps what a contract promises: what recurs only if what is assumed does."""
    if any(violated_conjuncts(run, safety_conjuncts(contract.guarantees))):
        return False
    owes = not any(violated_conjuncts(run, liveness_conjuncts(contract.assumptions)))
    return not owes or not any(violated_conjuncts(run, liveness_conjuncts(contract.guarantees)))
