"""Tables whose nodes are in the order of the variables.

The library looks for a better order of bits when diagrams grow, at moments that depend on time.
What is written must not: a table is made again in the order that only the variables decide.
"""

from sysmlc.synthesis.bdd.limits import LimitError
from sysmlc.synthesis.bdd.manager import Manager
from sysmlc.synthesis.bdd.symbols import Symbols
from sysmlc.synthesis.controllers.closed import nodes_of
from sysmlc.synthesis.controllers.strategy import Mode, Strategy
from sysmlc.synthesis.controllers.table import Entry, Table, tabled


def settled(table: Table, manager: Manager) -> Table:
    """The same table in the order of its variables; the manager must be new.

    Where that is beyond the manager's limits the table is what it was.
    """
    try:
        with manager.guard(), manager.calm():
            return _Again(table, manager).table()
    except LimitError:
        return table


class _Again:
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
