"""Whether robots, environment and mission together keep C_S (MOOD4I thesis, 4.3), decided.

Each conjunct is about one robot or two, and is asked of what is promised of these alone: less is
promised then, so that what follows follows from all of it. What is the same word for word, or
holds at first and again in each step, needs no diagram. A run that fails is looked for with as
few robots as it takes; the others rest (``among``), and the run is held to all contracts.
"""

from collections.abc import Callable, Iterator, Sequence

from msgspec import Struct
from msgspec.structs import replace

from sysmlc.logic import formula as f
from sysmlc.logic.contract import Class, Conjunct, Contract, Part
from sysmlc.logic.evaluate import has_primes
from sysmlc.robots import contract_terms as words
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
from sysmlc.synthesis.algebra.fair_systems import Runs, Universe
from sysmlc.synthesis.algebra.refinement import Entailment
from sysmlc.synthesis.algebra.traces import Trace, build_lasso, shortest_path
from sysmlc.synthesis.bdd.manager import Manager


class Counterexample(Struct, frozen=True):
    """A conjunct that does not follow, and a run of all robots that shows it, if one was found."""

    conjunct: Conjunct
    run: Trace | None


class JointProof:
    """C_R of all robots, C_E and the targets of some mission, asked for what C_S promises."""

    def __init__(self, study: Study, new_manager: Callable[[], Manager]) -> None:
        """Robots of the study start anywhere."""
        self.study, self.new_manager = study, new_manager
        self.joined = JointContracts(study)
        self._steps = {(one.class_, one.formula) for one in self.joined.steps()}
        self._known: dict[tuple[Robot, ...], tuple[Universe, Runs]] = {}

    # -- what holds in each step ---------------------------------------------------------------

    def stepwise_failure(self) -> Counterexample | None:
        """What robots and environment assume of one another in a step, or C_S promises of one, and
        nothing gives; None when all of it follows.

        In a step the environment gives its outputs from what was before, then targets are given,
        then robots answer: nobody waits for what it gives itself, so that who keeps its promises
        up to a step finds its assumptions kept in it.
        """
        parts = self.joined.parts
        assumed = (one for part in parts for one in safety_conjuncts(part.assumptions))
        for conjunct in (*assumed, *safety_conjuncts(self.joined.system.guarantees)):
            if not self._follows(conjunct):
                return Counterexample(conjunct, self._breaking(conjunct))
        return None

    def _follows(self, conjunct: Conjunct) -> bool:
        if (conjunct.class_, conjunct.formula) in self._steps:
            return True
        is_state = conjunct.class_ is Class.SAFETY and not has_primes(conjunct.formula)
        if is_state and all(map(self._follows, _induction_obligations(conjunct))):
            return True
        return self._is_entailed(conjunct)

    def _is_entailed(self, conjunct: Conjunct) -> bool:
        """Whether it follows from what is promised of its robots: in any step, else in any that
        can be reached."""
        robots = self.joined.about(conjunct)
        if robots is None:
            return False
        universe, runs = self._alone(robots)
        none = runs.manager.false
        with runs.manager.guard():
            broken = ~universe.node(conjunct)
            if conjunct.class_ is Class.INIT:
                return runs.system.init & broken == none
            if not has_primes(conjunct.formula):
                return runs.reachable & broken == none
            found = runs.predecessors_by(runs.manager.true, broken)
            return found == none or runs.reachable & found == none

    def _alone(self, robots: tuple[Robot, ...]) -> tuple[Universe, Runs]:
        """The steps of some robots, with what is promised of these alone."""
        if robots not in self._known:
            contract, facts = self.joined.only(robots)
            manager = self.new_manager()
            with manager.guard():
                universe = Universe((contract,), manager)
                self._known[robots] = universe, Runs(universe.system(facts))
        return self._known[robots]

    def _breaking(self, conjunct: Conjunct) -> Trace | None:
        """A run in which ways that lead nearer are offered again and again, and a promise of C_S is
        not kept."""
        for few in self._groups(conjunct):
            group = _RobotGroup(replace(self.study, robots=few), self.new_manager())
            run = group.find_violation(conjunct)
            full = None if run is None else self._checked(few, run, conjunct)
            if full is not None:
                return full
        return None

    # -- what holds again and again ------------------------------------------------------------

    def offered_failure(self) -> Counterexample | None:
        """That a way which leads nearer is offered to a robot again and again, as it assumes, if
        it does not follow: with a run in which the robot does not reach its target.

        Raises UndecidedError where no such run was found, and none excluded.
        """
        (conjunct,) = liveness_conjuncts(self.joined.robots[0].assumptions)
        for few in self._groups(conjunct):
            # Robots that stay are enough for most runs, and are explored at once.
            for is_still in (True, False):
                group = _RobotGroup(replace(self.study, robots=few), self.new_manager())
                goals = (*group.goals, *(group.stays if is_still else ()))
                run = group.unoffered(conjunct, goals)
                full = None if run is None else self._checked(few, run, conjunct)
                if full is not None:
                    return Counterexample(conjunct, full)
        if run is None and group.unoffered(conjunct, ()) is None:
            return None
        raise UndecidedError(conjunct)

    def recurring_failure(self) -> Counterexample | None:
        """What C_S promises to recur, and no robot promises word for word."""
        promised = [
            one for part in self.joined.robots for one in liveness_conjuncts(part.guarantees)
        ]
        known = {one.formula for one in promised}
        wanted = liveness_conjuncts(self.joined.system.guarantees)
        missing = (Counterexample(one, None) for one in wanted if one.formula not in known)
        return next(missing, None)

    def _groups(self, conjunct: Conjunct) -> Iterator[tuple[Robot, ...]]:
        """The robots that a conjunct is about, then with one more, and so on."""
        first = self.joined.about(conjunct) or ()
        every = (*first, *(one for one in self.study.robots if one not in first))
        return (every[:count] for count in range(max(1, len(first)), len(every) + 1))

    def _checked(self, few: Sequence[Robot], run: Trace, broken: Conjunct) -> Trace | None:
        """The run with all robots; None where it is no run of all contracts that breaks it."""
        full = (
            one for one in extend_to_all_robots(self.study, few, run) if self._is_run(one, broken)
        )
        return next((one for one in full if any(violated_conjuncts(one, (broken,)))), None)

    def _is_run(self, run: Trace, broken: Conjunct) -> bool:
        """Whether robots, environment and mission keep all that they promise in a run."""
        joined = self.joined
        given = (*joined.wiring, *mission_guarantees(self.study), *joined.environment.assumptions)
        is_given = not any(violated_conjuncts(run, (one for one in given if one != broken)))
        return is_given and all(satisfies_contract(run, one) for one in joined.parts)

    # -- how long it takes ---------------------------------------------------------------------

    def find_endless_travel(self) -> Trace | None:
        """Steps in which a robot may go on for any time without coming to its target; None when it
        is always there in a known time."""
        robot = self.study.robots[0]
        contract, facts = self.joined.only((robot,))
        manager = self.new_manager()
        with manager.guard():
            universe = Universe((contract,), manager)
            runs = Runs(
                universe.system((*facts, *mission_guarantees(replace(self.study, robots=(robot,)))))
            )
            away = universe.symbols.bdd(words.away(robot))
            found = runs.fair_within(runs.reachable & away)
            if found == manager.false:
                return None
            run = build_lasso(runs, shortest_path(runs, found), found)
        return next(extend_to_all_robots(self.study, (robot,), run))


class UndecidedError(Exception):
    """A conjunct does not follow by what was tried, and no run shows that it does not hold."""

    def __init__(self, conjunct: Conjunct) -> None:
        super().__init__(f"no run was found, and none excluded, that breaks: {conjunct.text}")


class _RobotGroup:
    """Some robots, the first of which is asked about, with the whole environment of these."""

    def __init__(self, study: Study, manager: Manager) -> None:
        self.study, self.manager = study, manager
        self.joined = JointContracts(study)
        contract, facts = self.joined.only(study.robots)
        promised = liveness_conjuncts(self.joined.environment.guarantees)
        if len(study.robots) > 1:
            # With one robot a cell is free when the robot is not in it: nothing depends on it.
            contract = Contract("", "", tuple(self.joined.variables.values()), (), ())
            facts = [*self.joined.steps()]
        self.facts = (*facts, *promised)
        self.goals = [*mission_guarantees(study)]
        self.stays = [words.stays(one) for one in study.robots]
        self.stays += [never_sent(one) for one in study.robots[1:]]
        with manager.guard():
            self.universe = Universe((contract,), manager)

    def find_violation(self, conjunct: Conjunct) -> Trace | None:
        """A run in which robots are offered ways again and again, and reach their targets."""
        every = (
            one for part in self.joined.robots for one in (*part.assumptions, *part.guarantees)
        )
        with self.manager.guard():
            system = self.universe.system((*self.facts, *self.goals, *liveness_conjuncts(every)))
            return Entailment(self.universe, system).find_violation(conjunct)

    def unoffered(self, conjunct: Conjunct, more: Sequence[Conjunct]) -> Trace | None:
        """A run in which all robots keep their contracts, and what is assumed does not recur."""
        facts = (*self.facts, *more)
        parts = [Part(one.component, one, one.origin) for one in self.joined.robots]
        with self.manager.guard():
            runs = Runs(self.universe.system(facts))
            return Recurrence(runs, parts, self.universe).find_violation(conjunct)


def _induction_obligations(conjunct: Conjunct) -> tuple[Conjunct, Conjunct]:
    """That a condition holds at first, and in each next step."""
    after = f.primed(conjunct.formula)
    return replace(conjunct, class_=Class.INIT), replace(conjunct, formula=after)
