"""Refinement, compatibility and consistency of contracts (thesis 2.2.1; Benveniste et al. 2018).

A contract is a set of environments (its assumptions) and of systems (what keeps its guarantees in
these environments). Everything is decided conjunct by conjunct on fair runs, so that an answer
names the conjunct that fails and shows a run.
"""

from collections.abc import Iterator, Sequence

from msgspec import Struct

from sysmlc.logic.contract import Class, Conjunct, Contract
from sysmlc.synthesis.algebra.fair_systems import FairSystem, Runs, Universe, observe_histories
from sysmlc.synthesis.algebra.traces import Trace, lasso, one, shortest
from sysmlc.synthesis.bdd.manager import Manager, Node


class Entailment:
    """The runs in which some conjuncts hold, asked whether others hold in them too."""

    def __init__(self, universe: Universe, given: FairSystem) -> None:
        """Nothing is explored until something is asked."""
        self._universe = universe
        self.runs = Runs(given)

    @property
    def is_possible(self) -> bool:
        """Whether there is a run at all."""
        return self.runs.fair & self.runs.system.init != self.runs.manager.false

    def example(self) -> Trace | None:
        """A run; None when there is none."""
        runs = self.runs
        start = runs.fair & runs.system.init
        return lasso(runs, [one(runs, start)], runs.fair) if self.is_possible else None

    def violation(self, conjunct: Conjunct) -> Trace | None:
        """A run in which the conjunct does not hold; None when it holds in all.

        Raises OutsideGr1Error for a conjunct of general LTL.
        """
        broken = ~self._universe.node(conjunct)
        if broken == self.runs.manager.false:
            return None
        return _VIOLATION_SEARCHES[conjunct.class_](self.runs, broken)


def _find_initial_violation(runs: Runs, broken: Node) -> Trace | None:
    found = runs.system.init & runs.fair & broken
    return lasso(runs, [one(runs, found)], runs.fair) if found != runs.manager.false else None


def _find_step_violation(runs: Runs, broken: Node) -> Trace | None:
    """A reachable step that breaks it and from which a fair run goes on."""
    found = runs.fair & runs.before_by(runs.fair, broken)
    if found == runs.manager.false:
        return None
    way = shortest(runs, found)
    symbols = runs.system.symbols
    # The state after the step: those that this state and the broken condition allow.
    after = symbols.unprime(runs.manager.exist(runs.bits, way[-1] & broken))
    way.append(one(runs, runs.after(way[-1]) & after & runs.fair))
    return lasso(runs, way, runs.fair)


def _find_fair_violation(runs: Runs, broken: Node) -> Trace | None:
    """A fair run that from some step on is never where it should be again and again."""
    found = runs.fair_within(runs.reachable & broken)
    if found == runs.manager.false:
        return None
    return lasso(runs, shortest(runs, found), found)


_VIOLATION_SEARCHES = {
    Class.INIT: _find_initial_violation,
    Class.SAFETY: _find_step_violation,
    Class.LIVENESS: _find_fair_violation,
}


class Failure(Struct, frozen=True):
    """A conjunct that does not follow, with a run in which it does not hold."""

    conjunct: Conjunct
    is_assumption: bool
    """Whether it is assumed by the contract that should refine, or promised by the other."""
    trace: Trace


def find_refinement_failures(
    concrete: Contract, abstract: Contract, manager: Manager
) -> Iterator[Failure]:
    """Why ``concrete`` does not refine ``abstract``; nothing when it does.

    A contract refines another when it assumes no more and promises no less: the other's
    assumptions entail its own, and with the other's assumptions its guarantees entail the other's.
    Raises DomainError, OutsideGr1Error, LimitError.
    """
    with manager.guard():
        yield from _find_all_failures(concrete, abstract, manager)


def _find_all_failures(
    concrete: Contract, abstract: Contract, manager: Manager
) -> Iterator[Failure]:
    both = observe_histories((concrete, abstract))
    (concrete, abstract), seen = both.contracts, both.definitions
    universe = Universe(both.contracts, manager)
    given = Entailment(universe, universe.system((*abstract.assumptions, *seen)))
    yield from _find_failures(
        given, _without_repeated(concrete.assumptions, abstract.assumptions), True
    )
    kept = (*abstract.assumptions, *concrete.guarantees, *seen)
    promised = Entailment(universe, universe.system(kept))
    yield from _find_failures(promised, _without_repeated(abstract.guarantees, kept), False)


def _find_failures(
    given: Entailment, wanted: Sequence[Conjunct], is_assumption: bool
) -> Iterator[Failure]:
    for conjunct in wanted:
        trace = given.violation(conjunct)
        if trace is not None:
            yield Failure(conjunct, is_assumption, trace)


def _without_repeated(wanted: Sequence[Conjunct], given: Sequence[Conjunct]) -> list[Conjunct]:
    """What is not given word for word."""
    known = {(one.class_, one.formula) for one in given}
    return [one for one in wanted if (one.class_, one.formula) not in known]


def find_environment_run(contract: Contract, manager: Manager) -> Trace | None:
    """A run that the assumptions allow; None when the contract is not compatible."""
    return _find_run(contract, manager, is_whole=False)


def find_contract_run(contract: Contract, manager: Manager) -> Trace | None:
    """A run that assumptions and guarantees allow; None when the contract is not consistent."""
    return _find_run(contract, manager, is_whole=True)


def _find_run(contract: Contract, manager: Manager, is_whole: bool) -> Trace | None:
    alone = observe_histories((contract,))
    (made,) = alone.contracts
    promised = made.guarantees if is_whole else ()
    with manager.guard():
        universe = Universe(alone.contracts, manager)
        system = universe.system((*made.assumptions, *promised, *alone.definitions))
        return Entailment(universe, system).example()
