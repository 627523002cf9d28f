"""Synthesis: contracts in GR(1) as games on decision diagrams (docs/synthesis.md).

``make_game`` translates a contract into a game, ``solve`` decides the game. ``dd`` is imported when
the first ``Manager`` is created.
"""

from sysmlc.synthesis.bdd.limits import LimitError, Limits
from sysmlc.synthesis.bdd.manager import Manager, Node
from sysmlc.synthesis.bdd.symbols import SymbolError, Symbols
from sysmlc.synthesis.games.game import Constraint, Game, OutsideGr1Error, make_game
from sysmlc.synthesis.games.solver import Layer, Solution, solve

__all__ = [
    "Constraint",
    "Game",
    "Layer",
    "LimitError",
    "Limits",
    "Manager",
    "Node",
    "OutsideGr1Error",
    "Solution",
    "SymbolError",
    "Symbols",
    "make_game",
    "solve",
]
