"""The states that plays come to, where they are few among many: tokens in an activity.

From these states no allowed turn leads out of them, so a verdict needs to look at nothing else. Of
a game with many bits whose rules leave few states they are found in no time, and backward steps
from arbitrary states, with tokens everywhere, take for ever.
"""

from sysmlc.synthesis.bdd.manager import Node
from sysmlc.synthesis.games.arena import Arena
from sysmlc.synthesis.games.image import Product

MANY = 48
"""Bits of a state from which on it is worth the looking."""
LARGE = 20_000
"""Nodes of the reached states, or of a step's, from which on it is not."""
LONG = 2_000
"""Steps after which the search is given up."""


def reachable(arena: Arena) -> Node | None:
    """The states that turns lead to from the start on, and others from which they lead to none
    but these; None when they are too many to be of use, or the game is small."""
    bits = _bits(arena)
    parts = [part for turn in arena.turns for part in turn.parts]
    if len(bits) < MANY:
        return None
    forward = Product(arena.manager, parts, bits)
    reached = fresh = _first(arena)
    for _ in range(LONG):
        if len(reached) > LARGE or len(fresh) > LARGE:
            return None
        if fresh == arena.manager.false:
            return reached
        fresh = arena.symbols.unprime(forward(fresh)) & ~reached
        reached = reached | fresh
    return None


def _bits(arena: Arena) -> tuple[str, ...]:
    """All bits without primes."""
    return arena.symbols.all_bits(arena.symbols.variables)


def _first(arena: Arena) -> Node:
    """The states that the turns at the start lead to, first ones or those ahead."""
    parts = [part for turn in arena.start for part in turn.parts]
    first = Product(arena.manager, parts, _bits(arena) if arena.is_ahead else ())
    found = first(arena.manager.true)
    return arena.symbols.unprime(found) if arena.is_ahead else found
