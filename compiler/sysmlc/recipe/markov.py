"""Costs of paths through a graph of situations: smallest, largest and expected amounts."""

from collections.abc import Hashable, Mapping, Sequence
from math import inf
from typing import Generic, NamedTuple, TypeVar

from sysmlc.ir.algorithms import find_reachable, strongly_connected_components
from sysmlc.recipe.costs import Cost

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
    ordered = [situation for situation in transitions if situation in useful]
    names = {situation: str(number) for number, situation in enumerate(ordered)}
    successors = {
        names[situation]: [names[s.target] for s in transitions[situation] if s.target in useful]
        for situation in ordered
    }
    components = [
        [ordered[int(name)] for name in component]
        for component in strongly_connected_components(successors)
    ]
    return components[::-1]


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
