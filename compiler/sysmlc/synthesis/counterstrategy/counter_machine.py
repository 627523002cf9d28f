"""Counter-strategies as machines: each state gives inputs, and goes on by what is answered."""

from collections.abc import Iterable, Iterator, Mapping, Sequence

from msgspec import Struct
from msgspec.structs import replace

from sysmlc.diagnostics import Severity, Sink, rule
from sysmlc.logic.contract import Conjunct, Contract, Owner, Variable
from sysmlc.logic.formula import Literal
from sysmlc.logic.reduction.reduce import reduced
from sysmlc.synthesis.algebra.traces import Trace
from sysmlc.synthesis.bdd.limits import LimitError
from sysmlc.synthesis.bdd.manager import Manager
from sysmlc.synthesis.counterstrategy.environment_strategy import (
    Bits,
    EnvironmentStrategy,
    find_ranks,
)
from sysmlc.synthesis.decision import Options, Place
from sysmlc.synthesis.games.game import Game, make_game
from sysmlc.synthesis.unrealizable.core import is_won, minimal_conflict
from sysmlc.synthesis.unrealizable.explanation import original_conjuncts

Row = tuple[Literal, ...]
"""Values of variables, in their order."""
MAX_MOVES = 50_000
_Key = tuple[tuple[bool, ...] | None, tuple[bool, ...], int]


class State(Struct, frozen=True):
    """The environment gives ``given`` and waits; without moves the system has no answer."""

    given: Row
    moves: Mapping[Row, int]
    """For each answer that the system may give the next state."""


class CounterStrategy(Struct, frozen=True):
    """A machine that makes the system fail; it begins in state 0."""

    inputs: tuple[Variable, ...]
    outputs: tuple[Variable, ...]
    states: tuple[State, ...]
    missed: tuple[Conjunct, ...] = ()
    """What does not all recur where the system always has an answer."""


def build_counterstrategy(
    environment: EnvironmentStrategy, contract: Contract, most: int = MAX_MOVES
) -> CounterStrategy:
    """The counter-strategy as a machine over the variables of a contract; equal states are one.

    ``contract`` is the one as it was written, without history bits. Raises LimitError.
    """
    return _merge_equal_states(_Exploration(environment, contract, most).run())


class _Exploration:
    def __init__(self, environment: EnvironmentStrategy, contract: Contract, most: int) -> None:
        self._environment = environment
        self._symbols = environment.lost.arena.symbols
        self._most = self._left = most
        self._sides = {
            owner: tuple(one for one in contract.variables if one.owner is owner) for owner in Owner
        }
        self._places: dict[_Key, int] = {}
        self._found: list[tuple[Bits | None, Bits, int]] = []

    def run(self) -> CounterStrategy:
        """Follow every answer of the system."""
        self._place(None, self._environment.first, 0)
        states = [
            State(self._row(given, Owner.ENVIRONMENT), dict(self._moves(before, given, fair)))
            for before, given, fair in self._found
        ]
        return CounterStrategy(
            self._sides[Owner.ENVIRONMENT], self._sides[Owner.SYSTEM], tuple(states)
        )

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


def _merge_equal_states(made: CounterStrategy) -> CounterStrategy:
    """The machine with a state for all that give the same inputs, now and after all answers."""
    classes, count = [0] * len(made.states), 0
    while True:
        keys: dict[object, int] = {}
        classes = [keys.setdefault(_state_key(one, classes), len(keys)) for one in made.states]
        if len(keys) == count:
            return _quotient(made, classes)
        count = len(keys)


def _state_key(state: State, classes: Sequence[int]) -> tuple[Row, frozenset[tuple[Row, int]]]:
    return state.given, frozenset((row, classes[place]) for row, place in state.moves.items())


def _quotient(made: CounterStrategy, classes: Sequence[int]) -> CounterStrategy:
    found: dict[int, State] = {}
    for state, class_ in zip(made.states, classes, strict=True):
        moves = {row: classes[place] for row, place in state.moves.items()}
        found.setdefault(class_, replace(state, moves=moves))
    return replace(made, states=tuple(found.values()))


def example_run(found: CounterStrategy) -> Trace:
    """A run in which the system answers so that it lasts; it ends where there is no answer."""
    steps: list[dict[str, Literal]] = []
    seen: dict[int, int] = {}
    left, place = _steps_until_stuck(found), 0
    while place not in seen:
        seen[place] = len(steps)
        state = found.states[place]
        steps.append(_by_name(found.inputs, state.given))
        if not state.moves:
            return Trace(tuple(steps), len(steps))
        answer, place = max(state.moves.items(), key=lambda move: left[move[1]])
        steps[-1] |= _by_name(found.outputs, answer)
    return Trace(tuple(steps), seen[place])


def _steps_until_stuck(found: CounterStrategy) -> list[int]:
    """For each state the most steps until there is no answer; many when that can be put off."""
    many = len(found.states)
    left = [many if one.moves else 0 for one in found.states]
    for _ in range(many):
        for place, state in enumerate(found.states):
            if state.moves:
                left[place] = min(many, 1 + max(left[other] for other in state.moves.values()))
    return left


def _by_name(variables: Sequence[Variable], row: Row) -> dict[str, Literal]:
    return {one.name: value for one, value in zip(variables, row, strict=True)}


NO_COUNTER = rule(
    "SM549",
    "counter-strategy-not-written",
    Severity.WARNING,
    "what defeats the contract of '{component}' is not written: {reached}",
    help="give more (--time-limit, --memory-limit, --nodes), or play against it (--play)",
)


def find_counterstrategies(
    contracts: Iterable[Contract], place: Place, sink: Sink, options: Options
) -> Iterator[tuple[CounterStrategy, Contract]]:
    """The counter-strategy of each contract, all of which cannot be kept.

    Of one that is too large nothing is made, and that is reported (SM549).
    """
    for contract in contracts:
        try:
            yield _find_counterstrategy(contract, options), contract
        except LimitError as problem:
            subject, reached = place(contract.origin), str(problem)
            sink.report(NO_COUNTER, subject, component=contract.component, reached=reached)


def _find_counterstrategy(contract: Contract, options: Options) -> CounterStrategy:
    environment = find_environment_strategy(contract, options)
    goals = (one.conjunct for one in environment.lost.game.goals)
    missed = original_conjuncts((one for one in goals if one is not None), contract)
    with environment.lost.arena.manager.guard():
        return replace(build_counterstrategy(environment, contract), missed=tuple(missed))


def find_environment_strategy(contract: Contract, options: Options) -> EnvironmentStrategy:
    """What the environment does to win, against goals that cannot be met together.

    Other goals would only hide why: it could wait for ever until they are met. Raises NotLostError
    when the contract can be kept, OutsideGr1Error, LimitError.
    """
    manager = Manager(options.engine, options.limits, options.progress)
    game = _keep_conflicting_goals(make_game(reduced(contract).contract, manager))
    with manager.guard():
        return EnvironmentStrategy(find_ranks(game))


def _keep_conflicting_goals(game: Game) -> Game:
    if not game.goals or is_won(game):
        return game
    found = minimal_conflict(game.goals, lambda some: not is_won(replace(game, goals=tuple(some))))
    return replace(game, goals=found)
