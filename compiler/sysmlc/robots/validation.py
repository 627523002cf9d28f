"""The mission in some runs, step by step, until it is done everywhere or something is wrong."""

from collections.abc import Callable, Iterator, Sequence
from functools import partial
from itertools import islice
from typing import Generic

from msgspec import Struct

from sysmlc.robots.answers import Answers
from sysmlc.robots.merging import Batch, States
from sysmlc.robots.run_sets import P
from sysmlc.robots.starts import MAX_CHUNK_RUNS, count_starts, iter_start_chunks, pick_start
from sysmlc.robots.study import Study
from sysmlc.robots.world import Allocation, World

MAX_STEPS = 1_000
"""Steps after which a mission without a deadline is given up."""


class Validation(Struct, frozen=True):
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
    is_slow: bool = False
    """Whether it is one that a robot has for longer than C_S allows."""

    @property
    def is_good(self) -> bool:
        """Whether the mission is done from every start."""
        return not self.failed


class Failure(Struct, Generic[P], frozen=True):
    """What goes wrong: in which runs, and which target is late."""

    runs: P
    late: int | None = None
    is_slow: bool = False
    """Whether a robot has that target for longer than C_S allows."""


class Simulation(Generic[P]):
    """Runs that are stepped together; ``reached`` has by target the last step it was reached in."""

    def __init__(self, world: World[P]) -> None:
        """The world may be one that has gone some steps."""
        self.world = world
        self.reached: list[int | None] = [None] * len(world.done)
        self._rested = 0

    def run(self, until: int | None = None) -> Failure[P] | None:
        """Step until all is done and all robots have rested, ``until`` some step, or to a failure.

        Robots have rested when each of them has had its turn to be shown a way and has stayed:
        from then on the run goes on for ever as it was.
        """
        known = list(self.world.done)
        while True:
            failure = self._failure()
            if failure is not None or self.is_over or self.world.time == until:
                return failure
            self.world.step()
            for number, done in enumerate(self.world.done):
                if done != known[number]:
                    self.reached[number], known[number] = self.world.time, done
            is_still = self.world.over == self.world.runs.all
            self._rested = self._rested + 1 if is_still else 0

    @property
    def is_over(self) -> bool:
        """Whether nothing new will happen in any of the runs."""
        return self._rested > len(self.world.bodies)

    def _failure(self) -> Failure[P] | None:
        """What is wrong by now."""
        world, runs = self.world, self.world.runs
        if world.wrong != runs.none:
            return Failure(world.wrong)
        for number, slow in enumerate(world.slow):
            if slow != runs.none:
                return Failure(slow, number, is_slow=True)
        study = world.study
        for number, target in enumerate(study.targets):
            left = runs.but(runs.all, world.done[number])
            limit = study.limit(target)
            if left != runs.none and world.time >= min(
                MAX_STEPS, MAX_STEPS if limit is None else limit
            ):
                return Failure(left, number)
        is_endless = world.time > MAX_STEPS + len(world.near)
        return Failure(runs.but(runs.all, world.over)) if is_endless else None


MAX_EXPLICIT_STARTS = 50_000_000
"""Starts up to which each has a bit of its own."""
FIRST_MERGE_STEP = 8
"""Steps after which states are first gone on with once: most robots are under way then. Later ones
are twice as far apart each time."""
MIN_MERGED_STARTS = 1 << 12
"""Starts up to which that costs more than it saves."""
_CHUNK_BITS = 32
"""Bits for the place in a chunk, in the number of a start."""


def validate_allocation(
    study: Study, allocation: Allocation, answers: Sequence[Answers]
) -> Validation:
    """Simulate the mission from all admissible starts; the first failure ends it."""
    if count_starts(study) > MAX_EXPLICIT_STARTS:
        return validate_symbolically(study, allocation, answers)
    return _ExplicitValidation(study, partial(World, study, allocation, answers)).run()


def validate_symbolically(
    study: Study, allocation: Allocation, answers: Sequence[Answers]
) -> Validation:
    """The same on decision diagrams over the cells in which robots start. Raises LimitError."""
    from sysmlc.robots.starts import symbolic_starts

    runs, number = symbolic_starts(study)
    simulation = Simulation(World(study, allocation, answers, runs))
    failure = simulation.run()
    failed = pick_start(runs, failure.runs) if failure else ()
    return _make_validation(number, simulation, simulation.reached, failure, failed)


def _make_validation(
    number: int,
    simulation: Simulation[P],
    reached: Sequence[int | None],
    failure: Failure[P] | None,
    failed: tuple[int, ...],
) -> Validation:
    known = (one for one in reached if one is not None)
    steps = simulation.world.time if failure else max(known, default=0)
    late = failure.late if failure else None
    is_slow = failure.is_slow if failure else False
    return Validation(number, steps, tuple(reached), failed, late, is_slow)


class _RunBatch(Struct, frozen=True):
    """Runs to be stepped together, and where they come from, by bit."""

    world: World[int]
    origins: Sequence[int]
    start: Callable[[int], tuple[int, ...]]
    """Where robots start in one of some runs."""


class _ExplicitValidation:
    """All starts with a bit each; after some steps all states with a bit each, and so on."""

    def __init__(self, study: Study, world: Callable[..., World[int]]) -> None:
        self.study, self.world = study, world
        self.number = 0
        self.reached: list[int | None] = [None] * len(study.targets)

    def run(self) -> Validation:
        """Step all parts to some step, then what they come to."""
        until = FIRST_MERGE_STEP if count_starts(self.study) > MIN_MERGED_STARTS else None
        parts = self._first()
        while True:
            states = States(len(self.study.robots))
            part = None
            for part in parts:
                found = self._stepped(part, until, states)
                if found is not None:
                    return found
            if part is None or not len(states) or until is None:
                known = (one for one in self.reached if one is not None)
                return Validation(self.number, max(known, default=0), tuple(self.reached))
            parts = self._later(states.batches(MAX_CHUNK_RUNS, part.world), until)
            until *= 2

    def _stepped(self, part: _RunBatch, until: int | None, states: States) -> Validation | None:
        """What fails; what is not over at that step is among the states."""
        simulation = Simulation(part.world)
        failure = simulation.run(until)
        pairs = zip(self.reached, simulation.reached, strict=True)
        self.reached = [old if new is None else max(old or 0, new) for old, new in pairs]
        if failure is not None:
            failed = part.start(failure.runs)
            starts = part.world.runs.all.bit_count()
            return _make_validation(starts, simulation, self.reached, failure, failed)
        if not simulation.is_over:
            states.add(part.world, part.origins)
        return None

    def _first(self) -> Iterator[_RunBatch]:
        for at, runs in enumerate(iter_start_chunks(self.study, MAX_CHUNK_RUNS)):
            self.number += runs.all.bit_count()
            base = at << _CHUNK_BITS
            origins = range(base, base + runs.all.bit_length())
            yield _RunBatch(self.world(runs), origins, partial(pick_start, runs))

    def _later(self, batches: Iterator[Batch], time: int) -> Iterator[_RunBatch]:
        for one in batches:
            start = partial(self._start, one.origins)
            yield _RunBatch(self.world(one.runs, one.state, time), one.origins, start)

    def _start(self, origins: Sequence[int], some: int) -> tuple[int, ...]:
        """Where robots start in a run that came to one of some states."""
        origin = origins[(some & -some).bit_length() - 1]
        at = origin >> _CHUNK_BITS
        runs = next(islice(iter_start_chunks(self.study, MAX_CHUNK_RUNS), at, None))
        return pick_start(runs, 1 << (origin - (at << _CHUNK_BITS)))
