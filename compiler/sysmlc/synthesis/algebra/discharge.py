"""Which parts of a composition can be relied on: what each assumes follows from what others keep.

A part keeps its promises once its assumptions follow from what holds already. Parts that wait for
one another are taken together, step by step: when no run of steps that all of them keep comes to
one that breaks an assumption of theirs, none of them is the first to fail (Misra and Chandy 1981;
Abadi and Lamport 1993). That is sound for initial conditions and safety, of parts that do not
read in the same step what they write for one another. What recurs is looked for in the runs in
which each part keeps its promise (``recurrence``): parts that only wait for one another wait for
ever.
"""

from collections.abc import Iterable, Iterator, Sequence
from itertools import product
from math import prod

from msgspec import Struct
from msgspec.structs import replace

from sysmlc.logic.contract import Class, Composite, Conjunct, Owner, Part
from sysmlc.logic.evaluate import has_primes
from sysmlc.synthesis.algebra.fair_systems import Runs, Universe
from sysmlc.synthesis.algebra.instantaneous_dependencies import Readings, readings
from sysmlc.synthesis.algebra.refinement import Entailment
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


class Open(Struct, frozen=True):
    """An assumption of a part that does not follow from what holds around it.

    With ``is_circular`` it does follow from what the others promise, but they wait for this part
    in turn. ``trace`` is a run in which it is broken, and all others keep their contracts; None
    where there is no such run, but no proof that it cannot be broken either.
    """

    part: Part
    conjunct: Conjunct
    trace: Trace | None
    is_circular: bool


class Discharge(Struct, frozen=True):
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

    def recurrence(self, parts: Sequence[Part]) -> Recurrence:
        """What recurs when these parts keep what they promise to recur, too."""
        return Recurrence(self.runs.runs, parts, self._universe)

    def can_break(self, conjunct: Conjunct, own: Iterable[Conjunct] = ()) -> bool:
        """Whether steps that keep all facts come to one that breaks an initial condition or a
        condition of every step, however it may go on from there.

        In that step whoever assumes the condition need not keep ``own``: it owes nothing then.
        """
        last = _Known(self._universe, (one for one in self.facts if one not in set(own)))
        runs, then = self.runs.runs, last.runs.runs
        broken, kept = ~self._universe.node(conjunct), last._invariant()
        if conjunct.class_ is not Class.INIT and has_primes(conjunct.formula):
            return runs.reachable & then.before_by(kept, broken) != runs.manager.false
        begins = then.system.init & kept & broken != runs.manager.false
        if begins or conjunct.class_ is Class.INIT:
            return begins
        return (
            runs.reachable & then.before_by(kept & broken, runs.manager.true) != runs.manager.false
        )

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
    reading = readings(composite, universe)
    known = _Known(universe, (*given, *composite.wiring))
    waiting = stepwise = composite.parts
    while True:
        found = _established(waiting, stepwise, known, reading)
        if not found:
            return Discharge(known.facts, tuple(_open(waiting, stepwise, known, reading)))
        done, steady = found
        known = known.adding(one for part in done for one in part.contract.guarantees)
        known = known.adding(one for part in steady for one in _stepwise(part, is_assumed=False))
        waiting = tuple(part for part in waiting if part not in done)
        stepwise = tuple(part for part in stepwise if part not in (*done, *steady))


_Parts = Sequence[Part]


def _established(
    waiting: _Parts, stepwise: _Parts, known: "_Known", reading: Readings
) -> tuple[_Parts, _Parts] | None:
    """The next parts that keep all they promise, or what they promise of each step.

    First one by one, then steps of several, then what recurs when all wait for something.
    """
    done = [part for part in waiting if known.gives(part.contract.assumptions)]
    if done:
        return done, ()
    steady = [part for part in stepwise if known.gives(_stepwise(part, is_assumed=True))]
    steady = steady or _together(stepwise, reading, known)
    if steady:
        return (), steady
    done = _recurring([part for part in waiting if part not in stepwise], known)
    return (done, ()) if done else None


def _recurring(parts: _Parts, known: "_Known") -> list[Part]:
    """Those whose assumptions recur in all runs in which all of them keep their promises."""
    recurrence = known.recurrence(parts)
    if not recurrence.is_decided:
        return []
    return [
        part
        for part in parts
        if not any(recurrence.violation(one) for one in _liveness(part.contract.assumptions))
    ]


def _liveness(conjuncts: Iterable[Conjunct]) -> list[Conjunct]:
    return [one for one in conjuncts if one.class_ is Class.LIVENESS]


def _stepwise(part: Part, is_assumed: bool) -> list[Conjunct]:
    """What a part assumes or promises at first and in each step."""
    contract = part.contract
    every = contract.assumptions if is_assumed else contract.guarantees
    return [one for one in every if one.class_ in (Class.INIT, Class.SAFETY)]


def _together(parts: Sequence[Part], reading: Readings, known: _Known) -> list[Part]:
    """The most parts whose safety holds step by step when all of them keep theirs."""
    circular = reading.circular(parts)
    chosen = [part for part in parts if part not in circular]
    while chosen:
        steps = known.adding(one for part in chosen for one in _stepwise(part, is_assumed=False))
        kept = [
            part
            for part in chosen
            if not any(
                _breaks_first(part, one, steps, reading) for one in _stepwise(part, is_assumed=True)
            )
        ]
        if len(kept) == len(chosen):
            break
        chosen = kept
    return chosen


def _breaks_first(part: Part, assumed: Conjunct, steps: _Known, reading: Readings) -> bool:
    """Whether the others, keeping their steps, can be the first to break what a part assumes.

    Outputs that the part chooses before it sees any input of the step it chooses as it has to.
    """
    return steps.can_break(assumed, reading.seeing(part))


def outputs(part: Part) -> set[str]:
    """The variables that the part decides."""
    return {one.name for one in part.contract.variables if one.owner is Owner.SYSTEM}


def _open(waiting: _Parts, stepwise: _Parts, known: _Known, reading: Readings) -> Iterator[Open]:
    """What is missing for the parts that are not established.

    Of what several parts do step by step only what breaks first is told: with it, the rest holds.
    """
    circular = reading.circular(stepwise)
    ordered = [part for part in stepwise if part not in circular]
    steps = known.adding(one for part in ordered for one in _stepwise(part, is_assumed=False))
    steady = steps.adding(one for part in circular for one in _stepwise(part, is_assumed=False))
    recurrence = steady.recurrence(waiting)
    for part in waiting:
        others = (one for other in waiting if other != part for one in other.contract.guarantees)
        around = known.adding((*others, *_stepwise(part, is_assumed=False)))
        for one in part.contract.assumptions:
            recurs = one.class_ is Class.LIVENESS
            if known.gives([one]) or not (
                recurs or part in circular or _breaks_first(part, one, steps, reading)
            ):
                continue
            trace = around.runs.violation(one)
            is_circular = trace is None
            if is_circular and recurs and recurrence.is_decided:
                trace = recurrence.violation(one)
                if trace is None:
                    continue
            yield Open(part, one, trace, is_circular)
