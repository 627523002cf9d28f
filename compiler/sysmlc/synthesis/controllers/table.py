"""Symbolic controllers: what is answered as one table of decision nodes, however many states.

A node tests one bit and goes on to one of two others; 0 is false and 1 is true. What is remembered
is what the variables were in the step before, and a mode (the goal in turn). A table can be run as
it stands, and has the size of the decision diagrams, not of what they would list.
"""

from collections.abc import Iterator, Mapping, Sequence

from msgspec import Struct

from sysmlc.logic import domains
from sysmlc.logic.contract import Variable
from sysmlc.logic.formula import Literal
from sysmlc.synthesis.bdd.limits import LimitError, TooLargeError
from sysmlc.synthesis.bdd.manager import Manager, Node
from sysmlc.synthesis.bdd.symbols import Symbols, width
from sysmlc.synthesis.controllers.strategy import Mode, Strategy

MOST_NODES = 1_000_000


class Bit(Struct, frozen=True):
    """One bit of the code of a variable, of this step or of the one before."""

    variable: str
    place: int
    """0 is the most significant one."""
    is_before: bool


class Entry(Struct, frozen=True):
    """What is done in a mode: places of nodes."""

    outputs: tuple[int, ...]
    """For each bit of the outputs, in their order."""
    onward: tuple[int, ...]
    """For each mode whether it is the next one; exactly one is."""


class Table(Struct, frozen=True):
    """A deterministic controller over decision nodes."""

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
        """The outputs for inputs, and the next state: 0 before the first step, then a mode and 1.

        ``last`` has inputs and outputs of the step before.
        """
        entry = self.modes[state - 1] if state else self.first
        variables = (*self.inputs, *self.outputs)
        before = {one.name: coded(one, last[one.name]) for one in variables if last}
        given = {one.name: coded(one, now[one.name]) for one in self.inputs}
        bits = [bool(self.value(place, before, given)) for place in entry.outputs]
        onward = [bool(self.value(place, before, given)) for place in entry.onward]
        return dict(_shared(self.outputs, bits)), onward.index(True) + 1

    def value(
        self, place: int, last: Mapping[str, Sequence[bool]], now: Mapping[str, Sequence[bool]]
    ) -> int:
        """What a node comes to, 0 or 1, for the bits of the variables before and in this step."""
        while place > 1:
            bit, low, high = self.nodes[place - 2]
            one = self.bits[bit]
            values = last if one.is_before else now
            place = high if values[one.variable][one.place] else low
        return place


def tabled(strategy: Strategy, most: int = MOST_NODES) -> Table:
    """The table of a strategy. Raises TooLargeError when it has too many nodes."""
    return _Tabling(strategy, most).run()


class _Tabling:
    def __init__(self, strategy: Strategy, most: int) -> None:
        self._strategy, self._manager, self._most = strategy, strategy.manager, most
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
        """Go through all functions; what they share is there once."""
        strategy = self._strategy
        variables = strategy.symbols.variables
        first, *modes = map(self._entry, (strategy.first, *strategy.modes))
        return Table(
            tuple(variables[name] for name in strategy.inputs),
            tuple(variables[name] for name in strategy.outputs),
            tuple(self._bits[bit] for bit in self._known),
            tuple(self._nodes),
            first,
            tuple(modes),
        )

    def _entry(self, mode: Mode) -> Entry:
        bits = self._strategy.symbols.all_bits(self._strategy.outputs)
        outputs = tuple(self._place(mode.outputs[bit]) for bit in bits)
        return Entry(outputs, tuple(map(self._place, mode.onward)))

    def _place(self, node: Node) -> int:
        """The place of a diagram; all below it have one before."""
        waiting = [node]
        while waiting:
            one = waiting[-1]
            if one in self._places:
                waiting.pop()
                continue
            bit, low, high = self._manager.branches(one)
            missing = [below for below in (low, high) if below not in self._places]
            waiting += missing
            if not missing:
                self._add(one, bit, self._places[low], self._places[high])
        return self._places[node]

    def _add(self, node: Node, bit: str, low: int, high: int) -> None:
        if len(self._nodes) >= self._most:
            raise TooLargeError("nodes of the controller", f"{self._most:,}")
        known = self._known.setdefault(bit, len(self._known))
        self._nodes.append((known, low, high))
        self._places[node] = len(self._nodes) + 1
        self._manager.check("writing the controller")


def coded(variable: Variable, value: Literal) -> tuple[bool, ...]:
    """The bits of a variable for a value, the most significant one first."""
    place = domains.values(variable.domain).index(value)
    return tuple(bool(place >> at & 1) for at in reversed(range(width(variable))))


def _shared(variables: Sequence[Variable], bits: Sequence[bool]) -> Iterator[tuple[str, Literal]]:
    """Bits in one row as the values of variables."""
    place = 0
    for variable in variables:
        own = bits[place : place + width(variable)]
        number = sum(bit << at for at, bit in enumerate(reversed(own)))
        yield variable.name, domains.values(variable.domain)[number]
        place += width(variable)


def rebuild_in_variable_order(table: Table, manager: Manager) -> Table:
    """The same table in the order of its variables; the manager must be new.

    Where that is beyond the manager's limits the table is what it was.
    """
    try:
        with manager.guard(), manager.calm():
            return _Rebuild(table, manager).table()
    except LimitError:
        return table


class _Rebuild:
    def __init__(self, table: Table, manager: Manager) -> None:
        self._table = table
        self._symbols = Symbols(manager, (*table.inputs, *table.outputs))
        self._nodes = nodes_of(table, self._symbols)

    def table(self) -> Table:
        """Functions of the nodes, and a table of them."""
        inputs, outputs = (
            tuple(one.name for one in side) for side in (self._table.inputs, self._table.outputs)
        )
        modes = tuple(map(self._mode, self._table.modes))
        return tabled(
            Strategy(self._symbols, inputs, outputs, self._mode(self._table.first), modes)
        )

    def _mode(self, entry: Entry) -> Mode:
        bits = self._symbols.all_bits(one.name for one in self._table.outputs)
        outputs = {bit: self._nodes[place] for bit, place in zip(bits, entry.outputs, strict=True)}
        return Mode(outputs, tuple(self._nodes[place] for place in entry.onward))


def nodes_of(table: Table, symbols: Symbols) -> list[Node]:
    """The diagram of each place; the first two are false and true."""
    manager = symbols.manager
    found = [manager.false, manager.true]
    for bit, low, high in table.nodes:
        one = table.bits[bit]
        name = symbols.bits(one.variable, primed=not one.is_before)[one.place]
        found.append(manager.ite(manager.var(name), found[high], found[low]))
        manager.check("translating the controller")
    return found
