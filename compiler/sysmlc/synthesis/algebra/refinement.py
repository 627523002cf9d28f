"""Entailment of conjuncts; refinement and compatibility of contracts (thesis 2.2.1).

The definitions are those of Benveniste et al. (2018).

A contract denotes a set of environments (those that satisfy its assumptions) and a set of systems
(those that satisfy its guarantees in these environments). Each conjunct is decided by itself on the
fair runs of the others, so a failure names the conjunct and shows a run that violates it.
"""

import time
from collections.abc import Iterable, Iterator

from msgspec import Struct
from msgspec.structs import replace

from sysmlc.logic import formula as f
from sysmlc.logic.basis import Basis, find_basis
from sysmlc.logic.contract import Class, Conjunct, Contract
from sysmlc.logic.reduction.contract_reduction import as_ltl, is_gr1
from sysmlc.logic.reduction.history import list_history_conjuncts, share_history
from sysmlc.synthesis.algebra.fair_systems import (
    FairSystem,
    Runs,
    Trace,
    Universe,
    build_lasso,
    merge_variables,
    observe_histories,
    pick_state,
    shortest_path,
)
from sysmlc.synthesis.algebra.tableau import encode_conjuncts
from sysmlc.synthesis.bdd.manager import Manager, ManagerFactory, Node


class Entailment:
    """The conjuncts that hold in all runs of a system."""

    def __init__(self, universe: Universe, system: FairSystem) -> None:
        """Prepare the runs of a system; nothing is explored yet."""
        self._universe = universe
        self.runs = Runs(system)

    @property
    def manager(self) -> Manager:
        """Owner of all diagrams."""
        return self.runs.manager

    @property
    def is_possible(self) -> bool:
        """Whether the system has any fair run."""
        return self.runs.fair & self.runs.system.init != self.runs.manager.false

    def find_example(self) -> Trace | None:
        """Return a fair run, or None if there is none."""
        if not self.is_possible:
            return None
        start = pick_state(self.runs, self.runs.fair & self.runs.system.init)
        return build_lasso(self.runs, [start], self.runs.fair)

    def find_violation(self, conjunct: Conjunct) -> Trace | None:
        """Return a run that violates the conjunct, or None if it holds in all runs.

        Raises OutsideGr1Error for a conjunct of general LTL.
        """
        violation = ~self._universe.node(conjunct)
        states = _find_violating_states(self.runs, conjunct.class_, violation)
        if states == self.runs.manager.false:
            return None
        if conjunct.class_ is Class.SAFETY:
            return _build_step_violation(self.runs, states, violation)
        if conjunct.class_ is Class.INIT:
            return build_lasso(self.runs, [pick_state(self.runs, states)], self.runs.fair)
        # A fair run that violates the condition forever from some step on.
        return build_lasso(self.runs, shortest_path(self.runs, states), states)

    def entails(self, conjunct: Conjunct) -> bool:
        """Whether the conjunct holds in all runs. Raises OutsideGr1Error as ``find_violation``."""
        violation = ~self._universe.node(conjunct)
        states = _find_violating_states(self.runs, conjunct.class_, violation)
        return states == self.runs.manager.false


def _find_violating_states(runs: Runs, class_: Class, violation: Node) -> Node:
    """Return the states of fair runs in which a violation is seen, according to the class.

    It is the first state, a state before a violating step, or a state from which on all violate.
    """
    if violation == runs.manager.false:
        return violation
    if class_ is Class.INIT:
        return runs.system.init & runs.fair & violation
    if class_ is Class.SAFETY:
        return runs.fair & _begin_steps(runs, violation)
    return runs.fair_within(runs.reachable & violation)


def _begin_steps(runs: Runs, violation: Node) -> Node:
    """Return states that contain the fair ones from which a fair run begins with a violation."""
    if not runs.system.symbols.names(violation, primed=True):
        return violation
    # All successors of reachable states are reachable.
    targets = runs.manager.true if runs.fair == runs.reachable else runs.fair
    return runs.predecessors_among_reachable(targets, violation)


def _build_step_violation(runs: Runs, states: Node, violation: Node) -> Trace:
    """Return a run through a reachable step that violates the conjunct."""
    path = shortest_path(runs, states)
    symbols = runs.system.symbols
    # Restrict the successors to those for which the last step violates the conjunct.
    successors = symbols.unprime(runs.manager.exist(runs.bits, path[-1] & violation))
    path.append(pick_state(runs, runs.successors(path[-1]) & successors & runs.fair))
    return build_lasso(runs, path, runs.fair)


class RunSearch:
    """Questions about the runs that satisfy conjuncts in any LTL (``tableau``).

    The history bits of the contracts follow their rules in all runs. Each set of facts is explored
    once.
    """

    def __init__(self, contracts: Iterable[Contract], new_manager: ManagerFactory) -> None:
        """Prepare questions about runs over the variables of the contracts. Raises DomainError."""
        self._contracts = tuple(contracts)
        self._new_manager = new_manager
        self._names = tuple(variable.name for variable in merge_variables(self._contracts))
        self._history = dict.fromkeys(
            conjunct
            for contract in self._contracts
            for conjunct in list_history_conjuncts(contract)
        )
        self._entailments: dict[tuple[Conjunct, ...], Entailment] = {}
        self._start_time: float | None = None

    def restart_clocks(self) -> None:
        """Let the time limit count from now, for a new question that may use earlier answers.

        All explorations until the next call share the limit.
        """
        self._start_time = time.process_time()
        for entailment in self._entailments.values():
            entailment.manager.restart_clock(self._start_time)

    def has_runs(self, facts: tuple[Conjunct, ...]) -> bool:
        """Whether some run satisfies the facts. Raises the errors of ``find_violation``."""
        runs = self._explore(facts)
        with runs.manager.guard():
            return runs.is_possible

    def find_violation(self, facts: tuple[Conjunct, ...], conjunct: Conjunct) -> Trace | None:
        """Return a run that satisfies the facts and violates the conjunct, or None.

        Raises DomainError, OutsideGr1Error, NotReducibleError, LimitError.
        """
        if _is_stated(facts, conjunct):
            return None
        if is_gr1(conjunct):
            runs = self._explore(facts)
            with runs.manager.guard():
                trace = runs.find_violation(conjunct)
        else:
            runs = self._explore((*facts, _negate(conjunct)))
            with runs.manager.guard():
                trace = runs.find_example()
        return None if trace is None else self._drop_auxiliary_variables(trace)

    def entails(self, facts: tuple[Conjunct, ...], conjunct: Conjunct) -> bool:
        """Whether no run satisfies the facts and violates the conjunct. Builds no such run.

        Raises the errors of ``find_violation``.
        """
        if _is_stated(facts, conjunct):
            return True
        if is_gr1(conjunct):
            runs = self._explore(facts)
            with runs.manager.guard():
                return runs.entails(conjunct)
        return not self.has_runs((*facts, _negate(conjunct)))

    def _explore(self, facts: tuple[Conjunct, ...]) -> Entailment:
        if facts not in self._entailments:
            observed = dict.fromkeys((*facts, *self._history))
            variables, conjuncts = encode_conjuncts(observed, self._names)
            predictions = Contract("", "", variables, (), ())
            manager = self._new_manager()
            if self._start_time is not None:
                manager.restart_clock(self._start_time)
            with manager.guard():
                universe = Universe((*self._contracts, predictions), manager, conjuncts)
                self._entailments[facts] = Entailment(universe, universe.system(conjuncts))
        return self._entailments[facts]

    def _drop_auxiliary_variables(self, trace: Trace) -> Trace:
        steps = tuple(
            {name: value for name, value in values.items() if name in self._names}
            for values in trace.steps
        )
        return replace(trace, steps=steps)


def _is_stated(facts: Iterable[Conjunct], conjunct: Conjunct) -> bool:
    return any(
        fact.class_ is conjunct.class_ and fact.formula == conjunct.formula for fact in facts
    )


def _negate(conjunct: Conjunct) -> Conjunct:
    return Conjunct(f.negate(as_ltl(conjunct)), Class.OTHER, conjunct.origin)


class Failure(Struct, frozen=True):
    """A conjunct that is not entailed, with a run that violates it."""

    conjunct: Conjunct
    is_assumption: bool
    """Whether it is an assumption of the concrete contract, not a guarantee of the abstract one."""
    trace: Trace


class Comparison(Struct, frozen=True):
    """A conjunct that refinement is about, and a run that violates it, or None if it is entailed.

    ``is_assumption`` has the meaning of that of ``Failure``. ``basis`` are the assumed ranges and
    the conditions without formula in both contracts.
    """

    conjunct: Conjunct
    is_assumption: bool
    trace: Trace | None
    basis: Basis = Basis()

    @property
    def is_decided(self) -> bool:
        """Whether the answer holds whatever the values of conditions without formula are."""
        return self.trace is None or not self.basis.conditions


def compare_conjuncts(
    concrete: Contract, abstract: Contract, new_manager: ManagerFactory
) -> Iterator[Comparison]:
    """Yield for each conjunct whether it is entailed; *concrete* refines *abstract* if all are.

    A contract refines another one if it assumes no more and guarantees no less. That is: the
    abstract assumptions entail the concrete assumptions, and the abstract assumptions together with
    the concrete guarantees entail the abstract guarantees. The conjuncts are in any LTL. Raises
    DomainError, OutsideGr1Error, NotReducibleError, LimitError.
    """
    basis = find_basis((concrete, abstract))
    (concrete, abstract), history = share_history((concrete, abstract))
    search = RunSearch((concrete, abstract, history), new_manager)
    facts = abstract.assumptions
    for assumption in concrete.assumptions:
        yield Comparison(assumption, True, search.find_violation(facts, assumption), basis)
    facts = (*abstract.assumptions, *concrete.guarantees)
    for guarantee in abstract.guarantees:
        yield Comparison(guarantee, False, search.find_violation(facts, guarantee), basis)


def find_refinement_failures(
    concrete: Contract, abstract: Contract, new_manager: ManagerFactory
) -> Iterator[Failure]:
    """Yield the reasons why *concrete* does not refine *abstract*; none if it does.

    Raises the errors of ``compare_conjuncts``.
    """
    for compared in compare_conjuncts(concrete, abstract, new_manager):
        if compared.trace is not None:
            yield Failure(compared.conjunct, compared.is_assumption, compared.trace)


def has_environment(contract: Contract, manager: Manager) -> bool:
    """Return whether some run satisfies the assumptions: whether the contract is compatible."""
    observed = observe_histories((contract,))
    (reduced,) = observed.contracts
    with manager.guard():
        universe = Universe(observed.contracts, manager)
        system = universe.system((*reduced.assumptions, *observed.definitions))
        return Entailment(universe, system).is_possible
