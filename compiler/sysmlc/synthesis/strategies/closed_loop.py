"""Closed loops: a controller together with the environments that satisfy the assumptions.

The controller becomes a relation over the variables of the contract and an additional variable for
its state. It is translated from its final form, independently of its synthesis: the formulas of a
machine, the nodes of a table.
"""

from collections.abc import Iterable, Iterator, Sequence

from msgspec import Struct

from sysmlc.controllers.machine import Machine, Move
from sysmlc.controllers.table import Entry, Table
from sysmlc.logic.contract import Contract, IntegerDomain, Owner, Variable
from sysmlc.logic.formula import Var, eq
from sysmlc.synthesis.bdd.manager import Manager, Node
from sysmlc.synthesis.bdd.symbols import Symbols, next_bit
from sysmlc.synthesis.games.arena import domain_constraint
from sysmlc.synthesis.strategies.tables import table_diagrams

Controller = Machine | Table


class ControllerRelation(Struct, frozen=True):
    """The behaviour of a controller as two conjunctions."""

    first: tuple[Node, ...]
    """The relation of the values in the first step and the state after it."""
    step: tuple[Node, ...]
    """The transition relation. The current state is the one after the current step, the next state
    the one after the next step."""


def state_variable(controller: Controller, contract: Contract) -> Variable:
    """Return a variable for the state of a controller, with a name that the contract lacks."""
    name = "state"
    while any(variable.name == name for variable in contract.variables):
        name += "_"
    size = controller.size if isinstance(controller, Machine) else len(controller.modes)
    return Variable(name, Owner.SYSTEM, IntegerDomain(0, size - 1))


def translate_controller(
    controller: Controller, symbols: Symbols, state: Variable
) -> ControllerRelation:
    """Return the relation of a controller whose state is the variable *state*.

    Raises SymbolError if the controller does not fit the variables.
    """
    if isinstance(controller, Machine):
        relation = _translate_machine(controller, symbols, state)
    else:
        relation = _translate_table(controller, symbols, state)
    names = [variable.name for variable in controller.outputs]
    first = domain_constraint(symbols, names)
    return ControllerRelation(
        (*relation.first, first), (*relation.step, domain_constraint(symbols, names, primed=True))
    )


def _translate_machine(machine: Machine, symbols: Symbols, state: Variable) -> ControllerRelation:
    transitions = symbols.manager.false
    first_step = symbols.manager.false
    for index, moves in enumerate(machine.states):
        moves_taken = _translate_moves(machine, moves, symbols, state)
        first_step = first_step if index else symbols.unprime(moves_taken)
        transitions = transitions | (symbols.encode({state.name: index}) & moves_taken)
    return ControllerRelation((first_step,), (transitions,))


def _translate_moves(
    machine: Machine, moves: Sequence[Move], symbols: Symbols, state: Variable
) -> Node:
    """Return the relation of the moves of one state; the first enabled move is taken."""
    transitions = symbols.manager.false
    remaining = symbols.manager.true
    for move in moves:
        symbols.manager.check("translating the machine")
        condition = symbols.bdd(move.when)
        transition = remaining & condition & symbols.encode({state.name: move.state}, primed=True)
        for variable, value in zip(machine.outputs, move.output, strict=True):
            transition = transition & symbols.bdd(eq(Var(variable.name, primed=True), value))
        transitions = transitions | transition
        remaining = remaining & ~condition
    return transitions


def _translate_table(table: Table, symbols: Symbols, state: Variable) -> ControllerRelation:
    nodes = table_diagrams(table, symbols)
    first = tuple(
        symbols.unprime(condition)
        for condition in _translate_entry(table, table.first, nodes, symbols, state)
    )
    by_mode = [tuple(_translate_entry(table, mode, nodes, symbols, state)) for mode in table.modes]
    later = list[Node]()
    for parts in zip(*by_mode, strict=True):
        later.append(
            symbols.manager.conjoin(
                symbols.encode({state.name: mode_number}).implies(part)
                for mode_number, part in enumerate(parts)
            )
        )
    return ControllerRelation(first, (*later, symbols.domain(state.name)))


def _translate_entry(
    table: Table, entry: Entry, nodes: Sequence[Node], symbols: Symbols, state: Variable
) -> Iterator[Node]:
    """Yield a condition on each output bit of the entry, then one on the next state."""
    manager = symbols.manager
    bits = symbols.all_bits(variable.name for variable in table.outputs)
    for bit, position in zip(bits, entry.outputs, strict=True):
        yield manager.var(next_bit(bit)).equiv(nodes[position])
    next_state, remaining = manager.false, manager.true
    for mode_number, position in enumerate(entry.successors):
        condition = remaining & nodes[position]
        next_state = next_state | (
            condition & symbols.encode({state.name: mode_number}, primed=True)
        )
        remaining = remaining & ~nodes[position]
    yield next_state


class ClosedLoop(Struct, frozen=True):
    """A controller in all environments that satisfy the assumptions."""

    symbols: Symbols
    initial: Node
    """The first steps."""
    assumptions: tuple[Node, ...]
    """The assumptions about a step and the next inputs."""
    transitions: tuple[Node, ...]
    """The transition relation of the controller."""
    fairness: tuple[Node, ...]

    @property
    def manager(self) -> Manager:
        """Owner of all diagrams."""
        return self.symbols.manager

    def project_on(self, names: frozenset[str]) -> "ClosedLoop":
        """Return the closed loop over the variables *names*, with at least the runs of this one."""
        eliminated = self.symbols.all_bits(
            name for name in self.symbols.variables if name not in names
        )
        allowed, moves, fairness = (
            tuple(self.select_about(nodes, names))
            for nodes in (self.assumptions, self.transitions, self.fairness)
        )
        starts = self.manager.exist(eliminated, self.initial)
        return ClosedLoop(self.symbols, starts, allowed, moves, fairness)

    def select_about(self, nodes: Iterable[Node], names: frozenset[str]) -> list[Node]:
        """Return the diagrams that depend on some of the variables, or on no variable at all."""
        variables_by_node = ((node, self.variables_of(node)) for node in nodes)
        return [
            node
            for node, variables in variables_by_node
            if not variables or not variables.isdisjoint(names)
        ]

    def variables_of(self, node: Node) -> frozenset[str]:
        """Return the variables that the diagram depends on, in this or the next step."""
        names = self.symbols.names
        return frozenset((*names(node), *names(node, primed=True)))
