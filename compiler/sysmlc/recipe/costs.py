"""Costs of steps and executions: time, work of machines, and how often each step runs.

A cost has a smallest and a largest amount of each measure. The first measure is the time; it is the
only one that parallel branches do not add up.
"""

from collections.abc import Mapping, Sequence
from math import ceil, inf

from msgspec import Struct

from sysmlc.recipe.model import Range


class NodeCost(Struct, frozen=True):
    """The duration of a step, and the machines or resources of which it occupies one.

    If the step occupies nothing else, ``is_exclusive`` states that other steps on these machines
    cannot run meanwhile. Functions of one service may share a resource that their service holds.
    """

    duration: Range
    machines: frozenset[str] = frozenset()
    is_exclusive: bool = True


class Cost(Struct, frozen=True):
    """Smallest and largest amounts, in the order of the measures; infinity is unbounded."""

    low: tuple[float, ...]
    high: tuple[float, ...]

    def __add__(self, cost: "Cost") -> "Cost":
        low = tuple(a + b for a, b in zip(self.low, cost.low, strict=True))
        return Cost(low, tuple(a + b for a, b in zip(self.high, cost.high, strict=True)))

    def __or__(self, cost: "Cost") -> "Cost":
        """Return the cost of one of two alternatives."""
        low = tuple(map(min, self.low, cost.low))
        return Cost(low, tuple(map(max, self.high, cost.high)))


class Measures:
    """The measures of a graph: the time, the work of each set of machines, the runs of each step.

    Steps of parallel branches that need the same machine run one after the other. *holds* states
    that a step may keep a machine for a later step of its branch.
    """

    def __init__(self, steps: Mapping[str, NodeCost], *, holds: bool = False) -> None:
        self._holds = holds
        sets = sorted({step.machines for step in steps.values() if step.machines}, key=sorted)
        self._work = {machines: index for index, machines in enumerate(sets, 1)}
        self._runs = {id: index for index, id in enumerate(steps, 1 + len(sets))}
        self.zero = Cost(*[(0.0,) * (1 + len(self._work) + len(self._runs))] * 2)
        self.of_step = {id: self._make_cost(id, step) for id, step in steps.items()}

    def _make_cost(self, id: str, step: NodeCost) -> Cost:
        low, high = list(self.zero.low), list(self.zero.high)
        longest = inf if step.duration.max is None else step.duration.max
        low[0], high[0] = step.duration.min, longest
        low[self._runs[id]] = high[self._runs[id]] = 1
        if step.machines:
            low[self._work[step.machines]] = step.duration.min if step.is_exclusive else 0
            high[self._work[step.machines]] = longest
        return Cost(tuple(low), tuple(high))

    def count_runs(self, cost: Cost) -> dict[str, Range]:
        """Return how often each step runs."""
        return {
            id: Range(int(cost.low[index]), to_maximum(cost.high[index]))
            for id, index in self._runs.items()
        }

    def run_in_parallel(self, branches: Sequence[Cost]) -> Cost:
        """Return the cost of branches that start together; it ends with the last of them."""
        total = self.zero
        for branch in branches:
            total = total + branch
        low = max((branch.low[0] for branch in branches), default=0)
        low = max(low, *(self._share_work(total, machines) for machines in self._list_unions()))
        high = max((self.bound_branch(n, branches) for n in range(len(branches))), default=0)
        return Cost((low, *total.low[1:]), (high, *total.high[1:]))

    def _list_unions(self) -> list[frozenset[str]]:
        return [frozenset(), *self._work, frozenset().union(*self._work)]

    def _share_work(self, cost: Cost, machines: frozenset[str]) -> float:
        """Return the time that *machines* need for the work that no other machine can do."""
        work = sum(cost.low[index] for needed, index in self._work.items() if needed <= machines)
        return ceil(work / len(machines)) if machines else 0

    def bound_branch(self, number: int, branches: Sequence[Cost]) -> float:
        """Return the latest end of one of parallel branches.

        A branch waits at most as long as the others use the machines that it needs. In every
        instant one of the branches that wait for one another makes progress, so that the sum of
        their times is a bound, too.
        """
        needed = [self._list_machines(branch) for branch in branches]
        connected = _find_connected(number, needed)
        total = sum(branches[n].high[0] for n in connected)
        if self._holds:
            return total
        waiting = sum(
            branches[n].high[index]
            for n in connected - {number}
            for machines, index in self._work.items()
            if machines & needed[number]
        )
        return min(total, branches[number].high[0] + waiting)

    def _list_machines(self, cost: Cost) -> frozenset[str]:
        used = (machines for machines, index in self._work.items() if cost.high[index] > 0)
        return frozenset().union(*used)


def _find_connected(start: int, needed: Sequence[frozenset[str]]) -> set[int]:
    """Return the branches that share machines with branch *start*, directly or through others."""
    connected, machines = {start}, needed[start]
    while True:
        new = {n for n, branch in enumerate(needed) if n not in connected and branch & machines}
        if not new:
            return connected
        connected |= new
        machines = machines.union(*(needed[n] for n in new))


def to_maximum(amount: float) -> int | None:
    """Return a largest amount as a whole number; None if it is unbounded."""
    return None if amount == inf else int(amount)
