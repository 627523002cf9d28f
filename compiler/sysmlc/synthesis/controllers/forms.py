"""The two forms of a controller: Mealy machines, and tables of decision nodes.

In every step a Mealy machine takes the first move of its state whose condition holds. Conditions
are formulas: a primed variable is an input of this step, an unprimed one is a register, which holds
the variable's value in the previous step. State 0 is before the first step and has no registers.
There may be no move for inputs that the assumptions exclude.

A table is a strategy as decision nodes. A node tests one bit and continues at one of two other
nodes; 0 is false and 1 is true. The controller remembers the values of all variables in the
previous step, and a mode (the goal in turn). A table can be executed as it is, and has the size of
the decision diagrams instead of the size of the states that they describe.

The library reorders bits while diagrams grow, at moments that depend on time, but output files must
be reproducible: ``rebuild_in_variable_order`` builds the table again in the order of its variables.
"""

from collections.abc import Iterator, Mapping, Sequence

from msgspec import Struct

from sysmlc.logic import domains
from sysmlc.logic.contract import Variable
from sysmlc.logic.evaluate import compile_evaluation, value_of
from sysmlc.logic.formula import Formula, Literal
from sysmlc.synthesis.bdd.limits import LimitError, TooLargeError
from sysmlc.synthesis.bdd.manager import Manager, Node
from sysmlc.synthesis.bdd.symbols import Symbols, width
from sysmlc.synthesis.controllers.strategy import Mode, Strategy

# -- Mealy machines ----------------------------------------------------------------------------


class Move(Struct, frozen=True):
    """The answer under a condition, and the next state."""

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
        enabled_moves = (
            move for move in self.states[state] if compile_evaluation(move.when)(last, now)
        )
        first_move = next(enabled_moves, None)
        if first_move is None:
            raise LookupError(f"state {state} has no move for {dict(now)}")
        return first_move


# -- tables ------------------------------------------------------------------------------------

MAX_NODES = 1_000_000


class Bit(Struct, frozen=True):
    """One bit of the code of a variable, in this step or the previous one."""

    variable: str
    place: int
    """0 is the most significant one."""
    is_before: bool


class Entry(Struct, frozen=True):
    """The behaviour in one mode, as positions of nodes."""

    outputs: tuple[int, ...]
    """For each bit of the outputs, in their order."""
    successors: tuple[int, ...]
    """For each mode whether it is the next one; exactly one of them is true."""


class Table(Struct, frozen=True):
    """A deterministic controller made of decision nodes."""

    inputs: tuple[Variable, ...]
    outputs: tuple[Variable, ...]
    bits: tuple[Bit, ...]
    nodes: tuple[tuple[int, int, int], ...]
    """Place of a bit, where to go on when it is false and when it is true: 0 false, 1 true, else
    the place of a node in this list and 2. No node goes on to a later one."""
    first: Entry
    modes: tuple[Entry, ...]

    def step(
        self, state: int, last: Mapping[str, Literal], now: Mapping[str, Literal]
    ) -> tuple[dict[str, Literal], int]:
        """Return the outputs for the inputs *now*, and the next state.

        State 0 is before the first step, then a state is the number of a mode plus 1. *last* has
        the inputs and outputs of the previous step.
        """
        entry = self.modes[state - 1] if state else self.first
        variables = (*self.inputs, *self.outputs)
        before = {
            variable.name: encode_value(variable, last[variable.name])
            for variable in variables
            if last
        }
        given = {
            variable.name: encode_value(variable, now[variable.name]) for variable in self.inputs
        }
        bits = [bool(self.value(place, before, given)) for place in entry.outputs]
        onward = [bool(self.value(place, before, given)) for place in entry.successors]
        return dict(_decode_row(self.outputs, bits)), onward.index(True) + 1

    def value(
        self, place: int, last: Mapping[str, Sequence[bool]], now: Mapping[str, Sequence[bool]]
    ) -> int:
        """What a node comes to, 0 or 1, for the bits of the variables before and in this step."""
        while place > 1:
            bit, low, high = self.nodes[place - 2]
            variable = self.bits[bit]
            values = last if variable.is_before else now
            place = high if values[variable.variable][variable.place] else low
        return place


def build_table(strategy: Strategy, most: int = MAX_NODES) -> Table:
    """Return the table of a strategy. Raises TooLargeError if it has more than *most* nodes."""
    return _TableBuilder(strategy, most).run()


class _TableBuilder:
    def __init__(self, strategy: Strategy, most: int) -> None:
        self._strategy, self._manager, self._max_nodes = strategy, strategy.manager, most
        symbols = strategy.symbols
        self._bits = {
            bit: Bit(name, place, is_before)
            for name in symbols.variables
            for is_before in (True, False)
            for place, bit in enumerate(symbols.bits(name, primed=not is_before))
        }
        self._places = {self._manager.false: 0, self._manager.true: 1}
        self._known: dict[str, int] = {}
        self._nodes: list[tuple[int, int, int]] = []

    def run(self) -> Table:
        """Visit all functions; shared nodes occur once."""
        strategy = self._strategy
        variables = strategy.symbols.variables
        first, *modes = map(self._build_entry, (strategy.first, *strategy.modes))
        return Table(
            tuple(variables[name] for name in strategy.inputs),
            tuple(variables[name] for name in strategy.outputs),
            tuple(self._bits[bit] for bit in self._known),
            tuple(self._nodes),
            first,
            tuple(modes),
        )

    def _build_entry(self, mode: Mode) -> Entry:
        bits = self._strategy.symbols.all_bits(self._strategy.outputs)
        outputs = tuple(self._place_of(mode.outputs[bit]) for bit in bits)
        return Entry(outputs, tuple(map(self._place_of, mode.successors)))

    def _place_of(self, node: Node) -> int:
        """Return the position of a diagram; all nodes below it come before it."""
        # No recursion: a diagram has as many levels as the contract has bits, often hundreds.
        stack = [node]
        while stack:
            diagram = stack[-1]
            if diagram in self._places:
                stack.pop()
                continue
            bit, low, high = self._manager.branches(diagram)
            missing = [below for below in (low, high) if below not in self._places]
            stack += missing
            if not missing:
                self._add_node(diagram, bit, self._places[low], self._places[high])
        return self._places[node]

    def _add_node(self, node: Node, bit: str, low: int, high: int) -> None:
        if len(self._nodes) >= self._max_nodes:
            raise TooLargeError("nodes of the controller", f"{self._max_nodes:,}")
        bit_number = self._known.setdefault(bit, len(self._known))
        self._nodes.append((bit_number, low, high))
        self._places[node] = len(self._nodes) + 1
        self._manager.check("writing the controller")


def encode_value(variable: Variable, value: Literal) -> tuple[bool, ...]:
    """Return the bits of a value of a variable, the most significant one first."""
    index = domains.values(variable.domain).index(value)
    return tuple(bool(index >> position & 1) for position in reversed(range(width(variable))))


def _decode_row(
    variables: Sequence[Variable], bits: Sequence[bool]
) -> Iterator[tuple[str, Literal]]:
    """Bits in one row as the values of variables."""
    position = 0
    for variable in variables:
        own_bits = bits[position : position + width(variable)]
        number = sum(bit << bit_position for bit_position, bit in enumerate(reversed(own_bits)))
        yield variable.name, domains.values(variable.domain)[number]
        position += width(variable)


def rebuild_in_variable_order(table: Table, manager: Manager) -> Table:
    """Return the table in the order of its variables; the manager must be new.

    If that exceeds the manager's limits, the table is returned unchanged.
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
        """Build the table of the diagrams of the old nodes."""
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
        outputs = {bit: self._nodes[place] for bit, place in zip(bits, entry.outputs, strict=True)}
        return Mode(outputs, tuple(self._nodes[place] for place in entry.successors))


def table_diagrams(table: Table, symbols: Symbols) -> list[Node]:
    """Return the diagram of each position; the first two are false and true."""
    manager = symbols.manager
    diagrams = [manager.false, manager.true]
    for bit, low, high in table.nodes:
        table_bit = table.bits[bit]
        name = symbols.bits(table_bit.variable, primed=not table_bit.is_before)[table_bit.place]
        diagrams.append(manager.ite(manager.var(name), diagrams[high], diagrams[low]))
        manager.check("translating the controller")
    return diagrams
