"""Entailment of conjuncts; refinement and compatibility of contracts (thesis 2.2.1).

The definitions are those of Benveniste et al. (2018).

A contract denotes a set of environments (those that satisfy its assumptions) and a set of systems
(those that satisfy its guarantees in these environments). Each conjunct is decided by itself on the
fair runs of the others, so a failure names the conjunct and shows a run that violates it.
"""

from collections.abc import Iterator, Sequence

from msgspec import Struct

from sysmlc.logic.contract import Class, Conjunct, Contract
from sysmlc.synthesis.algebra.fair_systems import (
    FairSystem,
    Runs,
    Trace,
    Universe,
    build_lasso,
    observe_histories,
    pick_state,
    shortest_path,
)
from sysmlc.synthesis.bdd.manager import Manager, Node


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
        if violation == self.runs.manager.false:
            return None
        return _VIOLATION_SEARCHES[conjunct.class_](self.runs, violation)


def _find_initial_violation(runs: Runs, violation: Node) -> Trace | None:
    states = runs.system.init & runs.fair & violation
    if states == runs.manager.false:
        return None
    return build_lasso(runs, [pick_state(runs, states)], runs.fair)


def _find_step_violation(runs: Runs, violation: Node) -> Trace | None:
    """Return a run through a reachable step that violates the conjunct."""
    states = runs.fair & runs.predecessors_by(runs.fair, violation)
    if states == runs.manager.false:
        return None
    path = shortest_path(runs, states)
    symbols = runs.system.symbols
    # Restrict the successors to those for which the last step violates the conjunct.
    successors = symbols.unprime(runs.manager.exist(runs.bits, path[-1] & violation))
    path.append(pick_state(runs, runs.successors(path[-1]) & successors & runs.fair))
    return build_lasso(runs, path, runs.fair)


def _find_fair_violation(runs: Runs, violation: Node) -> Trace | None:
    """Return a fair run that violates the condition forever from some step on."""
    states = runs.fair_within(runs.reachable & violation)
    if states == runs.manager.false:
        return None
    return build_lasso(runs, shortest_path(runs, states), states)


_VIOLATION_SEARCHES = {
    Class.INIT: _find_initial_violation,
    Class.SAFETY: _find_step_violation,
    Class.LIVENESS: _find_fair_violation,
}


class Failure(Struct, frozen=True):
    """A conjunct that is not entailed, with a run that violates it."""

    conjunct: Conjunct
    is_assumption: bool
    """Whether it is an assumption of the concrete contract, not a guarantee of the abstract one."""
    trace: Trace


def find_refinement_failures(
    concrete: Contract, abstract: Contract, manager: Manager
) -> Iterator[Failure]:
    """Yield the reasons why *concrete* does not refine *abstract*; none if it does.

    A contract refines another one if it assumes no more and guarantees no less. That is: the
    abstract assumptions entail the concrete assumptions, and the abstract assumptions together with
    the concrete guarantees entail the abstract guarantees. Raises DomainError, OutsideGr1Error,
    LimitError.
    """
    with manager.guard():
        yield from _find_all_failures(concrete, abstract, manager)


def _find_all_failures(
    concrete: Contract, abstract: Contract, manager: Manager
) -> Iterator[Failure]:
    observed = observe_histories((concrete, abstract))
    (concrete, abstract), definitions = observed.contracts, observed.definitions
    universe = Universe(observed.contracts, manager)
    assumed_runs = Entailment(universe, universe.system((*abstract.assumptions, *definitions)))
    yield from _find_failures(
        assumed_runs, _without_repeated(concrete.assumptions, abstract.assumptions), True
    )
    facts = (*abstract.assumptions, *concrete.guarantees, *definitions)
    guaranteed_runs = Entailment(universe, universe.system(facts))
    yield from _find_failures(guaranteed_runs, _without_repeated(abstract.guarantees, facts), False)


def _find_failures(
    runs: Entailment, conjuncts: Sequence[Conjunct], is_assumption: bool
) -> Iterator[Failure]:
    for conjunct in conjuncts:
        trace = runs.find_violation(conjunct)
        if trace is not None:
            yield Failure(conjunct, is_assumption, trace)


def _without_repeated(conjuncts: Sequence[Conjunct], facts: Sequence[Conjunct]) -> list[Conjunct]:
    """Return the conjuncts that are not literally among the facts, which need no search."""
    stated = {(conjunct.class_, conjunct.formula) for conjunct in facts}
    return [conjunct for conjunct in conjuncts if (conjunct.class_, conjunct.formula) not in stated]


def find_environment_run(contract: Contract, manager: Manager) -> Trace | None:
    """Return a run that satisfies the assumptions, or None if the contract is not compatible."""
    observed = observe_histories((contract,))
    (reduced,) = observed.contracts
    with manager.guard():
        universe = Universe(observed.contracts, manager)
        system = universe.system((*reduced.assumptions, *observed.definitions))
        return Entailment(universe, system).find_example()
