"""Which flows and running actions of a token graph may have tokens at the same time.

Pairs are looked at and not markings, so that it takes little time for any graph (A. Kovalyov,
"Concurrency relations and the safety problem for Petri nets", 1992). Guards, the pace of the game
and what interruptions take away are not looked at: of two places that are never marked together
it may say that they are, of two that are it never says that they are not.
"""

from collections.abc import Callable, Iterable, Iterator
from functools import cached_property

from msgspec import Struct

from sysmlc.logic.activities.token_graph import (
    ACTIVITY_REGION,
    Firing,
    NodeKind,
    TokenEdge,
    TokenGraph,
    TokenNode,
)


class Move(Struct, frozen=True, eq=False):
    """A node takes tokens and gives some; places are ids of edges and of running nodes.

    ``branch`` is the edge that a decision chooses, ``is_end`` says that a running node is done.
    ``clears`` are the places of a region that is over.
    """

    node: TokenNode
    takes: tuple[str, ...]
    gives: tuple[str, ...]
    branch: TokenEdge | None = None
    is_end: bool = False
    clears: tuple[str, ...] = ()


def gone(node: TokenNode) -> str:
    """The place of tokens that a node takes and gives to no flow of its region."""
    return f"{node.id} gone"


class Together:
    """The moves of a token graph, and the places that may be marked together."""

    def __init__(self, graph: TokenGraph) -> None:
        self.graph = graph
        self.moves = [move for node in graph.nodes for move in self._moves(node)]
        places = (place for move in self.moves for place in (*move.takes, *move.gives))
        known = dict.fromkeys([*(edge.id for edge in graph.edges), *places])
        self._bits = {place: 1 << number for number, place in enumerate(known)}

    def started(self, region: str) -> list[str]:
        """The edges that hold a token when a region starts."""
        return [edge.id for edge in self.graph.inside(region)[0] if edge.marked]

    def are(self, one: str, other: str) -> bool:
        """Whether both places may hold a token at the same time."""
        return bool(self._beside[one] & self._bits[other])

    @cached_property
    def are_none(self) -> bool:
        """Whether no two places are ever marked together: there is one token."""
        return not any(self._beside.values())

    def beside(self, place: str) -> Iterator[str]:
        """The places that may hold a token while this one does."""
        found = self._beside[place]
        return (other for other, bit in self._bits.items() if bit & found)

    # -- moves ---------------------------------------------------------------------------------

    def _moves(self, node: TokenNode) -> Iterator[Move]:
        incoming, outgoing = self.graph.incoming(node), self.graph.outgoing(node)
        match node.firing:
            case Firing.ANY:
                for edge in incoming:
                    yield self._move(node, [edge], outgoing)
            case Firing.ALL if incoming:
                yield self._move(node, incoming, outgoing)
            case Firing.CHOICE if incoming:
                for edge in outgoing:
                    yield self._move(node, incoming, [edge], edge)
                if not outgoing:
                    yield self._move(node, incoming, [])
            case Firing.WORK:
                yield from self._work(node, incoming, outgoing)

    def _move(
        self,
        node: TokenNode,
        taken: list[TokenEdge],
        given: list[TokenEdge],
        branch: TokenEdge | None = None,
    ) -> Move:
        stays = [edge.id for edge in taken if edge.keeps]
        gives = [*self._given(node, given), *stays, *self._heard(taken)]
        return Move(node, _ids(taken), tuple(gives), branch)

    def _work(
        self, node: TokenNode, incoming: list[TokenEdge], outgoing: list[TokenEdge]
    ) -> Iterator[Move]:
        is_region = node.kind is NodeKind.STRUCTURED
        if incoming:
            more = self.started(node.id) if is_region else []
            stays = [edge.id for edge in incoming if edge.keeps]
            gives = (node.id, *more, *stays, *self._heard(incoming))
            yield Move(node, _ids(incoming), gives)
        clears = tuple(self._content(node.id)) if is_region else ()
        yield Move(node, (node.id,), (*self._given(node, outgoing),), None, True, clears)

    def _given(self, node: TokenNode, edges: list[TokenEdge]) -> list[str]:
        found = [edge.id for edge in edges]
        is_left = any(edge.region == node.region for edge in edges)
        return found if is_left else [*found, gone(node)]

    def _heard(self, taken: list[TokenEdge]) -> list[str]:
        """The edges that get a token when these are taken, because they listen."""
        return [edge.id for edge in self._listening if self._is_heard(edge, taken)]

    def _is_heard(self, edge: TokenEdge, taken: list[TokenEdge]) -> bool:
        return any(one in taken for one in self.graph.entering(edge.listens))

    @cached_property
    def _listening(self) -> list[TokenEdge]:
        return [edge for edge in self.graph.edges if edge.listens]

    def _content(self, region: str) -> Iterator[str]:
        """The places in a region and in those inside it."""
        edges, workers = self.graph.inside(region)
        yield from (edge.id for edge in edges)
        yield from map(gone, self.graph.members(region))
        for node in workers:
            yield node.id
            if node.kind is NodeKind.STRUCTURED:
                yield from self._content(node.id)

    # -- pairs ---------------------------------------------------------------------------------

    @cached_property
    def _beside(self) -> dict[str, int]:
        """For each place those that may be marked with it, as bits."""
        return _Pairs(self._bits, self.moves, self.started(ACTIVITY_REGION)).found


class _Pairs:
    """The search for pairs: each move is tried again when what it takes is marked with more."""

    def __init__(self, bits: dict[str, int], moves: list[Move], marked: list[str]) -> None:
        self._bits, self._names = bits, list(bits)
        self._reached = self._mask(marked)
        self.found = {place: self._reached & ~bits[place] for place in marked}
        self.found = {place: self.found.get(place, 0) for place in bits}
        self._takers = takers(moves)
        self._waiting = dict.fromkeys(one for place in marked for one in self._takers(place))
        while self._waiting:
            move = next(iter(self._waiting))
            del self._waiting[move]
            self._make(move)

    def _make(self, move: Move) -> None:
        """Note what the tokens that a move gives are marked with, if it can be made."""
        takes = self._mask(move.takes)
        others = self._reached & ~takes & ~self._mask(move.clears)
        for place in move.takes:
            beside = self.found[place] | self._bits[place]
            if takes & ~(beside & self._reached):
                return
            others &= beside
        gives = self._mask(move.gives)
        for place in move.gives:
            self._mark(place, (others | gives) & ~self._bits[place])

    def _mark(self, place: str, beside: int) -> None:
        own = self._bits[place]
        new = beside & ~self.found[place]
        if not new and self._reached & own:
            return
        self._reached |= own
        self.found[place] |= new
        self._waiting.update(dict.fromkeys(self._takers(place)))
        for other in _places(new, self._names):
            self.found[other] |= own
            self._waiting.update(dict.fromkeys(self._takers(other)))

    def _mask(self, places: Iterable[str]) -> int:
        mask = 0
        for place in places:
            mask |= self._bits.get(place, 0)
        return mask


def takers(moves: Iterable[Move]) -> Callable[[str], list[Move]]:
    """The moves that take a token from a place."""
    found: dict[str, list[Move]] = {}
    for move in moves:
        for place in move.takes:
            found.setdefault(place, []).append(move)
    return lambda place: found.get(place, [])


def _ids(edges: list[TokenEdge]) -> tuple[str, ...]:
    return tuple(edge.id for edge in edges)


def _places(mask: int, names: list[str]) -> Iterator[str]:
    while mask:
        low = mask & -mask
        yield names[low.bit_length() - 1]
        mask ^= low
