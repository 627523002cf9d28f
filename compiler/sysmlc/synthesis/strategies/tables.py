"""Tables of strategies, and the diagrams of tables.

The library reorders bits while diagrams grow, at moments that depend on time, but output files must
be reproducible: ``rebuild_in_variable_order`` builds the table again in the order of its variables.
"""

from sysmlc.controllers.table import Bit, Entry, Table
from sysmlc.logic.contract import Owner
from sysmlc.synthesis.bdd.limits import LimitError, TooLargeError
from sysmlc.synthesis.bdd.manager import Manager, Node
from sysmlc.synthesis.bdd.symbols import Symbols
from sysmlc.synthesis.strategies.strategy import Mode, Strategy

MAX_NODES = 1_000_000
"""Nodes above which no table is written."""


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


def rebuild_in_variable_order(table: Table, manager: Manager) -> Table:
    """Return an equivalent table whose nodes test bits in the order of the variables.

    The manager must be new. If its limits are exceeded, the table is returned unchanged.
    """
    try:
        with manager.guard(), manager.without_reordering():
            symbols = Symbols(manager, (*table.inputs, *table.outputs))
            nodes = table_diagrams(table, symbols)
            bits = symbols.bits_of_owner(Owner.SYSTEM)
            first, *modes = (
                Mode(
                    {bit: nodes[root] for bit, root in zip(bits, entry.outputs, strict=True)},
                    tuple(nodes[root] for root in entry.successors),
                )
                for entry in (table.first, *table.modes)
            )
            return build_table(Strategy(symbols, first, tuple(modes)))
    except LimitError:
        return table


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
