"""The memory of a strategy: its reachable contents, and the variables that are counters.

Memory is reachable if some environment that satisfies the assumptions leads to it.
"""

from collections.abc import Iterable, Iterator, Mapping, Sequence

from msgspec import Struct

from sysmlc.logic import domains
from sysmlc.logic.contract import IntegerDomain, Owner
from sysmlc.logic.formula import Apply, Const, Formula, Literal, Op, Var, eq
from sysmlc.synthesis.bdd.manager import Node
from sysmlc.synthesis.bdd.skolem_functions import substitute
from sysmlc.synthesis.bdd.symbols import next_bit
from sysmlc.synthesis.games.relational_product import Product
from sysmlc.synthesis.strategies.strategy import Mode, Strategy

MAX_SET_VALUES = 2
"""Number of constants to which a counter may be set, besides counting."""


class ReachableStrategy(Struct, frozen=True):
    """A strategy with its reachable memory contents."""

    strategy: Strategy
    first: Node
    """The first inputs that the assumptions allow, primed."""
    care_sets: tuple[Node, ...]
    """For each mode, the possible combinations of memory and next inputs."""


def explore_strategy(
    strategy: Strategy, first: Iterable[Node], later: Iterable[Node]
) -> ReachableStrategy:
    """Explore a strategy in all environments that satisfy the assumptions.

    *first* contains the assumptions about inputs of the first step, *later* those about a step and
    the next inputs. Raises LimitError.
    """
    return _Exploration(strategy, tuple(first), tuple(later)).run()


class _Exploration:
    def __init__(
        self, strategy: Strategy, first: tuple[Node, ...], later: tuple[Node, ...]
    ) -> None:
        self.strategy, self.manager, self.symbols = strategy, strategy.manager, strategy.symbols
        self.later = later
        self.allowed = self.manager.conjoin(map(self.symbols.prime, first))
        # The variables whose previous value some function or assumption reads.
        read_nodes = [*later, *_functions_of_modes(strategy)]
        self.names = frozenset[str]().union(*map(self.symbols.names, read_nodes))

    def run(self) -> ReachableStrategy:
        """Compute the reachable memory of all modes as a least fixpoint."""
        strategy, manager = self.strategy, self.manager
        count = len(strategy.modes)
        reached_states = [manager.false] * count
        frontier = self._successors(strategy.first, (), self.allowed)
        while any(node != manager.false for node in frontier):
            reached_states = _unite(reached_states, frontier)
            next_frontier = [manager.false] * count
            for mode, node in zip(strategy.modes, frontier, strict=True):
                if node != manager.false:
                    successors = self._successors(mode, self.later, node)
                    next_frontier = _unite(next_frontier, successors)
            frontier = [
                added & ~reached
                for added, reached in zip(next_frontier, reached_states, strict=True)
            ]
            manager.check("exploring the controller")
        can_continue = Product(manager, self.later, ())
        return ReachableStrategy(
            strategy, self.allowed, tuple(can_continue(node) for node in reached_states)
        )

    def _successors(self, mode: Mode, parts: Sequence[Node], start: Node) -> list[Node]:
        """Return for each next mode the memory contents that one step from *start* leads to."""
        symbols, manager = self.symbols, self.manager
        remembered_bits = frozenset(symbols.all_bits(sorted(self.names), primed=True))
        graph = [
            manager.var(next_name).equiv(node)
            for bit, node in mode.outputs.items()
            if (next_name := next_bit(bit)) in remembered_bits
        ]
        inputs = symbols.all_bits(self.strategy.inputs, primed=True)
        removed_bits = [
            *symbols.all_bits(symbols.variables),
            *(bit for bit in inputs if bit not in remembered_bits),
        ]
        product = Product(manager, [*parts, *graph], removed_bits)
        return [symbols.unprime(product(start & condition)) for condition in mode.successors]


def _unite(left: Iterable[Node], right: Iterable[Node]) -> list[Node]:
    """Return for each mode the states in one of both lists."""
    return [first | second for first, second in zip(left, right, strict=True)]


def _functions_of_modes(strategy: Strategy) -> Iterator[Node]:
    """Yield the functions of all modes: of output bits, and of conditions for the next mode."""
    for mode in strategy.modes:
        yield from mode.outputs.values()
        yield from mode.successors


def choose_registers(reachable: ReachableStrategy) -> tuple[str, ...]:
    """Return the registers: counters, and the integer inputs that some function reads with one."""
    strategy, symbols = reachable.strategy, reachable.strategy.symbols
    read_bits = frozenset[str]().union(
        *map(strategy.manager.support, _functions_of_modes(strategy))
    )
    counters = [
        name
        for name in strategy.outputs
        if _is_number(strategy, name) and not read_bits.isdisjoint(symbols.bits(name))
    ]
    counters = [name for name in counters if _is_counter(reachable, name)]
    counter_bits = frozenset(symbols.all_bits(counters))
    input_registers = {
        name
        for node in _functions_of_modes(strategy)
        if not counter_bits.isdisjoint(strategy.manager.support(node))
        for name in symbols.names(node)
        if symbols.variables[name].owner is Owner.ENVIRONMENT and _is_number(strategy, name)
    }
    return tuple(name for name in symbols.variables if name in counters or name in input_registers)


def _is_number(strategy: Strategy, name: str) -> bool:
    domain = strategy.symbols.variables[name].domain
    return isinstance(domain, IntegerDomain) and domain.high - domain.low > 1


def _is_counter(reachable: ReachableStrategy, name: str) -> bool:
    """Whether an output counts: each step adds or subtracts one, keeps it or resets it.

    It may be reset to ``MAX_SET_VALUES`` different values. An output that is only kept or reset is
    no counter.
    """
    strategy, manager = reachable.strategy, reachable.strategy.manager
    values = domains.values(strategy.symbols.variables[name].domain)
    unchanged, *changes = counter_changes(name)
    is_counting, set_to = False, set[Literal]()
    for mode, care in zip(strategy.modes, reachable.care_sets, strict=True):
        changed = care & ~states_with_value(strategy, mode.outputs, name, unchanged)
        unexplained = changed
        for change in changes:
            unexplained = unexplained & ~states_with_value(strategy, mode.outputs, name, change)
        is_counting = is_counting or unexplained != changed
        if unexplained != manager.false:
            for value in values:
                if (
                    unexplained & states_with_value(strategy, mode.outputs, name, Const(value))
                    != manager.false
                ):
                    set_to.add(value)
                if len(set_to) > MAX_SET_VALUES:
                    return False
    return is_counting


def counter_changes(name: str) -> tuple[Formula, ...]:
    """Return the terms for the next value of a counter: unchanged, plus one, minus one."""
    step = Const(1)
    return Var(name), Apply(Op.ADD, (Var(name), step)), Apply(Op.SUB, (Var(name), step))


def states_with_value(
    strategy: Strategy, outputs: Mapping[str, Node], name: str, value: Formula
) -> Node:
    """Return the condition, over memory and inputs, under which an output equals *value*."""
    equation = strategy.symbols.bdd(eq(Var(name, primed=True), value))
    functions = {next_bit(bit): outputs[bit] for bit in strategy.symbols.bits(name)}
    return substitute(strategy.manager, equation, functions)
