"""When targets are reached, for lists of targets by robot and known travel times."""

from collections.abc import Iterator, Sequence
from itertools import pairwise

from msgspec import Struct

from sysmlc.robots.study import Study
from sysmlc.robots.travel import START, Travel
from sysmlc.robots.world import Allocation


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


def scheduled(study: Study, travel: Travel, allocation: Allocation) -> Schedule | None:
    """The times of an allocation; None when it cannot be done in the order that is asked for."""
    if not keeps_orders(study, allocation):
        return None
    reached: dict[int, int] = {}
    total = 0
    left = [list(own) for own in allocation]
    at = [(START, 0)] * len(allocation)
    while any(left):
        ready = next(_ready(study, left, reached), None)
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


def _ready(study: Study, left: Sequence[Sequence[int]], reached: dict[int, int]) -> Iterator[int]:
    """Robots whose next target waits for no other."""
    for robot, own in enumerate(left):
        if own and all(one in reached for one in study.earlier(own[0])):
            yield robot


def keeps_orders(study: Study, allocation: Allocation) -> bool:
    """Whether every target is reached once, and what is carried is carried by one robot."""
    given = sorted(target for own in allocation for target in own)
    if given != list(range(len(study.targets))):
        return False
    following = {one: other for own in allocation for one, other in pairwise(own)}
    return all(following.get(one) == later for one, later in study.carried.items())


def in_time(study: Study, schedule: Schedule) -> bool:
    """Whether all deadlines are kept if no robot has to wait for its way."""
    pairs = zip(study.targets, schedule.reached, strict=True)
    limits = ((study.limit(target), step) for target, step in pairs)
    return all(limit is None or step <= limit for limit, step in limits)
