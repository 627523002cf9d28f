"""Concurrency relation of a token graph: which places may hold tokens at the same time.

The relation is computed from pairs of places instead of markings, so that it takes polynomial time
(A. Kovalyov, "Concurrency relations and the safety problem for Petri nets", 1992). Guards, the
synchronous steps of the game, and interruptions are ignored: the relation may contain pairs that
are never marked together, but it never misses a pair.
"""

from collections.abc import Callable, Iterable, Iterator
from functools import cached_property

from msgspec import Struct

from sysmlc.logic.activities.token_graph import TokenGraph
from sysmlc.logic.activities.token_nodes import (
    ACTIVITY_REGION,
    Firing,
    NodeKind,
    TokenEdge,
    TokenNode,
)


class Move(Struct, frozen=True, eq=False):
    """A step of one node, which moves tokens from the places ``takes`` to the places ``gives``.

    Places are ids of edges and of running nodes. ``branch`` is the edge that a decision selects.
    ``is_end`` is true if the move ends a running node. ``clears`` are the places of a region that
    ends with the move.
    """

    node: TokenNode
    takes: tuple[str, ...]
    gives: tuple[str, ...]
    branch: TokenEdge | None = None
    is_end: bool = False
    clears: tuple[str, ...] = ()


def consumed_place(node: TokenNode) -> str:
    """Return the artificial place for tokens that leave the node's region at this node.

    The place is marked after the node has taken a token without giving one to an edge of its
    region. It records that the region may be at rest.
    """
    return f"{node.id} gone"


class ConcurrencyRelation:
    """The moves of a token graph, and the pairs of places that may be marked together."""

    def __init__(self, graph: TokenGraph) -> None:
        self.graph = graph
        self.moves = [move for node in graph.nodes for move in self._moves(node)]
        places = (place for move in self.moves for place in (*move.takes, *move.gives))
        ordered = dict.fromkeys([*(edge.id for edge in graph.edges), *places])
        self._bits = {place: 1 << number for number, place in enumerate(ordered)}

    def list_start_edges(self, region: str) -> list[str]:
        """List the edges that hold a token when a region starts."""
        return [edge.id for edge in self.graph.inside(region)[0] if edge.marked]

    def are_concurrent(self, left: str, right: str) -> bool:
        """Whether both places may hold a token at the same time."""
        return bool(self._concurrent[left] & self._bits[right])

    @cached_property
    def is_sequential(self) -> bool:
        """Whether no two places are ever marked together, so that there is only one token."""
        return not any(self._concurrent.values())

    def list_concurrent_places(self, place: str) -> Iterator[str]:
        """Yield the places that may hold a token at the same time as *place*."""
        mask = self._concurrent[place]
        return (other for other, bit in self._bits.items() if bit & mask)

    # -- moves ---------------------------------------------------------------------------------

    def _moves(self, node: TokenNode) -> Iterator[Move]:
        incoming, outgoing = self.graph.incoming(node), self.graph.outgoing(node)
        match node.firing:
            case Firing.ANY:
                for edge in incoming:
                    yield self._make_move(node, [edge], outgoing)
            case Firing.ALL if incoming:
                yield self._make_move(node, incoming, outgoing)
            case Firing.CHOICE if incoming:
                for edge in outgoing:
                    yield self._make_move(node, incoming, [edge], edge)
                if not outgoing:
                    yield self._make_move(node, incoming, [])
            case Firing.WORK:
                yield from self._work_moves(node, incoming, outgoing)

    def _make_move(
        self,
        node: TokenNode,
        taken: list[TokenEdge],
        given: list[TokenEdge],
        branch: TokenEdge | None = None,
    ) -> Move:
        retained = [edge.id for edge in taken if edge.keeps]
        gives = [*self._given_places(node, given), *retained, *self._listening_places(taken)]
        return Move(node, _edge_ids(taken), tuple(gives), branch)

    def _work_moves(
        self, node: TokenNode, incoming: list[TokenEdge], outgoing: list[TokenEdge]
    ) -> Iterator[Move]:
        is_region = node.kind is NodeKind.STRUCTURED
        if incoming:
            start_edges = self.list_start_edges(node.id) if is_region else []
            retained = [edge.id for edge in incoming if edge.keeps]
            gives = (node.id, *start_edges, *retained, *self._listening_places(incoming))
            yield Move(node, _edge_ids(incoming), gives)
        clears = tuple(self._content_places(node.id)) if is_region else ()
        yield Move(node, (node.id,), (*self._given_places(node, outgoing),), None, True, clears)

    def _given_places(self, node: TokenNode, edges: list[TokenEdge]) -> list[str]:
        places = [edge.id for edge in edges]
        stays_in_region = any(edge.region == node.region for edge in edges)
        return places if stays_in_region else [*places, consumed_place(node)]

    def _listening_places(self, taken: list[TokenEdge]) -> list[str]:
        """List the listening edges that get a token when a node takes tokens from these edges."""
        return [
            edge.id
            for edge in self._listening
            if any(entering in taken for entering in self.graph.entering(edge.listens))
        ]

    @cached_property
    def _listening(self) -> list[TokenEdge]:
        return [edge for edge in self.graph.edges if edge.listens]

    def _content_places(self, region: str) -> Iterator[str]:
        """Yield the places in a region and in the regions inside it."""
        edges, workers = self.graph.inside(region)
        yield from (edge.id for edge in edges)
        yield from map(consumed_place, self.graph.members(region))
        for node in workers:
            yield node.id
            if node.kind is NodeKind.STRUCTURED:
                yield from self._content_places(node.id)

    # -- pairs ---------------------------------------------------------------------------------

    @cached_property
    def _concurrent(self) -> dict[str, int]:
        """The concurrency relation: a bit mask of concurrent places for each place."""
        return _PairSearch(
            self._bits, self.moves, self.list_start_edges(ACTIVITY_REGION)
        ).concurrent


class _PairSearch:
    """Fixpoint of the relation by a worklist of moves.

    A move is applied again when one of the places that it takes from gets new concurrent places.
    """

    def __init__(self, bits: dict[str, int], moves: list[Move], marked: list[str]) -> None:
        self._bits, self._names = bits, list(bits)
        self._reached = self._mask_of(marked)
        self.concurrent = {place: self._reached & ~bits[place] for place in marked}
        self.concurrent = {place: self.concurrent.get(place, 0) for place in bits}
        self._moves_by_place = index_moves_by_place(moves)
        self._worklist = dict.fromkeys(
            move for place in marked for move in self._moves_by_place(place)
        )
        while self._worklist:
            move = next(iter(self._worklist))
            del self._worklist[move]
            self._apply_move(move)

    def _apply_move(self, move: Move) -> None:
        """Add the pairs that a move marks, if all places that it takes from are concurrent."""
        takes = self._mask_of(move.takes)
        remaining = self._reached & ~takes & ~self._mask_of(move.clears)
        for place in move.takes:
            concurrent = self.concurrent[place] | self._bits[place]
            if takes & ~(concurrent & self._reached):
                return
            remaining &= concurrent
        # What was concurrent to all taken places stays marked beside the given places.
        gives = self._mask_of(move.gives)
        for place in move.gives:
            self._mark_place(place, (remaining | gives) & ~self._bits[place])

    def _mark_place(self, place: str, concurrent: int) -> None:
        bit = self._bits[place]
        added = concurrent & ~self.concurrent[place]
        if not added and self._reached & bit:
            return
        self._reached |= bit
        self.concurrent[place] |= added
        self._worklist.update(dict.fromkeys(self._moves_by_place(place)))
        for other in _places(added, self._names):
            self.concurrent[other] |= bit
            self._worklist.update(dict.fromkeys(self._moves_by_place(other)))

    def _mask_of(self, places: Iterable[str]) -> int:
        mask = 0
        for place in places:
            mask |= self._bits.get(place, 0)
        return mask


def index_moves_by_place(moves: Iterable[Move]) -> Callable[[str], list[Move]]:
    """Return a function that lists the moves which take a token from a place."""
    moves_by_place: dict[str, list[Move]] = {}
    for move in moves:
        for place in move.takes:
            moves_by_place.setdefault(place, []).append(move)
    return lambda place: moves_by_place.get(place, [])


def _edge_ids(edges: list[TokenEdge]) -> tuple[str, ...]:
    return tuple(edge.id for edge in edges)


def _places(mask: int, names: list[str]) -> Iterator[str]:
    """Yield the places of a mask, the lowest bit first."""
    while mask:
        low = mask & -mask  # the lowest bit: far fewer steps than testing every place
        yield names[low.bit_length() - 1]
        mask ^= low
