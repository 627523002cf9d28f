"""Goals that are alike: robots that may be exchanged need one fixpoint, not one each.

Two goals are alike when to exchange their variables, each for the one at its place in the other
goal, leaves every turn of the arena what it is. From states that the exchange maps onto themselves
the states that reach the one goal are then the image of those that reach the other.
"""

from collections.abc import Mapping, Sequence

from sysmlc.logic.contract import Owner
from sysmlc.synthesis.bdd.manager import Node
from sysmlc.synthesis.games.arena import Arena
from sysmlc.synthesis.games.relational_product import Product

Swap = Mapping[str, str]
"""Bits, primed ones too, with those that they are exchanged for."""


def group_symmetric_goals(arena: Arena) -> dict[int, tuple[Swap, ...]]:
    """One goal of each kind, by its place, with what leads from it to the others of its kind."""
    found: dict[int, list[Swap]] = {}
    for place, goal in enumerate(arena.goals):
        for first, exchanges in found.items():
            exchange = _find_exchange(arena, arena.goals[first], goal)
            if exchange is not None and _is_symmetric(arena, exchange):
                exchanges.append(exchange)
                break
        else:
            found[place] = []
    return {place: tuple(exchanges) for place, exchanges in found.items()}


def swap_variables(arena: Arena, node: Node, exchange: Swap) -> Node:
    """The diagram with the variables exchanged."""
    support = arena.manager.support(node)
    return arena.manager.rename(node, {a: b for a, b in exchange.items() if a in support})


def _find_exchange(arena: Arena, one: Node, other: Node) -> Swap | None:
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
    return found if swap_variables(arena, one, found) == other else None


def _is_symmetric(arena: Arena, exchange: Swap) -> bool:
    """Whether the arena is the same after the exchange."""
    lists: list[Sequence[Node]] = [arena.goals, arena.fairness, [arena.states]]
    lists += [turn.parts for turn in arena.turns]
    are_parts = all(
        {swap_variables(arena, node, exchange) for node in nodes} == set(nodes) for nodes in lists
    )
    turns = [{exchange.get(bit, bit) for bit in turn.bits} for turn in arena.turns]
    return are_parts and turns == [set(turn.bits) for turn in arena.turns]


MAX_INVARIANT_NODES = 20_000
"""Nodes from which on rules are left where they are."""


def state_invariant(arena: Arena) -> Node:
    """What the first turn asks of the state that it is played in."""
    found, first = arena.manager.true, arena.turns[0]
    if first.owner is not Owner.SYSTEM:
        return found
    for part in first.parts:
        if arena.manager.support(part).isdisjoint(first.bits) and len(found) < MAX_INVARIANT_NODES:
            found = found & part
    return found


def drop_irrelevant_ranges(arena: Arena, goal: int, states: Node) -> Node:
    """The states, and with them codes without value of variables that the goal does not name.

    Only of variables of which nothing but the range is asked.
    """
    symbols, manager = arena.symbols, arena.manager
    named = symbols.names(arena.goals[goal]) if arena.goals else ()
    for name in symbols.names(states):
        range_ = symbols.domain(name)
        if range_ == manager.true or name in named:
            continue
        wide = manager.exist(symbols.bits(name), states)
        if wide & range_ == states:
            states = wide
    return states


MIN_STATE_BITS = 48
"""Bits of a state from which on it is worth the looking."""
MAX_REACHED_NODES = 20_000
"""Nodes of the reached states, or of a step's, from which on it is not."""
MAX_STEPS = 2_000
"""Steps after which the search is given up."""


def find_reachable_states(arena: Arena) -> Node | None:
    """The states that turns lead to from the start on, and others from which they lead to none
    but these; None when they are too many to be of use, or the game is small."""
    bits = _state_bits(arena)
    parts = [part for turn in arena.turns for part in turn.parts]
    if len(bits) < MIN_STATE_BITS:
        return None
    forward = Product(arena.manager, parts, bits)
    reached = fresh = _first_states(arena)
    for _ in range(MAX_STEPS):
        if len(reached) > MAX_REACHED_NODES or len(fresh) > MAX_REACHED_NODES:
            return None
        if fresh == arena.manager.false:
            return reached
        fresh = arena.symbols.unprime(forward(fresh)) & ~reached
        reached = reached | fresh
    return None


def _state_bits(arena: Arena) -> tuple[str, ...]:
    """All bits without primes."""
    return arena.symbols.all_bits(arena.symbols.variables)


def _first_states(arena: Arena) -> Node:
    """The states that the turns at the start lead to, first ones or those ahead."""
    parts = [part for turn in arena.start for part in turn.parts]
    first = Product(arena.manager, parts, _state_bits(arena) if arena.is_ahead else ())
    found = first(arena.manager.true)
    return arena.symbols.unprime(found) if arena.is_ahead else found
