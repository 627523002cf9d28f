"""Writes of an activity that saturate: their value can leave the range of the variable.

A data-flow analysis (``value_analysis``) decides most writes. For the others, all reachable states
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
from sysmlc.logic.activities.concurrency import ConcurrencyRelation
from sysmlc.logic.activities.interpreter import BranchPlan
from sysmlc.logic.activities.step_formulas import StepFormulas
from sysmlc.logic.activities.token_graph import TokenGraph
from sysmlc.logic.activities.token_nodes import Store, Write
from sysmlc.logic.activities.token_step import State
from sysmlc.logic.activities.value_analysis import MAX_VALUES, ValueAnalysis
from sysmlc.logic.contract import Domain
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
