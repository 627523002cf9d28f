"""Validation of a mission: robots and environment are simulated from every admissible start.

Thousands of starts are simulated in one operation (``run_sets``), and states that many of them
reach are continued once (``merging``). If the starts are too many to enumerate, the same steps are
computed on decision diagrams over the starts (MOOD4I thesis, 4.4.3).
"""

from collections.abc import Callable, Iterator, Sequence
from functools import partial
from itertools import islice
from typing import Generic

from msgspec import Struct

from sysmlc.robots.answers import Answers
from sysmlc.robots.merging import Batch, StateSet
from sysmlc.robots.run_sets import P
from sysmlc.robots.starts import (
    MAX_CHUNK_RUNS,
    count_starts,
    iter_start_chunks,
    pick_start,
    symbolic_starts,
)
from sysmlc.robots.study import Study
from sysmlc.robots.world import Allocation, World

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
