"""Who reaches which target: the thesis's Algorithm 1, with its defects settled (thesis 4.4.2).

Line 10 adds to a robot's costs what already contains them, so that costs double with each target;
here the robot's costs become the costs of having reached it. The paths of line 8 always begin at
the robot's start; here a robot goes on from where it is. The order of the targets and 'same robot'
are not in the algorithm; here targets are taken in an order that keeps the partial one, and what is
carried stays with its robot. A direct way is the shortest one, so that no graph is searched.
"""

from collections.abc import Iterator

from msgspec import Struct

from sysmlc.robots.schedule import START, Schedule, TravelTimes, build_schedule
from sysmlc.robots.study import Study


def sort_targets(study: Study) -> Iterator[int]:
    """The targets, each behind those that come before it; what is carried follows at once."""
    left = list(range(len(study.targets)))
    done: set[int] = set()
    carried = study.carried
    while left:
        ready = (one for one in left if done.issuperset(study.earlier(one)))
        target: int | None = next(ready, None)
        while target is not None and target in left:
            yield target
            left.remove(target)
            done.add(target)
            later = carried.get(target)
            is_ready = later is not None and done.issuperset(study.earlier(later))
            target = later if is_ready else None
        if not done:
            return


def allocate_greedily(study: Study, travel: TravelTimes) -> Schedule | None:
    """The allocation of Algorithm 1; None when some target is given to nobody."""
    robots = range(len(study.robots))
    lists: list[list[int]] = [[] for _ in robots]
    costs = [0] * len(lists)
    carriers: dict[int, int] = {}
    for target in _sort_carried_chains(study):
        options = [carriers[target]] if target in carriers else list(robots)
        known = {
            robot: costs[robot] + steps
            for robot in options
            if (steps := travel.get(robot, _last_place(lists[robot]), target)) is not None
        }
        if not known:
            return None
        best = min(known, key=lambda robot: (known[robot], robot))
        costs[best] = known[best]
        lists[best].append(target)
        if target in study.carried:
            carriers[study.carried[target]] = best
    return build_schedule(study, travel, tuple(map(tuple, lists)))


def _last_place(own: list[int]) -> int:
    return own[-1] if own else START


def _sort_carried_chains(study: Study) -> Iterator[int]:
    """The targets in order; what is carried right behind what it is carried from."""
    carried = study.carried
    given: set[int] = set()
    for target in sort_targets(study):
        here: int | None = None if target in carried.values() else target
        while here is not None and here not in given:
            yield here
            given.add(here)
            here = carried.get(here)


MAX_NODES = 10_000
"""Partial allocations that are looked at before the best one found counts as good enough."""


class BestAllocation(Struct, frozen=True):
    """The best allocation that was found."""

    schedule: Schedule
    is_proven: bool
    """Whether there is none better."""
    nodes: int


def allocate_optimally(
    study: Study, travel: TravelTimes, most: int = MAX_NODES
) -> BestAllocation | None:
    """The allocation that is done first, then with the fewest steps; None when there is none."""
    search = _Search(study, travel, most)
    found = allocate_greedily(study, travel)
    if found is not None:
        search.offer(_improve_by_local_search(study, travel, found))
    search.run()
    if search.best is None:
        return None
    return BestAllocation(search.best, search.nodes < most, search.nodes)


def _improve_by_local_search(study: Study, travel: TravelTimes, start: Schedule) -> Schedule:
    """The first neighbour that is better, and so on."""
    found = start
    while True:
        better = min(
            neighbour_allocations(study, travel, found), key=lambda one: one.cost, default=found
        )
        if better.cost >= found.cost:
            return found
        found = better


def neighbour_allocations(study: Study, travel: TravelTimes, start: Schedule) -> Iterator[Schedule]:
    """Allocations in which one chain of targets that are carried on is somewhere else."""
    carried = study.carried
    for head in range(len(study.targets)):
        if head in carried.values():
            continue
        chain = [head]
        while chain[-1] in carried:
            chain.append(carried[chain[-1]])
        rest = [tuple(one for one in own if one not in chain) for own in start.allocation]
        for robot, own in enumerate(rest):
            for place in range(len(own) + 1):
                moved = (*own[:place], *chain, *own[place:])
                made = build_schedule(study, travel, (*rest[:robot], moved, *rest[robot + 1 :]))
                if made is not None and made.allocation != start.allocation:
                    yield made


class _Search:
    """Targets are added in the order in which they are reached; what cannot be better is left."""

    def __init__(self, study: Study, travel: TravelTimes, most: int) -> None:
        self.study, self.travel, self.most = study, travel, most
        self.best: Schedule | None = None
        self.nodes = 0
        self.lists: list[list[int]] = [[] for _ in study.robots]
        self.reached: dict[int, int] = {}
        self.carried = study.carried
        self.carrying = {later: earlier for earlier, later in self.carried.items()}
        self.earlier = [study.earlier(one) for one in range(len(study.targets))]
        self.least = [self._least(target) for target in range(len(study.targets))]

    def _least(self, target: int) -> int:
        """The fewest steps in which any robot gets there from anywhere."""
        known = (steps for (_, _, goal), steps in self.travel.steps.items() if goal == target)
        return min(known, default=0)

    def offer(self, schedule: Schedule) -> None:
        """Keep it when it is better."""
        if self.best is None or schedule.cost < self.best.cost:
            self.best = schedule

    def run(self, total: int = 0, last: tuple[int, int] = (0, -1)) -> None:
        """Look at all ways to go on; ``last`` is the time and the robot of what was added last."""
        self.nodes += 1
        if self.nodes >= self.most:
            return
        if len(self.reached) == len(self.study.targets):
            made = build_schedule(self.study, self.travel, tuple(map(tuple, self.lists)))
            if made is not None:
                self.offer(made)
            return
        left, soonest = self._left(), self._soonest()
        for time, robot, target, steps in sorted(self._options(last)):
            more = left - self.least[target]
            if self._is_hopeless(max(time, soonest), total + steps + more):
                continue
            self.lists[robot].append(target)
            self.reached[target] = time
            self.run(total + steps, (time, robot))
            self.lists[robot].pop()
            del self.reached[target]

    def _options(self, last: tuple[int, int]) -> Iterator[tuple[int, int, int, int]]:
        """Time, robot, target and steps of what can be reached next, not before the last one."""
        fresh: set[int | None] = set()
        for robot, own in enumerate(self.lists):
            if not own:
                start = self.study.robots[robot].start
                if start is None and start in fresh:
                    continue
                fresh.add(start)
            for target in self._next(own):
                steps = self.travel.get(robot, own[-1] if own else START, target)
                if steps is None or not self._is_ready(target):
                    continue
                earlier = (self.reached[one] for one in self.earlier[target])
                time = max(self.reached[own[-1]] if own else 0, *earlier, 0) + steps
                if (time, robot) >= last:
                    yield time, robot, target, steps

    def _next(self, own: list[int]) -> list[int]:
        """What a robot may go to: on with what it carries, else to what nobody carries."""
        if own and own[-1] in self.carried:
            return [self.carried[own[-1]]]
        open_ = range(len(self.study.targets))
        return [one for one in open_ if one not in self.reached and one not in self.carrying]

    def _is_ready(self, target: int) -> bool:
        return all(one in self.reached for one in self.earlier[target])

    def _left(self) -> int:
        """The fewest steps that are still to go to all targets."""
        every = enumerate(self.least)
        return sum(steps for target, steps in every if target not in self.reached)

    def _soonest(self) -> int:
        """When the mission is done at the soonest, when robots share what is left alike."""
        ends = sum(self.reached[own[-1]] for own in self.lists if own)
        shared = -(-(ends + self._left()) // len(self.lists))
        return max(shared, *self.reached.values(), 0)

    def _is_hopeless(self, duration: int, total: int) -> bool:
        """Whether nothing better than the best can come of it."""
        return self.best is not None and (duration, total) >= self.best.cost
