"""Assignments of an activity that can leave the range of what they assign (SM428).

All states are looked at that the activity can reach, whatever the environment decides; where there
are too many of them each assignment that could leave the range is taken as one that can.
"""

from collections.abc import Iterator, Mapping, Sequence
from typing import TypeVar

from sysmlc.diagnostics import Sink
from sysmlc.ir import Graph
from sysmlc.logic import evaluate
from sysmlc.logic import formula as f
from sysmlc.logic.activities import token_game
from sysmlc.logic.activities.tokens import Store, TokenGraph, TokenNode, Write
from sysmlc.logic.formula import Formula, Literal
from sysmlc.logic.machines.moves import SATURATES

_T = TypeVar("_T")
_MOST_STEPS = 2_000


def report_stops(graph: Graph, tokens: TokenGraph, sink: Sink) -> None:
    """Report each write that can leave the range of its variable."""
    could = [(store, one) for store in tokens.stores for one in store.writes if one.stops]
    if not could:
        return
    reached = _stopped(tokens)
    for store, write in could:
        if reached is None or any(one in reached for one in write.stops):
            _report(graph, tokens, store, write, sink)


def _report(graph: Graph, tokens: TokenGraph, store: Store, write: Write, sink: Sink) -> None:
    node = tokens.node(write.node)
    subject, name = graph.subject(graph[node.origin]), store.variable.name
    sink.report(SATURATES, subject, transition=node.label, variable=name)


def _stopped(tokens: TokenGraph) -> set[Formula] | None:
    """The conditions under which a write stopped at a bound; None when that was not found out."""
    values = [part for s in tokens.stores for w in s.writes for pair in w.values for part in pair]
    is_open = any(one.first is None for one in tokens.stores)
    if is_open or any(map(tokens.is_decided_outside, values)):
        return None
    first = token_game.start(tokens)
    seen, waiting, steps = {first}, [first], 0
    met: set[Formula] = set()
    for state in waiting:
        for after in _successors(tokens, state, met):
            steps += 1
            if steps > _MOST_STEPS:
                return None
            if after not in seen:
                seen.add(after)
                waiting.append(after)
    return met


def _successors(
    tokens: TokenGraph, state: token_game.State, met: set[Formula]
) -> Iterator[token_game.State]:
    plans: list[list[int]] = [[]]
    while plans:
        oracle = _Oracle(tokens, plans.pop(), met)
        yield token_game.step(tokens, state, {}, oracle.holds, oracle.choose)
        plans += oracle.others()


class _Oracle:
    """Answers as planned what the environment decides, and knows what else could be answered."""

    def __init__(self, tokens: TokenGraph, plan: list[int], met: set[Formula]) -> None:
        self._tokens, self._plan, self._met = tokens, plan, met
        self._counts: list[int] = []
        self._answers: dict[Formula, bool] = {}

    def holds(self, formula: Formula, values: Mapping[str, Literal]) -> bool:
        """Whether a condition holds; the environment answers what is not the activity's own."""
        if not self._tokens.is_decided_outside(formula):
            found = evaluate.is_true(formula, values)
            if found and formula != f.TRUE:
                self._met.add(formula)
            return found
        if formula not in self._answers:
            self._answers[formula] = bool(self._next(2))
        return self._answers[formula]

    def choose(self, node: TokenNode, options: Sequence[_T]) -> _T:
        """One of several ways that are open."""
        del node
        return options[self._next(len(options))]

    def _next(self, count: int) -> int:
        place = len(self._counts)
        self._counts.append(count)
        return self._plan[place] if place < len(self._plan) else 0

    def others(self) -> Iterator[list[int]]:
        """The plans that differ from this one at a place that was not planned."""
        taken = [*self._plan, *[0] * (len(self._counts) - len(self._plan))]
        for place in range(len(self._plan), len(self._counts)):
            for other in range(1, self._counts[place]):
                yield [*taken[:place], other]
