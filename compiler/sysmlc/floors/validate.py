"""Whether robots and environment together do the mission, from every admissible start.

All starts are simulated, thousands in one operation (``planes``); where there are too many to list
them, the same steps are computed on decision diagrams over the starts (MOOD4I thesis, 4.4.3).
"""

from collections.abc import Iterator, Mapping, Sequence
from math import prod
from typing import Generic

from sysmlc.floors.answers import Answers
from sysmlc.floors.planes import P, Runs, apart, but, patterns
from sysmlc.floors.study import Study
from sysmlc.floors.travel import starts_of
from sysmlc.floors.world import Allocation, World
from sysmlc.values import dataclass

CHUNK = 1 << 17
"""Runs in one operation: more do not fit into fast memory."""
MOST_LISTED = 50_000_000
"""Starts up to which each has a bit of its own."""
STEPS = 1_000
"""Steps after which a mission without a deadline is given up."""


@dataclass(frozen=True, slots=True)
class Validation:
    """What the simulation of all admissible starts came to."""

    starts: int
    """How many there are."""
    steps: int
    """Steps of the longest mission; of the failed one when there is one."""
    reached: tuple[int | None, ...]
    """By target the latest step in which it was reached; None when it was not."""
    failed: tuple[int, ...] = ()
    """The cells in which robots start when the mission fails; empty when it never does."""
    late: int | None = None
    """The target that was not reached in time; None when robots met or had no answer."""

    @property
    def is_good(self) -> bool:
        """Whether the mission is done from every start."""
        return not self.failed


def validate(study: Study, allocation: Allocation, answers: Sequence[Answers]) -> Validation:
    """Simulate the mission from all admissible starts; the first failure ends it."""
    if _count(study) > MOST_LISTED:
        return symbolic(study, allocation, answers)
    found: Validation | None = None
    for chunk in chunks(study):
        one = Simulation(study, allocation, answers, chunk).run()
        if not one.is_good:
            return one
        found = one if found is None else _both(found, one)
    return found or Validation(0, 0, (None,) * len(study.targets))


def symbolic(study: Study, allocation: Allocation, answers: Sequence[Answers]) -> Validation:
    """The same on decision diagrams over the cells in which robots start. Raises LimitError."""
    from sysmlc.floors.diagrams import started

    runs, count = started(study)
    return Simulation(study, allocation, answers, Chunk(runs, count)).run()


def _both(one: Validation, other: Validation) -> Validation:
    pairs = zip(one.reached, other.reached, strict=True)
    return Validation(
        one.starts + other.starts,
        max(one.steps, other.steps),
        tuple(max(left or 0, right or 0) for left, right in pairs),
    )


@dataclass(frozen=True, slots=True)
class Chunk(Generic[P]):
    """Some of the starts: how many, and where robots start in one of the runs of a condition."""

    runs: Runs[P]
    count: int


def _count(study: Study) -> int:
    """Starts, those with two robots in one cell among them."""
    return prod(len(starts_of(study, robot)) for robot in range(len(study.robots)))


def chunks(study: Study) -> Iterator[Chunk[int]]:
    """All starts in chunks that are not too large: the last robots' cells are fixed in each, and
    those of the one before them are a few."""
    cells = study.grid.cells
    fixed = {at: one.start for at, one in enumerate(study.robots) if one.start is not None}
    open_ = [at for at in range(len(study.robots)) if at not in fixed]
    listed = 0
    while listed < len(open_) and len(cells) ** (listed + 1) <= CHUNK:
        listed += 1
    for chosen in _choices(study, open_[listed + 1 :], tuple(fixed.values())):
        here = fixed | dict(zip(open_[listed + 1 :], chosen, strict=True))
        left = tuple(cell for cell in cells if cell not in here.values())
        for group in _groups(left, listed) if listed < len(open_) else ((),):
            split = dict.fromkeys(open_[listed : listed + 1], group)
            chunk = _chunk(study, here, dict.fromkeys(open_[:listed], left) | split)
            if chunk.count:
                yield chunk


def _groups(cells: Sequence[int], listed: int) -> Iterator[Sequence[int]]:
    """The cells in groups, as many as a chunk has room for beside the robots that are listed."""
    some = max(1, CHUNK // len(cells) ** listed)
    return (cells[at : at + some] for at in range(0, len(cells), some))


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


def _chunk(
    study: Study, fixed: Mapping[int, int], open_: Mapping[int, Sequence[int]]
) -> Chunk[int]:
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
    placed = tuple(tuple(one & valid for one in robot) for robot in starts)
    return Chunk(Runs(valid, 0, placed, but), valid.bit_count())


class Simulation(Generic[P]):
    """The mission in the runs of a chunk."""

    def __init__(
        self,
        study: Study,
        allocation: Allocation,
        answers: Sequence[Answers],
        chunk: Chunk[P],
    ) -> None:
        self.study, self.chunk = study, chunk
        self.world = World(study, allocation, answers, chunk.runs)
        self.reached: list[int | None] = [None] * len(study.targets)
        self.time = 0

    def run(self) -> Validation:
        """Step until all targets are reached in all runs, or something is wrong in one."""
        while True:
            failed = self._failed()
            if failed is not None:
                return failed
            if all(one is not None for one in self.reached):
                return self._made()
            self.world.step()
            self.time += 1

    def _failed(self) -> Validation | None:
        """What is wrong by now; notes what has been reached."""
        runs, world = self.chunk.runs, self.world
        if world.wrong != runs.none:
            return self._made(world.wrong)
        for number, target in enumerate(self.study.targets):
            left = runs.but(runs.all, world.done[number])
            if left == runs.none:
                if self.reached[number] is None:
                    self.reached[number] = self.time
                continue
            known = (self.study.deadline, target.deadline, STEPS)
            if self.time >= min(one for one in known if one is not None):
                return self._made(left, number)
        return None

    def _made(self, failing: P | None = None, late: int | None = None) -> Validation:
        failed = () if failing is None else self._start(failing)
        return Validation(self.chunk.count, self.time, tuple(self.reached), failed, late)

    def _start(self, failing: P) -> tuple[int, ...]:
        """Where the robots start in one of the failing runs."""
        found: list[int] = []
        left = failing
        for robot in self.chunk.runs.starts:
            cell = next(at for at, one in enumerate(robot) if left & one != self.chunk.runs.none)
            left = left & robot[cell]
            found.append(cell)
        return tuple(found)
