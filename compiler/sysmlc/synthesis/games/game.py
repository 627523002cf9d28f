"""A contract as a game: initial conditions, relations in parts, and what must recur.

In every step the environment gives its variables first, then the system answers (Mealy). The
system is obliged by its guarantees until an assumption is broken (docs/synthesis.md).
"""

from collections.abc import Iterable, Iterator, Mapping

from msgspec import Struct, field

from sysmlc.logic.contract import BooleanDomain, Class, Conjunct, Contract, Owner
from sysmlc.logic.formula import Formula, variables
from sysmlc.synthesis.bdd.manager import Manager, Node
from sysmlc.synthesis.bdd.symbols import SymbolError, Symbols


class OutsideGr1Error(Exception):
    """A conjunct that GR(1) cannot say, with the reason in words."""

    def __init__(self, conjunct: Conjunct, why: str) -> None:
        super().__init__(why)
        self.conjunct = conjunct
        self.why = why


class Part(Struct, frozen=True):
    """A diagram with the conjunct that it comes from; None for the range of a variable."""

    node: Node
    conjunct: Conjunct | None = None


class Game(Struct, frozen=True):
    """A GR(1) game; a step is a pair of valuations, the second one primed.

    The system wins a play when it keeps ``init_guarantees`` and ``guarantees`` for as long as the
    environment keeps ``init_assumptions`` and ``assumptions``, and when all of ``goals`` recur or
    some of ``fairness`` does not.
    """

    manager: Manager
    symbols: Symbols
    init_assumptions: tuple[Part, ...]
    """Over inputs."""
    init_guarantees: tuple[Part, ...]
    """Over inputs and outputs."""
    assumptions: tuple[Part, ...]
    """Over inputs, outputs and next inputs; ranges of next inputs too."""
    guarantees: tuple[Part, ...]
    """Over inputs, outputs, next inputs and next outputs; ranges of next outputs too."""
    fairness: tuple[Part, ...]
    """Liveness assumptions, over inputs and outputs."""
    goals: tuple[Part, ...]
    """Liveness guarantees, over inputs and outputs."""
    definitions: Mapping[str, Mapping[str, Node]] = field(default_factory=dict)
    """Variables that are no longer played, with the diagram of each of their bits over others."""

    @property
    def inputs(self) -> tuple[str, ...]:
        """Bits of the environment."""
        return self.symbols.all_bits(self.names(Owner.ENVIRONMENT))

    @property
    def outputs(self) -> tuple[str, ...]:
        """Bits of the system."""
        return self.symbols.all_bits(self.names(Owner.SYSTEM))

    @property
    def next_inputs(self) -> tuple[str, ...]:
        """Bits of the environment in the next step."""
        return self.symbols.all_bits(self.names(Owner.ENVIRONMENT), primed=True)

    @property
    def next_outputs(self) -> tuple[str, ...]:
        """Bits of the system in the next step."""
        return self.symbols.all_bits(self.names(Owner.SYSTEM), primed=True)

    def names(self, owner: Owner) -> tuple[str, ...]:
        """The variables that one side plays."""
        variables = self.symbols.variables.values()
        return tuple(
            one.name for one in variables if one.owner is owner and one.name not in self.definitions
        )


def make_game(contract: Contract, manager: Manager) -> Game:
    """The game of a contract; the manager must be new.

    Raises OutsideGr1Error for a conjunct that GR(1) cannot say, LimitError when a limit is
    reached.
    """
    names = {owner: _names(contract, owner) for owner in Owner}
    for conjunct in contract.assumptions:
        _check(conjunct, names, is_assumption=True)
    for conjunct in contract.guarantees:
        _check(conjunct, names, is_assumption=False)
    # An order that suits the parts of a relation can be hopeless for the game: the one that the
    # variables come in is kept until there is more to look at.
    with manager.guard(), manager.calm():
        return _translated(contract, Symbols(manager, contract.variables, _together(contract)))


def _together(contract: Contract) -> Iterator[tuple[str, ...]]:
    """The variables of each conjunct."""
    for conjunct in (*contract.assumptions, *contract.guarantees):
        yield tuple(dict.fromkeys(one.name for one in variables(conjunct.formula)))


def _translated(contract: Contract, symbols: Symbols) -> Game:
    def parts(conjuncts: Iterable[Conjunct], class_: Class) -> tuple[Part, ...]:
        return tuple(_parts(symbols, conjuncts, class_))

    def ranges(owner: Owner, primed: bool) -> tuple[Part, ...]:
        return tuple(_ranges(symbols, owner, primed))

    assumed, promised = contract.assumptions, contract.guarantees
    return Game(
        manager=symbols.manager,
        symbols=symbols,
        init_assumptions=parts(assumed, Class.INIT) + ranges(Owner.ENVIRONMENT, False),
        init_guarantees=parts(promised, Class.INIT) + ranges(Owner.SYSTEM, False),
        assumptions=parts(assumed, Class.SAFETY) + ranges(Owner.ENVIRONMENT, True),
        guarantees=parts(promised, Class.SAFETY) + ranges(Owner.SYSTEM, True),
        fairness=parts(assumed, Class.LIVENESS),
        goals=parts(promised, Class.LIVENESS),
    )


def _parts(symbols: Symbols, conjuncts: Iterable[Conjunct], class_: Class) -> Iterator[Part]:
    for conjunct in conjuncts:
        if conjunct.class_ is class_:
            symbols.manager.check("translating the contract")
            try:
                yield Part(symbols.bdd(conjunct.formula), conjunct)
            except SymbolError as problem:
                raise OutsideGr1Error(conjunct, str(problem)) from None


def _ranges(symbols: Symbols, owner: Owner, primed: bool) -> Iterator[Part]:
    for variable in symbols.variables.values():
        if variable.owner is owner and not isinstance(variable.domain, BooleanDomain):
            node = symbols.domain(variable.name, primed)
            if node != symbols.manager.true:
                yield Part(node)


_Names = Mapping[Owner, frozenset[str]]
"""The variables of each side."""


def _names(contract: Contract, owner: Owner) -> frozenset[str]:
    return frozenset(one.name for one in contract.variables if one.owner is owner)


def _check(conjunct: Conjunct, names: _Names, is_assumption: bool) -> None:
    """Raise OutsideGr1Error when the conjunct's class does not allow what it speaks of."""
    why = _objection(conjunct, names, is_assumption)
    if why:
        raise OutsideGr1Error(conjunct, why)


def _objection(conjunct: Conjunct, names: _Names, is_assumption: bool) -> str:
    if conjunct.class_ is Class.OTHER:
        return "it is neither initial, nor for every step (G), nor recurring (GF)"
    if conjunct.class_ is not Class.SAFETY:
        after = _first(conjunct.formula, frozenset().union(*names.values()), primed=True)
        kind = "an initial condition" if conjunct.class_ is Class.INIT else "what must recur"
        if after:
            return f"{kind} cannot speak of the next step ({after}')"
    return _of_assumption(conjunct, names[Owner.SYSTEM]) if is_assumption else ""


def _of_assumption(conjunct: Conjunct, outputs: frozenset[str]) -> str:
    if conjunct.class_ is Class.INIT:
        output = _first(conjunct.formula, outputs, primed=False)
        return output and f"an initial assumption cannot speak of an output ({output})"
    output = _first(conjunct.formula, outputs, primed=True)
    return output and f"an assumption cannot speak of the next value of an output ({output}')"


def _first(formula: Formula, names: frozenset[str], primed: bool) -> str:
    """The first variable of the formula among the names, or nothing."""
    found = (one.name for one in variables(formula) if one.primed == primed and one.name in names)
    return next(found, "")
