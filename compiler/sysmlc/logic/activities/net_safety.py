"""Whether a region is 1-safe in any order of moves: Petri net reductions, then a bounded search.

The reductions are those of T. Murata, "Petri nets: properties, analysis and applications", Proc.
IEEE 77(4), 1989, section V: they keep safeness, so that series and parallel parts of a
well-formed activity vanish before any marking is built. Guards are not looked at: a branch may
always be taken. Structured nodes are checked on their own and count as one action outside.

A region that passes is 1-safe in the token game, too, where all nodes move at once. Not the other
way round: what only the speed of the game keeps apart (``token_search``) fails here. Flows across
borders of regions and data stores are no places of such a net.
"""

from collections.abc import Iterable

from sysmlc.logic.activities.one_token import walk
from sysmlc.logic.activities.petri_net import Net, Safety, net_of
from sysmlc.logic.activities.token_graph import TokenGraph

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
    from sysmlc.logic.activities.net_reductions import reduce

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
