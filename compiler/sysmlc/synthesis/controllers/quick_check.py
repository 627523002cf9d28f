"""Whether a controller plainly keeps a contract: the check of ``verify`` for controllers that do.

Where runs can be is kept for those variables only that a later step, or what recurs, speaks of:
sensors and free cells of a step that is over do not matter, and are most of what can be told apart.
What is promised of steps is held against all steps at once. It may doubt a controller that keeps
its contract; it never trusts one that does not.
"""

from collections.abc import Iterable, Iterator

from sysmlc.synthesis.bdd.limits import TooLargeError
from sysmlc.synthesis.bdd.manager import Node
from sysmlc.synthesis.controllers.closed_loop import Closed
from sysmlc.synthesis.games.relational_product import Product, joined

MANY = 4_000
"""Nodes of the states that one step adds from which on it is worth to guess where runs can be."""
GUESSES = 5
"""Times that a guess of where runs can be is made smaller."""
WHOLE = 2
"""Parts of what a controller does when it is one relation, with the ranges of its outputs."""
ROOM = 100_000
"""Nodes that a guess may take beside twice those that there are."""


class Glance:
    """Runs, with what is forgotten of each step left out of them."""

    def __init__(self, closed: Closed, safe: Iterable[Node], recurring: Iterable[Node]) -> None:
        """``safe`` is promised of a step or two, ``recurring`` again and again."""
        self.closed, self.manager = closed, closed.manager
        self.safe, self.recurring = tuple(safe), tuple(recurring)
        self.goals = closed.fairness or (self.manager.true,)
        names = tuple(closed.symbols.variables)
        self._bits = closed.symbols.all_bits(names)
        self._next = closed.symbols.all_bits(names, primed=True)
        self._every = (*self._bits, *self._next)
        kept = self._kept()
        forgotten = [one for one in names if one not in kept]
        later = closed.symbols.all_bits(forgotten, primed=True)
        self._forward = Product(
            self.manager, (*closed.allowed, *closed.moves), (*self._bits, *later)
        )
        self._gone = closed.symbols.all_bits(forgotten)
        self.reachable = self._reached(self.manager.exist(self._gone, closed.starts))

    def after(self, states: Node) -> Node:
        """What is kept of the states that one step leads to."""
        return self.closed.symbols.unprime(self._forward(states))

    def keeps_each_step(self) -> bool:
        """Whether all that is promised of steps holds in all of them, the first one too."""
        about_one = [node for node in self.safe if self._is_of_one(node)]
        if not all(self.closed.starts <= node for node in about_one):
            return False
        later = [self._as_next(node) for node in self.safe]
        is_in_parts = len(self.closed.moves) > WHOLE
        together = self._grouped(later) if is_in_parts else joined(self.manager, later)
        return not any(self._is_broken(~node) for node in together)

    def _is_broken(self, step: Node) -> bool:
        """Whether a step can be one of these; with what is decided beside it only where it must."""
        done = (*self.closed.allowed, *self.closed.moves)
        return self.is_possible(step, self._about(step)) and self.is_possible(step, done)

    def _about(self, step: Node) -> list[Node]:
        """What is assumed, and what the controller does of what is spoken of in the next step."""
        of = self.manager.support
        after = frozenset(bit for bit in of(step) if bit.endswith("'"))
        return [
            *self.closed.allowed,
            *(one for one in self.closed.moves if not after.isdisjoint(of(one))),
        ]

    def _grouped(self, nodes: Iterable[Node]) -> Iterator[Node]:
        """Conjunctions of those that speak of the same bits."""
        groups: dict[frozenset[str], list[Node]] = {}
        for node in nodes:
            groups.setdefault(self.manager.support(node), []).append(node)
        for members in groups.values():
            yield from joined(self.manager, members)

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
        """All that runs come to; where that is much, a guess that no step leads out of, if any."""
        found = front = states
        is_guessed = False
        while front != self.manager.false:
            if not is_guessed and len(front) > MANY:
                is_guessed = True
                guess = self._guess_within_limits(states)
                if guess is not None:
                    return guess
            front = self.after(front) & ~found
            found = found | front
            self.manager.check("checking the controller")
        return found

    def _guess_within_limits(self, states: Node) -> Node | None:
        try:
            with self.manager.at_most(ROOM + 2 * self.manager.usage().nodes):
                return self._guessed(states)
        except TooLargeError:
            return None

    def _guessed(self, states: Node) -> Node | None:
        """What is promised and assumed of every single step, without what steps lead out of."""
        parts = [node for node in self._of_each_step() if self._is_kept(node)]
        for _ in range(GUESSES):
            found = self.manager.true
            for part in parts:
                found = found & part
            if not states <= found:
                return None
            leaving = [self._leaving(found, part) for part in parts]
            if all(node == self.manager.false for node in leaving):
                return found
            parts += [~node for node in leaving if node != self.manager.false]
        return None

    def _of_each_step(self) -> Iterator[Node]:
        symbols = self.closed.symbols
        yield from (symbols.domain(name) for name in symbols.variables)
        for node in self._grouped((*self.safe, *self.closed.allowed)):
            if self._is_of_one(node):
                yield node
            elif all(bit.endswith("'") for bit in self.manager.support(node)):
                yield symbols.unprime(node)

    def _is_kept(self, node: Node) -> bool:
        support = self.manager.support(node)
        return bool(support) and support.isdisjoint(self._gone)

    def _leaving(self, states: Node, part: Node) -> Node:
        """Those of the states from which a step may lead to where something does not hold."""
        out = self.closed.symbols.prime(~part)
        self.manager.check("checking the controller")
        return Product(self.manager, [*self._about(out), out], self._next)(states)
