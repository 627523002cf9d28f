"""Who reaches which target: the thesis's Algorithm 1, with its defects settled (thesis 4.4.2).

Line 10 adds to a robot's costs what already contains them, so that costs double with each target;
here the robot's costs become the costs of having reached it. The paths of line 8 always begin at
the robot's start; here a robot goes on from where it is. The order of the targets and 'same robot'
are not in the algorithm; here targets are taken in an order that keeps the partial one, and what is
carried stays with its robot. A direct way is the shortest one, so that no graph is searched.
"""

from collections.abc import Iterator

from sysmlc.robots.schedule import Schedule, scheduled
from sysmlc.robots.study import Study
from sysmlc.robots.travel import START, Travel


def ordered_targets(study: Study) -> Iterator[int]:
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


def greedy(study: Study, travel: Travel) -> Schedule | None:
    """The allocation of Algorithm 1; None when some target is given to nobody."""
    robots = range(len(study.robots))
    lists: list[list[int]] = [[] for _ in robots]
    costs = [0] * len(lists)
    carriers: dict[int, int] = {}
    for target in _whole_chains(study):
        options = [carriers[target]] if target in carriers else list(robots)
        known = {
            robot: costs[robot] + steps
            for robot in options
            if (steps := travel.get(robot, _place(lists[robot]), target)) is not None
        }
        if not known:
            return None
        best = min(known, key=lambda robot: (known[robot], robot))
        costs[best] = known[best]
        lists[best].append(target)
        if target in study.carried:
            carriers[study.carried[target]] = best
    return scheduled(study, travel, tuple(map(tuple, lists)))


def _place(own: list[int]) -> int:
    return own[-1] if own else START


def _whole_chains(study: Study) -> Iterator[int]:
    """The targets in order; what is carried right behind what it is carried from."""
    carried = study.carried
    given: set[int] = set()
    for target in ordered_targets(study):
        here: int | None = None if target in carried.values() else target
        while here is not None and here not in given:
            yield here
            given.add(here)
            here = carried.get(here)
