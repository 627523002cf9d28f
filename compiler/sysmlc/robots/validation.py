"""Validation of a mission: robots and environment are simulated from every admissible start.

Thousands of starts are simulated in one operation (``run_sets``), and states that many of them
reach are continued once (``merging``). The starts are sets of bits in chunks of limited size. If
they are too many to enumerate, the same steps are computed on decision diagrams over the starts
(MOOD4I thesis, 4.4.3).
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


class Validation(Struct, frozen=True):
    """The result of simulating all admissible starts."""

    starts: int
    """Number of admissible starts."""
    steps: int
    """Steps of the longest mission, or of the failed one."""
    reached: tuple[int | None, ...]
    """By target, the latest step in which it was reached; None if it was not."""
    failed: tuple[int, ...] = ()
    """The cells in which robots start if the mission fails; empty if it never fails."""
    late: int | None = None
    """The target that was not reached in time; None if robots met or had no answer."""
    is_slow: bool = False
    """Whether a robot has the late target for longer than C_S allows."""

    @property
    def is_good(self) -> bool:
        """Whether the mission is done from every start."""
        return not self.failed


class Failure(Struct, Generic[P], frozen=True):
    """A failure: the runs in which it occurs, and the late target."""

    runs: P
    late: int | None = None
    is_slow: bool = False
    """Whether a robot has that target for longer than C_S allows."""


class Simulation(Generic[P]):
    """Runs that are simulated together; ``reached`` is the last step in which each target was
    reached.
    """

    def __init__(self, world: World[P]) -> None:
        """The world may already have been simulated for some steps."""
        self.world = world
        self.reached: list[int | None] = [None] * len(world.done)
        self._rested = 0

    def run(self, until: int | None = None) -> Failure[P] | None:
        """Simulate until all is done and all robots have rested, until step *until*, or until a
        failure.

        Robots have rested if each of them was offered a cell in its turn and stayed: from then on
        the run repeats itself forever.
        """
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
            self._rested = self._rested + 1 if is_still else 0

    @property
    def is_over(self) -> bool:
        """Whether nothing new happens in any of the runs."""
        return self._rested > len(self.world.bodies)

    def _find_failure(self) -> Failure[P] | None:
        """Return the present failure, if there is one."""
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
"""Starts up to which each start has its own bit."""
FIRST_MERGE_STEP = 8
"""Step after which equal states are first merged: most robots are on their way then. The distance
to the next merge doubles each time."""
MIN_MERGED_STARTS = 1 << 12
"""Starts up to which merging costs more than it saves."""
_CHUNK_BITS = 32
"""Bits for the place in a chunk, in the number of a start."""


def validate_allocation(
    study: Study, allocation: Allocation, answers: Sequence[Answers]
) -> Validation:
    """Simulate the mission from all admissible starts; the first failure ends the simulation."""
    if count_starts(study) > MAX_EXPLICIT_STARTS:
        return validate_symbolically(study, allocation, answers)
    return _ExplicitValidation(study, partial(World, study, allocation, answers)).run()


def validate_symbolically(
    study: Study, allocation: Allocation, answers: Sequence[Answers]
) -> Validation:
    """Validate on decision diagrams over the starts of the robots. Raises LimitError."""
    runs, start_count = symbolic_starts(study)
    simulation = Simulation(World(study, allocation, answers, runs))
    failure = simulation.run()
    failed = pick_start(runs, failure.runs) if failure else ()
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
    """Runs to simulate together, and their origins by bit."""

    world: World[int]
    origins: Sequence[int]
    start: Callable[[int], tuple[int, ...]]
    """Returns the start of one of the runs."""


class _ExplicitValidation:
    """All starts with a bit each; later all states with a bit each, and so on."""

    def __init__(self, study: Study, world: Callable[..., World[int]]) -> None:
        self.study, self.world = study, world
        self.number = 0
        self.reached: list[int | None] = [None] * len(study.targets)

    def run(self) -> Validation:
        """Simulate all batches up to a step, then the states that they reached."""
        until = FIRST_MERGE_STEP if count_starts(self.study) > MIN_MERGED_STARTS else None
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
                return Validation(self.number, max(reached_steps, default=0), tuple(self.reached))
            batches = self._next_batches(states.batches(MAX_CHUNK_RUNS, batch.world), until)
            until *= 2

    def _run_batch(
        self, batch: _RunBatch, until: int | None, states: StateSet
    ) -> Validation | None:
        """Return the failure of a batch, if any; otherwise add its unfinished states."""
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
            self.number += runs.all.bit_count()
            base = chunk_number << _CHUNK_BITS
            origins = range(base, base + runs.all.bit_length())
            yield _RunBatch(self.world(runs), origins, partial(pick_start, runs))

    def _next_batches(self, batches: Iterator[Batch], time: int) -> Iterator[_RunBatch]:
        for batch in batches:
            start = partial(self._find_start, batch.origins)
            yield _RunBatch(self.world(batch.runs, batch.state, time), batch.origins, start)

    def _find_start(self, origins: Sequence[int], states: int) -> tuple[int, ...]:
        """Return the start of a run that reached one of the states."""
        origin = origins[(states & -states).bit_length() - 1]
        chunk_number = origin >> _CHUNK_BITS
        runs = next(islice(iter_start_chunks(self.study, MAX_CHUNK_RUNS), chunk_number, None))
        return pick_start(runs, 1 << (origin - (chunk_number << _CHUNK_BITS)))


# -- admissible starts -------------------------------------------------------------------------

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
