"""What recurs in a composition whose parts wait for one another.

Each part promises: when all that it assumes recurs, what it promises recurs. A run keeps such
promises when for each part something assumed no longer recurs, or everything promised does: runs
of a Streett condition, looked for case by case.
"""

from collections.abc import Iterator, Sequence
from itertools import product
from math import prod

from msgspec import Struct
from msgspec.structs import replace

from sysmlc.logic.contract import Class, Conjunct, Part
from sysmlc.synthesis.algebra.fair import Runs
from sysmlc.synthesis.algebra.systems import Universe
from sysmlc.synthesis.algebra.traces import Trace, lasso, shortest
from sysmlc.synthesis.bdd.manager import Node

MOST_CASES = 256


class Case(Struct, frozen=True):
    """Something that recurs, and where the run stays from some step on."""

    recurring: tuple[Node, ...]
    stay: Node


class Recurrence:
    """The runs of a system in which parts keep what they promise to recur."""

    def __init__(self, runs: Runs, parts: Sequence[Part], universe: Universe) -> None:
        """``runs`` keep what the parts promise of each step."""
        self._runs = runs
        self._universe = universe
        self._cases = [tuple(self._of(part)) for part in parts]

    @property
    def is_decided(self) -> bool:
        """Whether there are few enough cases."""
        return prod(map(len, self._cases)) <= MOST_CASES

    def violation(self, conjunct: Conjunct) -> Trace | None:
        """A run in which a conjunct does not recur; None when it does in all."""
        broken = ~self._universe.node(conjunct)
        for cases in product(*self._cases):
            stay = broken
            for one in cases:
                stay = stay & one.stay
            found = self._run(tuple(goal for one in cases for goal in one.recurring), stay)
            if found is not None:
                return found
        return None

    def _run(self, recurring: tuple[Node, ...], stay: Node) -> Trace | None:
        """A run that comes to stay somewhere, in which more recurs."""
        system = self._runs.system
        runs = Runs(replace(system, fairness=(*system.fairness, *recurring)))
        found = runs.fair_within(self._runs.reachable & stay)
        if found == runs.manager.false:
            return None
        return lasso(runs, shortest(runs, found), found)

    def _of(self, part: Part) -> Iterator[Case]:
        """The ways in which a part keeps its promise."""
        true = self._runs.manager.true
        promised = self._recurring(part.contract.guarantees)
        yield Case(promised, true)
        if promised:
            for one in self._recurring(part.contract.assumptions):
                yield Case((), ~one)

    def _recurring(self, conjuncts: Sequence[Conjunct]) -> tuple[Node, ...]:
        found = (one for one in conjuncts if one.class_ is Class.LIVENESS)
        return tuple(self._universe.node(one) for one in found)
