"""Discharge of the assumptions of parts by the guarantees of other parts in a composition.

Initial and safety assumptions are discharged by induction over the steps of a run, also if parts
assume safety of one another: no part is the first to fail (Misra and Chandy 1981; Abadi and Lamport
1993). For liveness, each part guarantees that its liveness guarantees recur if its liveness
assumptions do. A run satisfies this if, for each part, some assumption stops recurring or every
guarantee recurs. That is a Streett condition; the check enumerates its cases.
"""

from collections.abc import Iterable, Iterator, Sequence
from functools import cached_property
from itertools import product
from math import prod

from msgspec import Struct
from msgspec.structs import replace

from sysmlc.logic.contract import Class, Composite, Conjunct, Owner, Part, select_classes
from sysmlc.logic.formula import has_primes
from sysmlc.synthesis.algebra.fair_systems import Runs, Trace, Universe, build_lasso, shortest_path
from sysmlc.synthesis.algebra.instantaneous_dependencies import (
    DependencyGraph,
    build_dependency_graph,
)
from sysmlc.synthesis.algebra.refinement import Entailment
from sysmlc.synthesis.bdd.manager import Node

MAX_CASES = 256
"""Cases of the Streett condition above which recurrence is not examined (decision 31)."""


class StreettCase(Struct, frozen=True):
    """One case of a Streett condition: conditions recur, and the run finally stays in a set."""

    recurring: tuple[Node, ...]
    stay: Node


class Recurrence:
    """The runs of a system in which parts satisfy their liveness guarantees."""

    def __init__(self, runs: Runs, parts: Sequence[Part], universe: Universe) -> None:
        """*runs* must satisfy the safety guarantees of the parts."""
        self._runs = runs
        self._universe = universe
        self._cases = [tuple(self._cases_of(part)) for part in parts]

    @property
    def is_decided(self) -> bool:
        """Whether there are few enough cases to examine."""
        return prod(map(len, self._cases)) <= MAX_CASES

    def find_violation(self, conjunct: Conjunct) -> Trace | None:
        """Return a run in which a conjunct does not recur, or None if there is none."""
        violation = ~self._universe.node(conjunct)
        for cases in product(*self._cases):
            stay = violation & self._runs.manager.conjoin(case.stay for case in cases)
            trace = self._find_run(tuple(goal for case in cases for goal in case.recurring), stay)
            if trace is not None:
                return trace
        return None

    def _find_run(self, recurring: tuple[Node, ...], stay: Node) -> Trace | None:
        """Return a run that stays in *stay* from some step on and satisfies *recurring* as well.

        None if there is no such run.
        """
        system = self._runs.system
        runs = Runs(replace(system, fairness=(*system.fairness, *recurring)))
        states = runs.fair_within(self._runs.reachable & stay)
        if states == runs.manager.false:
            return None
        return build_lasso(runs, shortest_path(runs, states), states)

    def _cases_of(self, part: Part) -> Iterator[StreettCase]:
        """Yield the ways in which a part satisfies its liveness guarantees."""
        true = self._runs.manager.true
        guarantees = self._liveness_nodes(part.contract.guarantees)
        yield StreettCase(guarantees, true)
        if guarantees:
            for assumption in self._liveness_nodes(part.contract.assumptions):
                yield StreettCase((), ~assumption)

    def _liveness_nodes(self, conjuncts: Sequence[Conjunct]) -> tuple[Node, ...]:
        return tuple(map(self._universe.node, select_classes(conjuncts, Class.LIVENESS)))


class OpenAssumption(Struct, frozen=True):
    """An assumption of a part that its surroundings do not entail.

    If ``is_circular``, guarantees of the other parts entail the assumption, but these parts assume
    something of this part in turn. ``trace`` is a run that violates the assumption while all other
    parts satisfy their contracts; None if the search neither found nor excluded such a run.
    """

    part: Part
    conjunct: Conjunct
    trace: Trace | None
    is_circular: bool


class Discharge(Struct, frozen=True):
    """The conjuncts that hold in every run of the composition, and the open assumptions."""

    facts: tuple[Conjunct, ...]
    open: tuple[OpenAssumption, ...]


class _Facts:
    """Conjuncts that are established for every run of the composition, to derive others from."""

    def __init__(self, universe: Universe, facts: Iterable[Conjunct]) -> None:
        self._universe = universe
        self.facts = tuple(dict.fromkeys(facts))

    def extended_by(self, conjuncts: Iterable[Conjunct]) -> "_Facts":
        """Return the facts with additional conjuncts."""
        return _Facts(self._universe, (*self.facts, *conjuncts))

    @cached_property
    def runs(self) -> Entailment:
        """The runs in which all facts hold."""
        return Entailment(self._universe, self._universe.system(self.facts))

    def entails(self, conjuncts: Iterable[Conjunct]) -> bool:
        """Return whether all conjuncts hold in every run."""
        new_conjuncts = [conjunct for conjunct in conjuncts if conjunct not in self.facts]
        return all(self.runs.find_violation(conjunct) is None for conjunct in new_conjuncts)

    def recurrence(self, parts: Sequence[Part]) -> Recurrence:
        """Return the runs of the facts in which *parts* also satisfy their liveness guarantees."""
        return Recurrence(self.runs.runs, parts, self._universe)

    def can_break(self, conjunct: Conjunct, own_guarantees: Iterable[Conjunct] = ()) -> bool:
        """Whether a run of the facts can reach a step that violates *conjunct*.

        *conjunct* is an initial or a safety condition. The run need not continue after the
        violation. In the violating step *own_guarantees* need not hold: a part that has seen its
        assumption violated is released from them.
        """
        # Facts are kept in all steps before the violating one, without which a guarantee about
        # inputs would prove the assumption about the same inputs.
        facts_of_last_step = _Facts(
            self._universe, (fact for fact in self.facts if fact not in set(own_guarantees))
        )
        runs_before, runs_of_last_step = self.runs.runs, facts_of_last_step.runs.runs
        violation, invariant = ~self._universe.node(conjunct), facts_of_last_step._invariant()
        if conjunct.class_ is not Class.INIT and has_primes(conjunct.formula):
            return (
                runs_before.reachable & runs_of_last_step.predecessors(invariant, violation)
                != runs_before.manager.false
            )
        can_begin = (
            runs_of_last_step.system.init & invariant & violation != runs_before.manager.false
        )
        if can_begin or conjunct.class_ is Class.INIT:
            return can_begin
        return (
            runs_before.reachable & runs_of_last_step.predecessors(invariant & violation)
            != runs_before.manager.false
        )

    def _invariant(self) -> Node:
        """Return the conjunction of the facts about a single step."""
        return self._universe.manager.conjoin(
            self._universe.node(fact)
            for fact in self.facts
            if fact.class_ is Class.SAFETY and not has_primes(fact.formula)
        )


def discharge(
    composite: Composite, assumptions: Iterable[Conjunct], universe: Universe
) -> Discharge:
    """Establish as many parts as possible, starting with *assumptions* and the wiring.

    A part is established if its assumptions are entailed; its guarantees are facts from then on.
    The contracts must be in GR(1). Raises OutsideGr1Error, LimitError.
    """
    dependencies = build_dependency_graph(composite, universe)
    facts = _Facts(universe, (*assumptions, *composite.wiring))
    open_parts = unsafe_parts = composite.parts
    while True:
        established = _next_established(open_parts, unsafe_parts, facts, dependencies)
        if not established:
            return Discharge(
                facts.facts,
                tuple(_find_open_assumptions(open_parts, unsafe_parts, facts, dependencies)),
            )
        complete, safe = established
        facts = facts.extended_by(
            conjunct for part in complete for conjunct in part.contract.guarantees
        )
        facts = facts.extended_by(
            conjunct for part in safe for conjunct in _safety_conjuncts(part, is_assumed=False)
        )
        open_parts = tuple(part for part in open_parts if part not in complete)
        unsafe_parts = tuple(part for part in unsafe_parts if part not in (*complete, *safe))


_PartSequence = Sequence[Part]


def _next_established(
    open_parts: _PartSequence,
    unsafe_parts: _PartSequence,
    facts: "_Facts",
    dependencies: DependencyGraph,
) -> tuple[_PartSequence, _PartSequence] | None:
    """Return the parts that are established next: completely, and for their safety only.

    None if no further part can be established.
    """
    # In the order of cost: entailment for one part alone, induction over a set of parts, and the
    # Streett cases, which are needed if the remaining parts wait for the liveness of one another.
    complete = [part for part in open_parts if facts.entails(part.contract.assumptions)]
    if complete:
        return complete, ()
    safe = [
        part for part in unsafe_parts if facts.entails(_safety_conjuncts(part, is_assumed=True))
    ]
    safe = safe or _largest_inductive_set(unsafe_parts, dependencies, facts)
    if safe:
        return (), safe
    complete = _parts_with_recurring_assumptions(
        [part for part in open_parts if part not in unsafe_parts], facts
    )
    return (complete, ()) if complete else None


def _parts_with_recurring_assumptions(parts: _PartSequence, facts: "_Facts") -> list[Part]:
    """Return the parts whose liveness assumptions recur in all runs that satisfy all *parts*."""
    recurrence = facts.recurrence(parts)
    if not recurrence.is_decided:
        return []
    return [
        part
        for part in parts
        if not any(
            recurrence.find_violation(conjunct)
            for conjunct in select_classes(part.contract.assumptions, Class.LIVENESS)
        )
    ]


def _safety_conjuncts(part: Part, is_assumed: bool) -> tuple[Conjunct, ...]:
    """Return the initial and safety conjuncts that a part assumes or guarantees."""
    contract = part.contract
    conjuncts = contract.assumptions if is_assumed else contract.guarantees
    return select_classes(conjuncts, Class.INIT, Class.SAFETY)


def _largest_inductive_set(
    parts: Sequence[Part], dependencies: DependencyGraph, facts: _Facts
) -> list[Part]:
    """Return the largest set of parts of which none can be the first to violate safety.

    That is a greatest fixpoint: parts whose assumptions the others can break are removed.
    """
    # Induction over steps is unsound for an output that depends on itself within a step.
    circular = dependencies.circular_parts(parts)
    candidates = [part for part in parts if part not in circular]
    while candidates:
        steps = facts.extended_by(
            conjunct
            for part in candidates
            for conjunct in _safety_conjuncts(part, is_assumed=False)
        )
        remaining = [
            part
            for part in candidates
            if not any(
                _breaks_first(part, conjunct, steps, dependencies)
                for conjunct in _safety_conjuncts(part, is_assumed=True)
            )
        ]
        if len(remaining) == len(candidates):
            break
        candidates = remaining
    return candidates


def _breaks_first(
    part: Part, assumption: Conjunct, steps: _Facts, dependencies: DependencyGraph
) -> bool:
    """Return whether *assumption* can be violated before any part violates a safety guarantee.

    In the violating step the part is released only from guarantees about outputs that depend on
    inputs of that step. All its other outputs are chosen before the violation is visible.
    """
    return steps.can_break(assumption, dependencies.guarantees_after_inputs(part))


def outputs_of(part: Part) -> set[str]:
    """Return the variables that the part assigns."""
    return {variable.name for variable in part.contract.variables if variable.owner is Owner.SYSTEM}


def _find_open_assumptions(
    open_parts: _PartSequence,
    unsafe_parts: _PartSequence,
    facts: _Facts,
    dependencies: DependencyGraph,
) -> Iterator[OpenAssumption]:
    """Yield the assumptions that prevent the remaining parts from being established.

    Of the safety assumptions, only those that can be violated first are open: if they held, the
    others would hold too.
    """
    circular = dependencies.circular_parts(unsafe_parts)
    acyclic = [part for part in unsafe_parts if part not in circular]
    steps = facts.extended_by(
        guarantee for part in acyclic for guarantee in _safety_conjuncts(part, is_assumed=False)
    )
    all_steps = steps.extended_by(
        guarantee for part in circular for guarantee in _safety_conjuncts(part, is_assumed=False)
    )
    recurrence = all_steps.recurrence(open_parts)
    for part in open_parts:
        other_guarantees = (
            guarantee
            for other_part in open_parts
            if other_part != part
            for guarantee in other_part.contract.guarantees
        )
        surroundings = facts.extended_by(
            (*other_guarantees, *_safety_conjuncts(part, is_assumed=False))
        )
        for assumption in part.contract.assumptions:
            is_liveness = assumption.class_ is Class.LIVENESS
            if facts.entails([assumption]) or not (
                is_liveness
                or part in circular
                or _breaks_first(part, assumption, steps, dependencies)
            ):
                continue
            trace = surroundings.runs.find_violation(assumption)
            # The guarantees of the other parts entail it, but these are no facts: their parts are
            # not established either.
            is_circular = trace is None
            if is_circular and is_liveness and recurrence.is_decided:
                trace = recurrence.find_violation(assumption)
                if trace is None:
                    continue
            yield OpenAssumption(part, assumption, trace, is_circular)
