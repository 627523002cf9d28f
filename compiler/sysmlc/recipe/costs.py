"""Costs of steps and executions: time, work of machines, and how often each step runs.

The last section computes the expected costs of a Markov chain of situations. A cost has a smallest
and a largest amount of each measure. The first measure is the time; it is the
only one that parallel branches do not add up.
"""

from collections.abc import Hashable, Mapping, Sequence
from math import ceil, inf
from typing import Generic, NamedTuple, TypeVar

from msgspec import Struct

from sysmlc.ir.algorithms import find_reachable, strongly_connected_components
from sysmlc.recipe.model import Range


class NodeCost(Struct, frozen=True):
    """The milliseconds that a step takes, and the machines or resources of which it occupies one.

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
        unions = [frozenset[str](), *self._work, frozenset().union(*self._work)]
        low = max(low, *(self._share_work(total, machines) for machines in unions))
        high = max((self.bound_branch(n, branches) for n in range(len(branches))), default=0)
        return Cost((low, *total.low[1:]), (high, *total.high[1:]))

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


# -- expected costs --------------------------------------------------------------------------------

_S = TypeVar("_S", bound=Hashable)
_MOST_EQUATIONS = 60
"""Most situations of a cycle whose expected time is computed: the elimination is cubic."""
_TOLERANCE = 1e-9


class Transition(NamedTuple, Generic[_S]):
    """A step from one situation to the next; the probability None is unknown."""

    target: _S
    cost: Cost
    probability: float | None = 1.0


_Transitions = Mapping[_S, Sequence[Transition[_S]]]


def compute_costs(
    first: _S, ends: Sequence[_S], transitions: _Transitions[_S], zero: Cost
) -> tuple[dict[_S, Cost], list[_S]]:
    """Return the costs of all paths from *first* to each of *ends*.

    The second result has the situations of cycles that take time: paths may repeat them without a
    bound. Situations from which no end is reachable do not count.
    """
    predecessors: dict[_S, list[_S]] = {}
    for source, steps in transitions.items():
        for step in steps:
            predecessors.setdefault(step.target, []).append(source)
    useful = find_reachable(ends, lambda situation: predecessors.get(situation, ()))
    arrivals: dict[_S, Cost] = {first: zero}
    endless: list[_S] = []
    for component in _sort_components(useful, transitions):
        if not any(situation in arrivals for situation in component):
            continue
        inside = set(component)
        is_cycle = _is_cycle(component, transitions)
        if is_cycle and _stay_in_cycle(component, transitions, arrivals):
            endless += component
        for situation in component:
            for step in transitions[situation]:
                if step.target in useful and step.target not in inside:
                    _arrive(arrivals, step.target, arrivals[situation] + step.cost)
    return {end: arrivals[end] for end in ends if end in arrivals}, endless


def _arrive(arrivals: dict[_S, Cost], target: _S, cost: Cost) -> None:
    arrivals[target] = arrivals[target] | cost if target in arrivals else cost


def _sort_components(useful: set[_S], transitions: _Transitions[_S]) -> list[list[_S]]:
    """Return the strongly connected components in topological order."""
    successors = {
        situation: [step.target for step in steps if step.target in useful]
        for situation, steps in transitions.items()
        if situation in useful
    }
    return list(strongly_connected_components(successors))[::-1]


def _is_cycle(component: Sequence[_S], transitions: _Transitions[_S]) -> bool:
    return len(component) > 1 or any(
        step.target == component[0] for step in transitions[component[0]]
    )


def _stay_in_cycle(
    component: Sequence[_S], transitions: _Transitions[_S], arrivals: dict[_S, Cost]
) -> bool:
    """Compute the costs at the situations of a cycle; return whether the time has no bound."""
    inside = set(component)
    steps = [(a, step) for a in component for step in transitions[a] if step.target in inside]
    entries = [arrivals[situation] for situation in component if situation in arrivals]
    # Every step of the component is on a cycle: what it costs can be spent any number of times.
    repeated = [
        any(step.cost.high[k] > 0 for _, step in steps) for k in range(len(entries[0].high))
    ]
    highest = [
        inf if is_repeated else max(entry.high[k] for entry in entries)
        for k, is_repeated in enumerate(repeated)
    ]
    lows = {s: arrivals[s].low for s in component if s in arrivals}
    has_changed = True
    while has_changed:
        has_changed = False
        for source, step in steps:
            if source in lows:
                low = tuple(a + b for a, b in zip(lows[source], step.cost.low, strict=True))
                low = tuple(map(min, lows.get(step.target, low), low))
                if lows.get(step.target) != low:
                    lows[step.target], has_changed = low, True
    arrivals.update({s: Cost(lows[s], tuple(highest)) for s in component})
    return repeated[0]


# -- expected time -----------------------------------------------------------------------------


def compute_expected_time(first: _S, transitions: _Transitions[_S]) -> float | None:
    """Return the expected time from *first* to an end, which has no transitions.

    Return None unless every time is a single number and every probability is known.
    """
    for steps in transitions.values():
        total = sum(step.probability or 0 for step in steps)
        is_fixed = all(step.cost.low[0] == step.cost.high[0] for step in steps)
        if steps and (not is_fixed or abs(total - 1) > _TOLERANCE):
            return None
    times: dict[_S, float] = {}
    for component in reversed(_sort_components(set(transitions), transitions)):
        if len(component) > _MOST_EQUATIONS or not _solve(component, transitions, times):
            return None
    return times[first]


def _solve(component: Sequence[_S], transitions: _Transitions[_S], times: dict[_S, float]) -> bool:
    """Add the expected times of a component by elimination; return whether there is a solution."""
    index = {situation: number for number, situation in enumerate(component)}
    rows = []
    for situation in component:
        row = [0.0] * len(component) + [0.0]
        row[index[situation]] += 1
        for step in transitions[situation]:
            probability = step.probability or 0.0
            row[-1] += probability * step.cost.low[0]
            if step.target in index:
                row[index[step.target]] -= probability
            else:
                row[-1] += probability * times[step.target]
        rows.append(row)
    for k in range(len(rows)):
        pivot = max(range(k, len(rows)), key=lambda n: abs(rows[n][k]))
        if abs(rows[pivot][k]) < _TOLERANCE:
            return False
        rows[k], rows[pivot] = rows[pivot], rows[k]
        for n, row in enumerate(rows):
            if n != k and row[k]:
                factor = row[k] / rows[k][k]
                rows[n] = [a - factor * b for a, b in zip(row, rows[k], strict=True)]
    times.update({s: rows[n][-1] / rows[n][n] for s, n in index.items()})
    return True
