"""Whether a token graph is 1-safe in its own game: all states that it can reach, step by step.

Everything that can move moves in one step, as ``token_game`` plays it; what the environment
decides (when actions end, which branches are open) is tried in all ways. States are bit sets: one
bit for each edge and each running node.
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

_STEPS_A_STATE = 16
"""Steps that are tried for each allowed state before the search gives up."""


class UnsafeError(Exception):
    """A second token reached an edge, or a merge; the argument is the id of either."""


@dataclass(slots=True)
class Reached:
    """What the search found: nodes that get tokens while they run, that fired, regions that rest.

    ``unsafe`` is the id of an edge or a node that may get two tokens. ``is_complete`` is false
    when there were more states than allowed; nothing is known then.
    """

    unsafe: str = ""
    queues: set[str] = field(default_factory=set)
    fired: set[str] = field(default_factory=set)
    rests: set[str] = field(default_factory=set)
    finishes: bool = False
    is_complete: bool = True
    states: int = 0


def explore(graph: TokenGraph, limit: int) -> Reached:
    """Go through all states, at most ``limit`` of them."""
    reached, board = Reached(), _Board(graph)
    first = board.marked[ACTIVITY_REGION]
    seen, waiting, steps = {first}, [first], 0
    try:
        for state in waiting:
            for after in board.successors(state, reached):
                steps += 1
                if after not in seen:
                    seen.add(after)
                    waiting.append(after)
                if len(seen) > limit or steps > limit * _STEPS_A_STATE:
                    reached.is_complete = False
                    return reached
    except UnsafeError as error:
        reached.unsafe = str(error)
    reached.states = len(seen)
    return reached


class _Part(Struct, frozen=True):
    """A node as bits; ``triggers`` are what keeps its region from being complete.

    ``apart`` are the incoming edges, those that interrupt one region together.
    """

    node: TokenNode
    firing: Firing
    takes: int
    gives: int
    run: int
    triggers: int
    around: tuple[str, ...]
    branches: tuple[int, ...]
    apart: tuple[int, ...]
    is_timed: bool


class _Change(Struct, frozen=True):
    """What a node does in a step: bits that vanish, and bits that appear."""

    takes: int = 0
    gives: int = 0
    starts: int = 0


class _Board:
    """The graph as bits."""

    def __init__(self, graph: TokenGraph) -> None:
        self.graph = graph
        names = [*(edge.id for edge in graph.edges), *(f"{n.id} runs" for n in graph.workers())]
        self.bits = {name: 1 << number for number, name in enumerate(names)}
        self.keeps = self._mask(edge for edge in graph.edges if edge.keeps)
        self.parts = [self._part(node) for node in graph.nodes if node.firing is not Firing.NEVER]
        self.members = {
            region: [part for part in self.parts if part.node.region == region]
            for region in graph.regions()
        }
        self.ends = {region: self._mask(graph.ends(region)) for region in graph.regions()}
        self.marked = {
            region: self._mask(e for e in graph.inside(region)[0] if e.marked)
            for region in graph.regions()
        }
        self.content = {region: self._content(region) for region in graph.regions()}
        self.structured = [p for p in self.parts if p.node.kind is NodeKind.STRUCTURED]
        lost = {one.id: self._lost(frozenset(one.nodes)) for one in graph.interruptibles}
        self.hearing = [
            (self.bits[edge.id], self._run(graph.node(edge.target)), *self._heard(edge))
            for edge in graph.edges
            if edge.listens
        ]
        self.losses = [
            (self.bits[edge.id], lost[edge.interrupts]) for edge in graph.edges if edge.interrupts
        ]

    def _heard(self, edge: TokenEdge) -> tuple[int, int, frozenset[str]]:
        """The edges that make an edge listen, and what has to run around it."""
        around = list(self.graph.regions_around(edge.region))
        runs = sum(map(self._run, around))
        return self._mask(self.graph.entering(edge.listens)), runs, frozenset(n.id for n in around)

    def _mask(self, edges: "Iterator[TokenEdge] | list[TokenEdge]") -> int:
        return sum(self.bits[edge.id] for edge in edges)

    def _run(self, node: TokenNode) -> int:
        return self.bits.get(f"{node.id} runs", 0)

    def _part(self, node: TokenNode) -> _Part:
        outgoing = self.graph.outgoing(node)
        return _Part(
            node,
            node.firing,
            self._mask(self.graph.incoming(node)),
            self._mask(outgoing),
            self._run(node),
            self._mask(self.graph.triggers(node)),
            tuple(around.id for around in self.graph.regions_around(node.region)),
            tuple(self.bits[edge.id] for edge in outgoing),
            self._apart(node),
            node.duration is Duration.TIMED and node.done is not None,
        )

    def _apart(self, node: TokenNode) -> tuple[int, ...]:
        found: dict[str, int] = {}
        for edge in self.graph.incoming(node):
            key = edge.interrupts or edge.id
            found[key] = found.get(key, 0) | self.bits[edge.id]
        return tuple(found.values())

    def _content(self, region: str) -> int:
        """The edges and running nodes in a region and in the regions inside it."""
        edges, workers = self.graph.inside(region)
        inner = [node for node in workers if node.kind is NodeKind.STRUCTURED]
        own = self._mask(edges) | sum(map(self._run, workers))
        for node in inner:
            own |= self._content(node.id)
        return own

    def _lost(self, members: frozenset[str]) -> int:
        lost = self._mask(e for e in self.graph.edges if {e.source, e.target} <= members)
        for node in self.graph.workers():
            if node.id in members:
                lost |= self._run(node)
                lost |= self.content.get(node.id, 0)
        return lost

    # -- one step --------------------------------------------------------------------------

    def successors(self, state: int, reached: Reached) -> Iterator[int]:
        """All states after one step. Raises UnsafeError."""
        if self._is_complete(ACTIVITY_REGION, state, reached):
            reached.finishes = True
            yield self.marked[ACTIVITY_REGION]
            return
        ended = {
            part.node.id
            for part in self.structured
            if state & part.run and self._is_complete(part.node.id, state, reached)
        }
        runs = {part.node.id for part in self.structured if state & part.run} - ended
        options = [
            changes
            for part in self.parts
            if all(region in runs for region in part.around)
            and (changes := list(self._changes(part, state, ended, reached)))
        ]
        for chosen in product(*options):
            yield self._after(state, chosen, ended)

    def _is_complete(self, region: str, state: int, reached: Reached) -> bool:
        if state & self.ends[region]:
            reached.fired.update(
                part.node.id
                for part in self.members[region]
                if part.firing is Firing.END and state & part.takes
            )
            return True
        if any(_is_active(part, state) for part in self.members[region]):
            return False
        reached.rests.add(region)
        return True

    def _changes(
        self, part: _Part, state: int, ended: set[str], reached: Reached
    ) -> Iterator[_Change]:
        """The ways in which a node may move; none when it has no tokens."""
        ready = state & part.takes
        has_all = bool(part.takes) and ready == part.takes
        if part.firing is Firing.WORK:
            yield from self._work(part, state, has_all, ended, reached)
        elif part.firing is Firing.ANY and ready:
            if part.gives & ~self.keeps and sum(bool(ready & one) for one in part.apart) > 1:
                raise UnsafeError(part.node.id)
            reached.fired.add(part.node.id)
            yield _Change(ready, part.gives)
        elif part.firing is Firing.ALL and has_all:
            reached.fired.add(part.node.id)
            yield _Change(ready, part.gives)
        elif part.firing is Firing.CHOICE and has_all:
            reached.fired.add(part.node.id)
            yield from (_Change(ready, branch) for branch in part.branches or (0,))
            if part.branches and not part.node.exhaustive:
                yield _Change()

    def _work(
        self, part: _Part, state: int, has_all: bool, ended: set[str], reached: Reached
    ) -> Iterator[_Change]:
        node = part.node
        if state & part.run:
            if has_all:
                reached.queues.add(node.id)
            if node.kind is NodeKind.STRUCTURED:
                is_done = node.id in ended
                yield _Change(part.run, part.gives) if is_done else _Change()
                return
            yield _Change(part.run, part.gives)
            if part.is_timed:
                yield _Change()
        elif has_all:
            reached.fired.add(node.id)
            yield _Change(part.takes, 0, part.run)

    def _after(self, state: int, changes: tuple[_Change, ...], ended: set[str]) -> int:
        takes = gives = starts = 0
        for change in changes:
            takes |= change.takes
            gives |= change.gives
            starts |= change.starts
        left = state & ~(takes & ~self.keeps)
        if left & gives & ~self.keeps:
            raise UnsafeError(self._name(left & gives & ~self.keeps))
        for heard, run, coming, around, regions in self.hearing:
            is_alive = state & around == around and not regions & ended
            if takes & coming and not state & (heard | run) and is_alive:
                gives |= heard
        after = left | gives | starts
        for region in sorted(ended):
            after &= ~self.content[region]
        for entered, lost in self.losses:
            if gives & entered:
                after &= ~lost
        for part in self.structured:
            if starts & part.run and after & part.run:
                after |= self.marked[part.node.id]
        return after

    def _name(self, bits: int) -> str:
        return next(name for name, bit in self.bits.items() if bit & bits)


def _is_active(part: _Part, state: int) -> bool:
    if state & part.run:
        return True
    if part.firing in (Firing.ANY, Firing.END):
        return bool(state & part.takes)
    return bool(part.triggers) and state & part.triggers == part.triggers
