"""Reductions of the search that keep the verdict: symmetry of goals, reachable states and state
invariants.

Two goals are symmetric if a swap of their variables leaves every turn of the arena unchanged. From
a set of states that is closed under the swap, the states that reach one goal are the image of the
states that reach the other, so one fixpoint serves both. Among many state bits with few reachable
states (tokens of an activity), a forward search finds these states quickly, whereas backward steps
from arbitrary states take very long.
"""

from collections.abc import Mapping, Sequence

from sysmlc.logic.contract import Owner
from sysmlc.synthesis.bdd.manager import Node
from sysmlc.synthesis.games.arena import Arena
from sysmlc.synthesis.games.relational_product import Product

Swap = Mapping[str, str]
"""Bits, primed ones included, and the bits that replace them."""


def group_symmetric_goals(arena: Arena) -> dict[int, tuple[Swap, ...]]:
    """Return one representative of each class of symmetric goals, with the swaps that lead to the
    others.
    """
    groups: dict[int, list[Swap]] = {}
    for index, goal in enumerate(arena.goals):
        for representative, swaps in groups.items():
            swap = _find_swap(arena, arena.goals[representative], goal)
            if swap is not None and _is_symmetric(arena, swap):
                swaps.append(swap)
                break
        else:
            groups[index] = []
    return {index: tuple(swaps) for index, swaps in groups.items()}


def swap_variables(arena: Arena, node: Node, swap: Swap) -> Node:
    """Return the diagram with the variables swapped."""
    support = arena.manager.support(node)
    return arena.manager.rename(node, {a: b for a, b in swap.items() if a in support})


def _find_swap(arena: Arena, left_goal: Node, right_goal: Node) -> Swap | None:
    """Return the swap of the variables of two goals if it maps one goal to the other."""
    symbols = arena.symbols
    left_names, right_names = symbols.names(left_goal), symbols.names(right_goal)
    variables = symbols.variables
    if len(left_names) != len(right_names) or not set(left_names).isdisjoint(right_names):
        return None
    pairs = list(zip(left_names, right_names, strict=True))
    if any(
        variables[a].domain != variables[b].domain or variables[a].owner != variables[b].owner
        for a, b in pairs
    ):
        return None
    swap: dict[str, str] = {}
    for a, b in [*pairs, *((b, a) for a, b in pairs)]:
        for primed in (False, True):
            swap |= dict(zip(symbols.bits(a, primed), symbols.bits(b, primed), strict=True))
    return swap if swap_variables(arena, left_goal, swap) == right_goal else None


def _is_symmetric(arena: Arena, swap: Swap) -> bool:
    """Return whether the swap maps the arena to itself."""
    lists: list[Sequence[Node]] = [arena.goals, arena.fairness, [arena.states]]
    lists += [turn.parts for turn in arena.turns]
    are_parts = all(
        {swap_variables(arena, node, swap) for node in nodes} == set(nodes) for nodes in lists
    )
    turns = [{swap.get(bit, bit) for bit in turn.bits} for turn in arena.turns]
    return are_parts and turns == [set(turn.bits) for turn in arena.turns]


MAX_INVARIANT_NODES = 20_000
"""Nodes above which no further constraint is added to the state invariant."""


def state_invariant(arena: Arena) -> Node:
    """Return what the first turn requires of the state in which it is played."""
    result, first = arena.manager.true, arena.turns[0]
    if first.owner is not Owner.SYSTEM:
        return result
    for part in first.parts:
        if arena.manager.support(part).isdisjoint(first.bits) and len(result) < MAX_INVARIANT_NODES:
            result = result & part
    return result


def drop_irrelevant_ranges(arena: Arena, goal: int, states: Node) -> Node:
    """Add invalid codes of variables that the goal does not read to the states.

    Only variables of which the states require nothing but the range are extended.
    """
    symbols, manager = arena.symbols, arena.manager
    named = symbols.names(arena.goals[goal]) if arena.goals else ()
    for name in symbols.names(states):
        domain = symbols.domain(name)
        if domain == manager.true or name in named:
            continue
        extended = manager.exist(symbols.bits(name), states)
        if extended & domain == states:
            states = extended
    return states


MIN_STATE_BITS = 48
"""Bits of a state from which on the forward search is worthwhile."""
MAX_REACHED_NODES = 20_000
"""Nodes of the reached states, or of one step's, above which the search is abandoned."""
MAX_STEPS = 2_000
"""Steps after which the search is abandoned."""


def find_reachable_states(arena: Arena) -> Node | None:
    """Return the states that plays can reach, or None if there are too many or the game is small.

    The result is closed under all allowed turns, so that a verdict can ignore all other states.
    """
    bits = _state_bits(arena)
    parts = [part for turn in arena.turns for part in turn.parts]
    if len(bits) < MIN_STATE_BITS:
        return None
    forward = Product(arena.manager, parts, bits)
    reached = frontier = _first_states(arena)
    for _ in range(MAX_STEPS):
        if len(reached) > MAX_REACHED_NODES or len(frontier) > MAX_REACHED_NODES:
            return None
        if frontier == arena.manager.false:
            return reached
        frontier = arena.symbols.unprime(forward(frontier)) & ~reached
        reached = reached | frontier
    return None


def _state_bits(arena: Arena) -> tuple[str, ...]:
    """Return all current bits."""
    return arena.symbols.all_bits(arena.symbols.variables)


def _first_states(arena: Arena) -> Node:
    """Return the states after the first turns, or after the second ones if the arena is ahead."""
    parts = [part for turn in arena.start for part in turn.parts]
    first = Product(arena.manager, parts, _state_bits(arena) if arena.is_ahead else ())
    states = first(arena.manager.true)
    return arena.symbols.unprime(states) if arena.is_ahead else states
