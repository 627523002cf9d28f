"""The best allocation, by branch and bound, and others near it when that one does not do."""

from collections.abc import Iterator

from msgspec import Struct

from sysmlc.robots.allocate import greedy
from sysmlc.robots.schedule import Schedule, scheduled
from sysmlc.robots.study import Study
from sysmlc.robots.travel import START, Travel

MOST_NODES = 10_000
"""Partial allocations that are looked at before the best one found counts as good enough."""


class Best(Struct, frozen=True):
    """The best allocation that was found."""

    schedule: Schedule
    is_proven: bool
    """Whether there is none better."""
    nodes: int


def best(study: Study, travel: Travel, most: int = MOST_NODES) -> Best | None:
    """The allocation that is done first, then with the fewest steps; None when there is none."""
    search = _Search(study, travel, most)
    found = greedy(study, travel)
    if found is not None:
        search.offer(_improved(study, travel, found))
    search.run()
    if search.best is None:
        return None
    return Best(search.best, search.nodes < most, search.nodes)


def _improved(study: Study, travel: Travel, start: Schedule) -> Schedule:
    """The first neighbour that is better, and so on."""
    found = start
    while True:
        better = min(near(study, travel, found), key=lambda one: one.cost, default=found)
        if better.cost >= found.cost:
            return found
        found = better


def near(study: Study, travel: Travel, start: Schedule) -> Iterator[Schedule]:
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
                made = scheduled(study, travel, (*rest[:robot], moved, *rest[robot + 1 :]))
                if made is not None and made.allocation != start.allocation:
                    yield made


class _Search:
    """Targets are added in the order in which they are reached; what cannot be better is left."""

    def __init__(self, study: Study, travel: Travel, most: int) -> None:
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
            made = scheduled(self.study, self.travel, tuple(map(tuple, self.lists)))
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
