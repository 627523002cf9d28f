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


def reduce(net: Net) -> None:
    """Apply the reductions until none applies."""
    _delay_ends(net)
    rules = (_drop_idle, _merge_parallel_moves, _fuse_places, _fuse_moves, _merge_parallel_places)
    while sum(rule(net) for rule in rules):
        pass


def _delay_ends(net: Net) -> None:
    """Let a token reach a final node one move later, so that what is before it can be fused."""
    for move in [move for move in net.moves if move.is_end]:
        (place,) = move.takes
        end = f"{place}$end"
        net.places[end] = None
        net.moves.append(Move({place}, {end}, set()))
        move.takes = {end}


def _makers(net: Net) -> dict[str, list[Move]]:
    found: dict[str, list[Move]] = {place: [] for place in net.places}
    for move in net.moves:
        for place in sorted(move.gives):
            found[place].append(move)
    return found


def _takers(net: Net) -> dict[str, list[Move]]:
    found: dict[str, list[Move]] = {place: [] for place in net.places}
    for move in net.moves:
        for place in sorted(move.takes):
            found[place].append(move)
    return found


def _credit(net: Net, place: str, nodes: set[str], makers: Iterable[Move]) -> None:
    """Nodes that fire as soon as the place is marked fire with each move that marks it."""
    if place in net.marked:
        net.alive |= nodes
    for maker in makers:
        maker.nodes |= nodes


def _drop_idle(net: Net) -> bool:
    """A move that gives back exactly the one token that it takes changes nothing."""
    idle = [m for m in net.moves if len(m.takes) == 1 and m.takes == m.gives and not m.is_end]
    makers = _makers(net)
    for move in idle:
        (place,) = move.takes
        net.busy.add(place)
        _credit(net, place, move.nodes, (m for m in makers[place] if m is not move))
    net.moves = [move for move in net.moves if not any(move is other for other in idle)]
    return bool(idle)


def _merge_parallel_moves(net: Net) -> bool:
    seen: dict[tuple[frozenset[str], frozenset[str], bool], Move] = {}
    for move in net.moves:
        key = (frozenset(move.takes), frozenset(move.gives), move.is_end)
        seen.setdefault(key, move).nodes |= move.nodes
    has_changed = len(seen) < len(net.moves)
    net.moves = list(seen.values())
    return has_changed


def _merge_parallel_places(net: Net) -> bool:
    makers, takers = _makers(net), _takers(net)
    seen: dict[tuple[object, ...], str] = {}
    doomed = []
    for place in net.places:
        key = (
            tuple(map(id, makers[place])),
            tuple(map(id, takers[place])),
            place in net.marked,
        )
        if seen.setdefault(key, place) != place and takers[place]:
            doomed.append(place)
            net.busy |= {seen[key]} if place in net.busy else set()
    for place in doomed:
        for move in (*makers[place], *takers[place]):
            move.gives.discard(place)
            move.takes.discard(place)
        _forget(net, place)
    return bool(doomed)


def _forget(net: Net, place: str) -> None:
    del net.places[place]
    net.marked.discard(place)
    net.busy.discard(place)


def _fuse_places(net: Net) -> bool:
    """p -> move -> q, where p has no other taker: p is q."""
    makers, takers = _makers(net), _takers(net)
    touched: set[str] = set()
    gone: list[Move] = []
    for move in net.moves:
        if move.is_end or len(move.takes) != 1 or len(move.gives) != 1:
            continue
        (before,), (after,) = move.takes, move.gives
        if before == after or {before, after} & touched or len(takers[before]) != 1:
            continue
        if {before, after} <= net.marked or any(after in m.gives for m in makers[before]):
            continue
        if _has_end(takers, {after}):
            continue
        touched |= {before, after}
        gone.append(move)
        _credit(net, before, move.nodes, makers[before])
        for maker in makers[before]:
            maker.gives.remove(before)
            maker.gives.add(after)
        if before in net.marked:
            net.marked.add(after)
        _forget(net, before)
    net.moves = [move for move in net.moves if not any(move is other for other in gone)]
    return bool(gone)


def _fuse_moves(net: Net) -> bool:
    """move -> p -> move, where p has one maker and one taker, which takes nothing else."""
    makers, takers = _makers(net), _takers(net)
    touched: list[Move] = []
    gone: list[Move] = []
    for place in list(net.places):
        if place in net.marked or len(makers[place]) != 1 or len(takers[place]) != 1:
            continue
        maker, taker = makers[place][0], takers[place][0]
        is_free = not any(m is maker or m is taker for m in touched)
        if not is_free or not _fusible(maker, taker, place) or _has_end(takers, taker.gives):
            continue
        touched += [maker, taker]
        gone.append(taker)
        maker.gives = (maker.gives - {place}) | taker.gives
        maker.nodes |= taker.nodes
        _forget(net, place)
    net.moves = [move for move in net.moves if not any(move is other for other in gone)]
    return bool(gone)


def _has_end(takers: dict[str, list[Move]], places: set[str]) -> bool:
    """Whether a token there ends the region at once, which a token before it does not."""
    return any(taker.is_end for place in places for taker in takers[place])


def _fusible(maker: Move, taker: Move, place: str) -> bool:
    if maker is taker or taker.is_end or maker.is_end or taker.takes != {place}:
        return False
    return bool(taker.gives) and not taker.gives & (maker.gives - {place})
