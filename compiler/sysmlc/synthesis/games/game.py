"""The GR(1) game of a contract: initial conditions, partitioned transition relations, liveness.

In every step the environment chooses its variables first, then the system answers (Mealy). The
guarantees bind the system until the environment breaks an assumption (docs/synthesis.md).
"""

from collections.abc import Iterable, Iterator, Mapping

from msgspec import Struct, field
from msgspec.structs import replace

from sysmlc.logic.contract import BooleanDomain, Class, Conjunct, Contract, Owner
from sysmlc.logic.formula import Formula, variables
from sysmlc.logic.reduction.history import list_history_conjuncts
from sysmlc.synthesis.bdd.manager import Manager, Node
from sysmlc.synthesis.bdd.symbols import SymbolError, Symbols
from sysmlc.synthesis.bdd.variable_order import VariableOrder, list_related
from sysmlc.synthesis.games.dead_ends import find_viable_inputs


class OutsideGr1Error(Exception):
    """Reports a conjunct that GR(1) cannot express, with the reason as text."""

    def __init__(self, conjunct: Conjunct, reason: str) -> None:
        super().__init__(reason)
        self.conjunct = conjunct
        self.reason = reason


class Constraint(Struct, frozen=True):
    """A diagram and the conjunct that it encodes.

    The range of a variable, and the exclusion of dead ends, have no conjunct.
    """

    node: Node
    conjunct: Conjunct | None = None


class Game(Struct, frozen=True):
    """A GR(1) game. A step is a pair of valuations, the second of them primed.

    The system wins a play if it satisfies ``init_guarantees`` and ``guarantees`` for as long as the
    environment satisfies ``init_assumptions`` and ``assumptions``, and if all of ``goals`` recur or
    some of ``fairness`` does not.
    """

    manager: Manager
    symbols: Symbols
    init_assumptions: tuple[Constraint, ...]
    """Conditions on inputs."""
    init_guarantees: tuple[Constraint, ...]
    """Conditions on inputs and outputs."""
    assumptions: tuple[Constraint, ...]
    """Conditions on inputs, outputs and next inputs, including the ranges of next inputs."""
    guarantees: tuple[Constraint, ...]
    """Conditions on inputs, outputs, next inputs and next outputs, including the ranges of next
    outputs."""
    fairness: tuple[Constraint, ...]
    """Liveness assumptions, conditions on inputs and outputs."""
    goals: tuple[Constraint, ...]
    """Liveness guarantees, conditions on inputs and outputs."""
    definitions: Mapping[str, Mapping[str, Node]] = field(default_factory=dict)
    """Eliminated variables, with a diagram over the other variables for each of their bits."""

    @property
    def inputs(self) -> tuple[str, ...]:
        """Bits of the environment's variables."""
        return self.symbols.all_bits(self.names(Owner.ENVIRONMENT))

    @property
    def outputs(self) -> tuple[str, ...]:
        """Bits of the system's variables."""
        return self.symbols.all_bits(self.names(Owner.SYSTEM))

    @property
    def next_inputs(self) -> tuple[str, ...]:
        """Bits of the environment's variables in the next step."""
        return self.symbols.all_bits(self.names(Owner.ENVIRONMENT), primed=True)

    @property
    def next_outputs(self) -> tuple[str, ...]:
        """Bits of the system's variables in the next step."""
        return self.symbols.all_bits(self.names(Owner.SYSTEM), primed=True)

    def names(self, owner: Owner) -> tuple[str, ...]:
        """Return the variables that one side chooses, without eliminated ones."""
        variables = self.symbols.variables.values()
        return tuple(
            variable.name
            for variable in variables
            if variable.owner is owner and variable.name not in self.definitions
        )


def make_game(
    contract: Contract, manager: Manager, order: VariableOrder = VariableOrder.CONJUNCTS
) -> Game:
    """Translate a contract into a game; the manager must be new.

    Raises OutsideGr1Error for a conjunct that GR(1) cannot express, LimitError if a limit is
    exceeded.
    """
    outputs = frozenset(v.name for v in contract.variables if v.owner is Owner.SYSTEM)
    for is_assumption, conjuncts in ((True, contract.assumptions), (False, contract.guarantees)):
        for conjunct in conjuncts:
            objection = _find_objection(conjunct, outputs, is_assumption)
            if objection:
                raise OutsideGr1Error(conjunct, objection)
    # An order of bits that suits single constraints can be bad for the whole game, so the
    # initial order is kept while the contract is translated.
    with manager.guard(), manager.without_reordering():
        edges = list_related((*contract.assumptions, *contract.guarantees))
        return _translate(contract, Symbols(manager, contract.variables, edges, order))


def _translate(contract: Contract, symbols: Symbols) -> Game:
    def parts(conjuncts: Iterable[Conjunct], class_: Class) -> tuple[Constraint, ...]:
        return tuple(_encode_conjuncts(symbols, conjuncts, class_))

    def ranges(owner: Owner, primed: bool) -> tuple[Constraint, ...]:
        return tuple(_encode_ranges(symbols, owner, primed))

    assumptions, guarantees = contract.assumptions, contract.guarantees
    game = Game(
        manager=symbols.manager,
        symbols=symbols,
        init_assumptions=parts(assumptions, Class.INIT) + ranges(Owner.ENVIRONMENT, False),
        init_guarantees=parts(guarantees, Class.INIT) + ranges(Owner.SYSTEM, False),
        assumptions=parts(assumptions, Class.SAFETY) + ranges(Owner.ENVIRONMENT, True),
        guarantees=parts(guarantees, Class.SAFETY) + ranges(Owner.SYSTEM, True),
        fairness=parts(assumptions, Class.LIVENESS),
        goals=parts(guarantees, Class.LIVENESS),
    )
    return _exclude_dead_ends(game, list_history_conjuncts(contract))


def _exclude_dead_ends(game: Game, history: Iterable[Conjunct]) -> Game:
    """Return the game in which the environment chooses viable inputs only."""
    history_conjuncts = frozenset(history)

    def restrict_outputs(constraints: Iterable[Constraint]) -> list[Node]:
        return [
            constraint.node
            for constraint in constraints
            if constraint.conjunct is None or constraint.conjunct in history_conjuncts
        ]

    viable = find_viable_inputs(
        game.symbols,
        [constraint.node for constraint in game.assumptions],
        restrict_outputs(game.init_guarantees),
        restrict_outputs(game.guarantees),
    )
    if viable is None:
        return game
    return replace(
        game,
        init_assumptions=(*game.init_assumptions, Constraint(viable.first)),
        assumptions=(*game.assumptions, Constraint(viable.later)),
    )


def _encode_conjuncts(
    symbols: Symbols, conjuncts: Iterable[Conjunct], class_: Class
) -> Iterator[Constraint]:
    for conjunct in conjuncts:
        if conjunct.class_ is class_:
            symbols.manager.check("translating the contract")
            try:
                yield Constraint(symbols.bdd(conjunct.formula), conjunct)
            except SymbolError as problem:
                raise OutsideGr1Error(conjunct, str(problem)) from None


def _encode_ranges(symbols: Symbols, owner: Owner, primed: bool) -> Iterator[Constraint]:
    for variable in symbols.variables.values():
        if variable.owner is owner and not isinstance(variable.domain, BooleanDomain):
            node = symbols.domain(variable.name, primed)
            if node != symbols.manager.true:
                yield Constraint(node)


def _find_objection(conjunct: Conjunct, outputs: frozenset[str], is_assumption: bool) -> str:
    """Return why GR(1) does not allow these variables in the conjunct's class, or an empty text."""
    if conjunct.class_ is Class.OTHER:
        return "it is neither initial, nor for every step (G), nor recurring (GF)"
    if conjunct.class_ is not Class.SAFETY:
        after = _first_variable(conjunct.formula, None, primed=True)
        kind = "an initial condition" if conjunct.class_ is Class.INIT else "what must recur"
        if after:
            return f"{kind} cannot refer to the next step ({after}')"
    if not is_assumption:
        return ""
    if conjunct.class_ is Class.INIT:
        output = _first_variable(conjunct.formula, outputs, primed=False)
        # The environment chooses first, before there is any output.
        return output and f"an initial assumption cannot refer to an output ({output})"
    # A history bit could express it, but then the system could violate the assumption itself and
    # would owe nothing afterwards (decision 25).
    output = _first_variable(conjunct.formula, outputs, primed=True)
    return output and f"an assumption cannot refer to the next value of an output ({output}')"


def _first_variable(formula: Formula, names: frozenset[str] | None, primed: bool) -> str:
    """Return the name of the formula's first variable among *names*, or an empty string.

    None stands for all variables.
    """
    matches = (
        variable.name
        for variable in variables(formula)
        if variable.primed == primed and (names is None or variable.name in names)
    )
    return next(matches, "")
