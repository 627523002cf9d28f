"""Check that a region is 1-safe for every order in which its nodes may move.

A region without forks and joins has one token, and a walk along its flows suffices. For any other
region the markings of its Petri net are searched, after reductions if there are many. Guards are
ignored: every branch may be taken. The content of a structured node is checked separately; in its
own region the node counts as an action.

A region that passes is 1-safe in the token game too, where all nodes move at once. The converse
does not hold: a region that is safe only because of the synchronous steps fails here and is left to
``reachability``. Flows across borders of regions and data stores are not places of the net.
"""

from collections.abc import Iterable, Iterator

from sysmlc.logic.activities.petri_net import Net, Safety, build_net, reduce_net
from sysmlc.logic.activities.token_graph import TokenGraph
from sysmlc.logic.activities.token_nodes import Firing, TokenEdge, TokenNode

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
                return Safety(unsafe=_first_place(remaining & gives, bits))
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


def _first_place(mask: int, bits: dict[str, int]) -> str:
    return next(place for place, bit in bits.items() if mask & bit)


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
