"""The two forms of a controller: Mealy machines, and tables of decision nodes.

In every step a Mealy machine takes the first move of its state whose condition holds. Conditions
are formulas: a primed variable is an input of this step, an unprimed one is a register, which holds
the variable's value in the previous step. State 0 is the state before the first step; its
conditions read no registers. For inputs that the assumptions exclude there need not be a move.

A table contains the functions of a strategy as decision nodes. A node tests one bit and continues
at one of two other nodes; node 0 is false, node 1 is true. The memory of the controller is the
values of all variables in the previous step, and a mode (the current goal). A table is directly
executable. Its size is that of the decision diagrams, which may describe very many states.

The library reorders bits while diagrams grow, at moments that depend on time, but output files must
be reproducible: ``rebuild_in_variable_order`` builds the table again in the order of its variables.
"""

from collections.abc import Iterator, Mapping, Sequence

from msgspec import Struct

from sysmlc.logic import domains
from sysmlc.logic.contract import Variable
from sysmlc.logic.evaluate import is_true, value_of
from sysmlc.logic.formula import Formula, Literal
from sysmlc.synthesis.bdd.limits import LimitError, TooLargeError
from sysmlc.synthesis.bdd.manager import Manager, Node
from sysmlc.synthesis.bdd.symbols import Symbols, width
from sysmlc.synthesis.controllers.strategy import Mode, Strategy

# -- Mealy machines ----------------------------------------------------------------------------


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


# -- tables ------------------------------------------------------------------------------------

MAX_NODES = 1_000_000
"""Nodes above which no table is written."""


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
        before = {
            variable.name: _encode_value(variable, last[variable.name])
            for variable in variables
            if last
        }
        inputs = {
            variable.name: _encode_value(variable, now[variable.name]) for variable in self.inputs
        }
        bits = [bool(self.evaluate(position, before, inputs)) for position in entry.outputs]
        is_next = [bool(self.evaluate(position, before, inputs)) for position in entry.successors]
        return dict(_decode_row(self.outputs, bits)), is_next.index(True) + 1

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


def build_table(strategy: Strategy, max_nodes: int = MAX_NODES) -> Table:
    """Return the table of a strategy. Raises TooLargeError above *max_nodes* nodes."""
    return _TableBuilder(strategy, max_nodes).run()


class _TableBuilder:
    def __init__(self, strategy: Strategy, max_nodes: int) -> None:
        self._strategy, self._manager, self._max_nodes = strategy, strategy.manager, max_nodes
        symbols = strategy.symbols
        self._bits = {
            bit: Bit(name, position, is_before)
            for name in symbols.variables
            for is_before in (True, False)
            for position, bit in enumerate(symbols.bits(name, primed=not is_before))
        }
        self._positions = {self._manager.false: 0, self._manager.true: 1}
        self._bit_indices: dict[str, int] = {}
        self._nodes: list[tuple[int, int, int]] = []

    def run(self) -> Table:
        """Return the table of all functions; shared nodes occur once."""
        strategy = self._strategy
        variables = strategy.symbols.variables
        first, *modes = map(self._build_entry, (strategy.first, *strategy.modes))
        return Table(
            tuple(variables[name] for name in strategy.inputs),
            tuple(variables[name] for name in strategy.outputs),
            tuple(self._bits[bit] for bit in self._bit_indices),
            tuple(self._nodes),
            first,
            tuple(modes),
        )

    def _build_entry(self, mode: Mode) -> Entry:
        bits = self._strategy.symbols.all_bits(self._strategy.outputs)
        outputs = tuple(self._position_of(mode.outputs[bit]) for bit in bits)
        return Entry(outputs, tuple(map(self._position_of, mode.successors)))

    def _position_of(self, node: Node) -> int:
        """Return the position of a diagram; its missing nodes are added, lower nodes first."""
        # No recursion: a diagram has as many levels as the contract has bits, often hundreds.
        stack = [node]
        while stack:
            diagram = stack[-1]
            if diagram in self._positions:
                stack.pop()
                continue
            bit, low, high = self._manager.branches(diagram)
            missing = [child for child in (low, high) if child not in self._positions]
            stack += missing
            if not missing:
                self._add_node(diagram, bit, self._positions[low], self._positions[high])
        return self._positions[node]

    def _add_node(self, node: Node, bit: str, low: int, high: int) -> None:
        if len(self._nodes) >= self._max_nodes:
            raise TooLargeError.of_number(self._max_nodes, "node", "of the controller")
        bit_index = self._bit_indices.setdefault(bit, len(self._bit_indices))
        self._nodes.append((bit_index, low, high))
        self._positions[node] = len(self._nodes) + 1
        self._manager.check("writing the controller")


def _encode_value(variable: Variable, value: Literal) -> tuple[bool, ...]:
    """Return the bits of a value of a variable, the most significant one first."""
    index = domains.values(variable.domain).index(value)
    return tuple(bool(index >> position & 1) for position in reversed(range(width(variable))))


def _decode_row(
    variables: Sequence[Variable], bits: Sequence[bool]
) -> Iterator[tuple[str, Literal]]:
    """Yield names and values of variables whose bits follow one another in *bits*."""
    position = 0
    for variable in variables:
        own_bits = bits[position : position + width(variable)]
        number = sum(bit << bit_position for bit_position, bit in enumerate(reversed(own_bits)))
        yield variable.name, domains.values(variable.domain)[number]
        position += width(variable)


def rebuild_in_variable_order(table: Table, manager: Manager) -> Table:
    """Return an equivalent table whose nodes test bits in the order of the variables.

    The manager must be new. If its limits are exceeded, the table is returned unchanged.
    """
    try:
        with manager.guard(), manager.without_reordering():
            return _Rebuild(table, manager).build()
    except LimitError:
        return table


class _Rebuild:
    def __init__(self, table: Table, manager: Manager) -> None:
        self._table = table
        self._symbols = Symbols(manager, (*table.inputs, *table.outputs))
        self._nodes = table_diagrams(table, self._symbols)

    def build(self) -> Table:
        """Build the table again from the diagrams of its nodes."""
        inputs, outputs = (
            tuple(variable.name for variable in side)
            for side in (self._table.inputs, self._table.outputs)
        )
        modes = tuple(map(self._build_mode, self._table.modes))
        return build_table(
            Strategy(self._symbols, inputs, outputs, self._build_mode(self._table.first), modes)
        )

    def _build_mode(self, entry: Entry) -> Mode:
        bits = self._symbols.all_bits(variable.name for variable in self._table.outputs)
        outputs = {
            bit: self._nodes[position] for bit, position in zip(bits, entry.outputs, strict=True)
        }
        return Mode(outputs, tuple(self._nodes[position] for position in entry.successors))


def table_diagrams(table: Table, symbols: Symbols) -> list[Node]:
    """Return the diagrams of all positions; the first two are false and true."""
    manager = symbols.manager
    diagrams = [manager.false, manager.true]
    for bit, low, high in table.nodes:
        table_bit = table.bits[bit]
        name = symbols.bits(table_bit.variable, primed=not table_bit.is_before)[table_bit.position]
        diagrams.append(manager.ite(manager.var(name), diagrams[high], diagrams[low]))
        manager.check("translating the controller")
    return diagrams
