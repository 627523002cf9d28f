"""Whether robots and environment together do the mission, from every admissible start.

All starts are simulated, thousands in one operation (``planes``), and states that many of them
come to are gone on with once (``merging``); where there are too many to list them, the same steps
are computed on decision diagrams over the starts (MOOD4I thesis, 4.4.3).
"""

from collections.abc import Callable, Iterator, Sequence
from functools import partial
from itertools import islice

from msgspec import Struct

from sysmlc.robots.answers import Answers
from sysmlc.robots.merging import Batch, States
from sysmlc.robots.planes import P
from sysmlc.robots.simulation import Failure, Simulation, Validation
from sysmlc.robots.starts import CHUNK, chunks, count, first_of
from sysmlc.robots.study import Study
from sysmlc.robots.world import Allocation, World

MOST_LISTED = 50_000_000
"""Starts up to which each has a bit of its own."""
MERGED = 8
"""Steps after which states are first gone on with once: most robots are under way then. Later ones
are twice as far apart each time."""
FEW = 1 << 12
"""Starts up to which that costs more than it saves."""
_SHIFT = 32
"""Bits for the place in a chunk, in the number of a start."""


def validate(study: Study, allocation: Allocation, answers: Sequence[Answers]) -> Validation:
    """Simulate the mission from all admissible starts; the first failure ends it."""
    if count(study) > MOST_LISTED:
        return symbolic(study, allocation, answers)
    return _Listed(study, partial(World, study, allocation, answers)).run()


def symbolic(study: Study, allocation: Allocation, answers: Sequence[Answers]) -> Validation:
    """The same on decision diagrams over the cells in which robots start. Raises LimitError."""
    from sysmlc.robots.diagrams import started

    runs, number = started(study)
    simulation = Simulation(World(study, allocation, answers, runs))
    failure = simulation.run()
    failed = first_of(runs, failure.runs) if failure else ()
    return _validation(number, simulation, simulation.reached, failure, failed)


def _validation(
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


class _Part(Struct, frozen=True):
    """Runs to be stepped together, and where they come from, by bit."""

    world: World[int]
    origins: Sequence[int]
    start: Callable[[int], tuple[int, ...]]
    """Where robots start in one of some runs."""


class _Listed:
    """All starts with a bit each; after some steps all states with a bit each, and so on."""

    def __init__(self, study: Study, world: Callable[..., World[int]]) -> None:
        self.study, self.world = study, world
        self.number = 0
        self.reached: list[int | None] = [None] * len(study.targets)

    def run(self) -> Validation:
        """Step all parts to some step, then what they come to."""
        until = MERGED if count(self.study) > FEW else None
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
            parts = self._later(states.batches(CHUNK, part.world), until)
            until *= 2

    def _stepped(self, part: _Part, until: int | None, states: States) -> Validation | None:
        """What fails; what is not over at that step is among the states."""
        simulation = Simulation(part.world)
        failure = simulation.run(until)
        pairs = zip(self.reached, simulation.reached, strict=True)
        self.reached = [old if new is None else max(old or 0, new) for old, new in pairs]
        if failure is not None:
            failed = part.start(failure.runs)
            starts = part.world.runs.all.bit_count()
            return _validation(starts, simulation, self.reached, failure, failed)
        if not simulation.is_over:
            states.add(part.world, part.origins)
        return None

    def _first(self) -> Iterator[_Part]:
        for at, runs in enumerate(chunks(self.study, CHUNK)):
            self.number += runs.all.bit_count()
            base = at << _SHIFT
            origins = range(base, base + runs.all.bit_length())
            yield _Part(self.world(runs), origins, partial(first_of, runs))

    def _later(self, batches: Iterator[Batch], time: int) -> Iterator[_Part]:
        for one in batches:
            start = partial(self._start, one.origins)
            yield _Part(self.world(one.runs, one.state, time), one.origins, start)

    def _start(self, origins: Sequence[int], some: int) -> tuple[int, ...]:
        """Where robots start in a run that came to one of some states."""
        origin = origins[(some & -some).bit_length() - 1]
        at = origin >> _SHIFT
        runs = next(islice(chunks(self.study, CHUNK), at, None))
        return first_of(runs, 1 << (origin - (at << _SHIFT)))
