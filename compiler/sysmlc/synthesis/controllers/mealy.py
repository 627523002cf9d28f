"""Mealy machines with conditions and registers.

In every step the machine takes the first move of its state whose condition holds. Conditions are
formulas: a primed variable is an input of this step, one without a prime a register, which holds
what the variable was in the step before. State 0 is before the first step and knows no registers.
Inputs that the assumptions exclude may have no move.
"""

from collections.abc import Mapping

from msgspec import Struct

from sysmlc.logic.contract import Variable
from sysmlc.logic.evaluate import evaluation, value_of
from sysmlc.logic.formula import Formula, Literal


class Move(Struct, frozen=True):
    """What a machine answers when a condition holds, and where it goes on."""

    when: Formula
    output: tuple[Formula, ...]
    """For each output a literal, or a number that a register gives: ``n``, ``n + 1``, ``n - 1``."""
    state: int


class Machine(Struct, frozen=True):
    """A deterministic machine; ``states[state]`` is what it may do there."""

    inputs: tuple[Variable, ...]
    outputs: tuple[Variable, ...]
    registers: tuple[Variable, ...]
    """Inputs and outputs whose last values conditions and outputs may name."""
    states: tuple[tuple[Move, ...], ...]

    @property
    def size(self) -> int:
        """Number of states, the one before the first step among them."""
        return len(self.states)

    @property
    def count(self) -> int:
        """Number of moves."""
        return sum(map(len, self.states))

    def step(
        self, state: int, last: Mapping[str, Literal], now: Mapping[str, Literal]
    ) -> tuple[dict[str, Literal], int]:
        """The outputs for inputs, and the next state; LookupError if there is no move.

        ``last`` has inputs and outputs of the step before.
        """
        move = self.taken(state, last, now)
        names = (one.name for one in self.outputs)
        values = (value_of(one, last) for one in move.output)
        return dict(zip(names, values, strict=True)), move.state

    def taken(self, state: int, last: Mapping[str, Literal], now: Mapping[str, Literal]) -> Move:
        """The move for these inputs, after a step with these values; LookupError if there is none.

        ``last`` has inputs and outputs of the step before.
        """
        found = (one for one in self.states[state] if evaluation(one.when)(last, now))
        move = next(found, None)
        if move is None:
            raise LookupError(f"state {state} has no move for {dict(now)}")
        return move
