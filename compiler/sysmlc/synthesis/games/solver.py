"""The winning states of a GR(1) game: a three-fold fixpoint.

Piterman, Pnueli, Sa'ar, Synthesis of Reactive(1) Designs (2006); Bloem, Jobstmann, Piterman,
Pnueli, Sa'ar (2012). The outer (greatest) fixpoint are states from which every goal can be reached
again, the middle (least) ones the layers on the way to one goal, the inner (greatest) ones states
in which the system may stay since an assumption does not recur.
"""

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass, field
from itertools import cycle

from msgspec import Struct

from sysmlc.synthesis.bdd.manager import Node
from sysmlc.synthesis.games.arena import Arena, Steps, plain
from sysmlc.synthesis.games.game import Game
from sysmlc.synthesis.games.search_reductions import (
    Swap,
    drop_irrelevant_ranges,
    find_reachable_states,
    group_symmetric_goals,
    state_invariant,
    swap_variables,
)
from sysmlc.synthesis.games.single_moves import SingleSteps, routes


class Layer(Struct, frozen=True):
    """States from which the system comes closer to a goal in a step, or stays.

    A state in ``states`` and not in the layer before it is in the goal itself (first layer), can
    force the layer before, or is in one of ``waiting``.
    """

    states: Node
    """This layer and all before it."""
    waiting: tuple[Node, ...]
    """For each fairness assumption: from here the system comes nearer, or stays here while the
    assumption does not hold."""


@dataclass(slots=True)
class Way:
    """The way to a goal among states that may be winning."""

    steps: Steps | SingleSteps
    fairness: tuple[Node, ...]
    winning: Node
    before: Sequence[Layer]
    """The layers of the same goal when there were more such states; they bound the new ones."""
    is_quick: bool
    """Whether only the last layer counts: the system then goes on until it has to wait, and what
    it comes to by waiting for one assumption counts at once for the next one."""
    _place: int = field(init=False, default=0)

    def layers(self, target: Node) -> Iterator[Layer]:
        """The layers of a goal's states (``target``), the nearest first."""
        reached = self.steps.arena.manager.false
        while reached != self.winning:
            start = target | self.steps.nearer(reached, self.winning)
            layer = self._quick(start) if self.is_quick else self._layer(start)
            if layer.states == reached:
                return
            yield layer
            reached = layer.states
            self._place += 1

    def _layer(self, start: Node) -> Layer:
        waiting = tuple(
            self._waiting(start, ~fair, bound)
            for fair, bound in zip(self.fairness, self._bounds(), strict=True)
        )
        states = start
        for one in waiting:
            states = states | one
        return Layer(states, waiting)

    def _quick(self, states: Node) -> Layer:
        before = self.steps.arena.manager.false
        while states not in (before, self.winning):
            before = states
            states = states | self.steps.nearer(states, self.winning)
        if states == self.winning:
            return Layer(states, ())
        waiting: list[Node] = []
        for fair, bound in zip(self.fairness, self._bounds(), strict=True):
            waiting.append(self._waiting(states, ~fair, bound))
            states = states | waiting[-1]
        return Layer(states, tuple(waiting))

    def _bounds(self) -> tuple[Node, ...]:
        """For each assumption more states than the system can wait in."""
        if self._place < len(self.before) and self.before[self._place].waiting:
            found = self.before[self._place].waiting
        else:
            whole = self.before[-1].states if self.before else self.winning
            found = (whole,) * len(self.fairness)
        return tuple(one & self.winning for one in found)

    def _waiting(self, start: Node, unfair: Node, bound: Node) -> Node:
        """Start, and where the system can stay until it is there, unfair for ever."""
        found = bound | start
        while True:
            fewer = found & (start | (unfair & self.steps.controllable(found)))
            if fewer == found:
                return found
            found = fewer


class Solution(Struct, frozen=True):
    """The outcome of a game."""

    arena: Arena
    is_realizable: bool
    winning: Node
    """States from which the system wins; with ``is_complete`` false those that may still be."""
    is_complete: bool
    """Whether the fixpoint was computed to its end; it need not be for the verdict."""
    layers: tuple[tuple[Layer, ...], ...]
    """For each goal (a game without goals has one: to go on) its layers, the nearest first.
    Without ``is_complete`` those of goals that are alike may be missing."""
    rounds: int
    """Times a goal was computed."""
    steps: int
    """Predecessors computed."""


def solve(game: Game, is_complete: bool = True) -> Solution:
    """Decide a game as it is written; without ``is_complete`` the verdict is all that counts.

    Raises LimitError when a limit of the manager is reached.
    """
    return solve_arena(plain(game), is_complete)


def solve_arena(arena: Arena, is_complete: bool = True) -> Solution:
    """Decide what was made of a game; winning states and layers are those of the arena.

    Raises LimitError when a limit of the manager is reached.
    """
    with arena.manager.guard():
        if is_complete:
            return _Solver(arena, Steps(arena), is_complete).run()
        return by_single_moves(arena) or _Solver(arena, _few(arena), is_complete).run()


def _few(arena: Arena) -> Steps:
    """The steps of a game, among the states that plays come to if these are few."""
    with arena.manager.calm():
        return Steps(arena, find_reachable_states(arena))


def by_single_moves(arena: Arena) -> Solution | None:
    """The solution if the game is won by moves of one component at a time (``routes``)."""
    ways = routes(arena)
    if ways is None:
        return None
    with arena.manager.calm():
        found = _Solver(arena, SingleSteps(arena, ways), is_complete=False).run()
    return found if found.is_realizable else None


@dataclass(slots=True)
class _Solver:
    arena: Arena
    _steps: Steps | SingleSteps
    is_complete: bool
    _goals: tuple[Node, ...] = field(init=False)
    _layers: list[tuple[Layer, ...]] = field(init=False)
    _rounds: int = 0

    def __post_init__(self) -> None:
        self._goals = self.arena.goals or (self.arena.manager.true,)
        self._layers = [() for _ in self._goals]

    def run(self) -> Solution:
        """Solve the game, with one goal for all that are alike if strategies are not asked for."""
        alike = {} if self.is_complete else group_symmetric_goals(self.arena)
        winning, is_known = self._settled(alike or self._each())
        exchanges = [exchange for found in alike.values() for exchange in found]
        if any(swap_variables(self.arena, winning, exchange) != winning for exchange in exchanges):
            self._layers = [() for _ in self._goals]
            winning, is_known = self._settled(self._each())
        return self._solution(winning, is_known and self._steps.is_won(winning), is_known)

    def _settled(self, alike: Mapping[int, tuple[Swap, ...]]) -> tuple[Node, bool]:
        """The goals in turn until none of them makes the winning states fewer.

        False when it was seen before that the game is lost.
        """
        winning, settled = self._candidates(), 0
        for goal in cycle(alike):
            found = reached = self._again(goal, winning)
            for exchange in alike[goal]:
                found = found & swap_variables(self.arena, reached, exchange)
            settled = settled + 1 if found == winning else 0
            winning = found
            if settled == len(alike):
                return winning, True
            if not self.is_complete and self._is_lost(winning):
                return winning, False
        return winning, True

    def _candidates(self) -> Node:
        """The states that may be winning: those in which a rule for the present step holds."""
        if self.is_complete:
            return self.arena.states
        found = self.arena.states & state_invariant(self.arena)
        return found if self._steps.within is None else found & self._steps.within

    def _again(self, goal: int, winning: Node) -> Node:
        """Those of the winning states from which the goal can be reached, again and again."""
        if self.is_complete:
            return self._attracted(goal, winning)
        return self._attracted(goal, drop_irrelevant_ranges(self.arena, goal, winning)) & winning

    def _each(self) -> dict[int, tuple[Swap, ...]]:
        """Every goal by itself: strategies need the layers of all."""
        return dict.fromkeys(range(len(self._goals)), ())

    def _is_lost(self, winning: Node) -> bool:
        """Whether it is seen without much work that the game is lost."""
        if self.arena.is_ahead and winning != self.arena.manager.false:
            return False
        return not self._steps.is_won(winning)

    def _attracted(self, goal: int, winning: Node) -> Node:
        """``_again``, whatever is not in the range of its variable."""
        self._rounds += 1
        self._steps.confine(winning)
        target = self._goals[goal] & self._steps.controllable(winning) & winning
        fairness, before = self.arena.fairness, self._layers[goal]
        way = Way(self._steps, fairness, winning, before, not self.is_complete)
        layers: list[Layer] = []
        for layer in way.layers(target):
            layers.append(layer)
            self._say(goal, len(layers))
        self._layers[goal] = tuple(layers)
        return layers[-1].states if layers else self.arena.manager.false

    def _say(self, goal: int, layers: int) -> None:
        self.arena.manager.check(f"round {self._rounds}, goal {goal + 1}, layer {layers}")

    def _solution(self, winning: Node, is_realizable: bool, is_complete: bool) -> Solution:
        return Solution(
            self.arena,
            is_realizable,
            winning,
            is_complete,
            tuple(self._layers),
            self._rounds,
            self._steps.count,
        )
