"""From contracts that cannot be kept to what defeats them."""

from collections.abc import Iterable, Iterator

from msgspec.structs import replace

from sysmlc.diagnostics import Severity, Sink, rule
from sysmlc.logic.contract import Contract
from sysmlc.logic.reduction.reduce import reduced
from sysmlc.synthesis.bdd.limits import LimitError
from sysmlc.synthesis.bdd.manager import Manager
from sysmlc.synthesis.counter.environment import Environment
from sysmlc.synthesis.counter.machine import Counter, counter
from sysmlc.synthesis.counter.ranks import lost
from sysmlc.synthesis.decide import Options, Place
from sysmlc.synthesis.games.game import Game, make_game
from sysmlc.synthesis.unrealizable.core import is_won
from sysmlc.synthesis.unrealizable.explain import conflict
from sysmlc.synthesis.unrealizable.reasons import as_written

NO_COUNTER = rule(
    "SM549",
    "counter-strategy-not-written",
    Severity.WARNING,
    "what defeats the contract of '{component}' is not written: {reached}",
    help="give more (--time-limit, --memory-limit, --nodes), or play against it (--play)",
)


def defeats(
    contracts: Iterable[Contract], place: Place, sink: Sink, options: Options
) -> Iterator[tuple[Counter, Contract]]:
    """The counter-strategy of each contract, all of which cannot be kept.

    Of one that is too large nothing is made, and that is reported (SM549).
    """
    for contract in contracts:
        try:
            yield _counter(contract, options), contract
        except LimitError as problem:
            subject, reached = place(contract.origin), str(problem)
            sink.report(NO_COUNTER, subject, component=contract.component, reached=reached)


def _counter(contract: Contract, options: Options) -> Counter:
    environment = environment_of(contract, options)
    goals = (one.conjunct for one in environment.lost.game.goals)
    missed = as_written((one for one in goals if one is not None), contract)
    with environment.lost.arena.manager.guard():
        return replace(counter(environment, contract), missed=tuple(missed))


def environment_of(contract: Contract, options: Options) -> Environment:
    """What the environment does to win, against goals that cannot be met together.

    Other goals would only hide why: it could wait for ever until they are met. Raises NotLostError
    when the contract can be kept, OutsideGr1Error, LimitError.
    """
    manager = Manager(options.engine, options.limits, options.progress)
    game = _without_needless_goals(make_game(reduced(contract).contract, manager))
    with manager.guard():
        return Environment(lost(game))


def _without_needless_goals(game: Game) -> Game:
    if not game.goals or is_won(game):
        return game
    found = conflict(game.goals, lambda some: not is_won(replace(game, goals=tuple(some))))
    return replace(game, goals=found)
