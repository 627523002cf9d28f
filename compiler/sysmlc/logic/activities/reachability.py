"""1-safety of a token graph under synchronous steps: a search of all reachable states.

The steps are those of ``token_step``. The search tries all decisions of the environment: when
actions end, and which branches are open. Values of variables are ignored.
"""

from dataclasses import dataclass, field

from msgspec.structs import replace

from sysmlc.logic import evaluate
from sysmlc.logic.activities.interpreter import BranchPlan
from sysmlc.logic.activities.token_graph import TokenGraph
from sysmlc.logic.activities.token_nodes import (
    ACTIVITY_REGION,
    Duration,
    Firing,
    NodeKind,
    TokenEdge,
    TokenNode,
)
from sysmlc.logic.activities.token_step import Choose, NotSafeError, State, TokenStep

_EXAMINED_PER_STATE = 50
"""Limit of nodes and edges that steps examine for each allowed state: the search takes about two
seconds for 20,000 allowed states."""


@dataclass(slots=True)
class ReachabilityResult:
    """Result of the search.

    ``queues`` are nodes that receive tokens while they run, ``fired`` the nodes that ever fired,
    ``rests`` the regions that become complete without a final node. ``unsafe`` is the id of an edge
    or node that may get two tokens. If ``is_complete`` is false, there were more states than
    allowed and nothing is known.
    """

    unsafe: str = ""
    queues: set[str] = field(default_factory=set)
    fired: set[str] = field(default_factory=set)
    rests: set[str] = field(default_factory=set)
    finishes: bool = False
    is_complete: bool = True
    states: int = 0


def explore_states(graph: TokenGraph, limit: int) -> ReachabilityResult:
    """Search all reachable states, at most *limit* of them.

    The steps of a large graph take longer, so that the search may give up with fewer states.
    """
    # Which actions get tokens while they run is a result of the search.
    nodes = tuple(replace(node, queues=True) for node in graph.nodes)
    graph = replace(graph, nodes=nodes, stores=(), named_conditions=(), handshake=None)
    reached = ReachabilityResult()
    start = graph.start_all(ACTIVITY_REGION)
    first = State(start.tokens, start.running)
    visited, worklist, steps = {first}, [first], 0
    max_steps = limit * _EXAMINED_PER_STATE // (1 + len(graph.nodes) + len(graph.edges))
    reached.fired |= start.moved
    try:
        for state in worklist:
            plans: list[list[int]] = [[]]
            while plans:
                plan = BranchPlan(plans.pop())
                step = _FreeStep(graph, state, plan.choose)
                after = step.compute_next()
                step.record(reached)
                plans += plan.list_alternatives()
                steps += 1
                if after not in visited:
                    visited.add(after)
                    worklist.append(after)
                if len(visited) > limit or steps > max_steps:
                    reached.is_complete = False
                    return reached
    except NotSafeError as error:
        reached.unsafe = error.place
    reached.states = len(visited)
    return reached


class _FreeStep(TokenStep):
    """A step in which any action may end, and any branch may be open."""

    def __init__(self, graph: TokenGraph, old: State, choose: Choose) -> None:
        self._ends: dict[str, bool] = {}
        self._branches: dict[str, list[TokenEdge]] = {}
        super().__init__(graph, old, {}, evaluate.is_true, choose)

    def is_done(self, node: TokenNode) -> bool:
        is_timed = node.duration is Duration.TIMED and node.done is not None
        if node.kind is NodeKind.STRUCTURED or not is_timed:
            return super().is_done(node)
        if node.id not in self._ends:
            self._ends[node.id] = self.choose(node, (True, False))
        return self._ends[node.id]

    def list_open_branches(self, node: TokenNode) -> list[TokenEdge]:
        if node.id not in self._branches:
            branches = self.graph.outgoing(node)
            options = [[branch] for branch in branches]
            self._branches[node.id] = self.choose(
                node, options if node.exhaustive else [*options, []]
            )
        return self._branches[node.id]

    def record(self, reached: ReachabilityResult) -> None:
        """Add what happened in this step to the result."""
        for region in self.graph.regions():
            around = self.graph.regions_around(region)
            if any(node.id not in self.old.running for node in around):
                continue
            reached.fired |= {n.id for n in self.graph.members(region) if self._fires(n)}
            for node in self.graph.members(region):
                if self.is_busy(node) and self.has_all(self.graph.incoming(node)):
                    reached.queues.add(node.id)
            if self.is_complete(region):
                reached.finishes |= region == ACTIVITY_REGION
                if not self.reaches_final(region):
                    reached.rests.add(region)
        for id in self.begun:
            if self.graph.node(id).kind is NodeKind.STRUCTURED:
                reached.fired |= self.graph.start(id).moved
        reached.fired |= self.begun

    def _fires(self, node: TokenNode) -> bool:
        edges = self.graph.incoming(node)
        match node.firing:
            case Firing.ANY | Firing.END:
                return any(map(self.is_present, edges))
            case Firing.ALL | Firing.CHOICE:
                return self.has_all(edges)
            case _:
                return False
