"""Check by Petri nets that a region is 1-safe for every order in which its nodes may move.

A region without forks and joins has one token, and a walk along its flows suffices. For any other
region the markings of its Petri net are searched, after reductions if there are many. Edges and
running nodes are places. Guards are ignored: every branch may be taken. The content of a structured
node is checked separately; in its own region the node counts as an action.

A region that passes is 1-safe in the token game too, where all nodes move at once. The converse
does not hold: a region that is safe only because of the synchronous steps fails here and is left to
``reachability``. Flows across borders of regions and data stores are not places of the net.

The reductions preserve 1-safety. They are those of T. Murata, "Petri nets: properties, analysis and
applications", Proc. IEEE 77(4), 1989, section V.
"""

from collections.abc import Iterable, Iterator
from dataclasses import dataclass, field
from itertools import combinations

from msgspec import Struct

from sysmlc.logic.activities.token_graph import TokenGraph
from sysmlc.logic.activities.token_nodes import Firing, TokenEdge, TokenNode


@dataclass(slots=True)
class NetTransition:
    """A transition of the net.

    ``nodes`` are the ids of the graph's nodes that fire with it. ``resets`` are places that lose
    their tokens when it fires. ``is_end`` is true if it ends the region.
    """

    takes: set[str]
    gives: set[str]
    nodes: set[str]
    resets: frozenset[str] = frozenset()
    is_end: bool = False


@dataclass(slots=True)
class Net:
    """The Petri net of a region: places (ids of edges and running nodes) and transitions.

    ``marked`` are the initially marked places. ``nodes`` are the nodes of the graph that fire with
    some transition, ``alive`` those that reductions have shown to fire. A token on a ``busy`` place
    can move forever, by a self-loop that a reduction removed.
    """

    places: dict[str, None]
    moves: list[NetTransition]
    marked: set[str]
    nodes: frozenset[str]
    alive: set[str] = field(default_factory=set)
    busy: set[str] = field(default_factory=set)


class Safety(Struct, frozen=True):
    """Result of the safety check of one region.

    ``unsafe`` is the id of an edge or node that may get a second token; ``dead`` holds the ids of
    nodes that never fire although a path of flows leads to them. ``finishes`` is true if the region
    may be complete, ``rests`` if that may happen without a token at a final node. If
    ``is_complete`` is false, there were more markings than allowed, and only ``unsafe`` is known.
    """

    unsafe: str = ""
    dead: frozenset[str] = frozenset()
    finishes: bool = True
    rests: bool = True
    is_complete: bool = True


def build_net(graph: TokenGraph, region: str) -> Net:
    """Return the Petri net of a region, with one place for each edge and each running node."""
    edges, running_nodes = graph.inside(region)
    # A sink always takes its token in the next step, so tokens cannot accumulate before it.
    drains = {edge.id for edge in edges if _is_drain(graph, edge)}
    place_edges = [edge for edge in edges if edge.id not in drains]
    places = dict.fromkeys(
        [*(edge.id for edge in place_edges), *(node.id for node in running_nodes)]
    )
    moves = [
        move
        for node in graph.nodes
        if node.region == region
        for move in _build_transitions(graph, node)
        if not move.takes & drains
    ]
    resets = {edge.id: _reset_places(graph, edge, places) for edge in edges if edge.interrupts}
    for move in moves:
        move.resets = frozenset(
            reset_place for place in sorted(move.gives) for reset_place in resets.get(place, ())
        )
        move.gives -= drains
    nodes = frozenset(node for move in moves for node in move.nodes)
    marked = {edge.id for edge in place_edges if edge.marked}
    for meeting in _merge_conflicts(graph, region, drains):
        places |= dict.fromkeys(meeting.gives)
        marked |= meeting.gives
        moves.append(meeting)
    return Net(places, moves, marked, nodes)


def _merge_conflicts(graph: TokenGraph, region: str, drains: set[str]) -> Iterator[NetTransition]:
    """Yield transitions that detect two tokens at a merge whose outgoing edge leads to a sink.

    ``build_net`` omits the places before sinks. Such a transition marks a place that is marked
    already, so that the search finds the second token.
    """
    for node in graph.nodes:
        leaving = {edge.id for edge in graph.outgoing(node)}
        if node.region != region or node.firing is not Firing.ANY or not leaving & drains:
            continue
        for left, right in combinations(graph.incoming(node), 2):
            is_one_interruption = left.interrupts and left.interrupts == right.interrupts
            if not is_one_interruption and {left.region, right.region} == {region}:
                yield NetTransition({left.id, right.id}, leaving & drains, set())


def _is_drain(graph: TokenGraph, edge: TokenEdge) -> bool:
    target = graph.node(edge.target)
    return target.firing is Firing.ANY and not graph.outgoing(target)


def _build_transitions(graph: TokenGraph, node: TokenNode) -> Iterator[NetTransition]:
    takes = {edge.id for edge in graph.incoming(node)}
    gives = {edge.id for edge in graph.outgoing(node)}
    match node.firing:
        case Firing.ANY:
            yield from (NetTransition({taken}, set(gives), {node.id}) for taken in sorted(takes))
        case Firing.END:
            yield from (
                NetTransition({taken}, set(), {node.id}, is_end=True) for taken in sorted(takes)
            )
        case Firing.ALL if takes:
            yield NetTransition(takes, gives, {node.id})
        case Firing.CHOICE if takes:
            for edge_id in sorted(gives):
                yield NetTransition(set(takes), {edge_id}, {node.id})
            if not gives:
                yield NetTransition(takes, set(), {node.id})
        case Firing.WORK if takes:
            yield NetTransition(takes, {node.id}, {node.id})
            yield NetTransition({node.id}, gives, set())


def _reset_places(graph: TokenGraph, edge: TokenEdge, places: Iterable[str]) -> frozenset[str]:
    region = next(
        interruptible
        for interruptible in graph.interruptibles
        if interruptible.id == edge.interrupts
    )
    members = frozenset(region.nodes)
    inside = {inner.id for inner in graph.edges if {inner.source, inner.target} <= members}
    return frozenset(place for place in places if place in inside or place in members)


def reduce_net(net: Net) -> None:
    """Apply the reductions until none applies."""
    _insert_end_places(net)
    rules = (
        _drop_self_loops,
        _merge_parallel_transitions,
        _fuse_series_places,
        _fuse_series_transitions,
        _merge_parallel_places,
    )
    while sum(rule(net) for rule in rules):
        pass


def _insert_end_places(net: Net) -> None:
    """Add a place and a transition before each final node, so that earlier places can be fused."""
    for move in [move for move in net.moves if move.is_end]:
        (place,) = move.takes
        end = f"{place}$end"
        net.places[end] = None
        net.moves.append(NetTransition({place}, {end}, set()))
        move.takes = {end}


def _index_moves(
    net: Net,
) -> tuple[dict[str, list[NetTransition]], dict[str, list[NetTransition]]]:
    """Return the transitions that give to each place, and those that take from it."""
    producers: dict[str, list[NetTransition]] = {place: [] for place in net.places}
    consumers: dict[str, list[NetTransition]] = {place: [] for place in net.places}
    for move in net.moves:
        for place in sorted(move.gives):
            producers[place].append(move)
        for place in sorted(move.takes):
            consumers[place].append(move)
    return producers, consumers


def _mark_fired(net: Net, place: str, nodes: set[str], producers: Iterable[NetTransition]) -> None:
    """Record that *nodes* fire after a transition marks the place, or always if it is marked."""
    if place in net.marked:
        net.alive |= nodes
    for producer in producers:
        producer.nodes |= nodes


def _drop_self_loops(net: Net) -> bool:
    """Remove transitions that return exactly the one token that they take."""
    loops = [
        loop
        for loop in net.moves
        if len(loop.takes) == 1 and loop.takes == loop.gives and not loop.is_end
    ]
    producers, _ = _index_moves(net)
    for move in loops:
        (place,) = move.takes
        net.busy.add(place)
        _mark_fired(net, place, move.nodes, (loop for loop in producers[place] if loop is not move))
    net.moves = [move for move in net.moves if not any(move is other for other in loops)]
    return bool(loops)


def _merge_parallel_transitions(net: Net) -> bool:
    """Merge transitions that take from the same places and give to the same places."""
    merged: dict[tuple[frozenset[str], frozenset[str], bool], NetTransition] = {}
    for move in net.moves:
        key = (frozenset(move.takes), frozenset(move.gives), move.is_end)
        merged.setdefault(key, move).nodes |= move.nodes
    has_changed = len(merged) < len(net.moves)
    net.moves = list(merged.values())
    return has_changed


def _merge_parallel_places(net: Net) -> bool:
    """Merge places with the same producers, consumers and initial marking."""
    producers, consumers = _index_moves(net)
    representatives: dict[tuple[object, ...], str] = {}
    duplicates = []
    for place in net.places:
        key = (
            tuple(map(id, producers[place])),
            tuple(map(id, consumers[place])),
            place in net.marked,
        )
        if representatives.setdefault(key, place) != place and consumers[place]:
            duplicates.append(place)
            net.busy |= {representatives[key]} if place in net.busy else set()
    for place in duplicates:
        for move in (*producers[place], *consumers[place]):
            move.gives.discard(place)
            move.takes.discard(place)
        _remove_place(net, place)
    return bool(duplicates)


def _remove_place(net: Net, place: str) -> None:
    del net.places[place]
    net.marked.discard(place)
    net.busy.discard(place)


def _fuse_series_places(net: Net) -> bool:
    """Fuse the places of p -> transition -> q if p has no other consumer."""
    producers, consumers = _index_moves(net)
    # The indexes are not updated, so that a place takes part in one fusion for each call.
    touched: set[str] = set()
    fused: list[NetTransition] = []
    for move in net.moves:
        if move.is_end or len(move.takes) != 1 or len(move.gives) != 1:
            continue
        (source,), (target,) = move.takes, move.gives
        if source == target or {source, target} & touched or len(consumers[source]) != 1:
            continue
        if {source, target} <= net.marked or any(
            target in producer.gives for producer in producers[source]
        ):
            continue
        if _ends_region(consumers, {target}):
            continue
        touched |= {source, target}
        fused.append(move)
        _mark_fired(net, source, move.nodes, producers[source])
        for producer in producers[source]:
            producer.gives.remove(source)
            producer.gives.add(target)
        if source in net.marked:
            net.marked.add(target)
        _remove_place(net, source)
    net.moves = [move for move in net.moves if not any(move is other for other in fused)]
    return bool(fused)


def _fuse_series_transitions(net: Net) -> bool:
    """Fuse transition -> p -> transition if p has one producer and one consumer.

    The consumer must take from p only.
    """
    producers, consumers = _index_moves(net)
    touched: list[NetTransition] = []
    fused: list[NetTransition] = []
    for place in list(net.places):
        if place in net.marked or len(producers[place]) != 1 or len(consumers[place]) != 1:
            continue
        producer, consumer = producers[place][0], consumers[place][0]
        is_free = not any(
            fused_transition is producer or fused_transition is consumer
            for fused_transition in touched
        )
        if (
            not is_free
            or not _can_fuse(producer, consumer, place)
            or _ends_region(consumers, consumer.gives)
        ):
            continue
        touched += [producer, consumer]
        fused.append(consumer)
        producer.gives = (producer.gives - {place}) | consumer.gives
        producer.nodes |= consumer.nodes
        _remove_place(net, place)
    net.moves = [move for move in net.moves if not any(move is other for other in fused)]
    return bool(fused)


def _ends_region(consumers: dict[str, list[NetTransition]], places: set[str]) -> bool:
    """Return whether a token on one of the places ends the region."""
    return any(consumer.is_end for place in places for consumer in consumers[place])


def _can_fuse(producer: NetTransition, consumer: NetTransition, place: str) -> bool:
    if producer is consumer or consumer.is_end or producer.is_end or consumer.takes != {place}:
        return False
    return bool(consumer.gives) and not consumer.gives & (producer.gives - {place})


# -- the search for a second token -----------------------------------------------------------------


_MAX_MARKINGS_UNREDUCED = 2_000
"""Limit of markings without reductions: the search takes some milliseconds."""


def check_safety(graph: TokenGraph, region: str, limit: int) -> Safety:
    """Search the markings of a region, at most *limit* of them.

    A small net is searched unreduced, so that a fault is located exactly; a large net is reduced
    first. In the reduced net other tokens may move before a final node ends the region, which can
    only produce false alarms.
    """
    single_token = check_single_token(graph, region)
    if single_token is not None:
        return single_token
    net = build_net(graph, region)
    unreduced = search_markings(net, min(limit, _MAX_MARKINGS_UNREDUCED))
    # The reductions do not preserve the effect of interruptions, which reset places.
    if unreduced.is_complete or any(move.resets for move in net.moves):
        return unreduced if unreduced.is_complete else search_markings(net, limit)
    reduce_net(net)
    return search_markings(net, limit)


def search_markings(net: Net, limit: int) -> Safety:
    """Search the markings breadth first; a marking in which the region ends has no successors."""
    bits = {place: 1 << number for number, place in enumerate(net.places)}
    transitions = [
        (
            _mask_of(transition.takes, bits),
            _mask_of(transition.gives, bits),
            _mask_of(transition.resets, bits),
            transition,
        )
        for transition in net.moves
        if not transition.is_end
    ]
    ends = [
        (_mask_of(transition.takes, bits), transition)
        for transition in net.moves
        if transition.is_end
    ]
    initial = _mask_of(net.marked, bits)
    visited, worklist = {initial}, [initial]
    busy = _mask_of(net.busy, bits)
    fired, finishes, rests = set(net.alive), False, False
    # Markings are bit masks, so that a transition is tested and fired by a few integer operations.
    for marking in worklist:
        ended = [transition for takes, transition in ends if marking & takes]
        fired.update(node for transition in ended for node in transition.nodes)
        can_move = bool(ended or marking & busy)
        for takes, gives, resets, transition in transitions:
            if marking & takes != takes:
                continue
            remaining = marking & ~takes
            # Checked where the region ends, too: in the token game, where all nodes move at once,
            # a second token may reach a merge in the step in which the first one leaves it.
            if remaining & gives & ~resets:
                return Safety(unsafe=next(p for p, bit in bits.items() if bit & remaining & gives))
            if ended:
                continue
            can_move = True
            fired |= transition.nodes
            successor = (remaining & ~resets) | gives
            if successor not in visited:
                visited.add(successor)
                worklist.append(successor)
        rests = rests or not can_move
        finishes = finishes or bool(ended)
        if len(visited) > limit:
            return Safety(is_complete=False)
    return Safety(dead=net.nodes - fired, finishes=finishes or rests, rests=rests)


def _mask_of(places: Iterable[str], bits: dict[str, int]) -> int:
    return sum(bits[place] for place in places)


def check_single_token(graph: TokenGraph, region: str) -> Safety | None:
    """Return the result for a region with a single token, or None if there may be more tokens.

    Precondition: no flow crosses the border of the region, and none interrupts a region.
    """
    starts = [edge for edge in graph.inside(region)[0] if edge.marked]
    members = graph.members(region)
    if len(starts) != 1 or not all(_preserves_token_count(graph, node) for node in members):
        return None
    reached = list(_reachable_edges(graph, starts[0]))
    firing = [
        (graph.node(edge.target), graph.outgoing(graph.node(edge.target))) for edge in reached
    ]
    fired = {node.id for node, _ in firing}
    finishes = any(node.firing is _END for node, _ in firing)
    # A token at rest: no node takes it, or its node gives no token.
    rests = any(not outgoing and node.firing is not _END for node, outgoing in firing)
    rests = rests or any(node.firing is _NEVER for node, _ in firing)
    dead = frozenset(node.id for node in members if _can_fire(graph, node)) - fired
    return Safety(dead=dead, finishes=finishes or rests, rests=rests)


def _preserves_token_count(graph: TokenGraph, node: TokenNode) -> bool:
    """Return whether the node gives exactly one token for each token that it takes."""
    match node.firing:
        case Firing.END | Firing.NEVER:
            return True
        case Firing.ANY:
            return len(graph.outgoing(node)) < 2
        case Firing.CHOICE:
            return len(graph.incoming(node)) < 2
        case _:
            return len(graph.incoming(node)) < 2 and len(graph.outgoing(node)) < 2


def _reachable_edges(graph: TokenGraph, start: TokenEdge) -> Iterator[TokenEdge]:
    """Yield the edges that the single token reaches until the region ends."""
    visited = {start.id}
    worklist = [start]
    for edge in worklist:
        yield edge
        node = graph.node(edge.target)
        if node.firing not in (_END, _NEVER):
            unvisited = [
                edge_ahead for edge_ahead in graph.outgoing(node) if edge_ahead.id not in visited
            ]
            visited.update(edge_ahead.id for edge_ahead in unvisited)
            worklist += unvisited


def _can_fire(graph: TokenGraph, node: TokenNode) -> bool:
    """Whether the node is to be reported if it never moves a token; sinks are not."""
    is_sink = node.firing is Firing.ANY and not graph.outgoing(node)
    return bool(graph.incoming(node)) and node.firing is not _NEVER and not is_sink


_END, _NEVER = Firing.END, Firing.NEVER
# Module-level names: in Python 3.11, looking up a member of an enumeration takes twice as long.
