"""The admissible starts of robots, a bit for each, in chunks that are not too large."""

from collections.abc import Iterator, Mapping, Sequence
from math import prod

from sysmlc.robots.planes import P, Runs, apart, but, patterns
from sysmlc.robots.study import Study
from sysmlc.robots.travel import starts_of

CHUNK = 1 << 17
"""Runs in one operation: more do not fit into fast memory."""


def count(study: Study) -> int:
    """Starts, those with two robots in one cell among them."""
    return prod(len(starts_of(study, robot)) for robot in range(len(study.robots)))


def chunks(study: Study, most: int = CHUNK) -> Iterator[Runs[int]]:
    """All starts in chunks that are not too large: the last robots' cells are fixed in each, and
    those of the one before them are a few."""
    cells = study.grid.cells
    fixed = {at: one.start for at, one in enumerate(study.robots) if one.start is not None}
    open_ = [at for at in range(len(study.robots)) if at not in fixed]
    listed = 0
    while listed < len(open_) and len(cells) ** (listed + 1) <= most:
        listed += 1
    for chosen in _choices(study, open_[listed + 1 :], tuple(fixed.values())):
        here = fixed | dict(zip(open_[listed + 1 :], chosen, strict=True))
        left = tuple(cell for cell in cells if cell not in here.values())
        room = max(1, most // len(cells) ** listed)
        for group in _groups(left, room) if listed < len(open_) else ((),):
            split = dict.fromkeys(open_[listed : listed + 1], group)
            chunk = _chunk(study, here, dict.fromkeys(open_[:listed], left) | split)
            if chunk.all:
                yield chunk


def _groups(cells: Sequence[int], room: int) -> Iterator[Sequence[int]]:
    """The cells in groups, as many as a chunk has room for beside the robots that are listed."""
    return (cells[at : at + room] for at in range(0, len(cells), room))


def _choices(
    study: Study, robots: Sequence[int], taken: tuple[int, ...]
) -> Iterator[tuple[int, ...]]:
    """Different cells for some robots, none of those that are taken."""
    if not robots:
        yield ()
        return
    for cell in study.grid.cells:
        if cell not in taken:
            for rest in _choices(study, robots[1:], (*taken, cell)):
                yield (cell, *rest)


def _chunk(study: Study, fixed: Mapping[int, int], open_: Mapping[int, Sequence[int]]) -> Runs[int]:
    """The starts with some robots in their cells, and others in any of theirs."""
    sizes = [len(cells) for cells in open_.values()]
    whole = (1 << prod(sizes)) - 1
    starts = [[0] * study.grid.size for _ in study.robots]
    for robot, cell in fixed.items():
        starts[robot][cell] = whole
    for (robot, cells), digit in zip(open_.items(), patterns(sizes), strict=True):
        for cell, bits in zip(cells, digit, strict=True):
            starts[robot][cell] = bits
    valid = apart(starts, whole)
    return Runs(valid, 0, tuple(tuple(one & valid for one in robot) for robot in starts), but)


def first_of(runs: Runs[P], some: P) -> tuple[int, ...]:
    """Where the robots start in one of some runs."""
    found: list[int] = []
    left = some
    for robot in runs.starts:
        cell = next(at for at, one in enumerate(robot) if left & one != runs.none)
        left = left & robot[cell]
        found.append(cell)
    return tuple(found)
