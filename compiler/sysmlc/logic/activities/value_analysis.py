"""Values that a variable may have wherever an activity has a token (a data-flow analysis).

One variable is followed along the flows; all others may have any value at any time. The result
covers every run, however many states there are, but may contain values that never occur. Sets of
values are bit masks in the order of the domain.
"""

from collections.abc import Iterable, Iterator, Mapping

from sysmlc.logic import domains
from sysmlc.logic import formula as f
from sysmlc.logic.activities.concurrency import (
    ConcurrencyRelation,
    Move,
    consumed_place,
    index_takers,
)
from sysmlc.logic.activities.step_formulas import StepFormulas
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
from sysmlc.logic.evaluate import Evaluation, compile_evaluation
from sysmlc.logic.formula import Formula, Literal

MAX_VALUES = 4_096
"""Largest domain of a variable that is followed."""
_MAX_VALUATIONS = 20_000
"""Above this number of valuations, a condition counts as true for every value."""


class ValueAnalysis:
    """The values of one variable at each place; its domain has at most ``MAX_VALUES`` values."""

    def __init__(self, graph: TokenGraph, together: ConcurrencyRelation, store: Store) -> None:
        self._graph, self._together, self._store = graph, together, store
        self._game = StepFormulas(graph)
        variables = (*graph.inputs, *(other.variable for other in graph.stores))
        domains = {variable.name: variable.domain for variable in variables}
        self._image = _ValueSets(store, domains)
        self._writes = {write.node: write for write in store.writes}
        self._takers = index_takers(together.moves)
        self._values_at: dict[str, int] = {}
        self._applied: dict[Move, int] = {}
        self._waiting: dict[Move, None] = {}
        self._propagate()

    @property
    def is_exact(self) -> bool:
        """Whether every value of the result occurs: there is one token, and one variable
        decides.
        """
        is_alone = self._together.is_sequential and len(self._graph.stores) == 1
        return is_alone and not self._graph.interruptibles and not self._image.gave_up

    def may_stop(self, write: Write) -> bool:
        """Return whether the write can be clamped when its node is done."""
        values = self._values_at.get(write.node, 0)
        values &= self._image.filter_values(self._game.done_formula(self._graph.node(write.node)))
        return any(values & self._image.filter_values(stop) for stop in write.stops)

    def _propagate(self) -> None:
        start_edges = self._together.list_start_edges(ACTIVITY_REGION)
        region_moves = [move for move in self._together.moves if move.clears]
        self._add_values(start_edges, self._initial_values())
        previous: dict[str, int] = {}
        while previous != self._values_at:
            previous = dict(self._values_at)
            while self._waiting:
                move = next(iter(self._waiting))
                del self._waiting[move]
                self._apply_move(move)
            for move in region_moves:
                self._apply_move(move)
            self._add_values(start_edges, self._restart_values())

    def _initial_values(self) -> int:
        first = self._store.first
        return self._image.every if first is None else self._image.single(first)

    def _restart_values(self) -> int:
        """Return the values with which the activity restarts."""
        if self._store.local and self._store.first is not None:
            return 0
        return self._values_at_completion(ACTIVITY_REGION)

    def _add_values(self, places: Iterable[str], values: int) -> None:
        for place in places:
            present = self._values_at.get(place, 0)
            if values & ~present:
                self._values_at[place] = present | values
                self._waiting.update(dict.fromkeys(self._takers(place)))

    def _apply_move(self, move: Move) -> None:
        values = self._values_before(move) & ~self._applied.get(move, 0)
        if not values:
            return
        self._applied[move] = self._applied.get(move, 0) | values
        write = self._writes.get(move.node.id) if move.is_end else None
        if write is None:
            self._add_values(move.gives, values)
            return
        written = self._image.written_values(write, values)
        self._add_values((*move.gives, *self._together.list_concurrent_places(write.node)), written)

    def _values_before(self, move: Move) -> int:
        """Return the values with which a move is possible."""
        values = self._image.every
        for place in move.takes:
            values &= self._values_at.get(place, 0)
        if move.branch is not None:
            values &= self._image.filter_values(self._game.guard_formula(move.branch))
        if move.is_end and move.node.kind is NodeKind.STRUCTURED:
            return values & self._values_at_completion(move.node.id)
        return (
            values & self._image.filter_values(self._game.done_formula(move.node))
            if move.is_end
            else values
        )

    # -- ends of regions -----------------------------------------------------------------------

    def _values_at_completion(self, region: str) -> int:
        """Return the values with which a region may be complete."""
        if self._graph.interruptibles or not self._together.list_start_edges(region):
            return self._image.every
        final_edges = [edge.id for edge in self._graph.ends(region)]
        resting = self._list_resting_places(region) if self._graph.can_rest(region) else ()
        values = 0
        for place in (*final_edges, *resting):
            values |= self._values_at.get(place, 0)
        return values

    def _list_resting_places(self, region: str) -> Iterator[str]:
        """Yield the places of tokens when nothing in a region can move."""
        yield from map(consumed_place, self._graph.members(region))
        edges, _ = self._graph.inside(region)
        yield from (edge.id for edge in edges if self._is_stuck(edge))

    def _is_stuck(self, edge: TokenEdge) -> bool:
        target = self._graph.node(edge.target)
        if edge.keeps or target.region != edge.region or target.firing is Firing.NEVER:
            return True
        is_any = target.firing in (Firing.ANY, Firing.END)
        return not is_any and len(self._graph.triggers(target)) > 1


class _ValueSets:
    """Sets of values of one variable under conditions and assignments."""

    def __init__(self, store: Store, known: Mapping[str, Domain]) -> None:
        self._name, self._known = store.variable.name, known
        self._values = domains.values(store.variable.domain)
        self._bits = {value: 1 << place for place, value in enumerate(self._values)}
        self.gave_up = False
        """Whether a condition or an expression had too many valuations."""
        self.every = (1 << len(self._values)) - 1
        self._filter_cache: dict[Formula, int] = {}
        self._image_cache: dict[tuple[Formula, Formula, int], int] = {}

    def single(self, value: Literal) -> int:
        """Return the set with one value."""
        return self._bits.get(value, self.every)

    def filter_values(self, condition: Formula) -> int:
        """Return the values with which the condition may hold."""
        if condition not in self._filter_cache:
            self._filter_cache[condition] = self._satisfying_values(condition)
        return self._filter_cache[condition]

    def _satisfying_values(self, condition: Formula) -> int:
        other_valuations = self._list_other_valuations(condition)
        if other_valuations is None:
            return self.every
        truth, satisfying = compile_evaluation(condition), 0
        for value, bit in self._bits.items():
            if any(truth({**row, self._name: value}, None) for row in other_valuations):
                satisfying |= bit
        return satisfying

    def _list_other_valuations(self, *formulas: Formula) -> list[dict[str, Literal]] | None:
        """Return all valuations of the other variables; None if there are too many."""
        names = {variable.name for formula in formulas for variable in f.variables(formula)} - {
            self._name
        }
        other_domains = {name: self._known[name] for name in sorted(names & self._known.keys())}
        if (
            len(other_domains) < len(names)
            or self._count_valuations(other_domains) > _MAX_VALUATIONS
        ):
            self.gave_up = True
            return None
        return list(domains.valuations(other_domains))

    def _count_valuations(self, others: Mapping[str, Domain]) -> int:
        return domains.count(others) * len(self._values)

    def written_values(self, write: Write, before: int) -> int:
        """Return the values that the write gives."""
        image = 0
        for condition, expression in write.values:
            values = before & self.filter_values(condition)
            image |= self._image_of(condition, expression, values) if values else 0
        return image

    def _image_of(self, condition: Formula, value: Formula, values: int) -> int:
        other_valuations = self._list_other_valuations(condition, value)
        if other_valuations is None:
            return self.every
        truth, evaluate, image = compile_evaluation(condition), compile_evaluation(value), 0
        for own_value, bit in self._bits.items():
            if values & bit:
                image |= self._image_of_valuation(truth, evaluate, other_valuations, own_value)
        return image

    def _image_of_valuation(
        self,
        truth: Evaluation,
        evaluate: Evaluation,
        other_valuations: list[dict[str, Literal]],
        own_value: Literal,
    ) -> int:
        image = 0
        for row in other_valuations:
            valuation = {**row, self._name: own_value}
            image |= self.single(evaluate(valuation, None)) if truth(valuation, None) else 0
        return image
