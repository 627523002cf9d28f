"""Arenas: the states of a game and the turns of a step, on which fixpoints are computed.

In a plain arena a step has a turn of the environment (next inputs), then a turn of the system (next
outputs). An encoded arena (``command_elimination``) has fewer bits in a state, and a turn of the
system before the turn of the environment.
"""

from collections.abc import Collection
from dataclasses import dataclass, field

from msgspec import Struct

from sysmlc.logic.contract import Owner
from sysmlc.synthesis.bdd.manager import Manager, Node
from sysmlc.synthesis.bdd.symbols import Symbols
from sysmlc.synthesis.games.game import Constraint, Game
from sysmlc.synthesis.games.relational_product import Product


class Turn(Struct, frozen=True):
    """A choice of one side: values of ``bits`` that satisfy all of ``parts``."""

    owner: Owner
    bits: tuple[str, ...]
    parts: tuple[Node, ...]


class Arena(Struct, frozen=True):
    """The states and turns of a game."""

    manager: Manager
    symbols: Symbols
    states: Node
    """The states in which all variables have values of their domains."""
    turns: tuple[Turn, ...]
    """The turns of a step, in order; they choose primed bits, except for commands."""
    start: tuple[Turn, ...]
    """The turns of the first step; if ``is_ahead``, also those that lead to the next state."""
    goals: tuple[Node, ...]
    """The liveness guarantees."""
    fairness: tuple[Node, ...]
    """The liveness assumptions."""
    is_ahead: bool = False
    """Whether a step begins with a turn of the system, which chooses commands."""
    command: Turn | None = None
    """If ``is_ahead``, the first turn of a step including the commands, which ``turns[0]`` may not
    contain any more."""


def build_plain_arena(game: Game) -> Arena:
    """Return the arena of a game without any encoding."""
    names = (*game.names(Owner.ENVIRONMENT), *game.names(Owner.SYSTEM))
    return Arena(
        manager=game.manager,
        symbols=game.symbols,
        states=domain_constraint(game.symbols, names),
        turns=(
            Turn(Owner.ENVIRONMENT, game.next_inputs, nodes_of(game.assumptions)),
            Turn(Owner.SYSTEM, game.next_outputs, nodes_of(game.guarantees)),
        ),
        start=(
            Turn(Owner.ENVIRONMENT, game.inputs, nodes_of(game.init_assumptions)),
            Turn(Owner.SYSTEM, game.outputs, nodes_of(game.init_guarantees)),
        ),
        goals=nodes_of(game.goals),
        fairness=nodes_of(game.fairness),
    )


def domain_constraint(symbols: Symbols, names: Collection[str], primed: bool = False) -> Node:
    """Return the condition that the variables *names* have values of their domains."""
    return symbols.manager.conjoin(symbols.domain(name, primed) for name in names)


def nodes_of(constraints: Collection[Constraint]) -> tuple[Node, ...]:
    """Return the diagrams of constraints."""
    return tuple(constraint.node for constraint in constraints)


@dataclass(slots=True)
class PredecessorOperator:
    """Computes controllable predecessors in an arena."""

    arena: Arena
    within: Node | None = None
    """States that are closed under all turns; results outside of them are arbitrary."""
    count: int = 0
    """Predecessors computed so far."""
    _products: tuple[tuple[Owner, Product], ...] = field(init=False)

    def __post_init__(self) -> None:
        self._products = turn_products(self.arena.manager, self.arena.turns)

    def controllable_predecessors(self, target: Node) -> Node:
        """Return the states from which the system can force the next state into *target*.

        This includes the states in which the environment has no next input.
        """
        self.count += 1
        if self.within is not None:
            target = self.arena.manager.restrict(target, self.within)
        return predecessors_through(self._products, self.arena.symbols.prime(target))

    def extend_attractor(self, attractor: Node, winning: Node) -> Node:
        """Return the winning states from which the system can force *attractor* in one step."""
        return self.controllable_predecessors(attractor) & winning

    def confine_to(self, winning: Node) -> None:
        """Permit arbitrary results outside of *winning* from now on.

        Only ``SingleMoveOperator`` uses the permission.
        """

    def environment_predecessors(self, target: Node) -> Node:
        """Return the states from which the environment can force the next state into *target*."""
        return ~self.controllable_predecessors(~target)

    def wins_initially(self, winning: Node) -> bool:
        """Return whether the system can force the first state into *winning*."""
        arena = self.arena
        target = arena.symbols.prime(winning) if arena.is_ahead else winning
        return (
            predecessors_through(turn_products(arena.manager, arena.start), target)
            == arena.manager.true
        )


def turn_products(manager: Manager, turns: Collection[Turn]) -> tuple[tuple[Owner, Product], ...]:
    """Return the owner and the relational product of each turn, for ``predecessors_through``."""
    return tuple((turn.owner, Product(manager, turn.parts, turn.bits)) for turn in turns)


def predecessors_through(products: Collection[tuple[Owner, Product]], target: Node) -> Node:
    """Return the states from which the system can force *target* to hold after the turns."""
    # Existential quantification for turns of the system, universal for those of the environment.
    for owner, product in reversed(tuple(products)):
        target = product(target) if owner is Owner.SYSTEM else ~product(~target)
    return target
