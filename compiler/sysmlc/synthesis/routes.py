"""Steps in which one component moves and all others stay: some of what the system may do.

When the first turn of a step is the system's and falls into components (robots, each with next
values that no rule compares with those of another), the system may move them one at a time. What
is won so is won: it only leaves moves out. Each component's steps speak of few next values, so
they take a fraction of the diagrams of joint steps, and they can be taken one after the other on
the way to a goal.
"""

from collections.abc import Iterable, Mapping
from dataclasses import field

from sysmlc.logic.contract import Owner
from sysmlc.synthesis.arena import Arena, Steps, Turn, played, products
from sysmlc.synthesis.image import Product
from sysmlc.synthesis.manager import Manager, Node
from sysmlc.synthesis.symbols import next_bit
from sysmlc.values import dataclass, replace

FEWEST = 3
"""Components from which on joint steps are worth avoiding."""


@dataclass(frozen=True, slots=True)
class Route:
    """A step in which some bits stay what they are."""

    moving: tuple[str, ...]
    """The bits that may change."""
    turns: tuple[Turn, ...]


def routes(arena: Arena) -> tuple[Route, ...]:
    """The ways to move one component of a system that has some, or nothing."""
    first = arena.turns[0]
    if first.owner is not Owner.SYSTEM:
        return ()
    components = tuple(_components(arena, first))
    if len(components) < FEWEST:
        return ()
    return tuple(_route(arena, own, components) for own in components)


def _components(arena: Arena, turn: Turn) -> Iterable[frozenset[str]]:
    """The next values that the turn chooses, those together that a rule speaks of together."""
    chosen = frozenset(turn.bits)
    variables = [
        chosen.intersection(arena.symbols.bits(name, primed=True))
        for name in arena.symbols.variables
    ]
    rules = [chosen & arena.manager.support(part) for part in turn.parts]
    groups: list[frozenset[str]] = []
    for together in filter(None, (*variables, *rules)):
        touched = [group for group in groups if not group.isdisjoint(together)]
        groups = [group for group in groups if group.isdisjoint(together)]
        groups.append(together.union(*touched))
    return (moved for group in groups if (moved := frozenset(filter(_is_next, group))))


def _route(arena: Arena, own: frozenset[str], components: Iterable[frozenset[str]]) -> Route:
    """The steps in which only these bits change."""
    manager = arena.manager
    others = frozenset[str]().union(*components) - own
    stay = {bit: manager.var(_present(bit)) for bit in sorted(others)}
    turns = tuple(
        replace(
            turn,
            bits=tuple(bit for bit in turn.bits if bit not in others),
            parts=tuple(dict.fromkeys(_staying(manager, part, stay) for part in turn.parts)),
        )
        for turn in arena.turns
    )
    bits = arena.symbols.all_bits(arena.symbols.variables)
    return Route(tuple(bit for bit in bits if next_bit(bit) not in others), turns)


def _staying(manager: Manager, part: Node, stay: Mapping[str, Node]) -> Node:
    support = manager.support(part)
    return manager.compose(part, {bit: now for bit, now in stay.items() if bit in support})


def _is_next(bit: str) -> bool:
    return bit.endswith("'")


def _present(bit: str) -> str:
    return bit.removesuffix("'")


@dataclass(slots=True)
class SingleSteps:
    """What can be forced when one component moves at a time; of the same use as ``Steps``."""

    arena: Arena
    ways: tuple[Route, ...]
    count: int = 0
    """Predecessors computed so far."""
    _products: tuple[tuple[tuple[Owner, Product], ...], ...] = field(init=False)
    _within: Node = field(init=False)
    _closed: tuple[bool, ...] = field(init=False)

    def __post_init__(self) -> None:
        manager = self.arena.manager
        self._products = tuple(products(manager, way.turns) for way in self.ways)
        self._within, self._closed = manager.true, (False,) * len(self.ways)

    def controllable(self, target: Node) -> Node:
        """States from which some component can move so that the target holds in the next one."""
        found = self.arena.manager.false
        for place in range(len(self.ways)):
            found = found | self._controllable(place, target)
        return found

    def nearer(self, reached: Node, winning: Node) -> Node:
        """What is reached and, of the winning states, those that lead there by a move of each
        component in turn, or of some of them."""
        for place in range(len(self.ways)):
            reached = reached | (self._controllable(place, reached) & winning)
        return reached

    def is_won(self, winning: Node) -> bool:
        """Whether the system can start so that it comes to these states."""
        return Steps(self.arena).is_won(winning)

    def _controllable(self, place: int, target: Node) -> Node:
        self.count += 1
        manager = self.arena.manager
        if self._closed[place]:
            target = manager.restrict(target, self._within)
        return played(self._products[place], self._after(place, target))

    def _after(self, place: int, target: Node) -> Node:
        """The same about the next step, in which some bits are what they were."""
        support = self.arena.manager.support(target)
        moving = (bit for bit in self.ways[place].moving if bit in support)
        return self.arena.manager.rename(target, {bit: next_bit(bit) for bit in moving})

    def confine(self, winning: Node) -> None:
        """What is said from now on has to be right in these states only.

        Where a component's moves never lead out of them, what holds outside does not matter.
        """
        if winning == self._within:
            return
        self._within = winning
        self._closed = tuple(self._is_closed(place) for place in range(len(self.ways)))

    def _is_closed(self, place: int) -> bool:
        reached = self._after(place, ~self._within)
        for _, product in reversed(self._products[place]):
            reached = product(reached)
        return reached & self._within == self.arena.manager.false
