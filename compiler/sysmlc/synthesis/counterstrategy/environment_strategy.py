"""What the environment does to win, step by step: a strategy with a little memory."""

from collections.abc import Iterator, Mapping

from msgspec import Struct

from sysmlc.synthesis.bdd.manager import Node
from sysmlc.synthesis.bdd.symbols import next_bit
from sysmlc.synthesis.games.arena import Arena, Steps, plain
from sysmlc.synthesis.games.game import Game


class Rank(Struct, frozen=True):
    """States from which the environment wins since one goal can be prevented."""

    states: Node
    """Those of this rank and of all before."""
    goal: int
    """The goal that is prevented."""
    stay: Node
    """Where the play stays while the goal is prevented."""
    ways: tuple[tuple[Node, ...], ...]
    """For each fairness assumption the states from which it is brought about within so many
    steps, the nearest first; each set contains the one before."""


class LostGame(Struct, frozen=True):
    """A game that the environment wins."""

    game: Game
    arena: Arena
    goals: tuple[Node, ...]
    """What has to recur; to go on, when nothing else is promised."""
    fairness: tuple[Node, ...]
    """What the environment brings about again and again."""
    ranks: tuple[Rank, ...]

    @property
    def states(self) -> Node:
        """All states from which the environment wins."""
        return self.ranks[-1].states if self.ranks else self.arena.manager.false


def find_ranks(game: Game) -> LostGame:
    """How the environment wins where it does; raises LimitError."""
    arena = plain(game)
    with arena.manager.guard():
        return _RankSearch(game, arena).run()


class _RankSearch:
    def __init__(self, game: Game, arena: Arena) -> None:
        self._game = game
        self._arena = arena
        self._steps = Steps(arena)
        true = arena.manager.true
        self._goals = arena.goals or (true,)
        self._fairness = arena.fairness or (true,)

    def run(self) -> LostGame:
        """Ranks until no goal can be prevented from more states."""
        return LostGame(self._game, self._arena, self._goals, self._fairness, tuple(self._ranks()))

    def _ranks(self) -> Iterator[Rank]:
        known = self._arena.manager.false
        settled, goal = 0, 0
        while settled < len(self._goals):
            rank = self._rank(goal, known)
            settled = settled + 1 if rank.states == known else 0
            if rank.states != known:
                yield rank
            known, goal = rank.states, (goal + 1) % len(self._goals)

    def _rank(self, goal: int, known: Node) -> Rank:
        """The states from which the goal is prevented, or those that are known are reached."""
        kept = ~self._goals[goal] | self._steps.escapable(known)
        stay = self._arena.states
        while True:
            within = kept & self._steps.escapable(stay) & self._arena.states
            ways = tuple(self._way(fair, within) for fair in self._fairness)
            fewer = stay
            for way in ways:
                fewer = fewer & way[-1]
            if fewer == stay:
                return Rank(known | stay, goal, stay, ways)
            stay = fewer

    def _way(self, fair: Node, within: Node) -> tuple[Node, ...]:
        """States within which the assumption can be brought about, by the steps that it takes."""
        found = [within & fair]
        while True:
            more = found[-1] | (within & self._steps.escapable(found[-1]))
            if more == found[-1]:
                return tuple(found)
            found.append(more)
            self._arena.manager.check("looking how the environment wins")


Bits = Mapping[str, bool]


class NotLostError(ValueError):
    """The environment does not win: the contract can be kept."""


class EnvironmentStrategy:
    """A winning strategy; valuations are bits of the present step, by name."""

    def __init__(self, lost: LostGame) -> None:
        """Raises NotLostError when the environment does not win."""
        self.lost = lost
        self._arena = lost.arena
        self.first = self._first()

    def _first(self) -> Bits:
        """Inputs at which every start of the system is lost."""
        given, answered = self._arena.start
        manager = self._arena.manager
        good = _conjunction(given.parts, manager.true)
        kept = _conjunction(answered.parts, manager.true)
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
        for found in self._each(_conjunction(parts, self._arena.manager.true), answered.bits):
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
        kept = _conjunction([manager.assign(one, state) for one in answered.parts], manager.true)
        missed = kept & ~self._arena.symbols.prime(target)
        good = _conjunction([manager.assign(one, state) for one in given.parts], manager.true)
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


def _conjunction(parts: list[Node] | tuple[Node, ...], found: Node) -> Node:
    for one in parts:
        found = found & one
    return found
