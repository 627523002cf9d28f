"""Whether a region is 1-safe in any order of moves: Petri net reductions, then a bounded search.

The reductions are those of T. Murata, "Petri nets: properties, analysis and applications", Proc.
IEEE 77(4), 1989, section V: they keep safeness, so that series and parallel parts of a
well-formed activity vanish before any marking is built. Guards are not looked at: a branch may
always be taken. Structured nodes are checked on their own and count as one action outside.

A region that passes is 1-safe in the token game, too, where all nodes move at once. Not the other
way round: what only the speed of the game keeps apart (``token_search``) fails here. Flows across
borders of regions and data stores are no places of such a net.
"""

from collections.abc import Iterable, Iterator

from sysmlc.logic.activities.petri_net import Net, Safety, net_of, reduce
from sysmlc.logic.activities.token_graph import Firing, TokenEdge, TokenGraph, TokenNode

_SMALL = 2_000
"""Markings that are searched without reductions: some milliseconds."""


def check(graph: TokenGraph, region: str, limit: int) -> Safety:
    """Search the markings of a region, at most ``limit`` of them.

    What is small is searched as it is, which finds the right place of a fault; what is large
    is reduced before. In the reduced net others may move on before a final node ends the
    region: this errs on the safe side.
    """
    found = walk(graph, region)
    if found is not None:
        return found
    net = net_of(graph, region)
    whole = search(net, min(limit, _SMALL))
    if whole.is_complete or any(move.resets for move in net.moves):
        return whole if whole.is_complete else search(net, limit)
    reduce(net)
    return search(net, limit)


def search(net: Net, limit: int) -> Safety:
    """Go through the markings, breadth first; a marking in which the region ends is the last."""
    bits = {place: 1 << number for number, place in enumerate(net.places)}
    moves = [
        (_mask(m.takes, bits), _mask(m.gives, bits), _mask(m.resets, bits), m)
        for m in net.moves
        if not m.is_end
    ]
    ends = [(_mask(m.takes, bits), m) for m in net.moves if m.is_end]
    first = _mask(net.marked, bits)
    seen, waiting = {first}, [first]
    busy = _mask(net.busy, bits)
    fired, finishes, rests = set(net.alive), False, False
    for marking in waiting:
        ended = [move for takes, move in ends if marking & takes]
        fired.update(node for move in ended for node in move.nodes)
        can_move = bool(ended or marking & busy)
        for takes, gives, resets, move in () if ended else moves:
            if marking & takes != takes:
                continue
            can_move = True
            fired |= move.nodes
            left = marking & ~takes
            if left & gives & ~resets:
                return Safety(unsafe=_place(left & gives, bits))
            after = (left & ~resets) | gives
            if after not in seen:
                seen.add(after)
                waiting.append(after)
        rests = rests or not can_move
        finishes = finishes or bool(ended)
        if len(seen) > limit:
            return Safety(is_complete=False)
    return Safety(dead=net.nodes - fired, finishes=finishes or rests, rests=rests)


def _mask(places: Iterable[str], bits: dict[str, int]) -> int:
    return sum(bits[place] for place in places)


def _place(mask: int, bits: dict[str, int]) -> str:
    return next(place for place, bit in bits.items() if mask & bit)


def walk(graph: TokenGraph, region: str) -> Safety | None:
    """What a search of all markings finds; None where there may be more than one token.

    No flow may cross the border of the region or interrupt one.
    """
    starts = [edge for edge in graph.inside(region)[0] if edge.marked]
    members = graph.members(region)
    if len(starts) != 1 or not all(_keeps_one(graph, node) for node in members):
        return None
    at = list(_places(graph, starts[0]))
    firing = [(graph.node(edge.target), graph.outgoing(graph.node(edge.target))) for edge in at]
    fired = {node.id for node, _ in firing}
    finishes = any(node.firing is _END for node, _ in firing)
    # A token that nothing takes stays, and one that nothing gives on is gone.
    rests = any(not after and node.firing is not _END for node, after in firing)
    rests = rests or any(node.firing is _NEVER for node, _ in firing)
    dead = frozenset(node.id for node in members if _may_fire(graph, node)) - fired
    return Safety(dead=dead, finishes=finishes or rests, rests=rests)


def _keeps_one(graph: TokenGraph, node: TokenNode) -> bool:
    """Whether the node gives one token for one."""
    match node.firing:
        case Firing.END | Firing.NEVER:
            return True
        case Firing.ANY:
            return len(graph.outgoing(node)) < 2
        case Firing.CHOICE:
            return len(graph.incoming(node)) < 2
        case _:
            return len(graph.incoming(node)) < 2 and len(graph.outgoing(node)) < 2


def _places(graph: TokenGraph, start: TokenEdge) -> Iterator[TokenEdge]:
    """The edges that the token comes to; where a region ends it goes no further."""
    seen = {start.id}
    waiting = [start]
    for edge in waiting:
        yield edge
        node = graph.node(edge.target)
        if node.firing not in (_END, _NEVER):
            new = [after for after in graph.outgoing(node) if after.id not in seen]
            seen.update(after.id for after in new)
            waiting += new


def _may_fire(graph: TokenGraph, node: TokenNode) -> bool:
    """Whether the node has tokens to move; a sink only takes them."""
    is_sink = node.firing is Firing.ANY and not graph.outgoing(node)
    return bool(graph.incoming(node)) and node.firing is not _NEVER and not is_sink


_END, _NEVER = Firing.END, Firing.NEVER
"""Members by names of the module: in Python 3.11 those of a class take twice as long."""
