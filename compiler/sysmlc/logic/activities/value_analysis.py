"""The values that a variable may have wherever an activity has a token.

One variable is followed along the flows, the others may have any value at any time. What it finds
holds in every run, however many states there are; a value that it allows need not come up.
Sets of values are bits, in the order of the domain.
"""

from collections.abc import Iterable, Iterator, Mapping

from sysmlc.logic import domains
from sysmlc.logic import formula as f
from sysmlc.logic.activities.concurrency import Move, Together, gone, takers
from sysmlc.logic.activities.step_formulas import Game
from sysmlc.logic.activities.token_graph import (
    ACTIVITY_REGION,
    Firing,
    NodeKind,
    Store,
    TokenEdge,
    TokenGraph,
    Write,
)
from sysmlc.logic.contract import Domain
from sysmlc.logic.evaluate import Evaluation, evaluation
from sysmlc.logic.formula import Formula, Literal

MOST_VALUES = 4_096
"""Values of a variable that is followed."""
_MOST_VALUATIONS = 20_000
"""Conditions over more values of several variables than this hold for each value of the one."""


class Spread:
    """The values of one variable at each place; of at most ``MOST_VALUES``."""

    def __init__(self, graph: TokenGraph, together: Together, store: Store) -> None:
        self._graph, self._together, self._store = graph, together, store
        self._game = Game(graph)
        known = (*graph.inputs, *(one.variable for one in graph.stores))
        self._image = _Image(store, {one.name: one.domain for one in known})
        self._writes = {one.node: one for one in store.writes}
        self._takers = takers(together.moves)
        self._at: dict[str, int] = {}
        self._made: dict[Move, int] = {}
        self._waiting: dict[Move, None] = {}
        self._play()

    @property
    def is_exact(self) -> bool:
        """Whether all values that are allowed come up: one token moves, one variable decides."""
        is_alone = self._together.are_none and len(self._graph.stores) == 1
        return is_alone and not self._graph.interruptibles and not self._image.gave_up

    def may_stop(self, write: Write) -> bool:
        """Whether a stop of the write may hold when its node is done."""
        values = self._at.get(write.node, 0)
        values &= self._image.where(self._game.done(self._graph.node(write.node)))
        return any(values & self._image.where(stop) for stop in write.stops)

    def _play(self) -> None:
        starts = self._together.started(ACTIVITY_REGION)
        regions = [one for one in self._together.moves if one.clears]
        self._add(starts, self._first())
        before: dict[str, int] = {}
        while before != self._at:
            before = dict(self._at)
            while self._waiting:
                move = next(iter(self._waiting))
                del self._waiting[move]
                self._make(move)
            for move in regions:
                self._make(move)
            self._add(starts, self._again())

    def _first(self) -> int:
        first = self._store.first
        return self._image.every if first is None else self._image.only(first)

    def _again(self) -> int:
        """The values with which the activity starts once more."""
        if self._store.local and self._store.first is not None:
            return 0
        return self._over(ACTIVITY_REGION)

    def _add(self, places: Iterable[str], values: int) -> None:
        for place in places:
            before = self._at.get(place, 0)
            if values & ~before:
                self._at[place] = before | values
                self._waiting.update(dict.fromkeys(self._takers(place)))

    def _make(self, move: Move) -> None:
        new = self._before(move) & ~self._made.get(move, 0)
        if not new:
            return
        self._made[move] = self._made.get(move, 0) | new
        write = self._writes.get(move.node.id) if move.is_end else None
        if write is None:
            self._add(move.gives, new)
            return
        after = self._image.after(write, new)
        self._add((*move.gives, *self._together.beside(write.node)), after)

    def _before(self, move: Move) -> int:
        """The values with which a move can be made."""
        values = self._image.every
        for place in move.takes:
            values &= self._at.get(place, 0)
        if move.branch is not None:
            values &= self._image.where(self._game.opened(move.branch))
        if move.is_end and move.node.kind is NodeKind.STRUCTURED:
            return values & self._over(move.node.id)
        return values & self._image.where(self._game.done(move.node)) if move.is_end else values

    # -- ends of regions -----------------------------------------------------------------------

    def _over(self, region: str) -> int:
        """The values with which a region may be over."""
        if self._graph.interruptibles or not self._together.started(region):
            return self._image.every
        ends = [edge.id for edge in self._graph.ends(region)]
        last = self._last(region) if self._graph.can_rest(region) else ()
        values = 0
        for place in (*ends, *last):
            values |= self._at.get(place, 0)
        return values

    def _last(self, region: str) -> Iterator[str]:
        """Places where tokens are when nothing in a region can move."""
        yield from map(gone, self._graph.members(region))
        edges, _ = self._graph.inside(region)
        yield from (edge.id for edge in edges if self._is_stuck(edge))

    def _is_stuck(self, edge: TokenEdge) -> bool:
        target = self._graph.node(edge.target)
        if edge.keeps or target.region != edge.region or target.firing is Firing.NEVER:
            return True
        is_any = target.firing in (Firing.ANY, Firing.END)
        return not is_any and len(self._graph.triggers(target)) > 1


class _Image:
    """What conditions and values say of one variable."""

    def __init__(self, store: Store, known: Mapping[str, Domain]) -> None:
        self._name, self._known = store.variable.name, known
        self._values = domains.values(store.variable.domain)
        self._bits = {value: 1 << place for place, value in enumerate(self._values)}
        self.gave_up = False
        """Whether conditions or values were too large to look at."""
        self.every = (1 << len(self._values)) - 1
        self._where: dict[Formula, int] = {}
        self._gives: dict[tuple[Formula, Formula, int], int] = {}

    def only(self, value: Literal) -> int:
        """The value alone."""
        return self._bits.get(value, self.every)

    def where(self, condition: Formula) -> int:
        """The values with which a condition may hold."""
        if condition not in self._where:
            self._where[condition] = self._holding(condition)
        return self._where[condition]

    def _holding(self, condition: Formula) -> int:
        others = self._others(condition)
        if others is None:
            return self.every
        truth, found = evaluation(condition), 0
        for value, bit in self._bits.items():
            if any(truth({**row, self._name: value}, None) for row in others):
                found |= bit
        return found

    def _others(self, *formulas: Formula) -> list[dict[str, Literal]] | None:
        """All values of the other variables; None when there are too many."""
        names = {one.name for formula in formulas for one in f.variables(formula)} - {self._name}
        others = {name: self._known[name] for name in sorted(names & self._known.keys())}
        if len(others) < len(names) or self._count(others) > _MOST_VALUATIONS:
            self.gave_up = True
            return None
        return list(domains.valuations(others))

    def _count(self, others: Mapping[str, Domain]) -> int:
        return domains.count(others) * len(self._values)

    def after(self, write: Write, before: int) -> int:
        """The values that a write gives."""
        found = 0
        for condition, value in write.values:
            held = before & self.where(condition)
            found |= self._given(condition, value, held) if held else 0
        return found

    def _given(self, condition: Formula, value: Formula, before: int) -> int:
        others = self._others(condition, value)
        if others is None:
            return self.every
        truth, gives, found = evaluation(condition), evaluation(value), 0
        for known, bit in self._bits.items():
            if before & bit:
                found |= self._all_given(truth, gives, others, known)
        return found

    def _all_given(
        self, truth: Evaluation, gives: Evaluation, others: list[dict[str, Literal]], known: Literal
    ) -> int:
        found = 0
        for row in others:
            now = {**row, self._name: known}
            found |= self.only(gives(now, None)) if truth(now, None) else 0
        return found
