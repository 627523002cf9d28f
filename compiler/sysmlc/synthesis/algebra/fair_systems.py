"""Contracts as fair transition systems: initial states, steps, recurring conditions, fair runs.

Fair runs are computed with the fixpoint of Emerson and Lei (1986). Conjuncts outside GR(1) are
first reduced to GR(1) with history bits, which observe the run. A witness (``Trace``) is a lasso: a
path, and a loop at its end that the run repeats forever.
"""

from collections.abc import Iterable, Iterator, Mapping, Sequence
from functools import cached_property

from msgspec import Struct
from msgspec.structs import replace

from sysmlc.logic.contract import Class, Conjunct, Contract, Domain, Variable
from sysmlc.logic.domains import describe_kind, regions_of
from sysmlc.logic.formula import Literal
from sysmlc.logic.quantities import StepQuantities, choose_numbers
from sysmlc.logic.reduction.contract_reduction import as_ltl, is_gr1
from sysmlc.logic.reduction.formula_reduction import NotReducibleError, reduce_formula
from sysmlc.logic.reduction.history import History, share_history
from sysmlc.synthesis.bdd.manager import Manager, Node
from sysmlc.synthesis.bdd.symbols import SymbolError, Symbols
from sysmlc.synthesis.bdd.variable_order import list_related
from sysmlc.synthesis.games.game import OutsideGr1Error
from sysmlc.synthesis.games.relational_product import Product


class DomainError(Exception):
    """Reports that two contracts declare a variable with different domains."""

    def __init__(self, name: str, domains: tuple[Domain, Domain]) -> None:
        kinds = f" ({describe_kind(domains[0])} and {describe_kind(domains[1])})"
        is_number = any(map(regions_of, domains))
        super().__init__(
            f"'{name}' has different values in the two contracts{kinds if is_number else ''}"
        )
        self.name = name
        self.domains = domains


class FairSystem(Struct, frozen=True):
    """The infinite runs from ``init`` that visit each of ``fairness`` infinitely often."""

    symbols: Symbols
    init: Node
    parts: tuple[Node, ...]
    """Conjuncts of the transition relation, over the bits of a state and of the next one."""
    fairness: tuple[Node, ...]


class Universe:
    """The variables of several contracts in one manager; equal names denote one variable."""

    def __init__(
        self, contracts: Iterable[Contract], manager: Manager, related: Iterable[Conjunct] = ()
    ) -> None:
        """Declare the variables; the manager must be new. Raises DomainError.

        Variables of the same conjunct in *related* get bits close together.
        """
        self.manager = manager
        self.symbols = Symbols(manager, merge_variables(contracts), list_related(related))
        nodes = map(self.symbols.domain, self.symbols.variables)
        self._ranges = tuple(node for node in nodes if node != self.manager.true)

    def system(self, conjuncts: Iterable[Conjunct], *, looks_ahead: bool = True) -> FairSystem:
        """Return the system whose runs satisfy all conjuncts and keep variables in their ranges.

        A system that *looks_ahead* neither starts in a state that violates a condition on single
        states nor has a step to one. Its infinite runs are the same, but not its finite ones.

        Raises OutsideGr1Error for a conjunct that is neither initial, nor a safety, nor a liveness
        conjunct.
        """
        nodes: dict[Class, list[Node]] = {class_: [] for class_ in Class}
        for conjunct in conjuncts:
            nodes[conjunct.class_].append(self.node(conjunct))
        invariants = self._ranges
        if looks_ahead:
            # Else steps lead to states without successors, which the search for fair runs finds.
            invariants += tuple(
                node for node in nodes[Class.SAFETY] if not self.symbols.names(node, primed=True)
            )
        # Initial values first, single values before relations among several variables: few states
        # remain, and conditions on them have small diagrams.
        init = self.manager.conjoin((*sorted(nodes[Class.INIT], key=len), *invariants))
        parts = (*self._ranges, *map(self.symbols.prime, invariants), *nodes[Class.SAFETY])
        return FairSystem(self.symbols, init, parts, tuple(nodes[Class.LIVENESS]))

    def node(self, conjunct: Conjunct) -> Node:
        """Return the diagram of a conjunct, without the temporal operators of its class.

        Raises OutsideGr1Error for a conjunct that has no class of GR(1) or no diagram.
        """
        if conjunct.class_ is Class.OTHER:
            why = "it is neither initial, nor for every step (G), nor recurring (GF)"
            raise OutsideGr1Error(conjunct, why)
        try:
            return self.symbols.bdd(conjunct.formula)
        except SymbolError as problem:
            raise OutsideGr1Error(conjunct, str(problem)) from None


def merge_variables(contracts: Iterable[Contract]) -> tuple[Variable, ...]:
    """Return the variables of all contracts; equal names denote one variable.

    Raises DomainError.
    """
    merged: dict[str, Variable] = {}
    for variable in (variable for contract in contracts for variable in contract.variables):
        first = merged.setdefault(variable.name, variable)
        if first.domain != variable.domain:
            raise DomainError(variable.name, (first.domain, variable.domain))
    return tuple(merged.values())


class Runs:
    """The runs of a system, explored on demand."""

    def __init__(self, system: FairSystem) -> None:
        """Prepare the relational product of steps; nothing is explored yet."""
        self.system = system
        symbols = system.symbols
        names = tuple(symbols.variables)
        self.bits: Sequence[str] = symbols.all_bits(names)
        self.next_bits: Sequence[str] = symbols.all_bits(names, primed=True)
        self._forward = Product(self.manager, system.parts, self.bits)
        self._reachable: Node | None = None

    @property
    def manager(self) -> Manager:
        """Owner of all diagrams."""
        return self.system.symbols.manager

    def successors(self, states: Node) -> Node:
        """Return the states that one step reaches."""
        return self.system.symbols.unprime(self._forward(states))

    def predecessors(self, states: Node, step: Node | None = None) -> Node:
        """Return the states from which one step that satisfies *step* leads to *states*."""
        targets = self.system.symbols.prime(states)
        return self._backward(targets if step is None else targets & step)

    def predecessors_among_reachable(self, states: Node, step: Node | None = None) -> Node:
        """Return states from which one step that satisfies *step* leads to *states*.

        All such reachable states are in the result. Unreachable states in it mean nothing, so that
        the caller intersects it with reachable ones.
        """
        targets = self.system.symbols.prime(states)
        product = self._backward if self._reachable is None else self._backward_among_reachable
        return product(targets if step is None else targets & step)

    @cached_property
    def _backward(self) -> Product:
        return Product(self.manager, self.system.parts, self.next_bits)

    @cached_property
    def _backward_among_reachable(self) -> Product:
        # Steps from unreachable states can take most of the nodes: of a block with 60 reachable
        # states, the parts had 1,000,000 nodes, and have 20,000 without these steps.
        parts = (self.manager.restrict(part, self.reachable) for part in self.system.parts)
        return Product(self.manager, parts, self.next_bits)

    @property
    def reachable(self) -> Node:
        """The states that some run reaches."""
        if self._reachable is None:
            self._reachable = self._compute_closure(self.system.init)
        return self._reachable

    @cached_property
    def fair(self) -> Node:
        """The reachable states in which some fair run begins."""
        # Without fairness, each state of a total relation begins a fair run. That it is total takes
        # one product with early quantification of nearly all bits; Emerson and Lei take several.
        is_total = not self.system.fairness and self.reachable <= self.predecessors_among_reachable(
            self.manager.true
        )
        return self.reachable if is_total else self.fair_within(self.reachable)

    @property
    def states_with_infinite_runs(self) -> Node:
        """The states, reachable or not, in which some infinite run begins."""
        states = self.manager.true
        while (shrunk := states & self.predecessors(states)) != states:
            states = shrunk
        return states

    def fair_within(self, states: Node) -> Node:
        """Return the states in which a fair run inside *states* begins (Emerson and Lei).

        All of *states* must be reachable.
        """
        result = states
        while True:
            shrunk = result
            for goal in self.goals:
                before_goal = self.states_reaching(shrunk, shrunk & goal)
                shrunk = shrunk & self.predecessors_among_reachable(before_goal)
            if shrunk == result:
                return result
            result = shrunk
            self.manager.check("searching for fair runs")

    @property
    def goals(self) -> tuple[Node, ...]:
        """The conditions that a fair run satisfies infinitely often; true if there are none."""
        return self.system.fairness or (self.manager.true,)

    def states_reaching(self, within: Node, target: Node) -> Node:
        """Return the states from which steps inside *within* lead to *target*.

        All states of *within* must be reachable.
        """
        reached = frontier = target
        while frontier != self.manager.false:
            frontier = within & self.predecessors_among_reachable(frontier) & ~reached
            reached = reached | frontier
        return reached

    def distance_layers(self, within: Node, target: Node) -> list[Node]:
        """Return the states that reach *target* inside *within*, by the least number of steps.

        The first layer is *target* itself. All states of *within* must be reachable.
        """
        layers = [target]
        reached = target
        while True:
            layer = within & self.predecessors_among_reachable(layers[-1]) & ~reached
            if layer == self.manager.false:
                return layers
            layers.append(layer)
            reached = reached | layer

    def _compute_closure(self, states: Node) -> Node:
        reached, frontier = states, states
        while frontier != self.manager.false:
            frontier = self.successors(frontier) & ~reached
            reached = reached | frontier
            self.manager.check("exploring the reachable states")
        return reached


class ObservedContracts(Struct, frozen=True):
    """Contracts that were reduced to GR(1) with shared history bits."""

    contracts: tuple[Contract, ...]
    definitions: tuple[Conjunct, ...]
    """The transition functions of the history bits, which restrict no run."""


def observe_histories(contracts: Iterable[Contract]) -> ObservedContracts:
    """Return the contracts in GR(1), with history bits where they are needed.

    Raises OutsideGr1Error for a conjunct that no known reduction brings into GR(1).
    """
    contracts, shared = share_history(tuple(contracts))
    history = History(
        variable.name for contract in (*contracts, shared) for variable in contract.variables
    )
    reduced_sides = [
        (
            tuple(_reduce_conjuncts(contract.assumptions, history)),
            tuple(_reduce_conjuncts(contract.guarantees, history)),
        )
        for contract in contracts
    ]
    observed = tuple(
        replace(
            contract,
            variables=(*contract.variables, *shared.variables, *history.variables),
            assumptions=assumptions,
            guarantees=guarantees,
        )
        for contract, (assumptions, guarantees) in zip(contracts, reduced_sides, strict=True)
    )
    return ObservedContracts(observed, (*shared.guarantees, *history.conjuncts))


def _reduce_conjuncts(conjuncts: Iterable[Conjunct], history: History) -> Iterator[Conjunct]:
    for conjunct in conjuncts:
        if is_gr1(conjunct):
            yield conjunct
            continue
        try:
            parts = reduce_formula(as_ltl(conjunct), history, conjunct.origin)
        except NotReducibleError as problem:
            raise OutsideGr1Error(conjunct, str(problem)) from None
        yield from (replace(conjunct, formula=part, class_=class_) for class_, part in parts)


# -- traces ------------------------------------------------------------------------------------


class Trace(Struct, frozen=True):
    """Values of all variables in each step; after the last step the run continues at step ``loop``.

    A run may also end because one side has no allowed values. Then ``loop`` is the number of steps,
    and the variables of this side have no value in the last step. ``auxiliary`` are the names of
    auxiliary variables (``Variable``), ``quiet`` those that texts omit while they have been false.
    ``violated`` is the step that violates the formula which the run refutes, if one is to blame;
    ``is_open`` means that the formula only demands something later that never comes. ``relevant``
    are inputs that texts show although they never change. ``numbers`` are those that texts show in
    place of regions, for each step; empty without regions.
    """

    steps: tuple[Mapping[str, Literal], ...]
    loop: int
    auxiliary: frozenset[str] = frozenset()
    quiet: frozenset[str] = frozenset()
    violated: int | None = None
    is_open: bool = False
    relevant: frozenset[str] = frozenset()
    numbers: tuple[StepQuantities, ...] = ()


def shortest_path(runs: Runs, target: Node) -> list[Node]:
    """Return the states of a shortest path from an initial state to *target*.

    Raises ValueError if *target* is not reachable.
    """
    frontiers = [runs.system.init]
    reached = frontiers[0]
    while frontiers[-1] & target == runs.manager.false:
        frontier = runs.successors(frontiers[-1]) & ~reached
        if frontier == runs.manager.false:
            raise ValueError("the target is not reachable")
        frontiers.append(frontier)
        reached = reached | frontier
    path = [pick_state(runs, frontiers[-1] & target)]
    for frontier in reversed(frontiers[:-1]):
        sources = frontier & runs.predecessors_among_reachable(path[0])
        path.insert(0, pick_state(runs, sources))
    return path


def build_lasso(runs: Runs, path: list[Node], within: Node) -> Trace:
    """Extend *path* by a loop inside *within* that visits every goal, and return the whole run.

    A fair run inside *within* must begin in each of its states. Raises ValueError if none does.
    """
    # From the end of the path, visit each goal in turn and return. If there is no way back, the
    # path has left a strongly connected component for a later one: repeat it one step later. The
    # components are finitely many, and `pick_state` is deterministic, so this ends.
    extended = list(path)
    while True:
        anchor = len(extended) - 1
        for goal in runs.goals:
            extended += _shortest_walk(runs, extended[-1], within, within & goal)
        closing = _shortest_walk(runs, extended[-1], within, extended[anchor], may_stay=False)
        if closing:
            return _decode_trace(runs, extended + closing[:-1], anchor)
        successors = runs.successors(extended[-1]) & within
        if successors == runs.manager.false:
            raise ValueError("no fair run continues from here")
        extended.append(pick_state(runs, successors))


def pick_state(runs: Runs, states: Node) -> Node:
    """Return one of the states; the choice is deterministic, whatever the order of bits."""
    assignment = runs.manager.pick(states, runs.bits)
    return runs.manager.false if assignment is None else runs.manager.cube(assignment)


def _shortest_walk(
    runs: Runs, start: Node, within: Node, target: Node, may_stay: bool = True
) -> list[Node]:
    """Return the states after *start* on a shortest path inside *within* to *target*.

    The list is empty if there is no path. It is also empty if *start* is in *target* already,
    unless *may_stay* is false, which asks for a cycle.
    """
    if may_stay and start & target != runs.manager.false:
        return []
    layers = runs.distance_layers(within, target & within)
    state = start
    walk: list[Node] = []
    successors = runs.successors(start)
    distance = next(
        (index for index, layer in enumerate(layers) if layer & successors != runs.manager.false),
        None,
    )
    if distance is None:
        return []
    for layer in reversed(layers[: distance + 1]):
        state = pick_state(runs, layer & runs.successors(state))
        walk.append(state)
    return walk


def _decode_trace(runs: Runs, states: list[Node], loop: int) -> Trace:
    symbols = runs.system.symbols
    assignments = (runs.manager.pick(state, runs.bits) or {} for state in states)
    auxiliary = (variable.name for variable in symbols.variables.values() if variable.is_auxiliary)
    steps = tuple(symbols.decode(assignment) for assignment in assignments)
    numbers = choose_numbers(symbols.variables.values(), steps)
    return Trace(steps, loop, frozenset(auxiliary), numbers=numbers)
