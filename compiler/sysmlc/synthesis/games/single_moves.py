"""Steps in which one component moves and all others stay: some of what the system may do.

When a turn of the system chooses next values of several numbers (positions of robots, states of
machines), it may change them one at a time. What is won so is won: it only leaves moves out. Each
component's steps speak of few next values, so they take a fraction of the diagrams of joint steps,
and they can be taken one after the other on the way to a goal. Booleans are left free.
"""

from collections.abc import Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass, field
from itertools import combinations

from msgspec import Struct
from msgspec.structs import replace

from sysmlc.logic.contract import BooleanDomain, Owner
from sysmlc.synthesis.bdd.manager import Manager, Node
from sysmlc.synthesis.bdd.symbols import next_bit
from sysmlc.synthesis.games.arena import Arena, Steps, Turn, played, products
from sysmlc.synthesis.games.relational_product import Product

FEWEST = 3
"""Components from which on joint steps are worth avoiding."""
LARGE = 2_000
"""Nodes from which on a rule about two variables is taken to tie them together."""


class Routes(Struct, frozen=True):
    """Turns of all, and then turns in which one component moves: the system's choice."""

    before: tuple[Turn, ...]
    ways: tuple[tuple[Turn, ...], ...]
    moving: tuple[tuple[str, ...], ...]
    """For each of the ways, the bits of the state that may change in it."""


def routes(arena: Arena) -> Routes | None:
    """The ways to move one component of a system that has some.

    Where the system may have to wait for the environment, joint steps cost less than many; where
    nothing has to be reached, there are none to take.
    """
    if arena.fairness or not arena.goals:
        return None
    for place, turn in enumerate(arena.turns):
        components = _components(arena, turn) if turn.owner is Owner.SYSTEM else ()
        if len(components) >= FEWEST:
            return _routes(arena, place, components)
    return None


def _components(arena: Arena, turn: Turn) -> tuple[frozenset[str], ...]:
    """Variables whose next values the turn chooses; in one component when they only move
    together."""
    variables = arena.symbols.variables
    chosen = [
        name
        for name in variables
        if not isinstance(variables[name].domain, BooleanDomain)
        and set(arena.symbols.bits(name, primed=True)) <= set(turn.bits)
    ]
    groups = [frozenset([name]) for name in chosen]
    for one, other in combinations(chosen, 2):
        if _are_tied(arena, turn, one, other):
            touched = [group for group in groups if one in group or other in group]
            groups = [group for group in groups if group not in touched]
            groups.append(frozenset[str]().union(*touched))
    return tuple(groups)


def _are_tied(arena: Arena, turn: Turn, one: str, other: str) -> bool:
    """Whether some rule lets none of the two move while the other stays."""
    manager, symbols = arena.manager, arena.symbols
    bits = [frozenset(symbols.bits(name, primed=True)) for name in (one, other)]
    for part in turn.parts:
        support = manager.support(part)
        if any(own.isdisjoint(support) for own in bits):
            continue
        if len(part) > LARGE or not all(_moves_alone(arena, part, *pair) for pair in _both(bits)):
            return True
    return False


def _both(bits: Sequence[frozenset[str]]) -> tuple[tuple[frozenset[str], frozenset[str]], ...]:
    return (bits[0], bits[1]), (bits[1], bits[0])


def _moves_alone(arena: Arena, part: Node, moving: frozenset[str], staying: frozenset[str]) -> bool:
    manager = arena.manager
    alone = _kept(manager, part, _stay(manager, staying))
    same = manager.true
    for bit in sorted(moving):
        same = same & manager.var(bit).equiv(manager.var(_present(bit)))
    return alone & ~same != manager.false


def _routes(arena: Arena, place: int, components: Sequence[frozenset[str]]) -> Routes:
    every = frozenset[str]().union(*components)
    ways, moving = [], []
    for own in components:
        others = frozenset(arena.symbols.all_bits(sorted(every - own), primed=True))
        ways.append(tuple(_way(arena.manager, arena.turns[place:], others)))
        bits = arena.symbols.all_bits(arena.symbols.variables)
        moving.append(tuple(bit for bit in bits if next_bit(bit) not in others))
    return Routes(arena.turns[:place], tuple(ways), tuple(moving))


def _way(manager: Manager, turns: Iterable[Turn], others: frozenset[str]) -> Iterator[Turn]:
    """The turns in which these next values are the present ones."""
    stay = _stay(manager, others)
    for turn in turns:
        bits = tuple(bit for bit in turn.bits if bit not in others)
        parts = dict.fromkeys(_kept(manager, part, stay) for part in turn.parts)
        yield replace(turn, bits=bits, parts=tuple(parts))


def _stay(manager: Manager, bits: Iterable[str]) -> dict[str, Node]:
    return {bit: manager.var(_present(bit)) for bit in sorted(bits)}


def _kept(manager: Manager, part: Node, stay: Mapping[str, Node]) -> Node:
    support = manager.support(part)
    return manager.compose(part, {bit: now for bit, now in stay.items() if bit in support})


def _present(bit: str) -> str:
    return bit.removesuffix("'")


@dataclass(slots=True)
class SingleSteps:
    """What can be forced when one component moves at a time; of the same use as ``Steps``."""

    arena: Arena
    routes: Routes
    within: Node | None = None
    count: int = 0
    """Predecessors computed so far."""
    _before: tuple[tuple[Owner, Product], ...] = field(init=False)
    _products: tuple[tuple[tuple[Owner, Product], ...], ...] = field(init=False)
    _within: Node = field(init=False)
    _closed: tuple[bool, ...] = field(init=False)

    def __post_init__(self) -> None:
        manager = self.arena.manager
        self._before = products(manager, self.routes.before)
        self._products = tuple(products(manager, way) for way in self.routes.ways)
        self._within, self._closed = manager.true, (False,) * len(self._products)

    def controllable(self, target: Node) -> Node:
        """States from which some component can move so that the target holds in the next one."""
        found = self.arena.manager.false
        for place in range(len(self._products)):
            found = found | self._moved(place, target)
        return played(self._before, found)

    def nearer(self, reached: Node, winning: Node) -> Node:
        """What is reached and, of the winning states, those that lead there by a move of each
        component in turn, or of some of them."""
        found = reached
        for place in range(len(self._products)):
            found = found | (played(self._before, self._moved(place, found)) & winning)
        if found == reached and self._before:
            # Which component moves may depend on what others have done before.
            found = found | (self.controllable(reached) & winning)
        return found

    def is_won(self, winning: Node) -> bool:
        """Whether the system can start so that it comes to these states."""
        return Steps(self.arena).is_won(winning)

    def confine(self, winning: Node) -> None:
        """What is said from now on has to be right in these states only.

        Where a component's moves never lead out of them, what holds outside does not matter.
        """
        if winning == self._within:
            return
        self._within = winning
        self._closed = tuple(self._is_closed(place) for place in range(len(self._products)))

    def _moved(self, place: int, target: Node) -> Node:
        """Where a component can move so that the target holds then, after the turns before."""
        self.count += 1
        if self._closed[place]:
            target = self.arena.manager.restrict(target, self._within)
        return played(self._products[place], self._after(place, target))

    def _after(self, place: int, target: Node) -> Node:
        """The same about the next step, in which some bits are what they were."""
        support = self.arena.manager.support(target)
        moving = (bit for bit in self.routes.moving[place] if bit in support)
        return self.arena.manager.rename(target, {bit: next_bit(bit) for bit in moving})

    def _is_closed(self, place: int) -> bool:
        reached = self._after(place, ~self._within)
        for _, product in reversed((*self._before, *self._products[place])):
            reached = product(reached)
        return reached & self._within == self.arena.manager.false
