"""A controller from the layers of a solved game: its answers, computed state by state.

A state is what all variables are, and the goal in turn. In it the system takes an answer that
leads to the nearest layer of the goal; where none is nearer it waits among the states in which an
assumption does not recur (Piterman, Pnueli, Sa'ar 2006, section 4). Choices are the same each time,
whatever the library and the order of bits.
"""

from bisect import bisect_left
from collections.abc import Hashable, Iterable, Iterator, Mapping, Sequence

from sysmlc.logic.contract import Owner
from sysmlc.logic.formula import Literal
from sysmlc.synthesis.arena import Turn
from sysmlc.synthesis.image import CLUSTER
from sysmlc.synthesis.manager import Manager, Node
from sysmlc.synthesis.solve import Solution
from sysmlc.synthesis.symbols import next_bit
from sysmlc.values import dataclass

Bits = Mapping[str, bool]


class AssumptionBrokenError(ValueError):
    """The environment gave inputs that the contract does not allow it."""


@dataclass(frozen=True, slots=True)
class State:
    """Where a controller is."""

    code: tuple[bool, ...]
    """The bits of inputs and outputs, in the order of ``Controller.bits``."""
    goal: int
    """The goal in turn; one that holds here already has been counted, unless all do."""


@dataclass(frozen=True, slots=True)
class _View:
    """What is allowed from a state on."""

    asked: tuple[Node, ...]
    """Assumptions about the next inputs."""
    owed: tuple[Node, ...]
    """Guarantees about the next inputs and outputs."""


class Controller:
    """Answers the environment so that a contract is kept."""

    def __init__(self, solution: Solution) -> None:
        """Settle what is joined once and for all; nothing is explored.

        Raises ValueError for a game that is lost, not solved to its end, or encoded with turns
        of its own.
        """
        arena = solution.arena
        if arena.is_ahead or not (solution.is_realizable and solution.is_complete):
            raise ValueError("a controller needs a plain game that was won")
        self._manager, self.symbols = arena.manager, arena.symbols
        self._solution = solution
        (self._first_inputs, self.inputs), (self._first_outputs, self.outputs) = (
            (_joined(arena.manager, turn), turn.bits) for turn in arena.start
        )
        self._asked, self._owed = (_joined(arena.manager, turn) for turn in arena.turns)
        self._goals = arena.goals or (arena.manager.true,)
        self.bits = (*self.inputs, *self.outputs)
        self._seen: tuple[State, _View] | None = None

    def start(self, inputs: Mapping[str, Literal]) -> State:
        """The first state for the first inputs.

        Raises AssumptionBrokenError when the assumptions do not allow these inputs.
        """
        return self.first(self._coded(inputs))

    def step(self, state: State, inputs: Mapping[str, Literal]) -> State:
        """The next state for the next inputs.

        Raises AssumptionBrokenError when the assumptions do not allow these inputs.
        """
        return self.after(state, self._coded(inputs))

    def values(self, state: State) -> dict[str, Literal]:
        """What the variables are in a state."""
        return self.symbols.decode(self._bits(state))

    def future(self, state: State) -> Hashable:
        """What all later steps depend on: states with the same future are answered the same."""
        view, now = self._view(state), self._bits(state)
        if self._holds(self._goals[state.goal], now):
            return view, state.goal
        here, waiting = self._layer(state.goal, now)
        return view, state.goal, here, waiting

    def first_inputs(self) -> Iterator[Bits]:
        """All first inputs that the assumptions allow."""
        return assignments(self._manager, _all(self._manager, self._first_inputs), self.inputs)

    def next_inputs(self, state: State) -> Iterator[Bits]:
        """All next inputs that the assumptions allow in a state, as bits without primes."""
        allowed = self.symbols.unprime(_all(self._manager, self._view(state).asked))
        return assignments(self._manager, allowed, self.inputs)

    def first(self, inputs: Bits) -> State:
        """``start`` for bits."""
        if not self._is_true(self._first_inputs, inputs):
            raise AssumptionBrokenError("the first inputs break an assumption")
        possible = self._possible(self._first_outputs, inputs)
        return self._chosen(self._nearest(possible, inputs, 0)[1], inputs, 0)

    def after(self, state: State, inputs: Bits) -> State:
        """``step`` for bits."""
        given = {next_bit(bit): value for bit, value in inputs.items()}
        view = self._view(state)
        if not self._is_true(view.asked, given):
            raise AssumptionBrokenError("the next inputs break an assumption")
        possible = self.symbols.unprime(self._possible(view.owed, given))
        return self._chosen(self._answers(state, possible, inputs), inputs, state.goal)

    def _answers(self, state: State, possible: Node, inputs: Bits) -> Node:
        """The answers that lead nearer to the goal, or on from it, or wait."""
        now = self._bits(state)
        rank, found = self._nearest(possible, inputs, state.goal)
        if self._holds(self._goals[state.goal], now):
            return found
        here, waiting = self._layer(state.goal, now)
        if rank < here:
            return found
        return possible & self._manager.assign(waiting, inputs)

    def _layer(self, goal: int, now: Bits) -> tuple[int, Node]:
        """The layer of a state, and where the system may wait there, for the first assumption."""
        layers = self._solution.layers[goal]
        here = bisect_left(layers, True, key=lambda layer: self._holds(layer.states, now))
        found = (one for one in layers[here].waiting if self._holds(one, now))
        return here, next(found, self._manager.false)

    def _nearest(self, possible: Node, inputs: Bits, goal: int) -> tuple[int, Node]:
        """The first layer that some answer leads to, and the answers that do."""
        layers = self._solution.layers[goal]

        def reached(place: int) -> Node:
            return possible & self._manager.assign(layers[place].states, inputs)

        places = range(len(layers))
        rank = bisect_left(places, True, key=lambda place: reached(place) != self._manager.false)
        return rank, reached(rank)

    def _chosen(self, answers: Node, inputs: Bits, goal: int) -> State:
        values = dict(inputs) | next(assignments(self._manager, answers, self.outputs))
        return State(tuple(values[bit] for bit in self.bits), self._in_turn(values, goal))

    def _in_turn(self, now: Bits, goal: int) -> int:
        """The first goal from this one on that does not hold now; itself when all hold."""
        count = len(self._goals)
        turns = ((goal + more) % count for more in range(count))
        return next((one for one in turns if not self._holds(self._goals[one], now)), goal)

    def _view(self, state: State) -> _View:
        """What is allowed from here; that of the last state is kept."""
        if self._seen is None or self._seen[0] != state:
            now = self._bits(state)
            asked, owed = (
                tuple(self._manager.assign(node, now) for node in parts)
                for parts in (self._asked, self._owed)
            )
            self._seen = state, _View(asked, owed)
        return self._seen[1]

    def _bits(self, state: State) -> Bits:
        return dict(zip(self.bits, state.code, strict=True))

    def _coded(self, inputs: Mapping[str, Literal]) -> Bits:
        found: dict[str, bool] = {}
        for one in self.symbols.variables.values():
            if one.owner is Owner.ENVIRONMENT:
                found |= self.symbols.code(one.name, inputs[one.name])
        return found

    def _possible(self, parts: Iterable[Node], given: Bits) -> Node:
        return _all(self._manager, (self._manager.assign(part, given) for part in parts))

    def _is_true(self, parts: Iterable[Node], given: Bits) -> bool:
        return all(self._holds(part, given) for part in parts)

    def _holds(self, node: Node, given: Bits) -> bool:
        return self._manager.assign(node, given) == self._manager.true


def assignments(manager: Manager, node: Node, bits: Sequence[str]) -> Iterator[dict[str, bool]]:
    """All values of the bits that make the diagram true, in the order of binary numbers.

    ``bits`` must contain the support.
    """
    waiting: list[tuple[Node, tuple[bool, ...]]] = [(node, ())]
    while waiting:
        left, values = waiting.pop()
        if left == manager.false:
            continue
        if len(values) == len(bits):
            yield dict(zip(bits, values, strict=True))
            continue
        bit = bits[len(values)]
        waiting += ((manager.assign(left, {bit: one}), (*values, one)) for one in (True, False))


def _joined(manager: Manager, turn: Turn) -> tuple[Node, ...]:
    """The parts of a turn, neighbours joined while they stay small."""
    found: list[Node] = []
    for part in turn.parts:
        both = found[-1] & part if found else part
        if found and len(both) <= CLUSTER:
            found[-1] = both
        else:
            found.append(part)
    return tuple(found)


def _all(manager: Manager, parts: Iterable[Node]) -> Node:
    found = manager.true
    for part in parts:
        found = found & part
    return found
