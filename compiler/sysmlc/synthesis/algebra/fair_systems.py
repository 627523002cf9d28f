"""Conjuncts as fair transition systems: where runs start, what a step is, what must recur."""

from collections.abc import Iterable, Iterator, Sequence

from msgspec import Struct
from msgspec.structs import replace

from sysmlc.logic.contract import Class, Conjunct, Contract, Domain, Variable
from sysmlc.logic.reduction.history import History
from sysmlc.logic.reduction.reduce import NotReducibleError, as_ltl, is_plain, parts_of
from sysmlc.synthesis.bdd.manager import Manager, Node
from sysmlc.synthesis.bdd.symbols import SymbolError, Symbols
from sysmlc.synthesis.games.game import OutsideGr1Error
from sysmlc.synthesis.games.relational_product import Product


class DomainError(Exception):
    """Two contracts have a variable of one name with different values."""

    def __init__(self, name: str, domains: tuple[Domain, Domain]) -> None:
        super().__init__(f"'{name}' has different values in the two contracts")
        self.name = name
        self.domains = domains


class FairSystem(Struct, frozen=True):
    """Infinite runs from ``init`` by steps in all ``parts`` that are again and again in each of
    ``fairness``."""

    symbols: Symbols
    init: Node
    parts: tuple[Node, ...]
    """Over the bits of a step and the next one."""
    fairness: tuple[Node, ...]


class Universe:
    """The variables of some contracts in one manager; those of one name are one variable."""

    def __init__(self, contracts: Iterable[Contract], manager: Manager) -> None:
        """Declare the variables; the manager must be new. Raises DomainError."""
        self.manager = manager
        self.symbols = Symbols(manager, _merged(contracts))
        self._now = self._ranges(primed=False)
        self._then = self._ranges(primed=True)

    def system(self, conjuncts: Iterable[Conjunct]) -> FairSystem:
        """The runs in which all conjuncts hold, each variable within its range.

        Raises OutsideGr1Error for a conjunct that is neither initial, nor for every step, nor
        recurring.
        """
        found: dict[Class, list[Node]] = {class_: [] for class_ in Class}
        for conjunct in conjuncts:
            found[conjunct.class_].append(self.node(conjunct))
        init = self.manager.true
        for node in (*self._now, *found[Class.INIT]):
            init = init & node
        parts = (*self._now, *self._then, *found[Class.SAFETY])
        return FairSystem(self.symbols, init, parts, tuple(found[Class.LIVENESS]))

    def node(self, conjunct: Conjunct) -> Node:
        """The diagram of a conjunct without the temporal operators that its class implies."""
        if conjunct.class_ is Class.OTHER:
            why = "it is neither initial, nor for every step (G), nor recurring (GF)"
            raise OutsideGr1Error(conjunct, why)
        try:
            return self.symbols.bdd(conjunct.formula)
        except SymbolError as problem:
            raise OutsideGr1Error(conjunct, str(problem)) from None

    def _ranges(self, primed: bool) -> tuple[Node, ...]:
        nodes = (self.symbols.domain(name, primed) for name in self.symbols.variables)
        return tuple(node for node in nodes if node != self.manager.true)


def _merged(contracts: Iterable[Contract]) -> Iterator[Variable]:
    known: dict[str, Variable] = {}
    for variable in (one for contract in contracts for one in contract.variables):
        other = known.setdefault(variable.name, variable)
        if other.domain != variable.domain:
            raise DomainError(variable.name, (other.domain, variable.domain))
    yield from known.values()


class Runs:
    """The runs of a system, explored as far as they are asked for."""

    def __init__(self, system: FairSystem) -> None:
        """Settle the order in which relations are joined; nothing is explored yet."""
        self.system = system
        symbols = system.symbols
        names = tuple(symbols.variables)
        self.bits: Sequence[str] = symbols.all_bits(names)
        self.next_bits: Sequence[str] = symbols.all_bits(names, primed=True)
        self._forward = Product(self.manager, system.parts, self.bits)
        self._backward = Product(self.manager, system.parts, self.next_bits)
        self._reachable: Node | None = None
        self._fair: Node | None = None

    @property
    def manager(self) -> Manager:
        """Owner of all diagrams."""
        return self.system.symbols.manager

    def after(self, states: Node) -> Node:
        """The states that one step leads to."""
        return self.system.symbols.unprime(self._forward(states))

    def before(self, states: Node) -> Node:
        """The states from which one step leads there."""
        return self._backward(self.system.symbols.prime(states))

    def before_by(self, states: Node, step: Node) -> Node:
        """The same for steps that also satisfy ``step``."""
        return self._backward(self.system.symbols.prime(states) & step)

    @property
    def reachable(self) -> Node:
        """All states that some run of steps leads to."""
        if self._reachable is None:
            self._reachable = self._closed(self.system.init)
        return self._reachable

    @property
    def fair(self) -> Node:
        """Reachable states from which a fair run goes on for ever."""
        if self._fair is None:
            self._fair = self.fair_within(self.reachable)
        return self._fair

    @property
    def endless(self) -> Node:
        """States, reachable or not, from which steps go on for ever."""
        found = self.manager.true
        while (fewer := found & self.before(found)) != found:
            found = fewer
        return found

    def fair_within(self, states: Node) -> Node:
        """States from which a fair run goes on for ever without leaving ``states``."""
        found = states
        while True:
            fewer = found
            for goal in self.goals:
                fewer = fewer & self.before(self.leading(fewer, fewer & goal))
            if fewer == found:
                return found
            found = fewer
            self.manager.check("looking for fair runs")

    @property
    def goals(self) -> tuple[Node, ...]:
        """What a fair run meets again and again; to go on, when nothing else is asked."""
        return self.system.fairness or (self.manager.true,)

    def leading(self, within: Node, target: Node) -> Node:
        """States from which steps within ``within`` lead to the target."""
        found = target
        while True:
            more = found | (within & self.before(found))
            if more == found:
                return found
            found = more

    def rings(self, within: Node, target: Node) -> list[Node]:
        """The same as sets of states by the number of steps, the target first."""
        found = [target]
        known = target
        while True:
            ring = within & self.before(found[-1]) & ~known
            if ring == self.manager.false:
                return found
            found.append(ring)
            known = known | ring

    def _closed(self, states: Node) -> Node:
        found, front = states, states
        while front != self.manager.false:
            front = self.after(front) & ~found
            found = found | front
            self.manager.check("exploring what can be reached")
        return found


class ObservedContracts(Struct, frozen=True):
    """Contracts over shared history bits."""

    contracts: tuple[Contract, ...]
    definitions: tuple[Conjunct, ...]
    """What the bits follow: true of every run, and no restriction of any."""


def observe_histories(contracts: Iterable[Contract]) -> ObservedContracts:
    """The contracts with history bits where they are needed.

    Raises OutsideGr1Error for a conjunct that no known reduction brings into GR(1).
    """
    given = tuple(contracts)
    history = History(one.name for contract in given for one in contract.variables)
    sides = [
        (
            tuple(_reduce_conjuncts(one.assumptions, history)),
            tuple(_reduce_conjuncts(one.guarantees, history)),
        )
        for one in given
    ]
    made = tuple(
        replace(
            contract,
            variables=(*contract.variables, *history.variables),
            assumptions=assumed,
            guarantees=promised,
        )
        for contract, (assumed, promised) in zip(given, sides, strict=True)
    )
    return ObservedContracts(made, tuple(history.conjuncts))


def _reduce_conjuncts(conjuncts: Iterable[Conjunct], history: History) -> Iterator[Conjunct]:
    for one in conjuncts:
        if is_plain(one):
            yield one
            continue
        try:
            parts = parts_of(as_ltl(one), history, one.origin)
        except NotReducibleError as problem:
            raise OutsideGr1Error(one, str(problem)) from None
        yield from (replace(one, formula=part, class_=class_) for class_, part in parts)
