"""Writes of an activity that saturate: their value can leave the range of the variable.

The data-flow analysis ``ValueAnalysis`` decides most writes. For the others, all reachable states
are searched with every decision of the environment, up to a limit. The search tracks only the
relevant variables: those of the writes, those that guards and ends of actions read, and those from
which their values are computed. A variable without an initial value may start with each value of
its domain.
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
from sysmlc.logic.activities.concurrency import (
    ConcurrencyRelation,
    Move,
    consumed_place,
    index_moves_by_place,
)
from sysmlc.logic.activities.interpreter import BranchPlan
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
from sysmlc.logic.activities.token_step import State
from sysmlc.logic.contract import Domain
from sysmlc.logic.evaluate import Evaluation, compile_evaluation
from sysmlc.logic.formula import Const, Formula, Literal
from sysmlc.logic.simplification import is_satisfiable, substitute

_T = TypeVar("_T")
_MAX_MOVES = 100_000
"""Limit of nodes and flows visited in all steps: a tenth of a second."""
_MAX_INPUTS = 64
"""Limit of valuations of the inputs that written values read."""


class SearchResult(Struct, frozen=True):
    """Writes that saturate in some run. If the search is complete, the others never saturate."""

    writes: list[Write]
    is_complete: bool


def _search_saturating_writes(graph: TokenGraph, writes: Iterable[Write]) -> SearchResult:
    """Search until each write has saturated, all states are visited, or the limit is reached."""
    open_writes = list(writes)
    return _Search(_reduce_to_relevant(graph, open_writes), open_writes).run()


def _reduce_to_relevant(graph: TokenGraph, relevant_writes: Sequence[Write]) -> TokenGraph:
    """Return the graph with only the variables that are relevant for these writes."""
    guards = (edge.guard.condition for edge in graph.edges if edge.guard is not None)
    formulas = [*guards, *(node.done for node in graph.nodes)]
    names = _variable_names(formula for formula in formulas if formula is not None)
    names |= {
        store.variable.name
        for store in graph.stores
        if any(write in relevant_writes for write in store.writes)
    }
    while True:
        stores = tuple(store for store in graph.stores if store.variable.name in names)
        added = _variable_names(
            part
            for store in stores
            for write in store.writes
            for pair in write.values
            for part in pair
        )
        added |= _variable_names(store.follows for store in stores if store.follows is not None)
        if added <= names:
            return replace(graph, stores=stores)
        names |= added


def _variable_names(formulas: Iterable[Formula]) -> set[str]:
    return {variable.name for formula in formulas for variable in f.variables(formula)}


class _Search:
    def __init__(self, graph: TokenGraph, writes_to_decide: list[Write]) -> None:
        self._graph, self._formulas = graph, StepFormulas(replace(graph, named_conditions=()))
        self._open_writes = list(writes_to_decide)
        self._domains = {variable.name: variable.domain for variable in graph.inputs}
        self._steps = _MAX_MOVES // (len(graph.nodes) + len(graph.edges))
        values = (part for s in graph.stores for w in s.writes for p in w.values for part in p)
        read = _variable_names(values) & self._domains.keys()
        self._input_domains = {name: self._domains[name] for name in sorted(read)}

    def run(self) -> SearchResult:
        """Return the writes that saturate."""
        all_writes = list(self._open_writes)
        is_complete = self._search_states()
        return SearchResult(
            [write for write in all_writes if write not in self._open_writes], is_complete
        )

    def _search_states(self) -> bool:
        unset = {
            store.variable.name: store.variable.domain
            for store in self._graph.stores
            if store.first is None
        }
        starts = domains.count(unset)
        if starts > self._steps or domains.count(self._input_domains) > _MAX_INPUTS:
            return False
        worklist = list(_initial_states(self._graph, unset))
        visited = set(worklist)
        for state in worklist:
            self._open_writes = [
                write for write in self._open_writes if not self._can_saturate(write, state)
            ]
            if not self._open_writes:
                return True
            for successor in self._successors(state):
                self._steps -= 1
                if self._steps < 0:
                    return False
                if successor not in visited:
                    visited.add(successor)
                    worklist.append(successor)
        return True

    def _can_saturate(self, write: Write, state: State) -> bool:
        """Whether the node may end in this state and assign a saturated value."""
        if write.node not in state.running:
            return False
        node, values = self._graph.node(write.node), token_game.values_of_state(self._graph, state)
        constants = {name: Const(value) for name, value in values.items()}
        condition = substitute(
            f.both(self._formulas.finish_formula(node), f.either(*write.stops)), constants
        )
        return is_satisfiable(condition, self._domains)

    def _successors(self, state: State) -> Iterator[State]:
        for inputs in domains.valuations(self._input_domains):
            plans: list[list[int]] = [[]]
            while plans:
                oracle = _PlannedChoices(inputs, self._domains, plans.pop())
                yield token_game.next_state(self._graph, state, inputs, oracle.holds, oracle.choose)
                plans += oracle.list_alternatives()


def _initial_states(graph: TokenGraph, unset: Mapping[str, Domain]) -> Iterator[State]:
    default = token_game.initial_state(graph)
    for values in domains.valuations(unset):
        stored = tuple((name, values.get(name, value)) for name, value in default.stored)
        yield replace(default, stored=stored)


class _PlannedChoices(BranchPlan):
    """Decisions of the environment in one step: open branches, and conditions over its inputs."""

    def __init__(
        self, inputs: Mapping[str, Literal], variable_domains: Mapping[str, Domain], plan: list[int]
    ) -> None:
        super().__init__(plan)
        self._inputs, self._domains = inputs, variable_domains
        self._answers: dict[Formula, bool] = {}

    def holds(self, formula: Formula, values: Mapping[str, Literal]) -> bool:
        """Whether a condition holds; the plan decides conditions over unknown inputs."""
        if all(variable.name in values for variable in f.variables(formula)):
            return evaluate.is_true(formula, values)
        if formula not in self._answers:
            constants = {name: Const(value) for name, value in values.items()}
            self._answers[formula] = self._choose_answer(substitute(formula, constants))
        return self._answers[formula]

    def _choose_answer(self, formula: Formula) -> bool:
        # A condition that is constant under the known values is no decision of the environment.
        ways = (
            (True, is_satisfiable(formula, self._domains)),
            (False, is_satisfiable(f.negate(formula), self._domains)),
        )
        possible = [answer for answer, can_be in ways if can_be]
        return self.choose(None, possible)


_CACHE_SIZE = 256
"""Cache size: a process that compiles again reuses results of activities that did not change."""


class Possibility(StrEnum):
    """Whether something happens in some run."""

    YES = "can"
    NO = "cannot"
    PERHAPS = "may (it has too many states to tell)"


@lru_cache(_CACHE_SIZE)
def find_saturating_writes(tokens: TokenGraph) -> tuple[tuple[Store, Write, Possibility], ...]:
    """Return each write that may leave its range, and whether that happens in some run."""
    candidates = [
        (store, write) for store in tokens.stores for write in store.writes if write.stops
    ]
    concurrency = ConcurrencyRelation(tokens)
    estimates = [(*write, _analyse_values(tokens, concurrency, *write)) for write in candidates]
    result = _search_saturating_writes(
        tokens, [write for _, write, possibility in estimates if possibility is Possibility.PERHAPS]
    )
    remaining = Possibility.NO if result.is_complete else Possibility.PERHAPS
    return tuple(
        (
            store,
            write,
            Possibility.YES
            if write in result.writes
            else remaining
            if possibility is Possibility.PERHAPS
            else possibility,
        )
        for store, write, possibility in estimates
    )


def _analyse_values(
    tokens: TokenGraph, concurrency: ConcurrencyRelation, store: Store, write: Write
) -> Possibility:
    """Return the result of the data-flow analysis for a write."""
    if domains.size(store.variable.domain) > MAX_VALUES:
        return Possibility.PERHAPS
    analysis = ValueAnalysis(_reduce_to_relevant(tokens, [write]), concurrency, store)
    if not analysis.may_stop(write):
        return Possibility.NO
    return Possibility.YES if analysis.is_exact else Possibility.PERHAPS


# -- values by place -------------------------------------------------------------------------------


MAX_VALUES = 4_096
"""Limit of the domain of the analysed variable."""
_MAX_VALUATIONS = 20_000
"""Above this number of valuations, a condition counts as true for every value."""


class ValueAnalysis:
    """Data-flow analysis: the values that a variable may have while a place holds a token.

    The analysis propagates the values of one variable along the flows; all other variables may have
    any value at any time. The result covers every run, but may contain values that never occur.
    Sets of values are bit masks in the order of the domain, which has at most ``MAX_VALUES``.
    """

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
