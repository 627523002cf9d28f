"""Fair runs: reachable states, states from which a fair run goes on (Emerson and Lei 1986)."""

from collections.abc import Sequence

from sysmlc.synthesis.algebra.systems import FairSystem
from sysmlc.synthesis.bdd.manager import Manager, Node
from sysmlc.synthesis.games.image import Product


class Runs:
    """The runs of a system, explored as far as they are asked for."""

    def __init__(self, system: FairSystem) -> None:
        """Settle the order in which relations are joined; nothing is explored yet."""
        self.system = system
        symbols = system.symbols
        names = tuple(symbols.variables)
        self.bits: Sequence[str] = symbols.all_bits(names)
        self.next_bits: Sequence[str] = symbols.all_bits(names, primed=True)
        self._forward = Product(self.manager, system.parts, self.bits)
        self._backward = Product(self.manager, system.parts, self.next_bits)
        self._reachable: Node | None = None
        self._fair: Node | None = None

    @property
    def manager(self) -> Manager:
        """Owner of all diagrams."""
        return self.system.symbols.manager

    def after(self, states: Node) -> Node:
        """The states that one step leads to."""
        return self.system.symbols.unprime(self._forward(states))

    def before(self, states: Node) -> Node:
        """The states from which one step leads there."""
        return self._backward(self.system.symbols.prime(states))

    def before_by(self, states: Node, step: Node) -> Node:
        """The same for steps that also satisfy ``step``."""
        return self._backward(self.system.symbols.prime(states) & step)

    @property
    def reachable(self) -> Node:
        """All states that some run of steps leads to."""
        if self._reachable is None:
            self._reachable = self._closed(self.system.init)
        return self._reachable

    @property
    def fair(self) -> Node:
        """Reachable states from which a fair run goes on for ever."""
        if self._fair is None:
            self._fair = self.fair_within(self.reachable)
        return self._fair

    @property
    def endless(self) -> Node:
        """States, reachable or not, from which steps go on for ever."""
        found = self.manager.true
        while (fewer := found & self.before(found)) != found:
            found = fewer
        return found

    def fair_within(self, states: Node) -> Node:
        """States from which a fair run goes on for ever without leaving ``states``."""
        found = states
        while True:
            fewer = found
            for goal in self.goals:
                fewer = fewer & self.before(self.leading(fewer, fewer & goal))
            if fewer == found:
                return found
            found = fewer
            self.manager.check("looking for fair runs")

    @property
    def goals(self) -> tuple[Node, ...]:
        """What a fair run meets again and again; to go on, when nothing else is asked."""
        return self.system.fairness or (self.manager.true,)

    def leading(self, within: Node, target: Node) -> Node:
        """States from which steps within ``within`` lead to the target."""
        found = target
        while True:
            more = found | (within & self.before(found))
            if more == found:
                return found
            found = more

    def rings(self, within: Node, target: Node) -> list[Node]:
        """The same as sets of states by the number of steps, the target first."""
        found = [target]
        known = target
        while True:
            ring = within & self.before(found[-1]) & ~known
            if ring == self.manager.false:
                return found
            found.append(ring)
            known = known | ring

    def _closed(self, states: Node) -> Node:
        found, front = states, states
        while front != self.manager.false:
            front = self.after(front) & ~found
            found = found | front
            self.manager.check("exploring what can be reached")
        return found
