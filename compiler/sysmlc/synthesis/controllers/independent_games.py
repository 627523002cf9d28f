"""Games that consist of independent games over disjoint variables, and the combination of their
strategies.

Whoever wins each of the games wins all of them at once. (The converse does not hold: if the
environment cannot go on in one game, it loses the others.)
"""

from collections.abc import Iterable, Iterator, Sequence
from itertools import product
from math import prod

from msgspec.structs import replace

from sysmlc.logic.contract import Owner
from sysmlc.support.disjoint_sets import group_related
from sysmlc.synthesis.bdd.manager import Node
from sysmlc.synthesis.bdd.symbols import Symbols
from sysmlc.synthesis.controllers.strategy import Functions, Mode, Strategy, extract_strategy
from sysmlc.synthesis.games.command_elimination import eliminate_commands
from sysmlc.synthesis.games.game import Constraint, Game
from sysmlc.synthesis.games.solver import solve_arena


def split_game(game: Game) -> tuple[Game, ...]:
    """Return the independent games of which the game consists, often only one."""
    related_names = [_variables_of(game, node) for node in _all_nodes(game)]
    for name, bits in game.definitions.items():
        related_names += [frozenset([name, *_variables_of(game, node)]) for node in bits.values()]
    components = group_related(game.symbols.variables, related_names)
    return (
        (game,)
        if len(components) == 1
        else tuple(_restrict_game(game, component) for component in components)
    )


def _all_nodes(game: Game) -> Iterator[Node]:
    for constraints in (
        game.init_assumptions,
        game.init_guarantees,
        game.assumptions,
        game.guarantees,
        game.fairness,
        game.goals,
    ):
        yield from (constraint.node for constraint in constraints)


def _variables_of(game: Game, node: Node) -> frozenset[str]:
    return frozenset((*game.symbols.names(node), *game.symbols.names(node, primed=True)))


def _restrict_game(game: Game, names: frozenset[str]) -> Game:
    """Return the game over some variables; constraints over no variable belong to every game."""

    def keep_constraints(constraints: Iterable[Constraint]) -> tuple[Constraint, ...]:
        return tuple(
            constraint
            for constraint in constraints
            if _variables_of(game, constraint.node) <= names
        )

    return replace(
        game,
        symbols=game.symbols.only(names),
        init_assumptions=keep_constraints(game.init_assumptions),
        init_guarantees=keep_constraints(game.init_guarantees),
        assumptions=keep_constraints(game.assumptions),
        guarantees=keep_constraints(game.guarantees),
        fairness=keep_constraints(game.fairness),
        goals=keep_constraints(game.goals),
        definitions={name: bits for name, bits in game.definitions.items() if name in names},
    )


MAX_MODES = 16
"""Modes of the combined strategy above which the game is solved as a whole."""


def combine_independent_strategies(game: Game) -> Strategy | None:
    """Return the combined strategy of several games; None if there is one game or one is lost."""
    games = split_game(game)
    if len(games) == 1 or prod(max(1, len(part.goals)) for part in games) > MAX_MODES:
        return None
    strategies = list[Strategy]()
    for part in games:
        solution = solve_arena(eliminate_commands(part))
        if not solution.is_realizable:
            return None
        strategies.append(extract_strategy(part, solution))
    return (
        _combine_strategies(strategies, game.symbols)
        if prod(len(part.modes) for part in strategies) <= MAX_MODES
        else None
    )


def _combine_strategies(strategies: Sequence[Strategy], symbols: Symbols) -> Strategy:
    sides = {
        owner: tuple(
            variable.name for variable in symbols.variables.values() if variable.owner is owner
        )
        for owner in Owner
    }
    first = _combine_modes([variable.first for variable in strategies], symbols)
    modes = tuple(
        _combine_modes(modes, symbols)
        for modes in product(*(variable.modes for variable in strategies))
    )
    return Strategy(symbols, sides[Owner.ENVIRONMENT], sides[Owner.SYSTEM], first, modes)


def _combine_modes(modes: Sequence[Mode], symbols: Symbols) -> Mode:
    outputs: dict[str, Node] = {}
    for mode in modes:
        outputs |= mode.outputs
    return Mode(_order_outputs(outputs, symbols), tuple(_combine_successors(modes, symbols)))


def _combine_successors(modes: Sequence[Mode], symbols: Symbols) -> list[Node]:
    """Return for each combination of modes the condition under which it is the next one."""
    combined = list[Node]()
    for conditions in product(*(mode.successors for mode in modes)):
        node = symbols.manager.true
        for condition in conditions:
            node = node & condition
        combined.append(node)
    return combined


def _order_outputs(outputs: Functions, symbols: Symbols) -> Functions:
    return {bit: outputs[bit] for bit in symbols.bits_of_owner(Owner.SYSTEM)}
