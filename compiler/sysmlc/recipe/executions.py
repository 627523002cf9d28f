"""The executions of a flow graph: which situations they reach, and what they cost.

A situation is a node that a token reaches, with the known values of variables and the iterations of
the loops around it. Branches of a fork are explored one by one up to their join. Guards that
depend on unknown values leave all their branches open.
"""

from collections.abc import Iterable, Iterator, Mapping
from itertools import product
from typing import NamedTuple

from msgspec import Struct

from sysmlc.recipe.costs import Cost, Measures, Transition, compute_costs, compute_expected_time
from sysmlc.recipe.expression import evaluate
from sysmlc.recipe.flow import (
    STEPS,
    find_loop_cycles,
    find_reachable,
    fix_iterations,
    list_forward_edges,
)
from sysmlc.recipe.model import FlowEdge, FlowGraph, Node
from sysmlc.recipe.valuation import CHOICES, Valuation, Variables, merge_values, set_value

_ENDS = frozenset({"final", "flowFinal"})
_ITERATION = "#"
"""Prefix of the entry of a valuation that counts the iterations of a loop node."""
_MOST_COMBINATIONS = 2000
"""Most combinations of outcomes of parallel branches."""
_DEEPEST_FORK = 100
"""Most forks inside of one another; a branch that leads back to its fork has no end of them."""


class TooManySituationsError(RuntimeError):
    """The executions reach more situations than the exploration may visit."""


class UnstructuredError(RuntimeError):
    """The branches of a fork do not meet at one join."""


class Situation(NamedTuple):
    """A token that reaches a node; ``is_joined`` after the join has taken all its tokens."""

    node: str
    values: Valuation
    is_joined: bool = False


_Step = Transition[Situation]
_Outcomes = dict[Situation, Cost]


class Precision(Struct, frozen=True):
    """What an exploration distinguishes: values of variables, and iterations of loops.

    Strict bounds exclude executions whose values require another round of a loop after its last
    one; otherwise these executions continue.
    """

    has_values: bool = True
    has_iterations: bool = True
    has_strict_bounds: bool = True


class Result(Struct, frozen=True):
    """The cost of the executions that end at each final node, and their expected milliseconds.

    ``endless`` has the nodes that executions may repeat without a bound.
    """

    ends: dict[str, Cost]
    expected: float | None
    endless: tuple[str, ...]


class Exploration:
    """The executions of one graph, with at most *limit* situations."""

    def __init__(
        self,
        graph: FlowGraph,
        measures: Measures,
        variables: Variables,
        precision: Precision,
        limit: int,
    ) -> None:
        self._nodes = {node.id: fix_iterations(node, graph) for node in graph.nodes}
        self._measures = measures
        self._variables = variables
        self._precision = precision
        self._remaining = limit
        self._outgoing = _list_outgoing(graph, self._nodes)
        self._forward = list_forward_edges(graph)
        targets = [target for _, target in self._forward]
        self._joins = {
            id
            for id, node in self._nodes.items()
            if (node.kind == "join" or node.kind in STEPS) and targets.count(id) > 1
        }
        self._cycles = find_loop_cycles(graph)
        self._endless: dict[str, None] = {}
        self._explored: dict[tuple[Situation, frozenset[str]], _Outcomes] = {}
        self._depth = 0

    def run(self) -> Result:
        """Return the result for executions that begin at the initial node.

        Raises TooManySituationsError and UnstructuredError.
        """
        start = next((node.id for node in self._nodes.values() if node.kind == "initial"), None)
        if start is None:
            return Result({}, None, ())
        first = Situation(start, self._variables.start if self._precision.has_values else ())
        transitions = self._explore(first, frozenset())
        ends: dict[str, Cost] = {}
        for (id, _, _), cost in self._find_outcomes(first, transitions).items():
            ends[id] = ends[id] | cost if id in ends else cost
        if any(self._nodes[id].kind not in _ENDS for id in ends):
            raise UnstructuredError
        return Result(ends, compute_expected_time(first, transitions), tuple(self._endless))

    # -- situations ----------------------------------------------------------------------------

    def _explore(self, first: Situation, volatile: frozenset[str]) -> dict[Situation, list[_Step]]:
        """Return the transitions of all situations that *first* leads to; ends have none.

        *volatile* variables have no known value, because a parallel branch assigns them.
        """
        transitions: dict[Situation, list[_Step]] = {}
        worklist = [first]
        while worklist:
            situation = worklist.pop()
            if situation in transitions:
                continue
            self._remaining -= 1
            if self._remaining < 0:
                raise TooManySituationsError
            is_end = self._is_end(situation)
            steps = [] if is_end else list(self._iter_transitions(situation, volatile))
            transitions[situation] = steps
            worklist += (step.target for step in steps)
        return transitions

    def _find_outcomes(
        self, first: Situation, transitions: Mapping[Situation, list[_Step]]
    ) -> _Outcomes:
        """Return the costs of the ends, and record the nodes of cycles without a bound."""
        ends = [situation for situation in transitions if self._is_end(situation)]
        outcomes, endless = compute_costs(first, ends, transitions, self._measures.zero)
        self._endless.update(dict.fromkeys(situation.node for situation in endless))
        return outcomes

    def _is_end(self, situation: Situation) -> bool:
        is_join = situation.node in self._joins and not situation.is_joined
        return is_join or self._nodes[situation.node].kind in _ENDS

    def _iter_transitions(self, situation: Situation, volatile: frozenset[str]) -> Iterator[_Step]:
        node = self._nodes[situation.node]
        cost = self._measures.of_step.get(node.id, self._measures.zero)
        values = situation.values
        if self._precision.has_values:
            values = self._variables.assign(node, values, volatile)
        outgoing = self._outgoing.get(node.id, [])
        if node.kind in CHOICES:
            yield from self._choose(node, outgoing, values, volatile)
        elif node.kind == "forEach":
            for edge in self._select_iterations(node, outgoing, values):
                yield Transition(self._follow(edge, values), cost)
        elif len(outgoing) > 1:
            yield from self._fork(outgoing, values, volatile, cost)
        else:
            yield from (Transition(self._follow(edge, values), cost) for edge in outgoing)

    def _follow(self, edge: FlowEdge, values: Valuation) -> Situation:
        """Return the situation behind an edge; iterations count only inside their loop."""
        node = self._nodes[edge.source]
        limit = self._find_iterations(node)
        if edge.role == "body" and limit is not None:
            count = min(_count_iterations(values, node) + 1, limit)
            values = set_value(values, _ITERATION + node.id, count)
        live_values = tuple(
            (name, value)
            for name, value in values
            if not name.startswith(_ITERATION)
            or edge.target in self._cycles[name.removeprefix(_ITERATION)].nodes
        )
        return Situation(edge.target, live_values)

    # -- choices and loops ---------------------------------------------------------------------

    def _choose(
        self, node: Node, outgoing: list[FlowEdge], values: Valuation, volatile: frozenset[str]
    ) -> Iterator[_Step]:
        """Yield a transition for each case of the values and each edge that is open in it."""
        cases = [values]
        if self._precision.has_values:
            guards = [guard for edge in outgoing if (guard := self._variables.guards.get(edge))]
            cases = list(self._variables.iter_cases(guards, values, volatile))
        cases_by_edge: dict[FlowEdge, list[Valuation]] = {}
        for case in cases:
            open_edges = self._select_open(outgoing, case)
            for edge in self._select_iterations(node, open_edges, case):
                cases_by_edge.setdefault(edge, []).append(case)
        probabilities = _find_probabilities(list(cases_by_edge), outgoing)
        for edge, edge_cases in cases_by_edge.items():
            probability = probabilities.get(edge)
            # A probability is that of the edge, so that its cases stay together.
            is_split = probability is None or len(edge_cases) == 1
            for case in edge_cases if is_split else [values]:
                yield Transition(self._follow(edge, case), self._measures.zero, probability)

    def _select_open(self, outgoing: list[FlowEdge], values: Valuation) -> list[FlowEdge]:
        """Return the edges whose guards may be true; else edges if no guard certainly is."""
        valuation = dict(values)
        guards = self._variables.guards
        truths = {edge: evaluate(guards[edge], valuation) for edge in outgoing if edge in guards}
        is_decided = any(truths.values())
        return [
            edge
            for edge in outgoing
            if (not is_decided if edge.is_else else truths.get(edge) is not False)
        ]

    def _select_iterations(
        self, node: Node, outgoing: list[FlowEdge], values: Valuation
    ) -> list[FlowEdge]:
        """Return the edges that the number of iterations allows at a loop or for-each node."""
        limit = self._find_iterations(node)
        body = [edge for edge in outgoing if edge.role == "body"]
        exits = [edge for edge in outgoing if edge.role != "body"]
        if limit is None or not body:
            return outgoing
        count = _count_iterations(values, node)
        if node.kind == "forEach" and count < node.min_iterations:
            return body
        if node.max_iterations is None or count < limit:
            return outgoing
        return exits if exits or self._precision.has_strict_bounds else body

    def _find_iterations(self, node: Node) -> int | None:
        """Return the number of iterations up to which they are counted, None if they are not."""
        if not self._precision.has_iterations or node.id not in self._cycles:
            return None
        if node.kind == "forEach":
            limit = node.max_iterations
            return (node.min_iterations or None) if limit is None else limit
        if node.max_iterations is None:
            return None
        # A loop that is tested first is closed as often as its body runs; a loop that is tested
        # last is closed once less, because the last round leaves it.
        return node.max_iterations - (0 if self._cycles[node.id].is_tested_first else 1)

    # -- parallel branches ---------------------------------------------------------------------

    def _fork(
        self, outgoing: list[FlowEdge], values: Valuation, volatile: frozenset[str], cost: Cost
    ) -> Iterator[_Step]:
        """Yield a transition to the join, or to the end, for each combination of outcomes."""
        shared = volatile | self._find_shared_variables([edge.target for edge in outgoing])
        start = tuple(item for item in values if item[0] not in shared)
        branches = [
            list(self._explore_branch(self._follow(edge, start), shared).items())
            for edge in outgoing
        ]
        size = 1
        for outcomes in branches:
            size *= len(outcomes)
        if size > _MOST_COMBINATIONS:
            raise TooManySituationsError
        steps = [
            step
            for combination in product(*branches)
            if (step := self._combine(combination, branches, start, cost)) is not None
        ]
        probability = 1.0 if len(steps) == 1 else None
        yield from (Transition(step.target, step.cost, probability) for step in steps)

    def _explore_branch(self, first: Situation, volatile: frozenset[str]) -> _Outcomes:
        key = (first, volatile)
        if key not in self._explored:
            self._depth += 1
            if self._depth > _DEEPEST_FORK:
                raise TooManySituationsError
            transitions = self._explore(first, volatile)
            self._explored[key] = self._find_outcomes(first, transitions)
            self._depth -= 1
        return self._explored[key]

    def _combine(
        self,
        combination: tuple[tuple[Situation, Cost], ...],
        branches: list[list[tuple[Situation, Cost]]],
        start: Valuation,
        cost: Cost,
    ) -> _Step | None:
        """Return the transition for one outcome of each branch; None if they exclude each other."""
        values = merge_values([situation.values for situation, _ in combination], start)
        if values is None:
            return None
        costs = [branch_cost for _, branch_cost in combination]
        kinds = [self._nodes[situation.node].kind for situation, _ in combination]
        if "final" in kinds:
            return self._end_activity(combination, kinds, values, cost)
        joins = {
            s.node for (s, _), kind in zip(combination, kinds, strict=True) if kind not in _ENDS
        }
        total = self._measures.run_in_parallel(costs)
        if len(joins) > 1:
            raise UnstructuredError
        if not joins:
            return Transition(Situation(combination[0][0].node, values), cost + total)
        (join,) = joins
        waiting = []
        for (_, branch_cost), kind, outcomes in zip(combination, kinds, branches, strict=True):
            if kind not in _ENDS:
                waiting.append(branch_cost)
            elif any(situation.node == join for situation, _ in outcomes):
                # The join waits forever for a branch that ends at a flow final node instead.
                return None
        # A branch that ends by itself may be shorter or longer than those that the join awaits.
        lowest = self._measures.run_in_parallel(waiting).low[0]
        total = Cost((lowest, *total.low[1:]), total.high)
        return Transition(Situation(join, values, is_joined=True), cost + total)

    def _end_activity(
        self,
        combination: tuple[tuple[Situation, Cost], ...],
        kinds: list[str],
        values: Valuation,
        cost: Cost,
    ) -> _Step:
        """Return the transition to the first final node: it ends the other branches."""
        costs = [branch_cost for _, branch_cost in combination]
        final = [number for number, kind in enumerate(kinds) if kind == "final"]
        lowest = min(costs[number].low[0] for number in final)
        highest = min(self._measures.bound_branch(number, costs) for number in final)
        total = self._measures.run_in_parallel(costs)
        none = self._measures.zero.low[1:]
        end = Situation(combination[final[0]][0].node, values)
        return Transition(end, cost + Cost((lowest, *none), (highest, *total.high[1:])))

    def _find_shared_variables(self, targets: list[str]) -> frozenset[str]:
        """Return the variables that one branch assigns and another one uses."""
        reached = [find_reachable([target], self._forward) for target in targets]
        common = set.intersection(*reached)
        uses = [self._list_uses(nodes - common) for nodes in reached]
        return frozenset(
            name
            for number, (assigned, _) in enumerate(uses)
            for name in assigned
            if any(name in used for n, (_, used) in enumerate(uses) if n != number)
        )

    def _list_uses(self, nodes: set[str]) -> tuple[set[str], set[str]]:
        """Return the variables that nodes assign, and those that they assign or read."""
        assigned: set[str] = set()
        for id in nodes:
            node = self._nodes[id]
            assigned |= {name for _, name in node.assign} | {node.variable}
        read = self._variables.list_read(nodes)
        return assigned, assigned | read


def _list_outgoing(graph: FlowGraph, nodes: Mapping[str, Node]) -> dict[str, list[FlowEdge]]:
    """Return the edges by their source; two edges between steps are one order."""
    outgoing: dict[str, list[FlowEdge]] = {}
    for edge in graph.edges:
        edges = outgoing.setdefault(edge.source, [])
        is_choice = nodes[edge.source].kind in CHOICES
        if is_choice or edge.target not in {e.target for e in edges}:
            edges.append(edge)
    return outgoing


def _count_iterations(values: Valuation, node: Node) -> int:
    return int(dict(values).get(_ITERATION + node.id, 0))


def _find_probabilities(
    edges: list[FlowEdge], outgoing: Iterable[FlowEdge]
) -> dict[FlowEdge, float]:
    """Return the probabilities of the edges that are open, as far as they are known."""
    if len(edges) == 1:
        return {edges[0]: 1.0}
    stated = {edge: edge.probability for edge in outgoing if edge.probability is not None}
    # Nothing states how the probability of an edge that is closed goes to the others.
    is_complete = stated.keys() == set(edges) == set(outgoing)
    return stated if is_complete else {}
