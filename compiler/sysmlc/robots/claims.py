"""Decision of the claims about the four contracts of a floor (MOOD4I thesis, 4.3.2 to 4.3.4)."""

from collections.abc import Callable, Iterator, Mapping
from functools import partial
from operator import methodcaller

from msgspec import Struct
from msgspec.structs import replace

from sysmlc.logic.contract import Conjunct, Contract
from sysmlc.logic.formula import variable_names
from sysmlc.robots import contract_terms as terms
from sysmlc.robots.environment_contract import environment_contract
from sysmlc.robots.joint_proof import Counterexample, JointProof, UndecidedError
from sysmlc.robots.mission_contract import mission_contract
from sysmlc.robots.robot_contract import robot_contract
from sysmlc.robots.run_extension import extend_to_all_robots, violated_conjuncts
from sysmlc.robots.schedule import TravelTimes
from sysmlc.robots.study import Study
from sysmlc.robots.system_contract import system_contract
from sysmlc.synthesis.algebra.fair_systems import Trace, Universe
from sysmlc.synthesis.algebra.refinement import Entailment, find_refinement_failures
from sysmlc.synthesis.bdd.limits import LimitError
from sysmlc.synthesis.bdd.manager import Manager, ManagerFactory
from sysmlc.synthesis.decision import Options
from sysmlc.synthesis.witnesses import describe_run, manager_factory


class Claim(Struct, frozen=True):
    """A claim and its result."""

    claim: str
    holds: bool | None
    """None if the claim is not decided."""
    reason: str = ""
    run: tuple[str, ...] = ()
    """A run that refutes the claim, a line for each step."""


MISSION_CLAIM = "C_S refines C_M"
_NONE: Mapping[str, Claim] = {}
_Procedure = Callable[[str, ManagerFactory], Claim]
_Search = Callable[[JointProof], Counterexample | None]


def decide_claims(
    study: Study, travel: TravelTimes, options: Options, known_claims: Mapping[str, Claim] = _NONE
) -> Iterator[Claim]:
    """Yield the decided claims; claims about one robot are decided for the first robot.

    Results in *known_claims* are reused, except for the claim about the mission.
    """
    # Without starts the results hold for all robots and missions of the floor, so they can be
    # cached.
    robots_without_starts = tuple(replace(robot, start=None) for robot in study.robots)
    study = replace(study, robots=robots_without_starts)
    for claim, decide in _claim_procedures(study, travel).items():
        if claim == MISSION_CLAIM and not study.targets:
            continue
        is_known = claim in known_claims and claim != MISSION_CLAIM
        yield known_claims[claim] if is_known else _decide_within_limits(claim, options, decide)


def _claim_procedures(study: Study, travel: TravelTimes) -> dict[str, _Procedure]:
    """Return the decision procedure of each claim; contracts are built on demand."""
    robot = study.robots[0]
    # The proof is used, as the contracts are built, when a claim is decided.
    safety = methodcaller("find_safety_failure")
    liveness = methodcaller("find_liveness_failure")
    return {
        "C_S refines C_R": partial(_decide_refinement, study, lambda: robot_contract(study, robot)),
        "C_S refines C_R among others": partial(
            _decide_refinement, study, lambda: robot_contract(study, robot, is_alone=False)
        ),
        "C_S refines C_E": partial(_decide_refinement, study, lambda: environment_contract(study)),
        MISSION_CLAIM: partial(_decide_refinement, study, lambda: mission_contract(study, travel)),
        "C_E as the thesis defines it discharges what C_R assumes of it": partial(
            _decide_discharge, study, True, True
        ),
        "C_E discharges what C_R assumes of it": partial(_decide_discharge, study, False, True),
        "C_E discharges what C_R among others assumes of it": partial(
            _decide_discharge, study, False, False
        ),
        "C_R, C_E and C_M together keep what C_S promises of each step": partial(
            _decide_jointly, study, (safety,)
        ),
        "C_R, C_E and C_M together refine C_S": partial(
            _decide_jointly, study, (safety, liveness, methodcaller("find_offer_failure"))
        ),
        "C_R, C_E and C_M together keep C_S where ways that lead nearer are offered": partial(
            _decide_jointly, study, (safety, liveness)
        ),
        "C_R and C_E bring robots to their targets in a known time, as C_M assumes": partial(
            _decide_travel_time, study
        ),
    }


def _decide_refinement(
    study: Study,
    build_abstract_contract: Callable[[], Contract],
    claim: str,
    new_manager: ManagerFactory,
) -> Claim:
    concrete, abstract = system_contract(study), build_abstract_contract()
    shared_names = {variable.name for variable in concrete.variables} & {
        variable.name for variable in abstract.variables
    }
    if not shared_names:
        return Claim(claim, False, "they have no variable in common")
    failure = next(find_refinement_failures(concrete, abstract, new_manager), None)
    if failure is None:
        return Claim(claim, True)
    verb = "assumes more" if failure.is_assumption else "does not promise"
    reason = f"{claim.partition(' ')[0]} {verb}: {failure.conjunct.text}"
    return Claim(claim, False, reason, _describe_trace(failure.trace, failure.conjunct))


def _decide_discharge(
    study: Study, is_literal: bool, is_alone: bool, claim: str, new_manager: ManagerFactory
) -> Claim:
    """Decide whether C_E entails the assumptions of the first robot about its environment.

    A violating run is searched with as few robots as possible, extended to all robots and checked.
    """
    environment = environment_contract(study, is_literal)
    environment_conjuncts = (*environment.assumptions, *environment.guarantees)
    violation = None
    for smaller_study, others_stay in _iter_attempts(study):
        violation = _find_undischarged(
            smaller_study, is_literal, is_alone, new_manager(), others_stay
        )
        if violation is None:
            continue
        conjunct, smaller_run = violation
        for run in extend_to_all_robots(study, smaller_study.robots, smaller_run, is_literal):
            if not any(violated_conjuncts(run, environment_conjuncts)) and any(
                violated_conjuncts(run, (conjunct,))
            ):
                reason = f"C_E does not promise: {conjunct.text}"
                return Claim(claim, False, reason, _describe_trace(run, conjunct))
    # The last attempt has considered all robots.
    if violation is None:
        return Claim(claim, True)
    return Claim(claim, None, "what some robots are shown is not so when all are there")


def _iter_attempts(study: Study) -> Iterator[tuple[Study, bool]]:
    """Yield studies with one robot, two robots and so on, and whether the robots have to stay.

    Each study is yielded with staying robots first: these are explored quickly, and most violations
    occur among them already.
    """
    for count in range(1, len(study.robots) + 1):
        few = replace(study, robots=study.robots[:count])
        yield from ((few, True), (few, False))


def _find_undischarged(
    study: Study, is_literal: bool, is_alone: bool, manager: Manager, others_stay: bool
) -> tuple[Conjunct, Trace] | None:
    """Return an assumption of the first robot that C_E does not entail, with a violating run.

    Assumptions about targets are not checked but used as facts, because the mission guarantees
    them. Assumptions about offers read targets, too, but are checked.
    """
    target_names = {terms.target(other) for other in study.robots}
    environment = environment_contract(study, is_literal)
    robot = robot_contract(study, study.robots[0], is_alone)
    target_assumptions = [
        assumption for assumption in robot.assumptions if _names_of(assumption) & target_names
    ]
    offer_assumptions = [
        assumption for assumption in target_assumptions if _is_about_offers(assumption)
    ]
    other_assumptions = [
        assumption for assumption in robot.assumptions if assumption not in target_assumptions
    ]
    facts = [*environment.assumptions, *environment.guarantees]
    facts += [
        assumption for assumption in target_assumptions if assumption not in offer_assumptions
    ]
    facts += [terms.forbid_moves(other) for other in study.robots if others_stay]
    with manager.guard():
        universe = Universe((environment, robot), manager)
        runs = Entailment(universe, universe.system(facts))
        for conjunct in (*other_assumptions, *offer_assumptions):
            trace = runs.find_violation(conjunct)
            if trace is not None:
                return conjunct, trace
    return None


def _decide_jointly(
    study: Study, searches: tuple[_Search, ...], claim: str, new_manager: ManagerFactory
) -> Claim:
    """Decide a claim that holds if none of the searches of a joint proof finds a failure."""
    proof = JointProof(study, new_manager)
    failure = next(filter(None, (search(proof) for search in searches)), None)
    if failure is None:
        return Claim(claim, True)
    if failure.run is None:
        return Claim(claim, None, f"no run was found that breaks: {failure.conjunct.text}")
    reason = f"nothing promises: {failure.conjunct.text}"
    return Claim(claim, False, reason, _describe_trace(failure.run, failure.conjunct))


def _decide_travel_time(study: Study, claim: str, new_manager: ManagerFactory) -> Claim:
    run = JointProof(study, new_manager).find_endless_travel()
    if run is None:
        return Claim(claim, True)
    reason = f"'{study.robots[0].name}' may go on like that for any time"
    return Claim(claim, False, reason, tuple(describe_run(run)))


def _describe_trace(trace: Trace | None, broken: Conjunct) -> tuple[str, ...]:
    return () if trace is None else tuple(describe_run(trace, broken))


def _names_of(conjunct: Conjunct) -> set[str]:
    return variable_names(conjunct.formula)


def _is_about_offers(conjunct: Conjunct) -> bool:
    """Whether the conjunct reads a sensor, which the environment sets."""
    return any("_sensor_" in name for name in _names_of(conjunct))


def _decide_within_limits(claim: str, options: Options, decide: _Procedure) -> Claim:
    try:
        return decide(claim, manager_factory(options))
    except (LimitError, UndecidedError) as problem:
        return Claim(claim, None, str(problem))
