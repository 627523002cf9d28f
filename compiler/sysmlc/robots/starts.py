"""The admissible starts of the robots, as sets of bits in chunks of limited size, or as decision
diagrams if there are too many to enumerate.
"""

from collections.abc import Iterator, Mapping, Sequence
from math import prod

from sysmlc.robots.run_sets import P, RunSpace, difference, digit_patterns, starts_without_collision
from sysmlc.robots.study import Study, possible_starts
from sysmlc.synthesis import Limits, Manager, Node

MAX_CHUNK_RUNS = 1 << 17
"""Runs in one operation: larger sets do not fit into the processor's cache."""


def count_starts(study: Study) -> int:
    """Return the number of starts, including those with two robots in one cell."""
    return prod(len(possible_starts(study, robot)) for robot in range(len(study.robots)))


def iter_start_chunks(study: Study, max_runs: int = MAX_CHUNK_RUNS) -> Iterator[RunSpace[int]]:
    """Yield all starts in chunks of limited size.

    In a chunk the cells of the last robots are fixed, and the robot before them has a few cells.
    """
    cells = study.grid.cells
    fixed_cells = {
        robot: placed_robot.start
        for robot, placed_robot in enumerate(study.robots)
        if placed_robot.start is not None
    }
    open_robots = [robot for robot in range(len(study.robots)) if robot not in fixed_cells]
    listed_count = 0
    while listed_count < len(open_robots) and len(cells) ** (listed_count + 1) <= max_runs:
        listed_count += 1
    for chosen in _choose_cells(
        study, open_robots[listed_count + 1 :], tuple(fixed_cells.values())
    ):
        cells_by_robot = fixed_cells | dict(
            zip(open_robots[listed_count + 1 :], chosen, strict=True)
        )
        free_cells = tuple(cell for cell in cells if cell not in cells_by_robot.values())
        room = max(1, max_runs // len(cells) ** listed_count)
        for group in _cell_groups(free_cells, room) if listed_count < len(open_robots) else ((),):
            split = dict.fromkeys(open_robots[listed_count : listed_count + 1], group)
            chunk = _build_chunk(
                study, cells_by_robot, dict.fromkeys(open_robots[:listed_count], free_cells) | split
            )
            if chunk.all:
                yield chunk


def _cell_groups(cells: Sequence[int], size: int) -> Iterator[Sequence[int]]:
    """Split the cells into groups for which a chunk has room besides the enumerated robots."""
    return (cells[start : start + size] for start in range(0, len(cells), size))


def _choose_cells(
    study: Study, robots: Sequence[int], used_cells: tuple[int, ...]
) -> Iterator[tuple[int, ...]]:
    """Yield different unused cells for some robots."""
    if not robots:
        yield ()
        return
    for cell in study.grid.cells:
        if cell not in used_cells:
            for other_cells in _choose_cells(study, robots[1:], (*used_cells, cell)):
                yield (cell, *other_cells)


def _build_chunk(
    study: Study, fixed_cells: Mapping[int, int], open_cells: Mapping[int, Sequence[int]]
) -> RunSpace[int]:
    """Return the starts with some robots in fixed cells, and others in any of their cells."""
    sizes = [len(cells) for cells in open_cells.values()]
    every_run = (1 << prod(sizes)) - 1
    starts = [[0] * study.grid.size for _ in study.robots]
    for robot, cell in fixed_cells.items():
        starts[robot][cell] = every_run
    for (robot, cells), patterns in zip(open_cells.items(), digit_patterns(sizes), strict=True):
        for cell, runs in zip(cells, patterns, strict=True):
            starts[robot][cell] = runs
    valid_runs = starts_without_collision(starts, every_run)
    return RunSpace(
        valid_runs,
        0,
        tuple(tuple(run_set & valid_runs for run_set in robot) for robot in starts),
        difference,
    )


def pick_start(runs: RunSpace[P], runs_of_interest: P) -> tuple[int, ...]:
    """Return the cells in which the robots start in one of the runs."""
    cells: list[int] = []
    remaining = runs_of_interest
    for robot in runs.starts:
        cell = next(
            cell_number
            for cell_number, run_set in enumerate(robot)
            if remaining & run_set != runs.none
        )
        remaining = remaining & robot[cell]
        cells.append(cell)
    return tuple(cells)


MAX_DIAGRAM_MEMORY = 4 << 30
"""Bytes that the diagrams may take."""


def symbolic_starts(study: Study, limits: Limits | None = None) -> tuple[RunSpace[Node], int]:
    """Return all admissible starts as decision diagrams, and their number."""
    manager = Manager(limits=limits or Limits(memory=MAX_DIAGRAM_MEMORY))
    size = study.grid.size
    width = max(1, (size - 1).bit_length())
    names = [[f"s{robot}_{bit}" for bit in range(width)] for robot in range(len(study.robots))]
    manager.declare([bit for bits_of_robot in names for bit in bits_of_robot])
    starts = [
        [_starts_in_cell(manager, study, robot, cell, bits) for cell in range(size)]
        for robot, bits in enumerate(names)
    ]
    valid_starts = manager.true
    for robot in starts:
        is_placed = manager.false
        for start_set in robot:
            is_placed = is_placed | start_set
        valid_starts = valid_starts & is_placed
    for cell in range(size):
        occupied = manager.false
        for robot in starts:
            valid_starts = valid_starts & ~(occupied & robot[cell])
            occupied = occupied | robot[cell]
    valid_sets = tuple(
        tuple(start_set & valid_starts for start_set in bits_of_robot) for bits_of_robot in starts
    )
    runs = RunSpace(valid_starts, manager.false, valid_sets, _difference)
    return runs, manager.count(
        valid_starts, [bit for bits_of_robot in names for bit in bits_of_robot]
    )


def _difference(minuend: Node, subtrahend: Node) -> Node:
    return minuend & ~subtrahend


def _starts_in_cell(manager: Manager, study: Study, robot: int, cell: int, bits: list[str]) -> Node:
    """Return the diagram of a robot's start in a cell; false if the robot cannot start there."""
    start = study.robots[robot].start
    if cell in study.grid.blocked or start not in (None, cell):
        return manager.false
    return manager.cube({bit: bool(cell >> index & 1) for index, bit in enumerate(bits)})
