"""Validation of a mission: robots and environment are simulated from every admissible start.

Thousands of starts are simulated at once as sets of bits (``run_sets``), in chunks of limited size.
Runs that have reached the same state are continued as one (``merging``). If the starts are too many
to enumerate, the same steps are computed on decision diagrams over the starts. (MOOD4I thesis,
4.4.3)
"""

from collections.abc import Callable, Iterator, Mapping, Sequence
from functools import partial
from itertools import islice
from math import prod
from typing import Generic

from msgspec import Struct

from sysmlc.robots.answers import Answers
from sysmlc.robots.merging import Batch, StateSet
from sysmlc.robots.run_sets import P, RunSpace, difference, digit_patterns, starts_without_collision
from sysmlc.robots.study import Study, possible_starts
from sysmlc.robots.world import Allocation, World
from sysmlc.synthesis import Limits, Manager, Node

MAX_STEPS = 1_000
"""Steps after which a mission without a deadline fails."""
MAX_CHUNK_RUNS = 1 << 17
"""Number of runs that are simulated at once: larger sets do not fit into the processor's cache."""


class Validation(Struct, frozen=True):
    """The result of simulating all admissible starts."""

    starts: int
    """Number of admissible starts."""
    steps: int
    """Steps of the longest mission, or of the failed one."""
    reached: tuple[int | None, ...]
    """For each target, the latest step in which a run reached it; None if no run did."""
    failed: tuple[int, ...] = ()
    """A start from which the mission fails, as a cell for each robot; empty if there is none."""
    late: int | None = None
    """The target that was not reached in time; None if robots met or had no answer."""
    is_slow: bool = False
    """Whether a robot had the late target for longer than C_S allows (``Study.within``)."""

    @property
    def is_good(self) -> bool:
        """Whether the mission succeeds from every start."""
        return not self.failed


class Failure(Struct, Generic[P], frozen=True):
    """A failure of a simulated mission."""

    runs: P
    """The runs in which it occurs."""
    late: int | None = None
    """The late target; None if robots met or had no answer."""
    is_slow: bool = False
    """Whether a robot had that target for longer than C_S allows."""


class Simulation(Generic[P]):
    """The simulation of many runs together, until they end or fail."""

    def __init__(self, world: World[P]) -> None:
        """Continue *world*, which may already have been simulated for some steps."""
        self.world = world
        self.reached: list[int | None] = [None] * len(world.done)
        """For each target, the latest step in which a run reached it."""
        self._rested_steps = 0

    def run(self, until: int | None = None) -> Failure[P] | None:
        """Simulate until all runs are over, or until step *until*. Return the first failure."""
        done_before = list(self.world.done)
        while True:
            failure = self._find_failure()
            if failure is not None or self.is_over or self.world.time == until:
                return failure
            self.world.step()
            for number, done in enumerate(self.world.done):
                if done != done_before[number]:
                    self.reached[number], done_before[number] = self.world.time, done
            is_still = self.world.finished == self.world.runs.all
            self._rested_steps = self._rested_steps + 1 if is_still else 0

    @property
    def is_over(self) -> bool:
        """Whether all runs only repeat themselves from now on."""
        # After the mission each robot is offered a cell in its turn and stays. When all have had
        # their turns, the same steps follow again.
        return self._rested_steps > len(self.world.bodies)

    def _find_failure(self) -> Failure[P] | None:
        """Return a failure in the current step, or None."""
        world, runs = self.world, self.world.runs
        if world.wrong != runs.none:
            return Failure(world.wrong)
        for number, slow in enumerate(world.exceeds_limit):
            if slow != runs.none:
                return Failure(slow, number, is_slow=True)
        study = world.study
        for number, target in enumerate(study.targets):
            open_runs = runs.without(runs.all, world.done[number])
            limit = study.limit(target)
            if open_runs != runs.none and world.time >= min(
                MAX_STEPS, MAX_STEPS if limit is None else limit
            ):
                return Failure(open_runs, number)
        is_endless = world.time > MAX_STEPS + len(world.neighbours)
        return Failure(runs.without(runs.all, world.finished)) if is_endless else None


MAX_EXPLICIT_STARTS = 50_000_000
"""Number of starts above which decision diagrams replace sets of bits."""
FIRST_MERGE_STEP = 8
"""Step after which runs in equal states are first merged, as most robots are on their way then.
Each later merge takes place after twice the number of steps."""
MIN_MERGED_STARTS = 1 << 12
"""Number of starts up to which runs are not merged: one merge takes as long as five steps."""
_CHUNK_BITS = 32
"""A start is numbered by its chunk and its bit in the chunk; these are the bits for the latter."""


def validate_allocation(
    study: Study, allocation: Allocation, answers: Sequence[Answers]
) -> Validation:
    """Simulate the mission from all admissible starts until it is over or fails somewhere."""
    if _count_starts(study) > MAX_EXPLICIT_STARTS:
        return validate_symbolically(study, allocation, answers)
    return _ExplicitValidation(study, partial(World, study, allocation, answers)).run()


def validate_symbolically(
    study: Study, allocation: Allocation, answers: Sequence[Answers]
) -> Validation:
    """Validate with sets of runs as decision diagrams over the starts. Raises LimitError."""
    runs, start_count = symbolic_starts(study)
    simulation = Simulation(World(study, allocation, answers, runs))
    failure = simulation.run()
    failed = _pick_start(runs, failure.runs) if failure else ()
    return _make_validation(start_count, simulation, simulation.reached, failure, failed)


def _make_validation(
    start_count: int,
    simulation: Simulation[P],
    reached: Sequence[int | None],
    failure: Failure[P] | None,
    failed: tuple[int, ...],
) -> Validation:
    reached_steps = (step for step in reached if step is not None)
    steps = simulation.world.time if failure else max(reached_steps, default=0)
    late = failure.late if failure else None
    is_slow = failure.is_slow if failure else False
    return Validation(start_count, steps, tuple(reached), failed, late, is_slow)


class _RunBatch(Struct, frozen=True):
    """Runs to simulate together."""

    world: World[int]
    origins: Sequence[int]
    """For each bit, the number of a start that leads to the run."""
    start: Callable[[int], tuple[int, ...]]
    """Returns the start of one run of a set, as a cell for each robot."""


class _ExplicitValidation:
    """The validation with a bit for each start, and after each merge a bit for each state."""

    def __init__(self, study: Study, create_world: Callable[..., World[int]]) -> None:
        self.study, self.create_world = study, create_world
        self.start_count = 0
        self.reached: list[int | None] = [None] * len(study.targets)

    def run(self) -> Validation:
        """Simulate all batches up to a step, then merge the reached states into new batches."""
        until = FIRST_MERGE_STEP if _count_starts(self.study) > MIN_MERGED_STARTS else None
        batches = self._first_batches()
        while True:
            states = StateSet(len(self.study.robots))
            batch = None
            for batch in batches:
                failure_result = self._run_batch(batch, until, states)
                if failure_result is not None:
                    return failure_result
            if batch is None or not len(states) or until is None:
                reached_steps = (step for step in self.reached if step is not None)
                return Validation(
                    self.start_count, max(reached_steps, default=0), tuple(self.reached)
                )
            batches = self._next_batches(states.batches(MAX_CHUNK_RUNS, batch.world), until)
            until *= 2

    def _run_batch(
        self, batch: _RunBatch, until: int | None, states: StateSet
    ) -> Validation | None:
        """Simulate a batch. Return its failure, or add its unfinished runs to *states*."""
        simulation = Simulation(batch.world)
        failure = simulation.run(until)
        pairs = zip(self.reached, simulation.reached, strict=True)
        self.reached = [
            earlier if later is None else max(earlier or 0, later) for earlier, later in pairs
        ]
        if failure is not None:
            failed = batch.start(failure.runs)
            starts = batch.world.runs.all.bit_count()
            return _make_validation(starts, simulation, self.reached, failure, failed)
        if not simulation.is_over:
            states.add(batch.world, batch.origins)
        return None

    def _first_batches(self) -> Iterator[_RunBatch]:
        for chunk_number, runs in enumerate(iter_start_chunks(self.study, MAX_CHUNK_RUNS)):
            self.start_count += runs.all.bit_count()
            base = chunk_number << _CHUNK_BITS
            origins = range(base, base + runs.all.bit_length())
            yield _RunBatch(self.create_world(runs), origins, partial(_pick_start, runs))

    def _next_batches(self, batches: Iterator[Batch], time: int) -> Iterator[_RunBatch]:
        for batch in batches:
            start = partial(self._find_start, batch.origins)
            world = self.create_world(batch.runs, batch.state, time)
            yield _RunBatch(world, batch.origins, start)

    def _find_start(self, origins: Sequence[int], states: int) -> tuple[int, ...]:
        """Return the start of a run that has reached one of *states*."""
        # The lowest set bit of the set of states.
        origin = origins[(states & -states).bit_length() - 1]
        chunk_number = origin >> _CHUNK_BITS
        runs = next(islice(iter_start_chunks(self.study, MAX_CHUNK_RUNS), chunk_number, None))
        return _pick_start(runs, 1 << (origin - (chunk_number << _CHUNK_BITS)))


# -- admissible starts -------------------------------------------------------------------------


def _count_starts(study: Study) -> int:
    """Return the number of starts, including those with two robots in one cell."""
    return prod(len(possible_starts(study, robot)) for robot in range(len(study.robots)))


def iter_start_chunks(study: Study, max_runs: int = MAX_CHUNK_RUNS) -> Iterator[RunSpace[int]]:
    """Yield all starts in chunks of at most about *max_runs* runs."""
    # The first robots without a start may be in any cell within a chunk. The next one may be in a
    # group of cells, as many as fit into the chunk, and the last ones are in fixed cells.
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
    """Split the cells into groups of *size* cells."""
    return (cells[start : start + size] for start in range(0, len(cells), size))


def _choose_cells(
    study: Study, robots: Sequence[int], used_cells: tuple[int, ...]
) -> Iterator[tuple[int, ...]]:
    """Yield all combinations of different unused cells for some robots."""
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
    """Return the starts with some robots in fixed cells, and others in any of their open cells."""
    # The number of a run, written in digits of different bases, gives the cells of the open robots.
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


def _pick_start(runs: RunSpace[P], runs_of_interest: P) -> tuple[int, ...]:
    """Return the start of one run of a set, as a cell for each robot."""
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
"""Memory limit for decision diagrams over starts, in bytes."""


def symbolic_starts(study: Study, limits: Limits | None = None) -> tuple[RunSpace[Node], int]:
    """Return the run space of all admissible starts as decision diagrams, and their number."""
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
