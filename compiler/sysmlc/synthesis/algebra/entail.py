"""Whether all runs of a system satisfy a conjunct, and a run that does not."""

from sysmlc.logic.contract import Class, Conjunct
from sysmlc.synthesis.algebra.fair import Runs
from sysmlc.synthesis.algebra.systems import FairSystem, Universe
from sysmlc.synthesis.algebra.traces import Trace, lasso, one, shortest
from sysmlc.synthesis.bdd.manager import Node


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
        return _SEARCHES[conjunct.class_](self.runs, broken)


def _at_the_start(runs: Runs, broken: Node) -> Trace | None:
    found = runs.system.init & runs.fair & broken
    return lasso(runs, [one(runs, found)], runs.fair) if found != runs.manager.false else None


def _in_a_step(runs: Runs, broken: Node) -> Trace | None:
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


def _for_ever(runs: Runs, broken: Node) -> Trace | None:
    """A fair run that from some step on is never where it should be again and again."""
    found = runs.fair_within(runs.reachable & broken)
    if found == runs.manager.false:
        return None
    return lasso(runs, shortest(runs, found), found)


_SEARCHES = {
    Class.INIT: _at_the_start,
    Class.SAFETY: _in_a_step,
    Class.LIVENESS: _for_ever,
}
