"""What fixpoints are computed on: the states of a game and the turns from one to the next.

A step of a plain game is a turn of the environment (next inputs) and one of the system (next
outputs). Encodings of the same game (``shift``) have fewer bits in a state and a turn of the
system before the one of the environment.
"""

from collections.abc import Collection
from dataclasses import dataclass, field

from msgspec import Struct

from sysmlc.logic.contract import Owner
from sysmlc.synthesis.bdd.manager import Manager, Node
from sysmlc.synthesis.bdd.symbols import Symbols
from sysmlc.synthesis.games.game import Game, Part
from sysmlc.synthesis.games.relational_product import Product


class Turn(Struct, frozen=True):
    """One side chooses values of bits so that all parts hold."""

    owner: Owner
    bits: tuple[str, ...]
    parts: tuple[Node, ...]


class Arena(Struct, frozen=True):
    """The states and the turns of a game."""

    manager: Manager
    symbols: Symbols
    states: Node
    """The states that are looked at: all variables in their ranges."""
    turns: tuple[Turn, ...]
    """The turns of a step, in order; the last ones choose primed bits."""
    start: tuple[Turn, ...]
    """The turns that lead to the first state, or with ``is_ahead`` to the second one."""
    goals: tuple[Node, ...]
    fairness: tuple[Node, ...]
    is_ahead: bool = False
    command: Turn | None = None
    """With ``is_ahead`` the first turn with all that is chosen in it: of ``turns`` commands may
    have been quantified away."""


def plain(game: Game) -> Arena:
    """The arena of a game as it is written."""
    names = (*game.names(Owner.ENVIRONMENT), *game.names(Owner.SYSTEM))
    return Arena(
        manager=game.manager,
        symbols=game.symbols,
        states=in_range(game.symbols, names),
        turns=(
            Turn(Owner.ENVIRONMENT, game.next_inputs, nodes(game.assumptions)),
            Turn(Owner.SYSTEM, game.next_outputs, nodes(game.guarantees)),
        ),
        start=(
            Turn(Owner.ENVIRONMENT, game.inputs, nodes(game.init_assumptions)),
            Turn(Owner.SYSTEM, game.outputs, nodes(game.init_guarantees)),
        ),
        goals=nodes(game.goals),
        fairness=nodes(game.fairness),
    )


def in_range(symbols: Symbols, names: Collection[str], primed: bool = False) -> Node:
    """Where the variables have values."""
    found = symbols.manager.true
    for name in names:
        found = found & symbols.domain(name, primed)
    return found


def nodes(parts: Collection[Part]) -> tuple[Node, ...]:
    """The diagrams of parts."""
    return tuple(part.node for part in parts)


@dataclass(slots=True)
class Steps:
    """What can be forced in one step of an arena."""

    arena: Arena
    within: Node | None = None
    """States that turns do not lead out of, and outside of which nothing matters."""
    count: int = 0
    """Predecessors computed so far."""
    _products: tuple[tuple[Owner, Product], ...] = field(init=False)

    def __post_init__(self) -> None:
        self._products = products(self.arena.manager, self.arena.turns)

    def controllable(self, target: Node) -> Node:
        """States from which the system can see to it that the target holds in the next one.

        Where the environment has no next input, that is so.
        """
        self.count += 1
        if self.within is not None:
            target = self.arena.manager.restrict(target, self.within)
        return played(self._products, self.arena.symbols.prime(target))

    def nearer(self, reached: Node, winning: Node) -> Node:
        """Those of the winning states that can force the next one to be reached."""
        return self.controllable(reached) & winning

    def confine(self, winning: Node) -> None:
        """What is said from now on has to be right in these states only."""

    def escapable(self, target: Node) -> Node:
        """States from which the environment can see to it that the next one is in the target."""
        return ~self.controllable(~target)

    def is_won(self, winning: Node) -> bool:
        """Whether the system can start so that it comes to these states."""
        arena = self.arena
        target = arena.symbols.prime(winning) if arena.is_ahead else winning
        return played(products(arena.manager, arena.start), target) == arena.manager.true


def products(manager: Manager, turns: Collection[Turn]) -> tuple[tuple[Owner, Product], ...]:
    """Turns as ``played`` takes them."""
    return tuple((turn.owner, Product(manager, turn.parts, turn.bits)) for turn in turns)


def played(products: Collection[tuple[Owner, Product]], target: Node) -> Node:
    """Where the turns can be played so that the target holds after them."""
    for owner, product in reversed(tuple(products)):
        target = product(target) if owner is Owner.SYSTEM else ~product(~target)
    return target
