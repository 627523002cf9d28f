"""Strategies of independent games (``games.apart``) as one: each does its own."""

from collections.abc import Sequence
from itertools import product
from math import prod

from sysmlc.logic.contract import Owner
from sysmlc.synthesis.bdd.manager import Node
from sysmlc.synthesis.bdd.symbols import Symbols
from sysmlc.synthesis.controllers.strategy import Functions, Mode, Strategy, strategy
from sysmlc.synthesis.games.apart import independent
from sysmlc.synthesis.games.game import Game
from sysmlc.synthesis.games.shift import shifted
from sysmlc.synthesis.games.solve import solve_arena

MOST_MODES = 16
"""Modes of all strategies together, beyond which the game is better played as a whole."""


def apart(game: Game) -> Strategy | None:
    """The strategy of a game that consists of several; None where one is lost, or there is one."""
    games = independent(game)
    if len(games) == 1 or prod(max(1, len(one.goals)) for one in games) > MOST_MODES:
        return None
    plans = list[Strategy]()
    for one in games:
        solution = solve_arena(shifted(one))
        if not solution.is_realizable:
            return None
        plans.append(strategy(one, solution))
    return (
        _joined(plans, game.symbols)
        if prod(len(one.modes) for one in plans) <= MOST_MODES
        else None
    )


def _joined(plans: Sequence[Strategy], symbols: Symbols) -> Strategy:
    sides = {
        owner: tuple(one.name for one in symbols.variables.values() if one.owner is owner)
        for owner in Owner
    }
    first = _mode([one.first for one in plans], symbols)
    modes = tuple(_mode(modes, symbols) for modes in product(*(one.modes for one in plans)))
    return Strategy(symbols, sides[Owner.ENVIRONMENT], sides[Owner.SYSTEM], first, modes)


def _mode(modes: Sequence[Mode], symbols: Symbols) -> Mode:
    outputs: dict[str, Node] = {}
    for mode in modes:
        outputs |= mode.outputs
    return Mode(_in_order(outputs, symbols), tuple(_onward(modes, symbols)))


def _onward(modes: Sequence[Mode], symbols: Symbols) -> list[Node]:
    """For each combination of next modes whether it is the next one."""
    found = list[Node]()
    for ways in product(*(mode.onward for mode in modes)):
        node = symbols.manager.true
        for way in ways:
            node = node & way
        found.append(node)
    return found


def _in_order(outputs: Functions, symbols: Symbols) -> Functions:
    return {bit: outputs[bit] for bit in symbols.owned(Owner.SYSTEM)}
