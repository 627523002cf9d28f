"""Whether a controller plainly keeps a contract: the check of ``verify`` for controllers that do.

Where runs can be is kept for those variables only that a later step, or what recurs, speaks of:
sensors and free cells of a step that is over do not matter, and are most of what can be told apart.
What is promised of steps is held against all steps at once. It may doubt a controller that keeps
its contract; it never trusts one that does not.
"""

from collections.abc import Iterable

from sysmlc.synthesis.bdd.manager import Manager, Node
from sysmlc.synthesis.bdd.symbols import Symbols
from sysmlc.synthesis.games.image import Product, joined
from sysmlc.values import dataclass


@dataclass(frozen=True, slots=True)
class Closed:
    """A controller in all environments that keep the assumptions."""

    symbols: Symbols
    starts: Node
    """First steps."""
    allowed: tuple[Node, ...]
    """What is assumed of a step and the next inputs."""
    moves: tuple[Node, ...]
    """What the controller does."""
    fairness: tuple[Node, ...]

    @property
    def manager(self) -> Manager:
        """Owner of all diagrams."""
        return self.symbols.manager


class Glance:
    """Runs, with what is forgotten of each step left out of them."""

    def __init__(self, closed: Closed, safe: Iterable[Node], recurring: Iterable[Node]) -> None:
        """``safe`` is promised of a step or two, ``recurring`` again and again."""
        self.closed, self.manager = closed, closed.manager
        self.safe, self.recurring = tuple(safe), tuple(recurring)
        self.goals = closed.fairness or (self.manager.true,)
        names = tuple(closed.symbols.variables)
        self._bits = closed.symbols.all_bits(names)
        self._every = (*self._bits, *closed.symbols.all_bits(names, primed=True))
        kept = self._kept()
        forgotten = [one for one in names if one not in kept]
        later = closed.symbols.all_bits(forgotten, primed=True)
        self._forward = Product(
            self.manager, (*closed.allowed, *closed.moves), (*self._bits, *later)
        )
        gone = closed.symbols.all_bits(forgotten)
        self.reachable = self._reached(self.manager.exist(gone, closed.starts))

    def after(self, states: Node) -> Node:
        """What is kept of the states that one step leads to."""
        return self.closed.symbols.unprime(self._forward(states))

    def keeps_each_step(self) -> bool:
        """Whether all that is promised of steps holds in all of them, the first one too."""
        about_one = [node for node in self.safe if self._is_of_one(node)]
        if not all(self.closed.starts <= node for node in about_one):
            return False
        later = [self._as_next(node) for node in self.safe]
        done = (*self.closed.allowed, *self.closed.moves)
        return not any(self.is_possible(~node, done) for node in joined(self.manager, later))

    def is_possible(self, step: Node, parts: Iterable[Node]) -> bool:
        """Whether a step by all parts from where runs can be is one of these."""
        if step == self.manager.false:
            return False
        found = Product(self.manager, [*parts, step], self._every)
        return found(self.reachable) != self.manager.false

    def _is_of_one(self, node: Node) -> bool:
        return all(not bit.endswith("'") for bit in self.manager.support(node))

    def _as_next(self, node: Node) -> Node:
        return self.closed.symbols.prime(node) if self._is_of_one(node) else node

    def _kept(self) -> frozenset[str]:
        """The variables whose values of a step are spoken of later."""
        closed = self.closed
        two = (node for node in self.safe if not self._is_of_one(node))
        spoken = (*closed.allowed, *closed.moves, *closed.fairness, *self.recurring, *two)
        return frozenset(name for node in spoken for name in closed.symbols.names(node))

    def _reached(self, states: Node) -> Node:
        found = front = states
        while front != self.manager.false:
            front = self.after(front) & ~found
            found = found | front
            self.manager.check("checking the controller")
        return found
