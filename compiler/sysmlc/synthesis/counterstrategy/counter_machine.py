"""Counter-strategies as machines: each state gives inputs, and its moves depend on the answer."""

from collections.abc import Iterable, Iterator, Mapping, Sequence

from msgspec import Struct
from msgspec.structs import replace

from sysmlc.diagnostics import Severity, Sink, rule
from sysmlc.logic.contract import Conjunct, Contract, Owner, Variable
from sysmlc.logic.formula import Literal
from sysmlc.logic.reduction.contract_reduction import reduce_contract
from sysmlc.synthesis.algebra.fair_systems import Trace
from sysmlc.synthesis.bdd.limits import LimitError
from sysmlc.synthesis.bdd.manager import Manager
from sysmlc.synthesis.counterstrategy.environment_strategy import (
    Bits,
    EnvironmentStrategy,
    find_ranks,
)
from sysmlc.synthesis.decision import Options, Place
from sysmlc.synthesis.games.game import Game, make_game
from sysmlc.synthesis.unrealizable import is_won, minimal_conflict, original_conjuncts

Row = tuple[Literal, ...]
"""Values of variables, in their order."""
MAX_MOVES = 50_000
_Key = tuple[tuple[bool, ...] | None, tuple[bool, ...], int]


class State(Struct, frozen=True):
    """The environment gives *given* and waits; without moves the system has no answer."""

    given: Row
    moves: Mapping[Row, int]
    """The next state for each answer that the system may give."""


class CounterStrategy(Struct, frozen=True):
    """A machine that makes the system fail; it starts in state 0."""

    inputs: tuple[Variable, ...]
    outputs: tuple[Variable, ...]
    states: tuple[State, ...]
    missed: tuple[Conjunct, ...] = ()
    """Liveness guarantees that do not all recur, if the system always has an answer."""


def build_counterstrategy(
    environment: EnvironmentStrategy, contract: Contract, max_moves: int = MAX_MOVES
) -> CounterStrategy:
    """Build the machine over the variables of a contract, with equal states merged.

    *contract* is the one as it was written, without history bits. Raises LimitError.
    """
    return _merge_equal_states(_Exploration(environment, contract, max_moves).run())


class _Exploration:
    def __init__(
        self, environment: EnvironmentStrategy, contract: Contract, max_moves: int
    ) -> None:
        self._environment = environment
        self._symbols = environment.lost_game.arena.symbols
        self._max_moves = self._moves_left = max_moves
        self._sides = {
            owner: tuple(variable for variable in contract.variables if variable.owner is owner)
            for owner in Owner
        }
        self._places: dict[_Key, int] = {}
        self._situations: list[tuple[Bits | None, Bits, int]] = []

    def run(self) -> CounterStrategy:
        """Explore every answer of the system."""
        self._place_of(None, self._environment.first, 0)
        states = [
            State(
                self._values_of(inputs, Owner.ENVIRONMENT),
                dict(self._iter_moves(state_before, inputs, fair)),
            )
            for state_before, inputs, fair in self._situations
        ]
        return CounterStrategy(
            self._sides[Owner.ENVIRONMENT], self._sides[Owner.SYSTEM], tuple(states)
        )

    def _iter_moves(
        self, state_before: Bits | None, inputs: Bits, fair: int
    ) -> Iterator[tuple[Row, int]]:
        for answer in self._environment.iter_answers(state_before, inputs):
            self._count()
            state = {**inputs, **answer}
            next_inputs, next_fairness = self._environment.next_inputs(state, fair)
            yield (
                self._values_of(answer, Owner.SYSTEM),
                self._place_of(state, next_inputs, next_fairness),
            )

    def _place_of(self, state: Bits | None, inputs: Bits, fair: int) -> int:
        state_key = None if state is None else tuple(state.values())
        key = (state_key, tuple(inputs.values()), fair)
        if key not in self._places:
            self._places[key] = len(self._situations)
            self._situations.append((state, inputs, fair))
        return self._places[key]

    def _count(self) -> None:
        self._moves_left -= 1
        self._symbols.manager.check("listing what the environment does")
        if self._moves_left < 0:
            raise LimitError("answers of the system", f"{self._max_moves:,}")

    def _values_of(self, bits: Bits, owner: Owner) -> Row:
        values = self._symbols.decode(bits)
        return tuple(values[variable.name] for variable in self._sides[owner])


def _merge_equal_states(machine: CounterStrategy) -> CounterStrategy:
    """Merge the states with the same inputs now and after all sequences of answers."""
    classes, count = [0] * len(machine.states), 0
    while True:
        keys: dict[object, int] = {}
        classes = [
            keys.setdefault(_state_key(state, classes), len(keys)) for state in machine.states
        ]
        if len(keys) == count:
            return _quotient(machine, classes)
        count = len(keys)


def _state_key(state: State, classes: Sequence[int]) -> tuple[Row, frozenset[tuple[Row, int]]]:
    return state.given, frozenset((row, classes[place]) for row, place in state.moves.items())


def _quotient(machine: CounterStrategy, classes: Sequence[int]) -> CounterStrategy:
    representatives: dict[int, State] = {}
    for state, class_ in zip(machine.states, classes, strict=True):
        moves = {row: classes[place] for row, place in state.moves.items()}
        representatives.setdefault(class_, replace(state, moves=moves))
    return replace(machine, states=tuple(representatives.values()))


def example_run(machine: CounterStrategy) -> Trace:
    """Return a run in which the system survives as long as possible; it ends where there is no
    answer.
    """
    steps: list[dict[str, Literal]] = []
    first_steps: dict[int, int] = {}
    steps_left, place = _steps_until_stuck(machine), 0
    while place not in first_steps:
        first_steps[place] = len(steps)
        state = machine.states[place]
        steps.append(_by_name(machine.inputs, state.given))
        if not state.moves:
            return Trace(tuple(steps), len(steps))
        answer, place = max(state.moves.items(), key=lambda move: steps_left[move[1]])
        steps[-1] |= _by_name(machine.outputs, answer)
    return Trace(tuple(steps), first_steps[place])


def _steps_until_stuck(machine: CounterStrategy) -> list[int]:
    """Return for each state the most steps until there is no answer; the number of states if
    unlimited.
    """
    unlimited = len(machine.states)
    steps_left = [unlimited if state.moves else 0 for state in machine.states]
    for _ in range(unlimited):
        for place, state in enumerate(machine.states):
            if state.moves:
                steps_left[place] = min(
                    unlimited, 1 + max(steps_left[successor] for successor in state.moves.values())
                )
    return steps_left


def _by_name(variables: Sequence[Variable], row: Row) -> dict[str, Literal]:
    return {variable.name: value for variable, value in zip(variables, row, strict=True)}


NO_COUNTER = rule(
    "SM549",
    "counter-strategy-not-written",
    Severity.WARNING,
    "the counter-strategy for '{component}' is not written: {reached}",
    help="raise a limit (--time-limit, --memory-limit, --nodes), or play against it (--play)",
)


def find_counterstrategies(
    contracts: Iterable[Contract], place: Place, sink: Sink, options: Options
) -> Iterator[tuple[CounterStrategy, Contract]]:
    """Yield the counter-strategy of each contract, none of which is realizable.

    A counter-strategy that exceeds a limit is reported (SM549) and omitted.
    """
    for contract in contracts:
        try:
            yield _find_counterstrategy(contract, options), contract
        except LimitError as problem:
            subject, reached = place(contract.origin), str(problem)
            sink.report(NO_COUNTER, subject, component=contract.component, reached=reached)


def _find_counterstrategy(contract: Contract, options: Options) -> CounterStrategy:
    environment = find_environment_strategy(contract, options)
    goals = (goal.conjunct for goal in environment.lost_game.game.goals)
    missed = original_conjuncts((goal for goal in goals if goal is not None), contract)
    with environment.lost_game.arena.manager.guard():
        return replace(build_counterstrategy(environment, contract), missed=tuple(missed))


def find_environment_strategy(contract: Contract, options: Options) -> EnvironmentStrategy:
    """Return the strategy of the environment against goals that cannot be reached together.

    Other goals would hide the reason: the environment could wait forever until they are reached.
    Raises NotLostError if the contract is realizable, OutsideGr1Error, LimitError.
    """
    manager = Manager(options.engine, options.limits, options.progress)
    game = _keep_conflicting_goals(make_game(reduce_contract(contract).contract, manager))
    with manager.guard():
        return EnvironmentStrategy(find_ranks(game))


def _keep_conflicting_goals(game: Game) -> Game:
    if not game.goals or is_won(game):
        return game
    conflicting = minimal_conflict(
        game.goals, lambda goals: not is_won(replace(game, goals=tuple(goals)))
    )
    return replace(game, goals=conflicting)
