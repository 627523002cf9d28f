"""1-safety of a token graph under synchronous steps: a search of all reachable states.

All nodes that can move do so in one step, as in ``interpreter``. The search tries all decisions of
the environment: when actions end, and which branches are open. States are bit sets with one bit for
each edge and each running node.
"""

from collections.abc import Iterator
from dataclasses import dataclass, field
from itertools import product

from msgspec import Struct

from sysmlc.logic.activities.token_graph import (
    ACTIVITY_REGION,
    Duration,
    Firing,
    NodeKind,
    TokenEdge,
    TokenGraph,
    TokenNode,
)

_STEPS_PER_STATE = 16
"""Limit of steps for each allowed state; above it the search gives up."""


class UnsafeError(Exception):
    """A second token reached an edge or a merge; the argument is its id."""


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
    """Search all reachable states, at most *limit* of them."""
    reached, bit_graph = ReachabilityResult(), _BitGraph(graph)
    first = bit_graph.marked[ACTIVITY_REGION]
    visited, worklist, steps = {first}, [first], 0
    try:
        for state in worklist:
            for after in bit_graph.successors(state, reached):
                steps += 1
                if after not in visited:
                    visited.add(after)
                    worklist.append(after)
                if len(visited) > limit or steps > limit * _STEPS_PER_STATE:
                    reached.is_complete = False
                    return reached
    except UnsafeError as error:
        reached.unsafe = str(error)
    reached.states = len(visited)
    return reached


class _BitNode(Struct, frozen=True):
    """A node with bit masks for its edges.

    ``run`` is the bit that it runs. ``triggers`` are the edges that prevent the completion of its
    region while all of them hold a token. ``around`` are the regions around it. ``incoming_groups``
    are its incoming edges, grouped by the region that they interrupt.
    """

    node: TokenNode
    firing: Firing
    takes: int
    gives: int
    run: int
    triggers: int
    around: tuple[str, ...]
    branches: tuple[int, ...]
    incoming_groups: tuple[int, ...]
    is_timed: bool


class _Change(Struct, frozen=True):
    """The effect of a node in one step: edges that lose or get a token, and nodes that start."""

    takes: int = 0
    gives: int = 0
    starts: int = 0


class _BitGraph:
    """A token graph with bit masks for its nodes, regions and interruptions."""

    def __init__(self, graph: TokenGraph) -> None:
        self.graph = graph
        names = [*(edge.id for edge in graph.edges), *(f"{n.id} runs" for n in graph.workers())]
        self.bits = {name: 1 << number for number, name in enumerate(names)}
        self.keeps = self._edge_mask(edge for edge in graph.edges if edge.keeps)
        self.bit_nodes = [
            self._encode_node(node) for node in graph.nodes if node.firing is not Firing.NEVER
        ]
        self.members = {
            region: [bit_node for bit_node in self.bit_nodes if bit_node.node.region == region]
            for region in graph.regions()
        }
        self.ends = {region: self._edge_mask(graph.ends(region)) for region in graph.regions()}
        self.marked = {
            region: self._edge_mask(e for e in graph.inside(region)[0] if e.marked)
            for region in graph.regions()
        }
        self.content = {region: self._content_mask(region) for region in graph.regions()}
        self.structured = [p for p in self.bit_nodes if p.node.kind is NodeKind.STRUCTURED]
        lost = {
            region.id: self._lost_mask(frozenset(region.nodes)) for region in graph.interruptibles
        }
        self.listening_edges = [
            (
                self.bits[edge.id],
                self._run_bit(graph.node(edge.target)),
                *self._encode_listening(edge),
            )
            for edge in graph.edges
            if edge.listens
        ]
        self.interruptions = [
            (self.bits[edge.id], lost[edge.interrupts]) for edge in graph.edges if edge.interrupts
        ]

    def _encode_listening(self, edge: TokenEdge) -> tuple[int, int, frozenset[str]]:
        """Return what a listening edge depends on.

        These are the mask of edges that trigger it, and the mask and ids of the regions around it,
        which must run.
        """
        regions = list(self.graph.regions_around(edge.region))
        runs = sum(map(self._run_bit, regions))
        return (
            self._edge_mask(self.graph.entering(edge.listens)),
            runs,
            frozenset(region_node.id for region_node in regions),
        )

    def _edge_mask(self, edges: "Iterator[TokenEdge] | list[TokenEdge]") -> int:
        return sum(self.bits[edge.id] for edge in edges)

    def _run_bit(self, node: TokenNode) -> int:
        return self.bits.get(f"{node.id} runs", 0)

    def _encode_node(self, node: TokenNode) -> _BitNode:
        outgoing = self.graph.outgoing(node)
        return _BitNode(
            node,
            node.firing,
            self._edge_mask(self.graph.incoming(node)),
            self._edge_mask(outgoing),
            self._run_bit(node),
            self._edge_mask(self.graph.triggers(node)),
            tuple(around.id for around in self.graph.regions_around(node.region)),
            tuple(self.bits[edge.id] for edge in outgoing),
            self._group_incoming(node),
            node.duration is Duration.TIMED and node.done is not None,
        )

    def _group_incoming(self, node: TokenNode) -> tuple[int, ...]:
        groups: dict[str, int] = {}
        for edge in self.graph.incoming(node):
            key = edge.interrupts or edge.id
            groups[key] = groups.get(key, 0) | self.bits[edge.id]
        return tuple(groups.values())

    def _content_mask(self, region: str) -> int:
        """Return the mask of the edges and running nodes in a region and in regions inside it."""
        edges, workers = self.graph.inside(region)
        structured = [node for node in workers if node.kind is NodeKind.STRUCTURED]
        mask = self._edge_mask(edges) | sum(map(self._run_bit, workers))
        for node in structured:
            mask |= self._content_mask(node.id)
        return mask

    def _lost_mask(self, members: frozenset[str]) -> int:
        mask = self._edge_mask(
            edge for edge in self.graph.edges if {edge.source, edge.target} <= members
        )
        for node in self.graph.workers():
            if node.id in members:
                mask |= self._run_bit(node)
                mask |= self.content.get(node.id, 0)
        return mask

    # -- one step --------------------------------------------------------------------------

    def successors(self, state: int, reached: ReachabilityResult) -> Iterator[int]:
        """Yield all states after one step. Raises UnsafeError."""
        if self._is_complete(ACTIVITY_REGION, state, reached):
            reached.finishes = True
            yield self.marked[ACTIVITY_REGION]
            return
        ended = {
            node.node.id
            for node in self.structured
            if state & node.run and self._is_complete(node.node.id, state, reached)
        }
        runs = {node.node.id for node in self.structured if state & node.run} - ended
        options = [
            changes
            for node in self.bit_nodes
            if all(region in runs for region in node.around)
            and (changes := list(self._list_changes(node, state, ended, reached)))
        ]
        # All nodes move in the same step, so that the successors are all combinations.
        for combination in product(*options):
            yield self._apply_changes(state, combination, ended)

    def _is_complete(self, region: str, state: int, reached: ReachabilityResult) -> bool:
        if state & self.ends[region]:
            reached.fired.update(
                node.node.id
                for node in self.members[region]
                if node.firing is Firing.END and state & node.takes
            )
            return True
        if any(_is_active(node, state) for node in self.members[region]):
            return False
        reached.rests.add(region)
        return True

    def _list_changes(
        self, node: _BitNode, state: int, ended: set[str], reached: ReachabilityResult
    ) -> Iterator[_Change]:
        """Yield the alternative effects of a node in a step; none if it cannot move."""
        ready = state & node.takes
        has_all = bool(node.takes) and ready == node.takes
        if node.firing is Firing.WORK:
            yield from self._work_changes(node, state, has_all, ended, reached)
        elif node.firing is Firing.ANY and ready:
            if (
                node.gives & ~self.keeps
                and sum(bool(ready & group) for group in node.incoming_groups) > 1
            ):
                raise UnsafeError(node.node.id)
            reached.fired.add(node.node.id)
            yield _Change(ready, node.gives)
        elif node.firing is Firing.ALL and has_all:
            reached.fired.add(node.node.id)
            yield _Change(ready, node.gives)
        elif node.firing is Firing.CHOICE and has_all:
            reached.fired.add(node.node.id)
            yield from (_Change(ready, branch) for branch in node.branches or (0,))
            if node.branches and not node.node.exhaustive:
                yield _Change()

    def _work_changes(
        self,
        bit_node: _BitNode,
        state: int,
        has_all: bool,
        ended: set[str],
        reached: ReachabilityResult,
    ) -> Iterator[_Change]:
        node = bit_node.node
        if state & bit_node.run:
            if has_all:
                reached.queues.add(node.id)
            if node.kind is NodeKind.STRUCTURED:
                is_done = node.id in ended
                yield _Change(bit_node.run, bit_node.gives) if is_done else _Change()
                return
            yield _Change(bit_node.run, bit_node.gives)
            if bit_node.is_timed:
                yield _Change()
        elif has_all:
            reached.fired.add(node.id)
            yield _Change(bit_node.takes, 0, bit_node.run)

    def _apply_changes(self, state: int, changes: tuple[_Change, ...], ended: set[str]) -> int:
        takes = gives = starts = 0
        for change in changes:
            takes |= change.takes
            gives |= change.gives
            starts |= change.starts
        remaining = state & ~(takes & ~self.keeps)
        if remaining & gives & ~self.keeps:
            raise UnsafeError(self._name_of(remaining & gives & ~self.keeps))
        for listening, run, entering, region_runs, regions in self.listening_edges:
            is_alive = state & region_runs == region_runs and not regions & ended
            if takes & entering and not state & (listening | run) and is_alive:
                gives |= listening
        after = remaining | gives | starts
        for region in sorted(ended):
            after &= ~self.content[region]
        for entered, lost_bits in self.interruptions:
            if gives & entered:
                after &= ~lost_bits
        for node in self.structured:
            if starts & node.run and after & node.run:
                after |= self.marked[node.node.id]
        return after

    def _name_of(self, bits: int) -> str:
        return next(name for name, bit in self.bits.items() if bit & bits)


def _is_active(node: _BitNode, state: int) -> bool:
    if state & node.run:
        return True
    if node.firing in (Firing.ANY, Firing.END):
        return bool(state & node.takes)
    return bool(node.triggers) and state & node.triggers == node.triggers
