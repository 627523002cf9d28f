"""Strategies of independent games (``games.apart``) as one: each does its own."""

from collections.abc import Iterable, Iterator, Sequence
from itertools import product
from math import prod

from msgspec.structs import replace

from sysmlc.logic.contract import Owner
from sysmlc.synthesis.bdd.groups import tied
from sysmlc.synthesis.bdd.manager import Node
from sysmlc.synthesis.bdd.symbols import Symbols
from sysmlc.synthesis.controllers.strategy import Functions, Mode, Strategy, strategy
from sysmlc.synthesis.games.command_elimination import shifted
from sysmlc.synthesis.games.game import Game, Part
from sysmlc.synthesis.games.solver import solve_arena


def split_game(game: Game) -> tuple[Game, ...]:
    """The games that a game consists of; often it is one."""
    together = [_variables_of(game, node) for node in _all_nodes(game)]
    for name, bits in game.definitions.items():
        together += [frozenset([name, *_variables_of(game, node)]) for node in bits.values()]
    groups = tied(game.symbols.variables, together)
    return (game,) if len(groups) == 1 else tuple(_restrict_game(game, group) for group in groups)


def _all_nodes(game: Game) -> Iterator[Node]:
    for parts in (
        game.init_assumptions,
        game.init_guarantees,
        game.assumptions,
        game.guarantees,
        game.fairness,
        game.goals,
    ):
        yield from (part.node for part in parts)


def _variables_of(game: Game, node: Node) -> frozenset[str]:
    return frozenset((*game.symbols.names(node), *game.symbols.names(node, primed=True)))


def _restrict_game(game: Game, names: frozenset[str]) -> Game:
    """What is said of some variables; what is said of none (true, false) is said in each game."""

    def of(parts: Iterable[Part]) -> tuple[Part, ...]:
        return tuple(part for part in parts if _variables_of(game, part.node) <= names)

    return replace(
        game,
        symbols=game.symbols.only(names),
        init_assumptions=of(game.init_assumptions),
        init_guarantees=of(game.init_guarantees),
        assumptions=of(game.assumptions),
        guarantees=of(game.guarantees),
        fairness=of(game.fairness),
        goals=of(game.goals),
        definitions={name: bits for name, bits in game.definitions.items() if name in names},
    )


MAX_MODES = 16
"""Modes of all strategies together, beyond which the game is better played as a whole."""


def combine_independent_strategies(game: Game) -> Strategy | None:
    """The strategy of a game that consists of several; None where one is lost, or there is one."""
    games = split_game(game)
    if len(games) == 1 or prod(max(1, len(one.goals)) for one in games) > MAX_MODES:
        return None
    plans = list[Strategy]()
    for one in games:
        solution = solve_arena(shifted(one))
        if not solution.is_realizable:
            return None
        plans.append(strategy(one, solution))
    return (
        _combine_strategies(plans, game.symbols)
        if prod(len(one.modes) for one in plans) <= MAX_MODES
        else None
    )


def _combine_strategies(plans: Sequence[Strategy], symbols: Symbols) -> Strategy:
    sides = {
        owner: tuple(one.name for one in symbols.variables.values() if one.owner is owner)
        for owner in Owner
    }
    first = _combine_modes([one.first for one in plans], symbols)
    modes = tuple(
        _combine_modes(modes, symbols) for modes in product(*(one.modes for one in plans))
    )
    return Strategy(symbols, sides[Owner.ENVIRONMENT], sides[Owner.SYSTEM], first, modes)


def _combine_modes(modes: Sequence[Mode], symbols: Symbols) -> Mode:
    outputs: dict[str, Node] = {}
    for mode in modes:
        outputs |= mode.outputs
    return Mode(_order_outputs(outputs, symbols), tuple(_combine_successors(modes, symbols)))


def _combine_successors(modes: Sequence[Mode], symbols: Symbols) -> list[Node]:
    """For each combination of next modes whether it is the next one."""
    found = list[Node]()
    for ways in product(*(mode.onward for mode in modes)):
        node = symbols.manager.true
        for way in ways:
            node = node & way
        found.append(node)
    return found


def _order_outputs(outputs: Functions, symbols: Symbols) -> Functions:
    return {bit: outputs[bit] for bit in symbols.owned(Owner.SYSTEM)}
