"""What a strategy remembers: where it can be in environments that keep the assumptions, and which
of the variables count."""

from collections.abc import Iterable, Iterator, Mapping, Sequence

from msgspec import Struct

from sysmlc.logic import domains
from sysmlc.logic.contract import IntegerDomain, Owner
from sysmlc.logic.formula import Apply, Const, Formula, Literal, Op, Var, eq
from sysmlc.synthesis.bdd.manager import Node
from sysmlc.synthesis.bdd.skolem_functions import substituted
from sysmlc.synthesis.bdd.symbols import next_bit
from sysmlc.synthesis.controllers.strategy import Mode, Strategy
from sysmlc.synthesis.games.relational_product import Product

FEW = 2
"""Values that a counter may be set to beside counting."""


class Reached(Struct, frozen=True):
    """A strategy in all environments that keep the assumptions."""

    strategy: Strategy
    first: Node
    """First inputs that are allowed, primed."""
    cares: tuple[Node, ...]
    """For each mode: what the step before may have been, with the next inputs allowed then."""


def reached(strategy: Strategy, first: Iterable[Node], later: Iterable[Node]) -> Reached:
    """Explore a strategy; ``first`` and ``later`` are assumptions, over inputs of the first step
    and over a step and the next inputs. Raises LimitError."""
    return _Exploration(strategy, tuple(first), tuple(later)).run()


class _Exploration:
    def __init__(
        self, strategy: Strategy, first: tuple[Node, ...], later: tuple[Node, ...]
    ) -> None:
        self.strategy, self.manager, self.symbols = strategy, strategy.manager, strategy.symbols
        self.later = later
        self.allowed = self.manager.true
        for node in first:
            self.allowed = self.allowed & self.symbols.prime(node)
        self.names = self._remembered()

    def run(self) -> Reached:
        """Follow the first step, then all modes, until nothing new is found."""
        strategy, manager = self.strategy, self.manager
        count = len(strategy.modes)
        known = [manager.false] * count
        fresh = self._following(strategy.first, (), self.allowed)
        while any(node != manager.false for node in fresh):
            known = [old | new for old, new in zip(known, fresh, strict=True)]
            found = [manager.false] * count
            for mode, node in zip(strategy.modes, fresh, strict=True):
                if node != manager.false:
                    after = self._following(mode, self.later, node)
                    found = [old | new for old, new in zip(found, after, strict=True)]
            fresh = [new & ~old for new, old in zip(found, known, strict=True)]
            manager.check("exploring the controller")
        going_on = Product(manager, self.later, ())
        return Reached(strategy, self.allowed, tuple(going_on(node) for node in known))

    def _remembered(self) -> frozenset[str]:
        """Variables whose last value something depends on."""
        read = [*self.later, *_functions(self.strategy)]
        return frozenset[str]().union(*map(self.symbols.names, read))

    def _following(self, mode: Mode, parts: Sequence[Node], start: Node) -> list[Node]:
        """For each next mode what the step may have been, of what is remembered."""
        symbols, manager = self.symbols, self.manager
        kept = frozenset(symbols.all_bits(sorted(self.names), primed=True))
        graph = [
            manager.var(after).equiv(node)
            for bit, node in mode.outputs.items()
            if (after := next_bit(bit)) in kept
        ]
        given = symbols.all_bits(self.strategy.inputs, primed=True)
        gone = [*symbols.all_bits(symbols.variables), *(bit for bit in given if bit not in kept)]
        found = Product(manager, [*parts, *graph], gone)
        return [symbols.unprime(found(start & where)) for where in mode.onward]


def _functions(strategy: Strategy) -> Iterator[Node]:
    """All that is computed in later steps."""
    for mode in strategy.modes:
        yield from mode.outputs.values()
        yield from mode.onward


def registers(reached: Reached) -> tuple[str, ...]:
    """Outputs that count, and numbers among the inputs that are remembered beside them."""
    strategy, symbols = reached.strategy, reached.strategy.symbols
    read = frozenset[str]().union(*map(strategy.manager.support, _functions(strategy)))
    counters = [
        name
        for name in strategy.outputs
        if _is_number(strategy, name) and not read.isdisjoint(symbols.bits(name))
    ]
    counters = [name for name in counters if is_counter(reached, name)]
    counted = frozenset(symbols.all_bits(counters))
    beside = {
        name
        for node in _functions(strategy)
        if not counted.isdisjoint(strategy.manager.support(node))
        for name in symbols.names(node)
        if symbols.variables[name].owner is Owner.ENVIRONMENT and _is_number(strategy, name)
    }
    return tuple(name for name in symbols.variables if name in counters or name in beside)


def _is_number(strategy: Strategy, name: str) -> bool:
    domain = strategy.symbols.variables[name].domain
    return isinstance(domain, IntegerDomain) and domain.high - domain.low > 1


def is_counter(reached: Reached, name: str) -> bool:
    """Whether an output counts up or down by one, and else keeps its value or is set to a few."""
    strategy, manager = reached.strategy, reached.strategy.manager
    known = domains.values(strategy.symbols.variables[name].domain)
    stays, *counts = steps(name)
    is_counting, set_to = False, set[Literal]()
    for mode, care in zip(strategy.modes, reached.cares, strict=True):
        left = care & ~gives(strategy, mode.outputs, name, stays)
        rest = left
        for change in counts:
            rest = rest & ~gives(strategy, mode.outputs, name, change)
        is_counting = is_counting or rest != left
        for value in known if rest != manager.false else ():
            if rest & gives(strategy, mode.outputs, name, Const(value)) != manager.false:
                set_to.add(value)
            if len(set_to) > FEW:
                return False
    return is_counting


def steps(name: str) -> tuple[Formula, ...]:
    """What a counter does: it stays, or goes up or down by one."""
    one = Const(1)
    return Var(name), Apply(Op.ADD, (Var(name), one)), Apply(Op.SUB, (Var(name), one))


def gives(strategy: Strategy, outputs: Mapping[str, Node], name: str, value: Formula) -> Node:
    """Where an output is the value, over the step before and the inputs."""
    said = strategy.symbols.bdd(eq(Var(name, primed=True), value))
    by = {next_bit(bit): outputs[bit] for bit in strategy.symbols.bits(name)}
    return substituted(strategy.manager, said, by)
