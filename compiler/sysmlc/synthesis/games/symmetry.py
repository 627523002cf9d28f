"""Goals that are alike: robots that may be exchanged need one fixpoint, not one each.

Two goals are alike when to exchange their variables, each for the one at its place in the other
goal, leaves every turn of the arena what it is. From states that the exchange maps onto themselves
the states that reach the one goal are then the image of those that reach the other.
"""

from collections.abc import Mapping, Sequence

from sysmlc.synthesis.bdd.manager import Node
from sysmlc.synthesis.games.arena import Arena

Exchange = Mapping[str, str]
"""Bits, primed ones too, with those that they are exchanged for."""


def orbits(arena: Arena) -> dict[int, tuple[Exchange, ...]]:
    """One goal of each kind, by its place, with what leads from it to the others of its kind."""
    found: dict[int, list[Exchange]] = {}
    for place, goal in enumerate(arena.goals):
        for first, exchanges in found.items():
            exchange = _exchange(arena, arena.goals[first], goal)
            if exchange is not None and _is_kept(arena, exchange):
                exchanges.append(exchange)
                break
        else:
            found[place] = []
    return {place: tuple(exchanges) for place, exchanges in found.items()}


def image(arena: Arena, node: Node, exchange: Exchange) -> Node:
    """The diagram with the variables exchanged."""
    support = arena.manager.support(node)
    return arena.manager.rename(node, {a: b for a, b in exchange.items() if a in support})


def _exchange(arena: Arena, one: Node, other: Node) -> Exchange | None:
    """The exchange of the variables of two goals, if it takes one goal to the other."""
    symbols = arena.symbols
    left, right = symbols.names(one), symbols.names(other)
    of = symbols.variables
    if len(left) != len(right) or not set(left).isdisjoint(right):
        return None
    pairs = list(zip(left, right, strict=True))
    if any(of[a].domain != of[b].domain or of[a].owner != of[b].owner for a, b in pairs):
        return None
    found: dict[str, str] = {}
    for a, b in [*pairs, *((b, a) for a, b in pairs)]:
        for primed in (False, True):
            found |= dict(zip(symbols.bits(a, primed), symbols.bits(b, primed), strict=True))
    return found if image(arena, one, found) == other else None


def _is_kept(arena: Arena, exchange: Exchange) -> bool:
    """Whether the arena is the same after the exchange."""
    lists: list[Sequence[Node]] = [arena.goals, arena.fairness, [arena.states]]
    lists += [turn.parts for turn in arena.turns]
    are_parts = all(
        {image(arena, node, exchange) for node in nodes} == set(nodes) for nodes in lists
    )
    turns = [{exchange.get(bit, bit) for bit in turn.bits} for turn in arena.turns]
    return are_parts and turns == [set(turn.bits) for turn in arena.turns]
