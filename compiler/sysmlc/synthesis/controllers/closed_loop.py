"""Controllers as relations over the variables of a contract and one for the controller's state.

What is written is read here anew: conditions and outputs as formulas, tables node by node.
"""

from collections.abc import Iterable, Iterator, Sequence

from msgspec import Struct

from sysmlc.logic.contract import Contract, IntegerDomain, Owner, Variable
from sysmlc.logic.formula import Var, eq
from sysmlc.synthesis.bdd.manager import Manager, Node
from sysmlc.synthesis.bdd.symbols import Symbols, next_bit
from sysmlc.synthesis.controllers.mealy import Machine, Move
from sysmlc.synthesis.controllers.table import Entry, Table, nodes_of
from sysmlc.synthesis.games.arena import in_range

Controller = Machine | Table


class Relation(Struct, frozen=True):
    """What a controller does, as conjunctions."""

    first: tuple[Node, ...]
    """Over the first step and the state after it."""
    later: tuple[Node, ...]
    """Over a step and the state after it, and the next step and the state after that."""


def memory(controller: Controller, contract: Contract) -> Variable:
    """A variable for the state of a controller, with a name that the contract does not have."""
    name = "state"
    while any(one.name == name for one in contract.variables):
        name += "_"
    size = controller.size if isinstance(controller, Machine) else len(controller.modes)
    return Variable(name, Owner.SYSTEM, IntegerDomain(0, size - 1))


def relation(controller: Controller, symbols: Symbols, state: Variable) -> Relation:
    """The relation of a controller whose state is this variable.

    Raises SymbolError when it speaks of what the variables are not.
    """
    if isinstance(controller, Machine):
        found = _of_machine(controller, symbols, state)
    else:
        found = _of_table(controller, symbols, state)
    names = [one.name for one in controller.outputs]
    first = in_range(symbols, names)
    return Relation((*found.first, first), (*found.later, in_range(symbols, names, primed=True)))


def _of_machine(machine: Machine, symbols: Symbols, state: Variable) -> Relation:
    found = symbols.manager.false
    first = symbols.manager.false
    for place, moves in enumerate(machine.states):
        taken = _taken(machine, moves, symbols, state)
        first = first if place else symbols.unprime(taken)
        found = found | (symbols.encode({state.name: place}) & taken)
    return Relation((first,), (found,))


def _taken(machine: Machine, moves: Sequence[Move], symbols: Symbols, state: Variable) -> Node:
    """The moves of a state; of those whose condition holds the first one is taken."""
    found = symbols.manager.false
    left = symbols.manager.true
    for move in moves:
        symbols.manager.check("translating the machine")
        when = symbols.bdd(move.when)
        here = left & when & symbols.encode({state.name: move.state}, primed=True)
        for variable, value in zip(machine.outputs, move.output, strict=True):
            here = here & symbols.bdd(eq(Var(variable.name, primed=True), value))
        found = found | here
        left = left & ~when
    return found


def _of_table(table: Table, symbols: Symbols, state: Variable) -> Relation:
    nodes = nodes_of(table, symbols)
    first = tuple(symbols.unprime(one) for one in _entry(table, table.first, nodes, symbols, state))
    by_mode = [tuple(_entry(table, mode, nodes, symbols, state)) for mode in table.modes]
    later = list[Node]()
    for parts in zip(*by_mode, strict=True):
        found = symbols.manager.true
        for place, part in enumerate(parts):
            found = found & symbols.encode({state.name: place}).implies(part)
        later.append(found)
    return Relation(first, (*later, symbols.domain(state.name)))


def _entry(
    table: Table, entry: Entry, nodes: Sequence[Node], symbols: Symbols, state: Variable
) -> Iterator[Node]:
    """What holds of outputs and the next state."""
    manager = symbols.manager
    bits = symbols.all_bits(one.name for one in table.outputs)
    for bit, place in zip(bits, entry.outputs, strict=True):
        yield manager.var(next_bit(bit)).equiv(nodes[place])
    onward, left = manager.false, manager.true
    for after, place in enumerate(entry.onward):
        here = left & nodes[place]
        onward = onward | (here & symbols.encode({state.name: after}, primed=True))
        left = left & ~nodes[place]
    yield onward


class Closed(Struct, frozen=True):
    """A controller in all environments that keep the assumptions."""

    symbols: Symbols
    starts: Node
    """First steps."""
    allowed: tuple[Node, ...]
    """What is assumed of a step and the next inputs."""
    moves: tuple[Node, ...]
    """What the controller does."""
    fairness: tuple[Node, ...]

    @property
    def manager(self) -> Manager:
        """Owner of all diagrams."""
        return self.symbols.manager

    def about(self, names: frozenset[str]) -> "Closed":
        """What is said of some variables only: all runs are runs of it, too."""
        others = self.symbols.all_bits(name for name in self.symbols.variables if name not in names)
        allowed, moves, fairness = (
            tuple(self.speaking(nodes, names))
            for nodes in (self.allowed, self.moves, self.fairness)
        )
        starts = self.manager.exist(others, self.starts)
        return Closed(self.symbols, starts, allowed, moves, fairness)

    def speaking(self, nodes: Iterable[Node], names: frozenset[str]) -> list[Node]:
        """Those that say something of the variables, or what is true or false of all."""
        said = ((node, self.spoken(node)) for node in nodes)
        return [node for node, spoken in said if not spoken or not spoken.isdisjoint(names)]

    def spoken(self, node: Node) -> frozenset[str]:
        """The variables that something is said of."""
        names = self.symbols.names
        return frozenset((*names(node), *names(node, primed=True)))
