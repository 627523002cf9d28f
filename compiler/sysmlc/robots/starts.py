"""The admissible starts of robots, a bit for each, in chunks that are not too large."""

from collections.abc import Iterator, Mapping, Sequence
from math import prod

from sysmlc.robots.run_sets import P, RunSpace, difference, digit_patterns, starts_without_collision
from sysmlc.robots.study import Study, possible_starts
from sysmlc.synthesis import Limits, Manager, Node

MAX_CHUNK_RUNS = 1 << 17
"""Runs in one operation: more do not fit into fast memory."""


def count_starts(study: Study) -> int:
    """Starts, those with two robots in one cell among them."""
    return prod(len(possible_starts(study, robot)) for robot in range(len(study.robots)))


def iter_start_chunks(study: Study, most: int = MAX_CHUNK_RUNS) -> Iterator[RunSpace[int]]:
    """All starts in chunks that are not too large: the last robots' cells are fixed in each, and
    those of the one before them are a few."""
    cells = study.grid.cells
    fixed = {at: one.start for at, one in enumerate(study.robots) if one.start is not None}
    open_ = [at for at in range(len(study.robots)) if at not in fixed]
    listed = 0
    while listed < len(open_) and len(cells) ** (listed + 1) <= most:
        listed += 1
    for chosen in _choose_cells(study, open_[listed + 1 :], tuple(fixed.values())):
        here = fixed | dict(zip(open_[listed + 1 :], chosen, strict=True))
        left = tuple(cell for cell in cells if cell not in here.values())
        room = max(1, most // len(cells) ** listed)
        for group in _cell_groups(left, room) if listed < len(open_) else ((),):
            split = dict.fromkeys(open_[listed : listed + 1], group)
            chunk = _build_chunk(study, here, dict.fromkeys(open_[:listed], left) | split)
            if chunk.all:
                yield chunk


def _cell_groups(cells: Sequence[int], room: int) -> Iterator[Sequence[int]]:
    """The cells in groups, as many as a chunk has room for beside the robots that are listed."""
    return (cells[at : at + room] for at in range(0, len(cells), room))


def _choose_cells(
    study: Study, robots: Sequence[int], taken: tuple[int, ...]
) -> Iterator[tuple[int, ...]]:
    """Different cells for some robots, none of those that are taken."""
    if not robots:
        yield ()
        return
    for cell in study.grid.cells:
        if cell not in taken:
            for rest in _choose_cells(study, robots[1:], (*taken, cell)):
                yield (cell, *rest)


def _build_chunk(
    study: Study, fixed: Mapping[int, int], open_: Mapping[int, Sequence[int]]
) -> RunSpace[int]:
    """The starts with some robots in their cells, and others in any of theirs."""
    sizes = [len(cells) for cells in open_.values()]
    whole = (1 << prod(sizes)) - 1
    starts = [[0] * study.grid.size for _ in study.robots]
    for robot, cell in fixed.items():
        starts[robot][cell] = whole
    for (robot, cells), digit in zip(open_.items(), digit_patterns(sizes), strict=True):
        for cell, bits in zip(cells, digit, strict=True):
            starts[robot][cell] = bits
    valid = starts_without_collision(starts, whole)
    return RunSpace(
        valid, 0, tuple(tuple(one & valid for one in robot) for robot in starts), difference
    )


def pick_start(runs: RunSpace[P], some: P) -> tuple[int, ...]:
    """Where the robots start in one of some runs."""
    found: list[int] = []
    left = some
    for robot in runs.starts:
        cell = next(at for at, one in enumerate(robot) if left & one != runs.none)
        left = left & robot[cell]
        found.append(cell)
    return tuple(found)


MAX_DIAGRAM_MEMORY = 4 << 30
"""Bytes that the diagrams may take."""


def symbolic_starts(study: Study, limits: Limits | None = None) -> tuple[RunSpace[Node], int]:
    """All admissible starts, and how many there are."""
    manager = Manager(limits=limits or Limits(memory=MAX_DIAGRAM_MEMORY))
    size = study.grid.size
    width = max(1, (size - 1).bit_length())
    names = [[f"s{robot}_{bit}" for bit in range(width)] for robot in range(len(study.robots))]
    manager.declare([bit for own in names for bit in own])
    starts = [
        [_starts_in_cell(manager, study, robot, cell, bits) for cell in range(size)]
        for robot, bits in enumerate(names)
    ]
    valid = manager.true
    for robot in starts:
        placed = manager.false
        for one in robot:
            placed = placed | one
        valid = valid & placed
    for cell in range(size):
        taken = manager.false
        for robot in starts:
            valid = valid & ~(taken & robot[cell])
            taken = taken | robot[cell]
    known = tuple(tuple(one & valid for one in own) for own in starts)
    runs = RunSpace(valid, manager.false, known, _difference)
    return runs, manager.count(valid, [bit for own in names for bit in own])


def _difference(one: Node, other: Node) -> Node:
    return one & ~other


def _starts_in_cell(manager: Manager, study: Study, robot: int, cell: int, bits: list[str]) -> Node:
    """That a robot starts in a cell; where it cannot, never."""
    start = study.robots[robot].start
    if cell in study.grid.blocked or start not in (None, cell):
        return manager.false
    return manager.cube({bit: bool(cell >> at & 1) for at, bit in enumerate(bits)})
