"""Petri nets of regions of token graphs: flows and running actions as places."""

from collections.abc import Iterable, Iterator
from dataclasses import dataclass, field
from itertools import combinations

from msgspec import Struct

from sysmlc.logic.activities.token_graph import Firing, TokenEdge, TokenGraph, TokenNode


@dataclass(slots=True)
class Move:
    """A transition of the net; ``nodes`` are the graph's nodes that fire when it does."""

    takes: set[str]
    gives: set[str]
    nodes: set[str]
    resets: frozenset[str] = frozenset()
    is_end: bool = False


@dataclass(slots=True)
class Net:
    """Places (ids of edges and running nodes), transitions, and the places marked at first.

    ``nodes`` are all nodes that a transition stands for, ``alive`` those known to fire. A token on
    a ``busy`` place can move for ever.
    """

    places: dict[str, None]
    moves: list[Move]
    marked: set[str]
    nodes: frozenset[str]
    alive: set[str] = field(default_factory=set)
    busy: set[str] = field(default_factory=set)


class Safety(Struct, frozen=True):
    """What the search found in one region.

    ``unsafe`` is the id of an edge (or node) that may get a second token, ``dead`` holds
    the ids of nodes that never fire although a path of flows leads to them. ``finishes`` tells
    whether the region may be complete, ``rests`` whether it may be so without a final node.
    ``is_complete`` is false when there were more markings than allowed; nothing is known then
    beyond ``unsafe``.
    """

    unsafe: str = ""
    dead: frozenset[str] = frozenset()
    finishes: bool = True
    rests: bool = True
    is_complete: bool = True


def net_of(graph: TokenGraph, region: str) -> Net:
    """The Petri net of a region, with one place for each edge and each running node."""
    edges, workers = graph.inside(region)
    # A sink takes its token in the next step, whatever happens: nothing can pile up before it.
    drains = {edge.id for edge in edges if _is_drain(graph, edge)}
    kept = [edge for edge in edges if edge.id not in drains]
    places = dict.fromkeys([*(edge.id for edge in kept), *(node.id for node in workers)])
    moves = [
        move
        for node in graph.nodes
        if node.region == region
        for move in _moves(graph, node)
        if not move.takes & drains
    ]
    resets = {edge.id: _reset(graph, edge, places) for edge in edges if edge.interrupts}
    for move in moves:
        move.resets = frozenset(p for gift in sorted(move.gives) for p in resets.get(gift, ()))
        move.gives -= drains
    nodes = frozenset(node for move in moves for node in move.nodes)
    marked = {edge.id for edge in kept if edge.marked}
    for meeting in _meetings(graph, region, drains):
        places |= dict.fromkeys(meeting.gives)
        marked |= meeting.gives
        moves.append(meeting)
    return Net(places, moves, marked, nodes)


def _meetings(graph: TokenGraph, region: str, drains: set[str]) -> Iterator[Move]:
    """Two tokens that reach a merge before a sink at once: the place that they lead to is full."""
    for node in graph.nodes:
        leaving = {edge.id for edge in graph.outgoing(node)}
        if node.region != region or node.firing is not Firing.ANY or not leaving & drains:
            continue
        for one, other in combinations(graph.incoming(node), 2):
            is_one_interruption = one.interrupts and one.interrupts == other.interrupts
            if not is_one_interruption and {one.region, other.region} == {region}:
                yield Move({one.id, other.id}, leaving & drains, set())


def _is_drain(graph: TokenGraph, edge: TokenEdge) -> bool:
    target = graph.node(edge.target)
    return target.firing is Firing.ANY and not graph.outgoing(target)


def _moves(graph: TokenGraph, node: TokenNode) -> Iterator[Move]:
    takes = {edge.id for edge in graph.incoming(node)}
    gives = {edge.id for edge in graph.outgoing(node)}
    match node.firing:
        case Firing.ANY:
            yield from (Move({one}, set(gives), {node.id}) for one in sorted(takes))
        case Firing.END:
            yield from (Move({one}, set(), {node.id}, is_end=True) for one in sorted(takes))
        case Firing.ALL if takes:
            yield Move(takes, gives, {node.id})
        case Firing.CHOICE if takes:
            for gift in sorted(gives):
                yield Move(set(takes), {gift}, {node.id})
            if not gives:
                yield Move(takes, set(), {node.id})
        case Firing.WORK if takes:
            yield Move(takes, {node.id}, {node.id})
            yield Move({node.id}, gives, set())


def _reset(graph: TokenGraph, edge: TokenEdge, places: Iterable[str]) -> frozenset[str]:
    region = next(r for r in graph.interruptibles if r.id == edge.interrupts)
    members = frozenset(region.nodes)
    inside = {e.id for e in graph.edges if {e.source, e.target} <= members}
    return frozenset(place for place in places if place in inside or place in members)
