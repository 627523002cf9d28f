"""Which parts of a composition can be relied on: what each assumes follows from what others keep.

A part keeps its promises once its assumptions follow from what holds already. Parts that wait for
one another are taken together, step by step: when no run of steps that all of them keep comes to
one that breaks an assumption of theirs, none of them is the first to fail (Misra and Chandy 1981;
Abadi and Lamport 1993). That is sound for initial conditions and safety, of parts that do not
read in the same step what they write for one another; liveness is never taken in a circle.
"""

from collections.abc import Iterable, Mapping, Sequence

from sysmlc.logic import formula as f
from sysmlc.logic.composite import Composite, Part
from sysmlc.logic.contract import Class, Conjunct, Owner
from sysmlc.logic.evaluate import has_primes
from sysmlc.synthesis.algebra.at_once import read_at_once
from sysmlc.synthesis.algebra.entail import Entailment
from sysmlc.synthesis.algebra.systems import Universe
from sysmlc.synthesis.algebra.traces import Trace
from sysmlc.synthesis.manager import Node
from sysmlc.values import dataclass


@dataclass(frozen=True, slots=True)
class Open:
    """An assumption of a part that does not follow from what holds around it.

    ``trace`` is a run in which the others keep their promises and it is broken all the same; None
    when it follows from them, but they wait for this part in turn.
    """

    part: Part
    conjunct: Conjunct
    trace: Trace | None


@dataclass(frozen=True, slots=True)
class Discharge:
    """The conjuncts that hold in every run of the composition, and what is left open."""

    facts: tuple[Conjunct, ...]
    open: tuple[Open, ...]


class _Known:
    """What holds in every run, and what follows from it."""

    def __init__(self, universe: Universe, facts: Iterable[Conjunct]) -> None:
        self._universe = universe
        self.facts = tuple(dict.fromkeys(facts))
        self._asked: Entailment | None = None

    def adding(self, conjuncts: Iterable[Conjunct]) -> "_Known":
        """The same with more."""
        return _Known(self._universe, (*self.facts, *conjuncts))

    @property
    def runs(self) -> Entailment:
        """The runs in which all facts hold."""
        if self._asked is None:
            self._asked = Entailment(self._universe, self._universe.system(self.facts))
        return self._asked

    def gives(self, conjuncts: Iterable[Conjunct]) -> bool:
        """Whether all conjuncts hold in every run."""
        wanted = [one for one in conjuncts if one not in self.facts]
        return all(self.runs.violation(one) is None for one in wanted)

    def can_break(self, conjunct: Conjunct) -> bool:
        """Whether steps that keep all facts come to one that breaks an initial condition or a
        condition of every step, however it may go on from there."""
        runs = self.runs.runs
        broken = ~self._universe.node(conjunct)
        if conjunct.class_ is Class.INIT:
            return runs.system.init & self._invariant() & broken != runs.manager.false
        if has_primes(conjunct.formula):
            return runs.reachable & runs.before_by(runs.manager.true, broken) != runs.manager.false
        return runs.reachable & self._invariant() & broken != runs.manager.false

    def _invariant(self) -> Node:
        """What the facts say of each step alone."""
        found = self._universe.manager.true
        for one in self.facts:
            if one.class_ is Class.SAFETY and not has_primes(one.formula):
                found = found & self._universe.node(one)
        return found


def discharge(composite: Composite, given: Iterable[Conjunct], universe: Universe) -> Discharge:
    """Establish as many parts as can be, from what is given and how they are wired.

    The contracts are in GR(1). Raises OutsideGr1Error, LimitError.
    """
    parts = composite.parts
    reading = {one: _read_at_once(one, composite, universe) for one in parts}
    known, waiting, stepwise = (
        _Known(universe, (*given, *composite.wiring)),
        list(parts),
        list(parts),
    )
    while True:
        ready = [part for part in waiting if known.gives(part.contract.assumptions)]
        together = [] if ready else _together(stepwise, reading, known)
        if not ready and not together:
            return Discharge(known.facts, tuple(_open(waiting, known)))
        known = known.adding(one for part in ready for one in part.contract.guarantees)
        known = known.adding(one for part in together for one in _stepwise(part, is_assumed=False))
        waiting = [part for part in waiting if part not in ready]
        stepwise = [part for part in stepwise if part not in (*ready, *together)]


def _read_at_once(part: Part, composite: Composite, universe: Universe) -> list[Part]:
    """The parts on whose outputs of a step depends what this one does in the same step."""
    read = read_at_once(part.contract, universe)
    wired = [{v.name for v in f.variables(one.formula)} for one in composite.wiring]
    heard = read.union(*(names for names in wired if names & read))
    return [one for one in composite.parts if one != part and heard & outputs(one)]


def _stepwise(part: Part, is_assumed: bool) -> list[Conjunct]:
    """What a part assumes or promises at first and in each step."""
    contract = part.contract
    every = contract.assumptions if is_assumed else contract.guarantees
    return [one for one in every if one.class_ in (Class.INIT, Class.SAFETY)]


def _together(
    parts: Sequence[Part], reading: Mapping[Part, Sequence[Part]], known: _Known
) -> list[Part]:
    """The most parts whose safety holds step by step when all of them keep theirs."""
    among = {part: [one for one in reading[part] if one in parts] for part in parts}
    chosen = [part for part in parts if not _waits_for_itself(part, among)]
    while chosen:
        steps = known.adding(one for part in chosen for one in _stepwise(part, is_assumed=False))
        kept = [
            part
            for part in chosen
            if not any(steps.can_break(one) for one in _stepwise(part, is_assumed=True))
        ]
        if len(kept) == len(chosen):
            break
        chosen = kept
    return chosen


def _waits_for_itself(part: Part, reading: Mapping[Part, Sequence[Part]]) -> bool:
    """Whether what a part does in a step depends in the same step on what it does."""
    seen: list[Part] = []
    found = list(reading.get(part, ()))
    while found:
        one = found.pop()
        if one == part:
            return True
        if one not in seen:
            seen.append(one)
            found += reading.get(one, ())
    return False


def outputs(part: Part) -> set[str]:
    """The variables that the part decides."""
    return {one.name for one in part.contract.variables if one.owner is Owner.SYSTEM}


def _open(waiting: Sequence[Part], known: _Known) -> Iterable[Open]:
    """What is missing for the parts that are not established."""
    for part in waiting:
        others = (one for other in waiting if other != part for one in other.contract.guarantees)
        around = known.adding((*others, *_stepwise(part, is_assumed=False)))
        for one in part.contract.assumptions:
            if not known.gives([one]):
                yield Open(part, one, around.runs.violation(one))
