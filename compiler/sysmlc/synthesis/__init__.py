"""Synthesis: contracts in GR(1) as games on decision diagrams (docs/synthesis.md).

``game`` turns a contract into initial conditions and relations, ``solve`` decides the game.
``dd`` is imported when a ``Manager`` is made, not before.
"""

from sysmlc.synthesis.game import Game, OutsideGr1Error, Part, make_game
from sysmlc.synthesis.layers import Layer
from sysmlc.synthesis.manager import LimitError, Limits, Manager, Node
from sysmlc.synthesis.solve import Solution, solve
from sysmlc.synthesis.symbols import SymbolError, Symbols

__all__ = [
    "Game",
    "Layer",
    "LimitError",
    "Limits",
    "Manager",
    "Node",
    "OutsideGr1Error",
    "Part",
    "Solution",
    "SymbolError",
    "Symbols",
    "make_game",
    "solve",
]
