"""Machines of counter-strategies (``controllers.counter_strategy``), and example runs of them."""

from collections.abc import Iterable, Iterator

from msgspec.structs import replace

from sysmlc.controllers.counter_strategy import CounterStrategy, Row, State
from sysmlc.diagnostics import Severity, Sink, rule
from sysmlc.logic.contract import Contract, Owner
from sysmlc.logic.formula import Literal
from sysmlc.logic.quantities import choose_numbers
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
from sysmlc.synthesis.unrealizable import find_minimal_conflict, find_original_conjuncts, is_won

MAX_MOVES = 50_000
"""Answers of the system that are explored."""
_Key = tuple[tuple[bool, ...] | None, tuple[bool, ...], int]
"""Values of the previous step (None in the first step), inputs, index of a fairness assumption."""


def build_counterstrategy(
    environment: EnvironmentStrategy, contract: Contract, max_moves: int = MAX_MOVES
) -> CounterStrategy:
    """Build the machine of a strategy over the variables of a contract; equal states are merged.

    *contract* is the original contract, without history bits. Raises LimitError.
    """
    return _merge_equal_states(_Exploration(environment, contract, max_moves).run())


class _Exploration:
    """Explores a strategy of the environment against all answers of the system."""

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
        self._state_indices: dict[_Key, int] = {}
        self._unexplored_states: list[tuple[Bits | None, Bits, int]] = []

    def run(self) -> CounterStrategy:
        """Return the machine, with one state for each reachable combination of ``_Key``."""
        self._index_state(None, self._environment.first, 0)
        # The list grows while it is traversed: `_index_state` appends the states that moves reach.
        states = [
            State(
                self._values_of(inputs, Owner.ENVIRONMENT),
                dict(self._iter_moves(state_before, inputs, fair)),
            )
            for state_before, inputs, fair in self._unexplored_states
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
                self._index_state(state, next_inputs, next_fairness),
            )

    def _index_state(self, state: Bits | None, inputs: Bits, fair: int) -> int:
        """Return the index of a state of the machine; a new state is added."""
        state_key = None if state is None else tuple(state.values())
        key = (state_key, tuple(inputs.values()), fair)
        if key not in self._state_indices:
            self._state_indices[key] = len(self._unexplored_states)
            self._unexplored_states.append((state, inputs, fair))
        return self._state_indices[key]

    def _count(self) -> None:
        self._moves_left -= 1
        self._symbols.manager.check("listing the moves of the environment")
        if self._moves_left < 0:
            raise LimitError.of_number(self._max_moves, "answer", "of the system")

    def _values_of(self, bits: Bits, owner: Owner) -> Row:
        values = self._symbols.decode(bits)
        return tuple(values[variable.name] for variable in self._sides[owner])


def _merge_equal_states(machine: CounterStrategy) -> CounterStrategy:
    """Merge states from which equal sequences of answers always lead to equal inputs."""
    # Partition refinement (Moore): split classes until all states of a class have equal keys.
    classes, count = [0] * len(machine.states), 0
    while True:
        # The moves between classes are the keys, and the states of the quotient.
        merged = [
            State(state.inputs, {row: classes[successor] for row, successor in state.moves.items()})
            for state in machine.states
        ]
        numbers: dict[object, int] = {}
        refined = [
            numbers.setdefault((state.inputs, frozenset(state.moves.items())), len(numbers))
            for state in merged
        ]
        if len(numbers) == count:
            representatives = dict(zip(reversed(classes), reversed(merged), strict=True))
            states = tuple(representatives[class_] for class_ in range(count))
            return replace(machine, states=states)
        classes, count = refined, len(numbers)


def example_run(machine: CounterStrategy) -> Trace:
    """Return a run with the answers that let the system survive longest.

    The run ends in a state without answers, or with a loop.
    """
    steps: list[dict[str, Literal]] = []
    first_steps: dict[int, int] = {}
    steps_left, state = _steps_until_stuck(machine), 0
    while state not in first_steps:
        first_steps[state] = len(steps)
        steps.append(machine.inputs_in(state))
        moves = machine.states[state].moves
        if not moves:
            return _make_trace(machine, steps, len(steps))
        answer, state = max(moves.items(), key=lambda move: steps_left[move[1]])
        names = (variable.name for variable in machine.outputs)
        steps[-1] |= zip(names, answer, strict=True)
    return _make_trace(machine, steps, first_steps[state])


def _make_trace(machine: CounterStrategy, steps: list[dict[str, Literal]], loop: int) -> Trace:
    numbers = choose_numbers((*machine.inputs, *machine.outputs), steps)
    return Trace(tuple(steps), loop, numbers=numbers)


def _steps_until_stuck(machine: CounterStrategy) -> list[int]:
    """Return for each state the largest number of steps until the system has no answer.

    If the system can answer forever, that is the number of states.
    """
    unlimited = len(machine.states)
    steps_left = [unlimited if state.moves else 0 for state in machine.states]
    for _ in range(unlimited):
        for index, state in enumerate(machine.states):
            if state.moves:
                steps_left[index] = min(
                    unlimited, 1 + max(steps_left[successor] for successor in state.moves.values())
                )
    return steps_left


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
    """Yield the counter-strategies of *contracts*, which must be unrealizable.

    A counter-strategy that exceeds a limit is reported (SM549) and omitted.
    """
    for contract in contracts:
        try:
            environment = find_environment_strategy(contract, options)
            goals = (goal.conjunct for goal in environment.lost_game.game.goals)
            unmet = find_original_conjuncts((goal for goal in goals if goal is not None), contract)
            with environment.lost_game.arena.manager.guard():
                machine = build_counterstrategy(environment, contract)
            yield replace(machine, unmet_guarantees=tuple(unmet)), contract
        except LimitError as problem:
            subject, reached = place(contract.origin), str(problem)
            sink.report(NO_COUNTER, subject, component=contract.component, reached=reached)


def find_environment_strategy(contract: Contract, options: Options) -> EnvironmentStrategy:
    """Return a strategy of the environment against liveness guarantees that are in conflict.

    Raises NotLostError if the contract is realizable, OutsideGr1Error, LimitError.
    """
    manager = Manager(options.engine, options.limits, options.progress)
    game = _keep_conflicting_goals(make_game(reduce_contract(contract).contract, manager))
    with manager.guard():
        return EnvironmentStrategy(find_ranks(game))


def _keep_conflicting_goals(game: Game) -> Game:
    """Return the game with a minimal set of goals that makes the system lose."""
    # With other goals, the environment could wait forever for the system to reach one of these, and
    # the strategy would not show the reason.
    if not game.goals or is_won(game):
        return game
    conflicting = find_minimal_conflict(
        game.goals, lambda goals: not is_won(replace(game, goals=tuple(goals)))
    )
    return replace(game, goals=conflicting)
