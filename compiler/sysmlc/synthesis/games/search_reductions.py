"""Reductions of the search that preserve the verdict, but not the layers (decision 25).

*Symmetric goals*: two goals are symmetric if a swap of their variables leaves every turn of the
arena unchanged. Within a set of states that is closed under the swap, the states that reach one
goal are the image of the states that reach the other, so one fixpoint is enough for both.

*Reachable states*: if many state bits have few reachable combinations (tokens of an activity), a
forward search finds these states quickly. Backward steps from arbitrary states take very long.

*Single moves*: a turn of the system may choose next values of several integers or enumerations,
such as positions of robots or states of machines. In a single move only one of these components
changes. This only omits moves, so a game that is won with single moves is won. The diagrams of
single moves are a fraction of those of joint moves. On the way to a goal the components can move
one after the other. Booleans may change in every move.
"""

from collections.abc import Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass, field
from itertools import combinations, permutations

from msgspec import Struct
from msgspec.structs import replace

from sysmlc.logic.contract import BooleanDomain, Owner
from sysmlc.synthesis.bdd.manager import Manager, Node
from sysmlc.synthesis.bdd.symbols import current_bit, next_bit
from sysmlc.synthesis.games.arena import (
    Arena,
    PredecessorOperator,
    Turn,
    predecessors_through,
    turn_products,
)
from sysmlc.synthesis.games.relational_product import Product

Swap = Mapping[str, str]
"""A permutation of variables: bits, current and next, with the bits that replace them."""


def group_symmetric_goals(arena: Arena) -> dict[int, tuple[Swap, ...]]:
    """Return a representative of each class of symmetric goals, by its index.

    Each representative has the swaps that map it to the other goals of its class.
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
    """Whether the swap maps the arena to itself.

    Parts are compared as sets of diagrams, so some symmetries are not recognised.
    """
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
    """Return the conditions of the first turn that are about the current state alone.

    Only a turn of the system has any: a state that violates them is lost.
    """
    result, first = arena.manager.true, arena.turns[0]
    if first.owner is not Owner.SYSTEM:
        return result
    for part in first.parts:
        if arena.manager.support(part).isdisjoint(first.bits) and len(result) < MAX_INVARIANT_NODES:
            result = result & part
    return result


def drop_irrelevant_ranges(arena: Arena, goal: int, states: Node) -> Node:
    """Drop range conditions from *states* to make the diagram smaller.

    A range is dropped if the goal does not read the variable and *states* state nothing else about
    the variable. The caller has to intersect its results with the original states.
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
"""Least number of state bits for which the forward search is worthwhile."""
MAX_REACHED_NODES = 20_000
"""Nodes of the reached states, or of the frontier, above which the forward search is abandoned."""
MAX_STEPS = 2_000
"""Steps after which the forward search is abandoned."""


def find_reachable_states(arena: Arena) -> Node | None:
    """Return the states that plays can reach; None if they are too many or the game is small.

    The result is closed under all turns, so a verdict can ignore all other states.
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
    """Return the states after the start turns of the arena."""
    parts = [part for turn in arena.start for part in turn.parts]
    first = Product(arena.manager, parts, _state_bits(arena) if arena.is_ahead else ())
    states = first(arena.manager.true)
    return arena.symbols.unprime(states) if arena.is_ahead else states


# -- single moves ------------------------------------------------------------------------------

MIN_COMPONENTS = 3
"""Least number of components for which single moves are tried."""
MAX_RULE_NODES = 2_000
"""Nodes above which a constraint about two variables is not examined: they count as dependent."""


class SingleMoves(Struct, frozen=True):
    """The turns of a step, split for moves of single components."""

    shared_turns: tuple[Turn, ...]
    """The turns before the components move."""
    component_turns: tuple[tuple[Turn, ...], ...]
    """For each component, the remaining turns in which no other component changes."""
    moving_bits: tuple[tuple[str, ...], ...]
    """For each component, the state bits that may change in its turns."""


def find_single_moves(arena: Arena) -> SingleMoves | None:
    """Return the moves of single components, or None if joint moves are the better choice."""
    # With fairness assumptions the system may have to wait, and without goals there is nothing to
    # reach step by step. In both cases single moves took up to five times as long (decision 25).
    if arena.fairness or not arena.goals:
        return None
    for index, turn in enumerate(arena.turns):
        components = _find_components(arena, turn) if turn.owner is Owner.SYSTEM else ()
        if len(components) >= MIN_COMPONENTS:
            return _build_single_moves(arena, index, components)
    return None


def _find_components(arena: Arena, turn: Turn) -> tuple[frozenset[str], ...]:
    """Return the components: sets of variables whose next values the turn chooses.

    Variables that a constraint forces to change together are in one component.
    """
    variables = arena.symbols.variables
    chosen_names = [
        name
        for name in variables
        if not isinstance(variables[name].domain, BooleanDomain)
        and set(arena.symbols.bits(name, primed=True)) <= set(turn.bits)
    ]
    groups = [frozenset([name]) for name in chosen_names]
    for left_name, right_name in combinations(chosen_names, 2):
        if _cannot_move_alone(arena, turn, left_name, right_name):
            affected = [group for group in groups if left_name in group or right_name in group]
            groups = [group for group in groups if group not in affected]
            groups.append(frozenset[str]().union(*affected))
    return tuple(groups)


def _cannot_move_alone(arena: Arena, turn: Turn, left_name: str, right_name: str) -> bool:
    """Return whether a constraint forbids that one variable changes while the other does not."""
    manager, symbols = arena.manager, arena.symbols
    bit_sets = [frozenset(symbols.bits(name, primed=True)) for name in (left_name, right_name)]
    for part in turn.parts:
        support = manager.support(part)
        if any(own_bits.isdisjoint(support) for own_bits in bit_sets):
            continue
        if len(part) > MAX_RULE_NODES or not all(
            _can_move_alone(arena, part, *pair) for pair in permutations(bit_sets, 2)
        ):
            return True
    return False


def _can_move_alone(
    arena: Arena, part: Node, moving: frozenset[str], staying: frozenset[str]
) -> bool:
    manager = arena.manager
    restricted = _substitute_frames(manager, part, _frame_functions(manager, staying))
    unchanged = manager.conjoin(
        manager.var(bit).equiv(manager.var(current_bit(bit))) for bit in sorted(moving)
    )
    return restricted & ~unchanged != manager.false


def _build_single_moves(
    arena: Arena, index: int, components: Sequence[frozenset[str]]
) -> SingleMoves:
    all_names = frozenset[str]().union(*components)
    component_turns, moving_bits = [], []
    for component in components:
        other_bits = frozenset(arena.symbols.all_bits(sorted(all_names - component), primed=True))
        component_turns.append(
            tuple(_restrict_turns(arena.manager, arena.turns[index:], other_bits))
        )
        bits = arena.symbols.all_bits(arena.symbols.variables)
        moving_bits.append(tuple(bit for bit in bits if next_bit(bit) not in other_bits))
    return SingleMoves(arena.turns[:index], tuple(component_turns), tuple(moving_bits))


def _restrict_turns(
    manager: Manager, turns: Iterable[Turn], frozen_bits: frozenset[str]
) -> Iterator[Turn]:
    """Yield the turns with *frozen_bits* unchanged: their next values equal the current ones."""
    frames = _frame_functions(manager, frozen_bits)
    for turn in turns:
        bits = tuple(bit for bit in turn.bits if bit not in frozen_bits)
        parts = dict.fromkeys(_substitute_frames(manager, part, frames) for part in turn.parts)
        yield replace(turn, bits=bits, parts=tuple(parts))


def _frame_functions(manager: Manager, bits: Iterable[str]) -> dict[str, Node]:
    return {bit: manager.var(current_bit(bit)) for bit in sorted(bits)}


def _substitute_frames(manager: Manager, part: Node, frames: Mapping[str, Node]) -> Node:
    support = manager.support(part)
    return manager.compose(
        part, {bit: current for bit, current in frames.items() if bit in support}
    )


@dataclass(slots=True)
class SingleMoveOperator:
    """Computes predecessors if one component moves at a time; used like ``PredecessorOperator``."""

    arena: Arena
    moves: SingleMoves
    within: Node | None = None
    count: int = 0
    """Predecessors computed so far."""
    _shared_products: tuple[tuple[Owner, Product], ...] = field(init=False)
    _component_products: tuple[tuple[tuple[Owner, Product], ...], ...] = field(init=False)
    _winning: Node = field(init=False)
    _closed: tuple[bool, ...] = field(init=False)

    def __post_init__(self) -> None:
        manager = self.arena.manager
        self._shared_products = turn_products(manager, self.moves.shared_turns)
        self._component_products = tuple(
            turn_products(manager, way) for way in self.moves.component_turns
        )
        self._winning, self._closed = manager.true, (False,) * len(self._component_products)

    def controllable_predecessors(self, target: Node) -> Node:
        """Return the states from which the move of some component forces *target*."""
        result = self.arena.manager.disjoin(
            self._predecessors_by_move(index, target)
            for index in range(len(self._component_products))
        )
        return predecessors_through(self._shared_products, result)

    def extend_attractor(self, attractor: Node, winning: Node) -> Node:
        """Return *attractor* and the winning states that reach it by moves of the components."""
        # Each component continues from the states that the components before it have added, so one
        # call covers several steps. That is enough for a verdict, which needs no exact layers.
        result = attractor
        for index in range(len(self._component_products)):
            result = result | (
                predecessors_through(
                    self._shared_products, self._predecessors_by_move(index, result)
                )
                & winning
            )
        if result == attractor and self._shared_products:
            # Which component can move may depend on the shared turns before it.
            result = result | (self.controllable_predecessors(attractor) & winning)
        return result

    def wins_initially(self, winning: Node) -> bool:
        """Return whether the system can force the first state into *winning*."""
        return PredecessorOperator(self.arena).wins_initially(winning)

    def confine_to(self, winning: Node) -> None:
        """Permit arbitrary results outside of *winning* from now on.

        Targets can then be simplified for components whose moves never leave *winning*.
        """
        if winning == self._winning:
            return
        self._winning = winning
        self._closed = tuple(
            self._is_closed_under(index) for index in range(len(self._component_products))
        )

    def _predecessors_by_move(self, index: int, target: Node) -> Node:
        """Return the states after the shared turns from which the component can force *target*."""
        self.count += 1
        if self._closed[index]:
            target = self.arena.manager.restrict(target, self._winning)
        return predecessors_through(
            self._component_products[index], self._prime_moving(index, target)
        )

    def _prime_moving(self, index: int, target: Node) -> Node:
        """Prime the bits that the component may change; all other bits keep their values."""
        support = self.arena.manager.support(target)
        moving_bits = (bit for bit in self.moves.moving_bits[index] if bit in support)
        return self.arena.manager.rename(target, {bit: next_bit(bit) for bit in moving_bits})

    def _is_closed_under(self, index: int) -> bool:
        escaping = self._prime_moving(index, ~self._winning)
        for _, product in reversed((*self._shared_products, *self._component_products[index])):
            escaping = product(escaping)
        return escaping & self._winning == self.arena.manager.false
