"""Tables: controllers made of decision nodes.

A table contains the functions of a strategy as decision nodes. A node tests one bit and continues
at one of two other nodes; node 0 is false, node 1 is true. The memory of the controller is the
values of all variables in the previous step, and a mode (the current goal). A table is directly
executable. Its size is that of the decision diagrams, which may describe very many states.
"""

from collections.abc import Mapping, Sequence
from itertools import islice

from msgspec import Struct

from sysmlc.logic import domains
from sysmlc.logic.contract import Variable
from sysmlc.logic.formula import Literal


class Bit(Struct, frozen=True):
    """One bit of the code of a variable, in this step or the previous one."""

    variable: str
    position: int
    """The position of the bit in the code; 0 is the most significant bit."""
    is_before: bool
    """Whether it is the value in the previous step."""


class Entry(Struct, frozen=True):
    """The behaviour in one mode; functions are given by the positions of their nodes."""

    outputs: tuple[int, ...]
    """The function of each bit of the outputs."""
    successors: tuple[int, ...]
    """For each mode, the condition under which it is next; exactly one of them is true."""


class Table(Struct, frozen=True):
    """A deterministic controller made of decision nodes."""

    inputs: tuple[Variable, ...]
    outputs: tuple[Variable, ...]
    bits: tuple[Bit, ...]
    nodes: tuple[tuple[int, int, int], ...]
    """For each node the index of the tested bit, the position to continue at if it is false, and
    the position if it is true. Positions 0 and 1 are false and true; the node at index i has the
    position i + 2. Nodes continue at smaller positions only."""
    first: Entry
    """The behaviour in the first step."""
    modes: tuple[Entry, ...]

    def step(
        self, state: int, last: Mapping[str, Literal], now: Mapping[str, Literal]
    ) -> tuple[dict[str, Literal], int]:
        """Return the outputs for the inputs *now*, and the next state.

        State 0 is the state before the first step; a later state is the index of a mode plus 1.
        *last* has the inputs and outputs of the previous step.
        """
        entry = self.modes[state - 1] if state else self.first
        variables = (*self.inputs, *self.outputs)
        before = {v.name: domains.encode(v.domain, last[v.name]) for v in variables if last}
        inputs = {v.name: domains.encode(v.domain, now[v.name]) for v in self.inputs}
        bits = (bool(self.evaluate(position, before, inputs)) for position in entry.outputs)
        outputs = {
            v.name: domains.decode(v.domain, islice(bits, domains.width(v.domain)))
            for v in self.outputs
        }
        is_next = [self.evaluate(position, before, inputs) for position in entry.successors]
        return outputs, is_next.index(1) + 1

    def evaluate(
        self, position: int, last: Mapping[str, Sequence[bool]], now: Mapping[str, Sequence[bool]]
    ) -> int:
        """Return the value, 0 or 1, of the function whose root node is at *position*.

        *last* and *now* contain the bits of the variables in the previous step and in this one.
        """
        while position > 1:
            bit_index, low, high = self.nodes[position - 2]
            bit = self.bits[bit_index]
            values = last if bit.is_before else now
            position = high if values[bit.variable][bit.position] else low
        return position
