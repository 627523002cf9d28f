"""Data-flow analysis: the values that a variable may have while a place holds a token.

The analysis propagates the values of one variable along the flows; all other variables may have any
value at any time. The result covers every run, but may contain values that never occur. Sets of
values are bit masks in the order of the domain.
"""

from collections.abc import Iterable, Iterator, Mapping

from sysmlc.logic import domains
from sysmlc.logic import formula as f
from sysmlc.logic.activities.concurrency import (
    ConcurrencyRelation,
    Move,
    consumed_place,
    index_moves_by_place,
)
from sysmlc.logic.activities.step_formulas import StepFormulas
from sysmlc.logic.activities.token_graph import TokenGraph
from sysmlc.logic.activities.token_nodes import (
    ACTIVITY_REGION,
    Firing,
    NodeKind,
    Store,
    TokenEdge,
    Write,
)
from sysmlc.logic.contract import Domain
from sysmlc.logic.evaluate import Evaluation, compile_evaluation
from sysmlc.logic.formula import Formula, Literal

MAX_VALUES = 4_096
"""Limit of the domain of the analysed variable."""
_MAX_VALUATIONS = 20_000
"""Above this number of valuations, a condition counts as true for every value."""


class ValueAnalysis:
    """The values of one variable at each place; its domain has at most ``MAX_VALUES`` values."""

    def __init__(self, graph: TokenGraph, relation: ConcurrencyRelation, store: Store) -> None:
        self._graph, self._relation, self._store = graph, relation, store
        self._formulas = StepFormulas(graph)
        variables = (*graph.inputs, *(stored.variable for stored in graph.stores))
        variable_domains = {variable.name: variable.domain for variable in variables}
        self._value_sets = _ValueSets(store, variable_domains)
        self._writes = {write.node: write for write in store.writes}
        self._moves_by_place = index_moves_by_place(relation.moves)
        self._values_at: dict[str, int] = {}
        self._applied: dict[Move, int] = {}
        self._worklist: dict[Move, None] = {}
        self._propagate()

    @property
    def is_exact(self) -> bool:
        """Whether every value of the result occurs in some run.

        This holds with a single token and a single written variable, without interruptions.
        """
        is_alone = self._relation.is_sequential and len(self._graph.stores) == 1
        return is_alone and not self._graph.interruptibles and not self._value_sets.has_given_up

    def may_stop(self, write: Write) -> bool:
        """Whether the write may saturate."""
        values = self._values_at.get(write.node, 0)
        values &= self._value_sets.filter_values(
            self._formulas.done_formula(self._graph.node(write.node))
        )
        return any(values & self._value_sets.filter_values(stop) for stop in write.stops)

    def _propagate(self) -> None:
        start_edges = self._relation.list_start_edges(ACTIVITY_REGION)
        region_moves = [move for move in self._relation.moves if move.clears]
        self._add_values(start_edges, self._initial_values())
        previous: dict[str, int] = {}
        while previous != self._values_at:
            previous = dict(self._values_at)
            while self._worklist:
                move = next(iter(self._worklist))
                del self._worklist[move]
                self._apply_move(move)
            for move in region_moves:
                self._apply_move(move)
            self._add_values(start_edges, self._restart_values())

    def _initial_values(self) -> int:
        first = self._store.first
        return self._value_sets.every if first is None else self._value_sets.single(first)

    def _restart_values(self) -> int:
        """Return the values that the variable retains when the activity restarts."""
        if self._store.local and self._store.first is not None:
            return 0
        return self._values_at_completion(ACTIVITY_REGION)

    def _add_values(self, places: Iterable[str], values: int) -> None:
        for place in places:
            present = self._values_at.get(place, 0)
            if values & ~present:
                self._values_at[place] = present | values
                self._worklist.update(dict.fromkeys(self._moves_by_place(place)))

    def _apply_move(self, move: Move) -> None:
        values = self._values_before(move) & ~self._applied.get(move, 0)
        if not values:
            return
        self._applied[move] = self._applied.get(move, 0) | values
        write = self._writes.get(move.node.id) if move.is_end else None
        if write is None:
            self._add_values(move.gives, values)
            return
        # The new value is also seen by the tokens that other places hold at the same time.
        written = self._value_sets.written_values(write, values)
        self._add_values((*move.gives, *self._relation.list_concurrent_places(write.node)), written)

    def _values_before(self, move: Move) -> int:
        """Return the values of the variable under which a move is possible."""
        values = self._value_sets.every
        for place in move.takes:
            values &= self._values_at.get(place, 0)
        if move.branch is not None:
            values &= self._value_sets.filter_values(self._formulas.guard_formula(move.branch))
        if move.is_end and move.node.kind is NodeKind.STRUCTURED:
            return values & self._values_at_completion(move.node.id)
        if move.is_end:
            values &= self._value_sets.filter_values(self._formulas.done_formula(move.node))
        return values

    # -- ends of regions -----------------------------------------------------------------------

    def _values_at_completion(self, region: str) -> int:
        """Return the values of the variable under which a region may be complete."""
        if self._graph.interruptibles or not self._relation.list_start_edges(region):
            return self._value_sets.every
        final_edges = [edge.id for edge in self._graph.ends(region)]
        resting = self._list_resting_places(region) if self._graph.can_rest(region) else ()
        values = 0
        for place in (*final_edges, *resting):
            values |= self._values_at.get(place, 0)
        return values

    def _list_resting_places(self, region: str) -> Iterator[str]:
        """Yield the places that may hold tokens while nothing in a region can move."""
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

    def __init__(self, store: Store, variable_domains: Mapping[str, Domain]) -> None:
        self._name, self._domains = store.variable.name, variable_domains
        self._values = domains.values(store.variable.domain)
        self._bits = {value: 1 << place for place, value in enumerate(self._values)}
        self.has_given_up = False
        """Whether a condition or an expression had too many valuations."""
        self.every = (1 << len(self._values)) - 1
        self._filter_cache: dict[Formula, int] = {}

    def single(self, value: Literal) -> int:
        """Return the set with one value."""
        return self._bits.get(value, self.every)

    def filter_values(self, condition: Formula) -> int:
        """Return the values of the variable under which the condition may hold."""
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
        names = {variable.name for formula in formulas for variable in f.variables(formula)}
        names.discard(self._name)
        other_domains = {name: self._domains[name] for name in sorted(names & self._domains.keys())}
        has_unknown_domain = len(other_domains) < len(names)
        count = domains.count(other_domains) * len(self._values)
        if has_unknown_domain or count > _MAX_VALUATIONS:
            self.has_given_up = True
            return None
        return list(domains.valuations(other_domains))

    def written_values(self, write: Write, before: int) -> int:
        """Return the values that the write may assign, given the values *before*."""
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
