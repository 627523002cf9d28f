"""The states that a fixpoint has to look at: fewer conditions, or fewer states.

Rules for the present step hold in all winning states, so it begins with them. Codes that stand for
no value are no matter: turns never lead to them. A state set that is cut to the ranges of many
variables, whose bits lie between each other, is large for nothing.
"""

from sysmlc.logic.contract import Owner
from sysmlc.synthesis.bdd.manager import Node
from sysmlc.synthesis.games.arena import Arena

LARGE = 20_000
"""Nodes from which on rules are left where they are."""


def invariant(arena: Arena) -> Node:
    """What the first turn asks of the state that it is played in."""
    found, first = arena.manager.true, arena.turns[0]
    if first.owner is not Owner.SYSTEM:
        return found
    for part in first.parts:
        if arena.manager.support(part).isdisjoint(first.bits) and len(found) < LARGE:
            found = found & part
    return found


def without_ranges(arena: Arena, goal: int, states: Node) -> Node:
    """The states, and with them codes without value of variables that the goal does not name.

    Only of variables of which nothing but the range is asked.
    """
    symbols, manager = arena.symbols, arena.manager
    named = symbols.names(arena.goals[goal]) if arena.goals else ()
    for name in symbols.names(states):
        range_ = symbols.domain(name)
        if range_ == manager.true or name in named:
            continue
        wide = manager.exist(symbols.bits(name), states)
        if wide & range_ == states:
            states = wide
    return states
