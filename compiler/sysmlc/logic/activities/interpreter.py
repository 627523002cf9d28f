"""Reference interpreter of token graphs, independent of the derived formulas.

Tests compare the contracts of ``derivation`` with the interpreter: every conjunct must hold in each
of its runs, and must fail in a run that was changed.
"""

from collections.abc import Callable, Iterator, Sequence
from typing import TypeVar

from sysmlc.logic import domains, evaluate
from sysmlc.logic.activities.token_graph import TokenGraph
from sysmlc.logic.activities.token_nodes import ACTIVITY_REGION, TokenNode
from sysmlc.logic.activities.token_step import Choose, Inputs, State, TokenStep, choose_first
from sysmlc.logic.formula import Formula, Literal

_T = TypeVar("_T")


class BranchPlan:
    """A choice function for one replay of a step: backtracking without copies of the state.

    It takes the *planned* branches, and then the first branch of each further choice. It counts the
    options of every choice, so that ``list_alternatives`` can plan the branches not taken.
    """

    def __init__(self, planned: list[int]) -> None:
        self._planned = planned
        self._counts: list[int] = []

    def choose(self, _node: TokenNode | None, options: Sequence[_T]) -> _T:
        """Return the planned option, or the first one."""
        self._counts.append(len(options))
        position = len(self._counts) - 1
        return options[self._planned[position] if position < len(self._planned) else 0]

    def list_alternatives(self) -> Iterator[list[int]]:
        """Yield a plan for each other branch of the choices that were not planned."""
        branches = [*self._planned, *[0] * (len(self._counts) - len(self._planned))]
        for position in range(len(self._planned), len(self._counts)):
            for branch in range(1, self._counts[position]):
                yield [*branches[:position], branch]


def initial_state(graph: TokenGraph) -> State:
    """Return the first state. A variable without an initial value has its least value."""
    stored = (
        (
            store.variable.name,
            domains.values(store.variable.domain)[0] if store.first is None else store.first,
        )
        for store in graph.stores
    )
    if graph.handshake is not None and not graph.handshake.is_started:
        return State(frozenset(), frozenset(), tuple(stored), is_performed=False)
    start = graph.start_all(ACTIVITY_REGION)
    return State(start.tokens, start.running, tuple(stored))


def values_of(graph: TokenGraph, state: State, inputs: Inputs) -> dict[str, Literal]:
    """Return the values of all variables of the system in a step with these inputs."""
    step = TokenStep(graph, state, inputs, evaluate.is_true)
    conditions: dict[str, Literal] = {}
    for id, name in graph.named_conditions:
        edge = graph.find_edge(id)
        conditions[name] = step.is_complete(id) if edge is None else step.arrives(edge)
    if graph.handshake is not None:
        conditions[graph.handshake.finished] = step.is_finished()
    return values_of_state(graph, state) | conditions


def values_of_state(graph: TokenGraph, state: State) -> dict[str, Literal]:
    """Return the values of the variables that do not depend on the inputs of the step."""
    values: dict[str, Literal] = {node.run: node.id in state.running for node in graph.workers()}
    values |= {
        edge.variable: edge.id in state.tokens for edge in graph.edges if graph.can_hold(edge)
    }
    if graph.handshake is not None:
        values[graph.handshake.running] = state.is_performed
    return values | dict(state.stored)


def state_of(graph: TokenGraph, valuation: Inputs) -> State:
    """Return the state with these values of variables, the inverse of ``values_of``."""
    return State(
        frozenset(e.id for e in graph.edges if graph.can_hold(e) and valuation[e.variable]),
        frozenset(node.id for node in graph.workers() if valuation[node.run]),
        tuple((store.variable.name, valuation[store.variable.name]) for store in graph.stores),
        graph.handshake is None or bool(valuation[graph.handshake.running]),
    )


def next_state(
    graph: TokenGraph,
    state: State,
    inputs: Inputs,
    holds: Callable[[Formula, Inputs], bool],
    choose: Choose = choose_first,
) -> State:
    """Return the state after one step; *holds* evaluates a condition over the inputs.

    Raises NotSafeError if the graph is not 1-safe.
    """
    return TokenStep(graph, state, inputs, holds, choose).compute_next()
