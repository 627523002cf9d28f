"""Counter-strategies as machines: each state gives inputs, and goes on by what is answered."""

from collections.abc import Iterator, Mapping, Sequence

from msgspec import Struct
from msgspec.structs import replace

from sysmlc.logic.contract import Conjunct, Contract, Owner, Variable
from sysmlc.logic.formula import Literal
from sysmlc.synthesis.algebra.traces import Trace
from sysmlc.synthesis.bdd.limits import LimitError
from sysmlc.synthesis.counter.environment import Bits, Environment

Row = tuple[Literal, ...]
"""Values of variables, in their order."""
MOST_MOVES = 50_000
_Key = tuple[tuple[bool, ...] | None, tuple[bool, ...], int]


class State(Struct, frozen=True):
    """The environment gives ``given`` and waits; without moves the system has no answer."""

    given: Row
    moves: Mapping[Row, int]
    """For each answer that the system may give the next state."""


class Counter(Struct, frozen=True):
    """A machine that makes the system fail; it begins in state 0."""

    inputs: tuple[Variable, ...]
    outputs: tuple[Variable, ...]
    states: tuple[State, ...]
    missed: tuple[Conjunct, ...] = ()
    """What does not all recur where the system always has an answer."""


def counter(environment: Environment, contract: Contract, most: int = MOST_MOVES) -> Counter:
    """The counter-strategy as a machine over the variables of a contract; equal states are one.

    ``contract`` is the one as it was written, without history bits. Raises LimitError.
    """
    return _joined(_Exploration(environment, contract, most).run())


class _Exploration:
    def __init__(self, environment: Environment, contract: Contract, most: int) -> None:
        self._environment = environment
        self._symbols = environment.lost.arena.symbols
        self._most = self._left = most
        self._sides = {
            owner: tuple(one for one in contract.variables if one.owner is owner) for owner in Owner
        }
        self._places: dict[_Key, int] = {}
        self._found: list[tuple[Bits | None, Bits, int]] = []

    def run(self) -> Counter:
        """Follow every answer of the system."""
        self._place(None, self._environment.first, 0)
        states = [
            State(self._row(given, Owner.ENVIRONMENT), dict(self._moves(before, given, fair)))
            for before, given, fair in self._found
        ]
        return Counter(self._sides[Owner.ENVIRONMENT], self._sides[Owner.SYSTEM], tuple(states))

    def _moves(self, before: Bits | None, given: Bits, fair: int) -> Iterator[tuple[Row, int]]:
        for answer in self._environment.answers(before, given):
            self._count()
            state = {**given, **answer}
            after, onward = self._environment.next(state, fair)
            yield self._row(answer, Owner.SYSTEM), self._place(state, after, onward)

    def _place(self, before: Bits | None, given: Bits, fair: int) -> int:
        known = None if before is None else tuple(before.values())
        key = (known, tuple(given.values()), fair)
        if key not in self._places:
            self._places[key] = len(self._found)
            self._found.append((before, given, fair))
        return self._places[key]

    def _count(self) -> None:
        self._left -= 1
        self._symbols.manager.check("listing what the environment does")
        if self._left < 0:
            raise LimitError("answers of the system", f"{self._most:,}")

    def _row(self, bits: Bits, owner: Owner) -> Row:
        values = self._symbols.decode(bits)
        return tuple(values[one.name] for one in self._sides[owner])


def _joined(made: Counter) -> Counter:
    """The machine with a state for all that give the same inputs, now and after all answers."""
    classes, count = [0] * len(made.states), 0
    while True:
        keys: dict[object, int] = {}
        classes = [keys.setdefault(_key(one, classes), len(keys)) for one in made.states]
        if len(keys) == count:
            return _quotient(made, classes)
        count = len(keys)


def _key(state: State, classes: Sequence[int]) -> tuple[Row, frozenset[tuple[Row, int]]]:
    return state.given, frozenset((row, classes[place]) for row, place in state.moves.items())


def _quotient(made: Counter, classes: Sequence[int]) -> Counter:
    found: dict[int, State] = {}
    for state, class_ in zip(made.states, classes, strict=True):
        moves = {row: classes[place] for row, place in state.moves.items()}
        found.setdefault(class_, replace(state, moves=moves))
    return replace(made, states=tuple(found.values()))


def example(found: Counter) -> Trace:
    """A run in which the system answers so that it lasts; it ends where there is no answer."""
    steps: list[dict[str, Literal]] = []
    seen: dict[int, int] = {}
    left, place = _left(found), 0
    while place not in seen:
        seen[place] = len(steps)
        state = found.states[place]
        steps.append(_named(found.inputs, state.given))
        if not state.moves:
            return Trace(tuple(steps), len(steps))
        answer, place = max(state.moves.items(), key=lambda move: left[move[1]])
        steps[-1] |= _named(found.outputs, answer)
    return Trace(tuple(steps), seen[place])


def _left(found: Counter) -> list[int]:
    """For each state the most steps until there is no answer; many when that can be put off."""
    many = len(found.states)
    left = [many if one.moves else 0 for one in found.states]
    for _ in range(many):
        for place, state in enumerate(found.states):
            if state.moves:
                left[place] = min(many, 1 + max(left[other] for other in state.moves.values()))
    return left


def _named(variables: Sequence[Variable], row: Row) -> dict[str, Literal]:
    return {one.name: value for one, value in zip(variables, row, strict=True)}
