"""When targets are reached, for lists of targets by robot and known travel times."""

from collections.abc import Iterator, Mapping, Sequence
from itertools import pairwise

from msgspec import Struct

from sysmlc.robots.study import Study, possible_starts
from sysmlc.robots.world import Allocation

START = -1
"""The place of a robot that has reached no target yet; other places are numbers of targets."""
REACTION = 2
"""Steps in which a robot that has a new target does not move yet: the one in which it learns of
it, and stays because it was in its last target, and the one in which its first command is given."""


class TravelTimes(Struct, frozen=True):
    """Steps by (robot, place, target), all numbers; what is not there cannot be reached."""

    steps: Mapping[tuple[int, int, int], int]
    is_simulated: bool = False
    """Whether they were measured in the simulation of synthesised robots."""

    def get(self, robot: int, place: int, target: int) -> int | None:
        """The steps of one way; None when no way leads there."""
        return self.steps.get((robot, place, target))

    @property
    def longest(self) -> int:
        """The steps of the longest way, at least 1."""
        return max(self.steps.values(), default=1)


def shortest_travel_times(study: Study) -> TravelTimes:
    """The steps that a robot needs when nothing is in its way."""
    found: dict[tuple[int, int, int], int] = {}
    for robot in range(len(study.robots)):
        places = {START: possible_starts(study, robot)}
        places |= {at: (target.cell,) for at, target in enumerate(study.targets)}
        for place, cells in places.items():
            for goal, target in enumerate(study.targets):
                known = study.grid.distances(target.cell)
                if goal != place and all(cell in known for cell in cells):
                    way = max((known[cell] for cell in cells), default=0)
                    found[robot, place, goal] = way + REACTION if way else 1
    return TravelTimes(found)


class Schedule(Struct, frozen=True):
    """An allocation with the steps in which its targets are reached when no robot waits for way."""

    allocation: Allocation
    reached: tuple[int, ...]
    """By target."""
    total: int
    """Steps that all robots travel."""

    @property
    def duration(self) -> int:
        """Steps of the mission."""
        return max(self.reached, default=0)

    @property
    def cost(self) -> tuple[int, int]:
        """What is to be least: the duration, then what all robots travel."""
        return self.duration, self.total


def build_schedule(study: Study, travel: TravelTimes, allocation: Allocation) -> Schedule | None:
    """The times of an allocation; None when it cannot be done in the order that is asked for."""
    if not respects_orders(study, allocation):
        return None
    reached: dict[int, int] = {}
    total = 0
    left = [list(own) for own in allocation]
    at = [(START, 0)] * len(allocation)
    while any(left):
        ready = next(_ready_robots(study, left, reached), None)
        if ready is None:
            return None
        target = left[ready].pop(0)
        place, free_at = at[ready]
        steps = travel.get(ready, place, target)
        if steps is None:
            return None
        begun = max(free_at, *(reached[one] for one in study.earlier(target)), 0)
        total += steps
        reached[target] = begun + steps
        at[ready] = target, begun + steps
    return Schedule(allocation, tuple(reached[one] for one in sorted(reached)), total)


def _ready_robots(
    study: Study, left: Sequence[Sequence[int]], reached: dict[int, int]
) -> Iterator[int]:
    """Robots whose next target waits for no other."""
    for robot, own in enumerate(left):
        if own and all(one in reached for one in study.earlier(own[0])):
            yield robot


def respects_orders(study: Study, allocation: Allocation) -> bool:
    """Whether every target is reached once, and what is carried is carried by one robot."""
    given = sorted(target for own in allocation for target in own)
    if given != list(range(len(study.targets))):
        return False
    following = {one: other for own in allocation for one, other in pairwise(own)}
    return all(following.get(one) == later for one, later in study.carried.items())


def meets_deadlines(study: Study, schedule: Schedule) -> bool:
    """Whether all deadlines are kept if no robot has to wait for its way."""
    pairs = zip(study.targets, schedule.reached, strict=True)
    limits = ((study.limit(target), step) for target, step in pairs)
    return all(limit is None or step <= limit for limit, step in limits)
