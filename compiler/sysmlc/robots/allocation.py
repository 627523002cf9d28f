"""Allocation of targets to robots: Algorithm 1 of the thesis (4.4.2), and branch and bound.

Algorithm 1 is corrected in three places. Line 10 adds a robot's previous costs twice, so they
double with each target; here the costs of a robot are the steps to its last target. The paths of
line 8 always begin at the robot's start; here a robot continues from its last target. The algorithm
has neither an order of targets nor targets for the same robot; here targets are sorted
topologically, and carried targets stay with their robot. Travel times are between places, so no
graph is searched. ``allocate_as_printed`` has none of these corrections, for comparison.
"""

from collections.abc import Iterator

from msgspec import Struct

from sysmlc.robots.schedule import START, Schedule, TravelTimes, build_schedule
from sysmlc.robots.study import Study


def sort_targets(study: Study) -> Iterator[int]:
    """Yield the targets in topological order, carried ones directly after their origin if ready."""
    remaining = list(range(len(study.targets)))
    visited: set[int] = set()
    carried = study.carried_targets
    while remaining:
        ready_targets = (
            candidate for candidate in remaining if visited.issuperset(study.earlier(candidate))
        )
        target: int | None = next(ready_targets, None)
        if target is None:
            # Only an order with a cycle leaves no target ready; the reader rejects such missions.
            return
        while target is not None and target in remaining:
            yield target
            remaining.remove(target)
            visited.add(target)
            carried_target = carried.get(target)
            is_ready = carried_target is not None and visited.issuperset(
                study.earlier(carried_target)
            )
            target = carried_target if is_ready else None


def allocate_greedily(study: Study, travel: TravelTimes) -> Schedule | None:
    """Return the allocation of Algorithm 1, or None if some target remains without a robot."""
    robots = range(len(study.robots))
    lists: list[list[int]] = [[] for _ in robots]
    costs = [0] * len(lists)
    carriers: dict[int, int] = {}
    for target in _sort_carried_chains(study):
        options = [carriers[target]] if target in carriers else list(robots)
        costs_by_robot = {
            robot: costs[robot] + steps
            for robot in options
            if (steps := travel.get(robot, _last_place(lists[robot]), target)) is not None
        }
        if not costs_by_robot:
            return None
        # Ties go to the first robot, so that equal studies give equal missions.
        best = min(costs_by_robot, key=lambda robot: (costs_by_robot[robot], robot))
        costs[best] = costs_by_robot[best]
        lists[best].append(target)
        if target in study.carried_targets:
            carriers[study.carried_targets[target]] = best
    return build_schedule(study, travel, tuple(map(tuple, lists)))


def allocate_as_printed(study: Study, travel: TravelTimes) -> Schedule | None:
    """Return the allocation of Algorithm 1 exactly as the thesis prints it (4.4.2).

    Targets are allocated in the order of the model, every path begins at the start of its robot
    (line 8), and the costs of a robot grow by its previous costs and the path (line 10). The result
    is None if a target is out of reach, or if the allocation breaks an order of the mission or
    assigns a carried target to another robot.
    """
    lists: list[list[int]] = [[] for _ in study.robots]
    costs = [0] * len(lists)
    for target in range(len(study.targets)):
        costs_by_robot = {
            robot: steps + costs[robot]
            for robot in range(len(lists))
            if (steps := travel.get(robot, START, target)) is not None
        }
        if not costs_by_robot:
            return None
        best = min(costs_by_robot, key=lambda robot: (costs_by_robot[robot], robot))
        costs[best] += costs_by_robot[best]
        lists[best].append(target)
    return build_schedule(study, travel, tuple(map(tuple, lists)))


def _last_place(targets: list[int]) -> int:
    return targets[-1] if targets else START


def _sort_carried_chains(study: Study) -> Iterator[int]:
    """Yield the targets in topological order, but each carried target directly after its origin."""
    carried = study.carried_targets
    visited: set[int] = set()
    for target in sort_targets(study):
        target_in_chain: int | None = None if target in carried.values() else target
        while target_in_chain is not None and target_in_chain not in visited:
            yield target_in_chain
            visited.add(target_in_chain)
            target_in_chain = carried.get(target_in_chain)


MAX_NODES = 10_000
"""Partial allocations after which branch and bound ends with the best allocation so far."""


class BestAllocation(Struct, frozen=True):
    """The best allocation of a search."""

    schedule: Schedule
    is_proven: bool
    """Whether the search was complete, so that no allocation is better."""
    nodes: int
    """Number of partial allocations that were examined."""


def allocate_optimally(
    study: Study, travel: TravelTimes, max_nodes: int = MAX_NODES
) -> BestAllocation | None:
    """Return the allocation with the earliest end, then the fewest steps; None if there is none."""
    search = _BranchAndBound(study, travel, max_nodes)
    greedy_schedule = allocate_greedily(study, travel)
    if greedy_schedule is not None:
        # A good first bound prunes most partial allocations.
        search.offer(_improve_by_local_search(study, travel, greedy_schedule))
    search.run()
    if search.best is None:
        return None
    return BestAllocation(search.best, search.nodes < max_nodes, search.nodes)


def _improve_by_local_search(study: Study, travel: TravelTimes, initial: Schedule) -> Schedule:
    """Move to the best neighbour allocation while that is an improvement."""
    schedule = initial
    while True:
        neighbour = min(
            neighbour_allocations(study, travel, schedule),
            key=lambda candidate: candidate.cost,
            default=schedule,
        )
        if neighbour.cost >= schedule.cost:
            return schedule
        schedule = neighbour


def neighbour_allocations(
    study: Study, travel: TravelTimes, schedule: Schedule
) -> Iterator[Schedule]:
    """Yield the allocations that differ in the robot or the position of one target.

    Targets that are carried one after the other move together.
    """
    carried = study.carried_targets
    for chain_head in range(len(study.targets)):
        if chain_head in carried.values():
            continue
        chain = [chain_head]
        while chain[-1] in carried:
            chain.append(carried[chain[-1]])
        other_targets = [
            tuple(target for target in targets if target not in chain)
            for targets in schedule.allocation
        ]
        for robot, targets in enumerate(other_targets):
            for index in range(len(targets) + 1):
                extended = (*targets[:index], *chain, *targets[index:])
                neighbour = build_schedule(
                    study, travel, (*other_targets[:robot], extended, *other_targets[robot + 1 :])
                )
                if neighbour is not None and neighbour.allocation != schedule.allocation:
                    yield neighbour


class _BranchAndBound:
    """Branch and bound over partial allocations.

    Targets are assigned in the order in which they are reached, so each schedule occurs once.
    """

    def __init__(self, study: Study, travel: TravelTimes, max_nodes: int) -> None:
        self.study, self.travel, self.max_nodes = study, travel, max_nodes
        self.best: Schedule | None = None
        self.nodes = 0
        self.lists: list[list[int]] = [[] for _ in study.robots]
        self.reached: dict[int, int] = {}
        self.carried = study.carried_targets
        self.carrying = {later: earlier for earlier, later in self.carried.items()}
        self.earlier = [study.earlier(target) for target in range(len(study.targets))]
        self.fewest_steps = [self._fewest_steps_to(target) for target in range(len(study.targets))]

    def _fewest_steps_to(self, target: int) -> int:
        """Return the fewest steps from any place to the target, for any robot."""
        steps_to_target = (
            steps for (_, _, goal), steps in self.travel.steps.items() if goal == target
        )
        return min(steps_to_target, default=0)

    def offer(self, schedule: Schedule) -> None:
        """Store the schedule if it is better."""
        if self.best is None or schedule.cost < self.best.cost:
            self.best = schedule

    def run(self, total: int = 0, last_assignment: tuple[int, int] = (0, -1)) -> None:
        """Examine all continuations of the current partial allocation.

        *total* is the number of steps travelled so far, *last_assignment* the time at which the
        last assigned target is reached, and its robot.
        """
        self.nodes += 1
        if self.nodes >= self.max_nodes:
            return
        if len(self.reached) == len(self.study.targets):
            schedule = build_schedule(self.study, self.travel, tuple(map(tuple, self.lists)))
            if schedule is not None:
                self.offer(schedule)
            return
        remaining, earliest_end = self._remaining_steps(), self._earliest_end()
        for time, robot, target, steps in sorted(self._list_options(last_assignment)):
            steps_after = remaining - self.fewest_steps[target]
            if self._can_prune(max(time, earliest_end), total + steps + steps_after):
                continue
            self.lists[robot].append(target)
            self.reached[target] = time
            self.run(total + steps, (time, robot))
            self.lists[robot].pop()
            del self.reached[target]

    def _list_options(
        self, last_assignment: tuple[int, int]
    ) -> Iterator[tuple[int, int, int, int]]:
        """Yield time, robot, target and steps of each possible next assignment.

        Assignments that would be reached before the last one are excluded.
        """
        starts_seen: set[int | None] = set()
        for robot, targets in enumerate(self.lists):
            if not targets:
                start = self.study.robots[robot].start
                # Robots without a stated start are interchangeable until they have a target.
                if start is None and start in starts_seen:
                    continue
                starts_seen.add(start)
            for target in self._next_targets(targets):
                steps = self.travel.get(robot, targets[-1] if targets else START, target)
                if steps is None or not self._is_ready(target):
                    continue
                earlier_times = (
                    self.reached[earlier_target] for earlier_target in self.earlier[target]
                )
                time = max(self.reached[targets[-1]] if targets else 0, *earlier_times, 0) + steps
                # Independent assignments are tried in one order only.
                if (time, robot) >= last_assignment:
                    yield time, robot, target, steps

    def _next_targets(self, targets: list[int]) -> list[int]:
        """Return the possible next targets of a robot.

        That is the carried target, if the robot has reached its origin. Otherwise these are all
        remaining targets that are not carried.
        """
        if targets and targets[-1] in self.carried:
            return [self.carried[targets[-1]]]
        all_targets = range(len(self.study.targets))
        return [
            candidate
            for candidate in all_targets
            if candidate not in self.reached and candidate not in self.carrying
        ]

    def _is_ready(self, target: int) -> bool:
        return all(earlier_target in self.reached for earlier_target in self.earlier[target])

    def _remaining_steps(self) -> int:
        """Return a lower bound of the steps to all remaining targets."""
        steps_by_target = enumerate(self.fewest_steps)
        return sum(steps for target, steps in steps_by_target if target not in self.reached)

    def _earliest_end(self) -> int:
        """Return a lower bound of the duration: the remaining steps are shared evenly."""
        end_times = sum(self.reached[targets[-1]] for targets in self.lists if targets)
        even_end = -(-(end_times + self._remaining_steps()) // len(self.lists))
        return max(even_end, *self.reached.values(), 0)

    def _can_prune(self, duration: int, total_steps: int) -> bool:
        """Whether these lower bounds of the costs reach the costs of the best schedule."""
        return self.best is not None and (duration, total_steps) >= self.best.cost
