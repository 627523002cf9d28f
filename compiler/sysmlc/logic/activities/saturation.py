"""Writes of an activity that stop at a bound, found by playing it in all ways.

Only the variables that matter are played: what guards and ends of actions read, the written ones,
and what their values are made of. What starts with an unknown value starts with each of them.
"""

from collections.abc import Iterable, Iterator, Mapping, Sequence
from enum import StrEnum
from functools import lru_cache
from typing import TypeVar

from msgspec import Struct
from msgspec.structs import replace

from sysmlc.logic import domains, evaluate
from sysmlc.logic import formula as f
from sysmlc.logic.activities import interpreter as token_game
from sysmlc.logic.activities.concurrency import Together
from sysmlc.logic.activities.step_formulas import Game
from sysmlc.logic.activities.token_graph import Store, TokenGraph, TokenNode, Write
from sysmlc.logic.activities.value_analysis import MOST_VALUES, Spread
from sysmlc.logic.contract import Domain
from sysmlc.logic.formula import Const, Formula, Literal
from sysmlc.logic.simplify import is_satisfiable, substitute

_T = TypeVar("_T")
_MOST_MOVES = 100_000
"""Nodes and flows looked at, all steps together: a tenth of a second."""
_MOST_INPUTS = 64
"""Valuations of the inputs that values are made of."""


class Stopped(Struct, frozen=True):
    """The writes that stop in some run; the others never do if the search is complete."""

    writes: list[Write]
    is_complete: bool


def search(graph: TokenGraph, writes: Iterable[Write]) -> Stopped:
    """Play until each of the writes has stopped, or all states or too many were seen."""
    wanted = list(writes)
    return _Search(reduced(graph, wanted), wanted).play()


def reduced(graph: TokenGraph, wanted: Sequence[Write]) -> TokenGraph:
    """The graph with the variables that matter for these writes."""
    guards = (edge.guard.condition for edge in graph.edges if edge.guard is not None)
    formulas = [*guards, *(node.done for node in graph.nodes)]
    names = _names(one for one in formulas if one is not None)
    names |= {s.variable.name for s in graph.stores if any(w in wanted for w in s.writes)}
    while True:
        stores = tuple(one for one in graph.stores if one.variable.name in names)
        more = _names(part for s in stores for w in s.writes for pair in w.values for part in pair)
        if more <= names:
            return replace(graph, stores=stores)
        names |= more


def _names(formulas: Iterable[Formula]) -> set[str]:
    return {variable.name for one in formulas for variable in f.variables(one)}


class _Search:
    def __init__(self, graph: TokenGraph, wanted: list[Write]) -> None:
        self._graph, self._game = graph, Game(graph)
        self._open = list(wanted)
        self._domains = {one.name: one.domain for one in graph.inputs}
        self._steps = _MOST_MOVES // (len(graph.nodes) + len(graph.edges))
        values = (part for s in graph.stores for w in s.writes for p in w.values for part in p)
        read = _names(values) & self._domains.keys()
        self._given = {name: self._domains[name] for name in sorted(read)}

    def play(self) -> Stopped:
        """The writes that stop."""
        wanted = list(self._open)
        is_complete = self._play()
        return Stopped([one for one in wanted if one not in self._open], is_complete)

    def _play(self) -> bool:
        unknown = {
            s.variable.name: s.variable.domain for s in self._graph.stores if s.first is None
        }
        starts = domains.count(unknown)
        if starts > self._steps or domains.count(self._given) > _MOST_INPUTS:
            return False
        waiting = list(_starts(self._graph, unknown))
        seen = set(waiting)
        for state in waiting:
            self._open = [one for one in self._open if not self._stops(one, state)]
            if not self._open:
                return True
            for after in self._successors(state):
                self._steps -= 1
                if self._steps < 0:
                    return False
                if after not in seen:
                    seen.add(after)
                    waiting.append(after)
        return True

    def _stops(self, write: Write, state: token_game.State) -> bool:
        """Whether the node may be done in this step, with a value that stops."""
        if write.node not in state.running or token_game.finishes(self._graph, state):
            return False
        node, values = self._graph.node(write.node), token_game.values(self._graph, state)
        given = {name: Const(value) for name, value in values.items()}
        ends = substitute(f.both(self._game.finishes(node), f.either(*write.stops)), given)
        return is_satisfiable(ends, self._domains)

    def _successors(self, state: token_game.State) -> Iterator[token_game.State]:
        for inputs in domains.valuations(self._given):
            plans: list[list[int]] = [[]]
            while plans:
                oracle = _Oracle(inputs, self._domains, plans.pop())
                yield token_game.step(self._graph, state, inputs, oracle.holds, oracle.choose)
                plans += oracle.others()


def _starts(graph: TokenGraph, unknown: Mapping[str, Domain]) -> Iterator[token_game.State]:
    first = token_game.start(graph)
    for values in domains.valuations(unknown):
        stored = tuple((name, values.get(name, value)) for name, value in first.stored)
        yield replace(first, stored=stored)


class _Oracle:
    """Answers as planned what the environment decides, and knows what else could be answered."""

    def __init__(
        self, inputs: Mapping[str, Literal], known: Mapping[str, Domain], plan: list[int]
    ) -> None:
        self._inputs, self._known, self._plan = inputs, known, plan
        self._counts: list[int] = []
        self._answers: dict[Formula, bool] = {}

    def holds(self, formula: Formula, values: Mapping[str, Literal]) -> bool:
        """Whether a condition holds; the environment answers what is not the activity's own."""
        if all(one.name in values for one in f.variables(formula)):
            return evaluate.is_true(formula, values)
        if formula not in self._answers:
            given = {name: Const(value) for name, value in values.items()}
            self._answers[formula] = self._answer(substitute(formula, given))
        return self._answers[formula]

    def _answer(self, formula: Formula) -> bool:
        ways = (
            (True, is_satisfiable(formula, self._known)),
            (False, is_satisfiable(f.negate(formula), self._known)),
        )
        possible = [answer for answer, can_be in ways if can_be]
        return possible[self._next(len(possible))]

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


_REMEMBERED = 256
"""Answers that are kept: a process that compiles again finds those of what was not edited."""


class Can(StrEnum):
    """Whether something happens in some run."""

    YES = "can"
    NO = "cannot"
    PERHAPS = "may (it has too many states to tell)"


@lru_cache(_REMEMBERED)
def leaving(tokens: TokenGraph) -> tuple[tuple[Store, Write, Can], ...]:
    """Each write that has stops, and whether it comes to one."""
    could = [(store, one) for store in tokens.stores for one in store.writes if one.stops]
    together = Together(tokens)
    said = [(*one, _on_the_way(tokens, together, *one)) for one in could]
    found = search(tokens, [write for _, write, can in said if can is Can.PERHAPS])
    rest = Can.NO if found.is_complete else Can.PERHAPS
    return tuple(
        (store, write, Can.YES if write in found.writes else rest if can is Can.PERHAPS else can)
        for store, write, can in said
    )


def _on_the_way(tokens: TokenGraph, together: Together, store: Store, write: Write) -> Can:
    """What the values along the flows say."""
    if domains.size(store.variable.domain) > MOST_VALUES:
        return Can.PERHAPS
    spread = Spread(reduced(tokens, [write]), together, store)
    if not spread.may_stop(write):
        return Can.NO
    return Can.YES if spread.is_exact else Can.PERHAPS
