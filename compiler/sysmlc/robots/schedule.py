"""Travel times of robots (thesis, 4.3.4), and schedules, the times at which targets are reached."""

from collections.abc import Iterator, Mapping, Sequence
from itertools import pairwise

from msgspec import Struct

from sysmlc.robots.study import Study, possible_starts
from sysmlc.robots.world import Allocation

START = -1
"""The place of a robot that has not reached a target yet; other places are numbers of targets."""
REACTION = 2
"""Steps between the assignment of a target and the first move: in the first one the robot still
stays in its previous target (C_R), in the second one it gives its first command."""


class TravelTimes(Struct, frozen=True):
    """The steps of journeys, by the numbers of robot, place and target.

    Journeys to unreachable targets are missing.
    """

    steps: Mapping[tuple[int, int, int], int]
    is_simulated: bool = False
    """Whether the times were measured in a simulation of synthesised controllers."""

    def get(self, robot: int, place: int, target: int) -> int | None:
        """Return the steps of a robot from a place to a target, or None if there is no path."""
        return self.steps.get((robot, place, target))

    @property
    def longest(self) -> int:
        """The steps of the longest journey, at least 1."""
        return max(self.steps.values(), default=1)


def shortest_travel_times(study: Study) -> TravelTimes:
    """Return the steps that robots need if nothing is in their way."""
    steps: dict[tuple[int, int, int], int] = {}
    for robot in range(len(study.robots)):
        starts_by_place = {START: possible_starts(study, robot)}
        starts_by_place |= {number: (target.cell,) for number, target in enumerate(study.targets)}
        for place, cells in starts_by_place.items():
            for goal, target in enumerate(study.targets):
                distances = study.grid.distances(target.cell)
                if goal != place and all(cell in distances for cell in cells):
                    distance = max((distances[cell] for cell in cells), default=0)
                    steps[robot, place, goal] = distance + REACTION if distance else 1
    return TravelTimes(steps)


class Schedule(Struct, frozen=True):
    """An allocation with its times, if no robot has to make way for others."""

    allocation: Allocation
    reached: tuple[int, ...]
    """For each target, the step in which it is reached."""
    total: int
    """Steps that all robots travel."""

    @property
    def duration(self) -> int:
        """The step in which the last target is reached."""
        return max(self.reached, default=0)

    @property
    def cost(self) -> tuple[int, int]:
        """The cost to minimise: the duration, then the steps of all robots."""
        return self.duration, self.total


def build_schedule(study: Study, travel: TravelTimes, allocation: Allocation) -> Schedule | None:
    """Return the schedule of an allocation.

    None if the order of the targets makes the allocation impossible, or a target is unreachable.
    """
    if not respects_orders(study, allocation):
        return None
    reached: dict[int, int] = {}
    total = 0
    remaining = [list(targets) for targets in allocation]
    positions = [(START, 0)] * len(allocation)
    while any(remaining):
        robot = next(_ready_robots(study, remaining, reached), None)
        if robot is None:
            return None
        target = remaining[robot].pop(0)
        last_place, free_at = positions[robot]
        steps = travel.get(robot, last_place, target)
        if steps is None:
            return None
        start_time = max(
            free_at, *(reached[target_number] for target_number in study.earlier(target)), 0
        )
        total += steps
        reached[target] = start_time + steps
        positions[robot] = target, start_time + steps
    return Schedule(
        allocation, tuple(reached[target_number] for target_number in sorted(reached)), total
    )


def _ready_robots(
    study: Study, remaining: Sequence[Sequence[int]], reached: dict[int, int]
) -> Iterator[int]:
    """Yield the robots that may depart: all targets before their next target are reached."""
    for robot, targets in enumerate(remaining):
        if targets and all(
            earlier_target in reached for earlier_target in study.earlier(targets[0])
        ):
            yield robot


def respects_orders(study: Study, allocation: Allocation) -> bool:
    """Return whether every target is allocated once, and carried targets follow their origin."""
    allocated = sorted(target for targets in allocation for target in targets)
    if allocated != list(range(len(study.targets))):
        return False
    successors = {
        target: next_target for targets in allocation for target, next_target in pairwise(targets)
    }
    return all(successors.get(target) == later for target, later in study.carried_targets.items())


def meets_deadlines(study: Study, schedule: Schedule) -> bool:
    """Return whether all deadlines are met if no robot has to wait."""
    pairs = zip(study.targets, schedule.reached, strict=True)
    limits_and_steps = ((study.limit(target), step) for target, step in pairs)
    return all(limit is None or step <= limit for limit, step in limits_and_steps)
