"""Proof that robots, environment and mission together satisfy C_S (MOOD4I thesis, 4.3).

Each conjunct of C_S is about one robot or two. It is checked against the guarantees about these
robots only, which is sound: what follows from fewer guarantees follows from all. Conjuncts that
some contract guarantees literally need no search. If a conjunct does not follow, a counterexample
is searched with as few robots as possible. The other robots are added at rest (``run_extension``),
and the complete run is checked against all contracts (decision 38).
"""

from collections.abc import Callable, Iterator, Sequence

from msgspec import Struct
from msgspec.structs import replace

from sysmlc.logic import formula as f
from sysmlc.logic.contract import Class, Conjunct, Contract, Part
from sysmlc.logic.formula import has_primes
from sysmlc.robots import contract_terms as terms
from sysmlc.robots.joint_contracts import (
    JointContracts,
    liveness_conjuncts,
    mission_guarantees,
    never_sent,
    safety_conjuncts,
)
from sysmlc.robots.run_extension import extend_to_all_robots, satisfies_contract, violated_conjuncts
from sysmlc.robots.study import Robot, Study
from sysmlc.synthesis.algebra.discharge import Recurrence
from sysmlc.synthesis.algebra.fair_systems import Runs, Trace, Universe, build_lasso, shortest_path
from sysmlc.synthesis.algebra.refinement import Entailment
from sysmlc.synthesis.bdd.manager import Manager


class Counterexample(Struct, frozen=True):
    """A conjunct that is not proven, with a run that violates it."""

    conjunct: Conjunct
    run: Trace | None
    """A run of all robots; None if no violating run was found."""


class JointProof:
    """Proof that C_R of all robots and C_E imply C_S, for the targets of any mission."""

    def __init__(self, study: Study, new_manager: Callable[[], Manager]) -> None:
        """Build the contracts of *study*, whose robots may start in any cell."""
        self.study, self.new_manager = study, new_manager
        self.contracts = JointContracts(study)
        self._step_conjuncts = {
            (conjunct.class_, conjunct.formula) for conjunct in self.contracts.steps()
        }
        self._runs_by_robots: dict[tuple[Robot, ...], tuple[Universe, Runs]] = {}

    # -- safety --------------------------------------------------------------------------------

    def find_safety_failure(self) -> Counterexample | None:
        """Return an initial or safety conjunct that is not proven, or None if all are.

        The conjuncts are the assumptions of C_R and C_E about each other, and the guarantees of
        C_S.
        """
        # The assumptions may be proven from guarantees that depend on them, by induction over
        # steps: in each step the environment first reacts to the previous step, then targets are
        # assigned, then robots answer, so no output depends on itself within a step.
        parts = self.contracts.parts
        assumptions = (
            conjunct for part in parts for conjunct in safety_conjuncts(part.assumptions)
        )
        for conjunct in (*assumptions, *safety_conjuncts(self.contracts.system.guarantees)):
            if not self._is_proven(conjunct):
                return Counterexample(conjunct, self._find_violation(conjunct))
        return None

    def _is_proven(self, conjunct: Conjunct) -> bool:
        if (conjunct.class_, conjunct.formula) in self._step_conjuncts:
            return True
        is_state_predicate = conjunct.class_ is Class.SAFETY and not has_primes(conjunct.formula)
        if is_state_predicate and all(map(self._is_proven, _induction_obligations(conjunct))):
            return True
        return self._is_entailed(conjunct)

    def _is_entailed(self, conjunct: Conjunct) -> bool:
        """Whether the guarantees about the robots of the conjunct entail it."""
        robots = self.contracts.robots_of(conjunct)
        if robots is None:
            return False
        universe, runs = self._runs_of(robots)
        nothing = runs.manager.false
        with runs.manager.guard():
            violation = ~universe.node(conjunct)
            if conjunct.class_ is Class.INIT:
                return runs.system.init & violation == nothing
            if not has_primes(conjunct.formula):
                return runs.reachable & violation == nothing
            # Compute the reachable states only if some step, reachable or not, is a violation.
            states = runs.predecessors(runs.manager.true, violation)
            return states == nothing or runs.reachable & states == nothing

    def _runs_of(self, robots: tuple[Robot, ...]) -> tuple[Universe, Runs]:
        """Return the runs that satisfy the guarantees about only these robots; memoised."""
        if robots not in self._runs_by_robots:
            contract, facts = self.contracts.restrict_to(robots)
            manager = self.new_manager()
            with manager.guard():
                universe = Universe((contract,), manager)
                self._runs_by_robots[robots] = universe, Runs(universe.system(facts))
        return self._runs_by_robots[robots]

    def _find_violation(self, conjunct: Conjunct) -> Trace | None:
        """Return a run of all robots that satisfies the contracts but not *conjunct*."""
        for robots in self._iter_groups(conjunct):
            group = _RobotGroup(replace(self.study, robots=robots), self.new_manager())
            run = group.find_violation(conjunct)
            extended_run = (
                None if run is None else self._extend_to_counterexample(robots, run, conjunct)
            )
            if extended_run is not None:
                return extended_run
        return None

    # -- liveness ------------------------------------------------------------------------------

    def find_offer_failure(self) -> Counterexample | None:
        """Return a violation of C_R's assumption about offers; None if the assumption is entailed.

        The assumption is that a direction nearer to the target is offered infinitely often. Raises
        UndecidedError if a violation was neither found nor excluded.
        """
        (conjunct,) = liveness_conjuncts(self.contracts.robots[0].assumptions)
        for robots in self._iter_groups(conjunct):
            # Resting robots suffice for most counterexamples, and are explored quickly.
            for others_stay in (True, False):
                group = _RobotGroup(replace(self.study, robots=robots), self.new_manager())
                constraints = (
                    *group.mission_conjuncts,
                    *(group.resting_conjuncts if others_stay else ()),
                )
                run = group.find_run_without_offers(conjunct, constraints)
                extended_run = (
                    None if run is None else self._extend_to_counterexample(robots, run, conjunct)
                )
                if extended_run is not None:
                    return Counterexample(conjunct, extended_run)
        # Only a search with all robots, and without an assumption about the mission, can exclude a
        # violation.
        if run is None and group.find_run_without_offers(conjunct, ()) is None:
            return None
        raise UndecidedError(conjunct)

    def find_liveness_failure(self) -> Counterexample | None:
        """Return a liveness guarantee of C_S that is not literally one of C_R, or None."""
        robot_guarantees = [
            guarantee
            for part in self.contracts.robots
            for guarantee in liveness_conjuncts(part.guarantees)
        ]
        guaranteed_formulas = {guarantee.formula for guarantee in robot_guarantees}
        system_guarantees = liveness_conjuncts(self.contracts.system.guarantees)
        missing_guarantees = (
            Counterexample(guarantee, None)
            for guarantee in system_guarantees
            if guarantee.formula not in guaranteed_formulas
        )
        return next(missing_guarantees, None)

    def _iter_groups(self, conjunct: Conjunct) -> Iterator[tuple[Robot, ...]]:
        """Yield growing groups of robots, beginning with those that the conjunct is about."""
        affected_robots = self.contracts.robots_of(conjunct) or ()
        all_robots = (
            *affected_robots,
            *(robot for robot in self.study.robots if robot not in affected_robots),
        )
        return (
            all_robots[:count] for count in range(max(1, len(affected_robots)), len(all_robots) + 1)
        )

    def _extend_to_counterexample(
        self, robots: Sequence[Robot], run: Trace, broken: Conjunct
    ) -> Trace | None:
        """Return an extension of the run to all robots that is a counterexample, or None.

        It must satisfy all contracts and violate *broken*.
        """
        extended_runs = (
            extended_run
            for extended_run in extend_to_all_robots(self.study, robots, run)
            if self._satisfies_contracts(extended_run, broken)
        )
        return next(
            (
                extended_run
                for extended_run in extended_runs
                if any(violated_conjuncts(extended_run, (broken,)))
            ),
            None,
        )

    def _satisfies_contracts(self, run: Trace, broken: Conjunct) -> bool:
        """Whether a run satisfies the contracts, apart from the assumption *broken*."""
        contracts = self.contracts
        assumptions = (
            *contracts.wiring,
            *mission_guarantees(self.study),
            *contracts.environment.assumptions,
        )
        holds_assumptions = not any(
            violated_conjuncts(run, (conjunct for conjunct in assumptions if conjunct != broken))
        )
        return holds_assumptions and all(
            satisfies_contract(run, contract) for contract in contracts.parts
        )

    # -- travel time ---------------------------------------------------------------------------

    def find_endless_travel(self) -> Trace | None:
        """Return a run in which a robot never reaches its target; None if there is none."""
        robot = self.study.robots[0]
        contract, facts = self.contracts.restrict_to((robot,))
        manager = self.new_manager()
        with manager.guard():
            universe = Universe((contract,), manager)
            runs = Runs(
                universe.system((*facts, *mission_guarantees(replace(self.study, robots=(robot,)))))
            )
            away = universe.symbols.bdd(terms.is_away_from_target(robot))
            states = runs.fair_within(runs.reachable & away)
            if states == manager.false:
                return None
            run = build_lasso(runs, shortest_path(runs, states), states)
        return next(extend_to_all_robots(self.study, (robot,), run))


class UndecidedError(Exception):
    """Reports a conjunct that was neither proven nor refuted by a run."""

    def __init__(self, conjunct: Conjunct) -> None:
        super().__init__(f"no run was found, and none excluded, that breaks: {conjunct.text}")


class _RobotGroup:
    """Some robots with all contracts about them, to search for a counterexample."""

    def __init__(self, study: Study, manager: Manager) -> None:
        self.study, self.manager = study, manager
        self.contracts = JointContracts(study)
        contract, facts = self.contracts.restrict_to(study.robots)
        liveness_guarantees = liveness_conjuncts(self.contracts.environment.guarantees)
        if len(study.robots) > 1:
            # With one robot a cell is free if the robot is not in it: no variables are needed.
            contract = Contract("", "", tuple(self.contracts.variables.values()), (), ())
            facts = [*self.contracts.steps()]
        self.facts = (*facts, *liveness_guarantees)
        self.mission_conjuncts = [*mission_guarantees(study)]
        self.resting_conjuncts = [terms.forbid_moves(robot) for robot in study.robots]
        self.resting_conjuncts += [never_sent(robot) for robot in study.robots[1:]]
        with manager.guard():
            self.universe = Universe((contract,), manager)

    def find_violation(self, conjunct: Conjunct) -> Trace | None:
        """Return a run that violates *conjunct* and in which all liveness conjuncts hold."""
        robot_conjuncts = (
            conjunct
            for part in self.contracts.robots
            for conjunct in (*part.assumptions, *part.guarantees)
        )
        with self.manager.guard():
            system = self.universe.system(
                (*self.facts, *self.mission_conjuncts, *liveness_conjuncts(robot_conjuncts))
            )
            return Entailment(self.universe, system).find_violation(conjunct)

    def find_run_without_offers(
        self, conjunct: Conjunct, additional_facts: Sequence[Conjunct]
    ) -> Trace | None:
        """Return a run in which *conjunct* (offers recur) is violated although C_R holds.

        A robot without recurring offers need not reach its targets.
        """
        facts = (*self.facts, *additional_facts)
        parts = [
            Part(contract.component, contract, contract.origin)
            for contract in self.contracts.robots
        ]
        with self.manager.guard():
            runs = Runs(self.universe.system(facts))
            return Recurrence(runs, parts, self.universe).find_violation(conjunct)


def _induction_obligations(conjunct: Conjunct) -> tuple[Conjunct, Conjunct]:
    """Return the obligations of an induction: *conjunct* holds initially and in each next step."""
    next_formula = f.prime(conjunct.formula)
    return replace(conjunct, class_=Class.INIT), replace(conjunct, formula=next_formula)
