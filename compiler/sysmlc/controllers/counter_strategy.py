"""Counter-strategies: environments that make every system fail, as Moore machines.

A state gives the inputs of a step, and the answer of the system selects the next state. State 0
gives the inputs of the first step.
"""

from collections.abc import Mapping

from msgspec import Struct

from sysmlc.logic.contract import Conjunct, Variable
from sysmlc.logic.formula import Literal

Row = tuple[Literal, ...]
"""Values of variables, in their order."""


class State(Struct, frozen=True):
    """The environment gives ``inputs``; if there are no moves, the system has no answer."""

    inputs: Row
    moves: Mapping[Row, int]
    """The next state for each answer that the system may give."""


class CounterStrategy(Struct, frozen=True):
    """An environment that makes every system fail."""

    inputs: tuple[Variable, ...]
    outputs: tuple[Variable, ...]
    states: tuple[State, ...]
    unmet_guarantees: tuple[Conjunct, ...] = ()
    """Liveness guarantees of which at least one does not recur if the system always answers."""

    def inputs_in(self, state: int) -> dict[str, Literal]:
        """Return the inputs that a state gives."""
        names = (variable.name for variable in self.inputs)
        return dict(zip(names, self.states[state].inputs, strict=True))

    def step(self, state: int, outputs: Mapping[str, Literal]) -> tuple[dict[str, Literal], int]:
        """Return the next inputs and the next state after the answer *outputs* in a state.

        Raises LookupError if the guarantees do not allow the answer.
        """
        next_state = self.states[state].moves[tuple(outputs[item.name] for item in self.outputs)]
        return self.inputs_in(next_state), next_state
