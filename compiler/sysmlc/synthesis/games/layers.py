"""Layers on the way to one goal: the middle and the inner fixpoint of a GR(1) game."""

from collections.abc import Iterator, Sequence
from dataclasses import dataclass, field

from msgspec import Struct

from sysmlc.synthesis.bdd.manager import Node
from sysmlc.synthesis.games.arena import Steps
from sysmlc.synthesis.games.routes import SingleSteps


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
