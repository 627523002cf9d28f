"""What the environment does to win, step by step: a strategy with a little memory."""

from collections.abc import Iterator, Mapping

from sysmlc.synthesis.bdd.manager import Node
from sysmlc.synthesis.bdd.symbols import next_bit
from sysmlc.synthesis.counter.ranks import Lost, Rank

Bits = Mapping[str, bool]


class NotLostError(ValueError):
    """The environment does not win: the contract can be kept."""


class Environment:
    """A winning strategy; valuations are bits of the present step, by name."""

    def __init__(self, lost: Lost) -> None:
        """Raises NotLostError when the environment does not win."""
        self.lost = lost
        self._arena = lost.arena
        self.first = self._first()

    def _first(self) -> Bits:
        """Inputs at which every start of the system is lost."""
        given, answered = self._arena.start
        manager = self._arena.manager
        good = _all(given.parts, manager.true)
        kept = _all(answered.parts, manager.true)
        good = good & ~manager.exist(answered.bits, kept & ~self.lost.states)
        found = manager.pick(good, given.bits)
        if found is None:
            raise NotLostError("the environment does not win")
        return found

    def answers(self, state: Bits | None, given: Bits) -> Iterator[Bits]:
        """Everything that the system may answer, at first (without a state) or in the next step.

        Nothing when it is stuck.
        """
        answered, known = self._arena.start[1], given
        if state is not None:
            answered = self._arena.turns[1]
            known = {**state, **{next_bit(bit): value for bit, value in given.items()}}
        parts = [self._arena.manager.assign(one, known) for one in answered.parts]
        for found in self._each(_all(parts, self._arena.manager.true), answered.bits):
            yield self._present(found)

    def rank(self, state: Bits) -> Rank:
        """The first rank with the state; raises NotLostError when the system wins there."""
        for one in self.lost.ranks:
            if self._holds(one.states, state):
                return one
        raise NotLostError("the system wins from here")

    def next(self, state: Bits, fair: int) -> tuple[Bits, int]:
        """The next inputs, and the assumption that is to be kept next."""
        rank = self.rank(state)
        if self._holds(self.lost.goals[rank.goal], state):
            return self._towards(state, self._before(rank)), 0
        if self._holds(self.lost.fairness[fair], state):
            return self._towards(state, rank.stay), (fair + 1) % len(self.lost.fairness)
        way = rank.ways[fair]
        place = next(at for at, states in enumerate(way) if self._holds(states, state))
        return self._towards(state, way[place - 1]), fair

    def _before(self, rank: Rank) -> Node:
        place = self.lost.ranks.index(rank)
        return self.lost.ranks[place - 1].states if place else self._arena.manager.false

    def _towards(self, state: Bits, target: Node) -> Bits:
        """Inputs after which all answers lead to the target; those of now, when they do."""
        manager = self._arena.manager
        given, answered = self._arena.turns
        kept = _all([manager.assign(one, state) for one in answered.parts], manager.true)
        missed = kept & ~self._arena.symbols.prime(target)
        good = _all([manager.assign(one, state) for one in given.parts], manager.true)
        good = good & ~manager.exist(answered.bits, missed)
        same = {next_bit(bit): state[bit] for bit in self.first}
        if self._holds(good, same):
            return {bit: state[bit] for bit in self.first}
        return self._present(manager.pick(good, given.bits) or {})

    def _present(self, after: Bits) -> Bits:
        """The same values as those of the present step."""
        return {bit.removesuffix("'"): value for bit, value in after.items()}

    def _each(self, node: Node, bits: tuple[str, ...]) -> Iterator[Bits]:
        manager = self._arena.manager
        while (found := manager.pick(node, bits)) is not None:
            yield found
            node = node & ~manager.cube(found)

    def _holds(self, node: Node, values: Bits) -> bool:
        manager = self._arena.manager
        return manager.assign(node, values) == manager.true


def _all(parts: list[Node] | tuple[Node, ...], found: Node) -> Node:
    for one in parts:
        found = found & one
    return found
