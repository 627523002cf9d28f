"""Reductions of Petri nets that keep whether they are 1-safe.

They are those of T. Murata, "Petri nets: properties, analysis and applications", Proc. IEEE
77(4), 1989, section V.
"""

from collections.abc import Iterable

from sysmlc.logic.activities.petri_net import Move, Net


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
