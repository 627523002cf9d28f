"""Mealy machines.

In every step a Mealy machine takes the first move of its state whose condition holds. Conditions
are formulas: a primed variable is an input of this step, an unprimed one is a register, which holds
the variable's value in the previous step. State 0 is the state before the first step; its
conditions read no registers. For inputs that the assumptions exclude there need not be a move.
"""

from collections.abc import Mapping

from msgspec import Struct

from sysmlc.logic.contract import Variable
from sysmlc.logic.evaluate import is_true, value_of
from sysmlc.logic.formula import Formula, Literal


class Move(Struct, frozen=True):
    """Outputs and next state under a condition."""

    when: Formula
    output: tuple[Formula, ...]
    """For each output a literal, or a term over a register: ``n``, ``n + 1`` or ``n - 1``."""
    state: int


class Machine(Struct, frozen=True):
    """A deterministic machine; ``states[state]`` are the moves of a state."""

    inputs: tuple[Variable, ...]
    outputs: tuple[Variable, ...]
    registers: tuple[Variable, ...]
    """Inputs and outputs whose previous values conditions and outputs may read."""
    states: tuple[tuple[Move, ...], ...]

    @property
    def size(self) -> int:
        """Number of states, including the one before the first step."""
        return len(self.states)

    @property
    def count(self) -> int:
        """Number of moves."""
        return sum(map(len, self.states))

    def step(
        self, state: int, last: Mapping[str, Literal], now: Mapping[str, Literal]
    ) -> tuple[dict[str, Literal], int]:
        """Return the outputs for the inputs *now*, and the next state.

        *last* has the inputs and outputs of the previous step. Raises LookupError if there is no
        move.
        """
        move = self.find_move(state, last, now)
        names = (term.name for term in self.outputs)
        values = (value_of(term, last) for term in move.output)
        return dict(zip(names, values, strict=True)), move.state

    def find_move(
        self, state: int, last: Mapping[str, Literal], now: Mapping[str, Literal]
    ) -> Move:
        """Return the move for the inputs *now*.

        *last* has the inputs and outputs of the previous step. Raises LookupError if there is no
        move.
        """
        enabled_moves = (move for move in self.states[state] if is_true(move.when, last, now))
        first_move = next(enabled_moves, None)
        if first_move is None:
            raise LookupError(f"state {state} has no move for {dict(now)}")
        return first_move
