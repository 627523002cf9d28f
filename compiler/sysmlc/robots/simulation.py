"""The mission in some runs, step by step, until it is done everywhere or something is wrong."""

from typing import Generic

from msgspec import Struct

from sysmlc.robots.planes import P
from sysmlc.robots.world import World

STEPS = 1_000
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
            if left != runs.none and world.time >= min(STEPS, STEPS if limit is None else limit):
                return Failure(left, number)
        is_endless = world.time > STEPS + len(world.near)
        return Failure(runs.but(runs.all, world.over)) if is_endless else None
