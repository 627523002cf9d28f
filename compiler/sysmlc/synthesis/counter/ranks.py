"""The states from which the environment wins, by rank: the dual of the fixpoint in ``solve``.

In a state of a rank the environment keeps its assumptions and prevents one goal for ever, unless
the system goes to a state of an earlier rank (Könighofer, Hofferek, Bloem 2013: counter-strategies
of GR(1) games).
"""

from collections.abc import Iterator

from msgspec import Struct

from sysmlc.synthesis.bdd.manager import Node
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


class Lost(Struct, frozen=True):
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


def lost(game: Game) -> Lost:
    """How the environment wins where it does; raises LimitError."""
    arena = plain(game)
    with arena.manager.guard():
        return _Search(game, arena).run()


class _Search:
    def __init__(self, game: Game, arena: Arena) -> None:
        self._game = game
        self._arena = arena
        self._steps = Steps(arena)
        true = arena.manager.true
        self._goals = arena.goals or (true,)
        self._fairness = arena.fairness or (true,)

    def run(self) -> Lost:
        """Ranks until no goal can be prevented from more states."""
        return Lost(self._game, self._arena, self._goals, self._fairness, tuple(self._ranks()))

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
