"""Steps in which one component moves and all others stay: a subset of the system's moves.

If a turn of the system chooses next values of several integers or enumerations (positions of
robots, states of machines), it may change them one at a time. A game that is won with these moves
is won, since moves are only omitted. The steps of a component depend on few next values, so their
diagrams are a fraction of those of joint steps, and steps of several components can be taken one
after the other on the way to a goal. Booleans are not frozen.
"""

from collections.abc import Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass, field
from itertools import combinations

from msgspec import Struct
from msgspec.structs import replace

from sysmlc.logic.contract import BooleanDomain, Owner
from sysmlc.synthesis.bdd.manager import Manager, Node
from sysmlc.synthesis.bdd.symbols import next_bit
from sysmlc.synthesis.games.arena import (
    Arena,
    PredecessorOperator,
    Turn,
    predecessors_through,
    turn_products,
)
from sysmlc.synthesis.games.relational_product import Product

MIN_COMPONENTS = 3
"""Components from which on joint steps are avoided."""
MAX_RULE_NODES = 2_000
"""Nodes above which a constraint about two variables counts as one that joins them."""


class SingleMoves(Struct, frozen=True):
    """The turns of all components, then for each component the turns in which only it moves."""

    shared_turns: tuple[Turn, ...]
    component_turns: tuple[tuple[Turn, ...], ...]
    moving_bits: tuple[tuple[str, ...], ...]
    """For each component, the state bits that may change in its turns."""


def find_single_moves(arena: Arena) -> SingleMoves | None:
    """Return the moves of single components, or None if joint steps are the better choice.

    That is so with fairness assumptions, where the system may have to wait, and without goals,
    where nothing has to be reached.
    """
    if arena.fairness or not arena.goals:
        return None
    for index, turn in enumerate(arena.turns):
        components = _find_components(arena, turn) if turn.owner is Owner.SYSTEM else ()
        if len(components) >= MIN_COMPONENTS:
            return _build_single_moves(arena, index, components)
    return None


def _find_components(arena: Arena, turn: Turn) -> tuple[frozenset[str], ...]:
    """Return the sets of variables whose next values the turn chooses.

    Variables that can only move together are one component.
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
    """Return whether some constraint forbids that one of the two moves while the other stays."""
    manager, symbols = arena.manager, arena.symbols
    bit_sets = [frozenset(symbols.bits(name, primed=True)) for name in (left_name, right_name)]
    for part in turn.parts:
        support = manager.support(part)
        if any(own_bits.isdisjoint(support) for own_bits in bit_sets):
            continue
        if len(part) > MAX_RULE_NODES or not all(
            _can_move_alone(arena, part, *pair) for pair in _both_orders(bit_sets)
        ):
            return True
    return False


def _both_orders(
    bits: Sequence[frozenset[str]],
) -> tuple[tuple[frozenset[str], frozenset[str]], ...]:
    return (bits[0], bits[1]), (bits[1], bits[0])


def _can_move_alone(
    arena: Arena, part: Node, moving: frozenset[str], staying: frozenset[str]
) -> bool:
    manager = arena.manager
    restricted = _substitute_frames(manager, part, _frame_functions(manager, staying))
    unchanged = manager.true
    for bit in sorted(moving):
        unchanged = unchanged & manager.var(bit).equiv(manager.var(_current_bit(bit)))
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
    """Yield the turns with the next values of *frozen_bits* equal to the current ones."""
    frames = _frame_functions(manager, frozen_bits)
    for turn in turns:
        bits = tuple(bit for bit in turn.bits if bit not in frozen_bits)
        parts = dict.fromkeys(_substitute_frames(manager, part, frames) for part in turn.parts)
        yield replace(turn, bits=bits, parts=tuple(parts))


def _frame_functions(manager: Manager, bits: Iterable[str]) -> dict[str, Node]:
    return {bit: manager.var(_current_bit(bit)) for bit in sorted(bits)}


def _substitute_frames(manager: Manager, part: Node, frames: Mapping[str, Node]) -> Node:
    support = manager.support(part)
    return manager.compose(
        part, {bit: current for bit, current in frames.items() if bit in support}
    )


def _current_bit(bit: str) -> str:
    return bit.removesuffix("'")


@dataclass(slots=True)
class SingleMoveOperator:
    """Predecessors if one component moves at a time; used like ``PredecessorOperator``."""

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
        """Return the states from which the move of some component leads to *target*."""
        result = self.arena.manager.false
        for index in range(len(self._component_products)):
            result = result | self._predecessors_by_move(index, target)
        return predecessors_through(self._shared_products, result)

    def extend_attractor(self, attractor: Node, winning: Node) -> Node:
        """Return *attractor* and the winning states from which moves of the components lead there.

        The components move one after the other, each of them or only some.
        """
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
        """Allow wrong results outside of *winning* from now on.

        A component whose moves never leave *winning* then uses smaller diagrams.
        """
        if winning == self._winning:
            return
        self._winning = winning
        self._closed = tuple(
            self._is_closed_under(index) for index in range(len(self._component_products))
        )

    def _predecessors_by_move(self, index: int, target: Node) -> Node:
        """Return where a component's move leads to *target*, after the shared turns."""
        self.count += 1
        if self._closed[index]:
            target = self.arena.manager.restrict(target, self._winning)
        return predecessors_through(
            self._component_products[index], self._prime_moving(index, target)
        )

    def _prime_moving(self, index: int, target: Node) -> Node:
        """Prime the bits that may change; the others keep their values."""
        support = self.arena.manager.support(target)
        moving_bits = (bit for bit in self.moves.moving_bits[index] if bit in support)
        return self.arena.manager.rename(target, {bit: next_bit(bit) for bit in moving_bits})

    def _is_closed_under(self, index: int) -> bool:
        escaping = self._prime_moving(index, ~self._winning)
        for _, product in reversed((*self._shared_products, *self._component_products[index])):
            escaping = product(escaping)
        return escaping & self._winning == self.arena.manager.false
