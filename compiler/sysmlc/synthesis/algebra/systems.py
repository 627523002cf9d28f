"""Conjuncts as fair transition systems: where runs start, what a step is, what must recur."""

from collections.abc import Iterable, Iterator

from msgspec import Struct

from sysmlc.logic.contract import Class, Conjunct, Contract, Domain, Variable
from sysmlc.synthesis.bdd.manager import Manager, Node
from sysmlc.synthesis.bdd.symbols import SymbolError, Symbols
from sysmlc.synthesis.games.game import OutsideGr1Error


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
