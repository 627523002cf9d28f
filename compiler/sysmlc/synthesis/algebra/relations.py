"""Refinement, compatibility and consistency of contracts (thesis 2.2.1; Benveniste et al. 2018).

A contract is a set of environments (its assumptions) and of systems (what keeps its guarantees in
these environments). Everything is decided conjunct by conjunct on fair runs, so that an answer
names the conjunct that fails and shows a run.
"""

from collections.abc import Iterator, Sequence

from msgspec import Struct

from sysmlc.logic.contract import Conjunct, Contract
from sysmlc.synthesis.algebra.entail import Entailment
from sysmlc.synthesis.algebra.observed import observed
from sysmlc.synthesis.algebra.systems import Universe
from sysmlc.synthesis.algebra.traces import Trace
from sysmlc.synthesis.bdd.manager import Manager


class Failure(Struct, frozen=True):
    """A conjunct that does not follow, with a run in which it does not hold."""

    conjunct: Conjunct
    is_assumption: bool
    """Whether it is assumed by the contract that should refine, or promised by the other."""
    trace: Trace


def refinement_failures(
    concrete: Contract, abstract: Contract, manager: Manager
) -> Iterator[Failure]:
    """Why ``concrete`` does not refine ``abstract``; nothing when it does.

    A contract refines another when it assumes no more and promises no less: the other's
    assumptions entail its own, and with the other's assumptions its guarantees entail the other's.
    Raises DomainError, OutsideGr1Error, LimitError.
    """
    with manager.guard():
        yield from _all_failures(concrete, abstract, manager)


def _all_failures(concrete: Contract, abstract: Contract, manager: Manager) -> Iterator[Failure]:
    both = observed((concrete, abstract))
    (concrete, abstract), seen = both.contracts, both.definitions
    universe = Universe(both.contracts, manager)
    given = Entailment(universe, universe.system((*abstract.assumptions, *seen)))
    yield from _failures(given, _new(concrete.assumptions, abstract.assumptions), True)
    kept = (*abstract.assumptions, *concrete.guarantees, *seen)
    promised = Entailment(universe, universe.system(kept))
    yield from _failures(promised, _new(abstract.guarantees, kept), False)


def _failures(
    given: Entailment, wanted: Sequence[Conjunct], is_assumption: bool
) -> Iterator[Failure]:
    for conjunct in wanted:
        trace = given.violation(conjunct)
        if trace is not None:
            yield Failure(conjunct, is_assumption, trace)


def _new(wanted: Sequence[Conjunct], given: Sequence[Conjunct]) -> list[Conjunct]:
    """What is not given word for word."""
    known = {(one.class_, one.formula) for one in given}
    return [one for one in wanted if (one.class_, one.formula) not in known]


def environment(contract: Contract, manager: Manager) -> Trace | None:
    """A run that the assumptions allow; None when the contract is not compatible."""
    return _example(contract, manager, is_whole=False)


def behaviour(contract: Contract, manager: Manager) -> Trace | None:
    """A run that assumptions and guarantees allow; None when the contract is not consistent."""
    return _example(contract, manager, is_whole=True)


def _example(contract: Contract, manager: Manager, is_whole: bool) -> Trace | None:
    alone = observed((contract,))
    (made,) = alone.contracts
    promised = made.guarantees if is_whole else ()
    with manager.guard():
        universe = Universe(alone.contracts, manager)
        system = universe.system((*made.assumptions, *promised, *alone.definitions))
        return Entailment(universe, system).example()
