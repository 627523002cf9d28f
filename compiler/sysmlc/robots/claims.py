"""What the thesis says of its four contracts, decided (MOOD4I thesis, 4.3.2 to 4.3.4)."""

from collections.abc import Callable, Iterator, Mapping
from functools import partial

from msgspec import Struct
from msgspec.structs import replace

from sysmlc.logic.contract import Conjunct, Contract
from sysmlc.logic.formula import variables
from sysmlc.robots import contract_terms as words
from sysmlc.robots.environment_contract import Sharing, environment_contract
from sysmlc.robots.joint_proof import Counterexample, JointProof, UndecidedError
from sysmlc.robots.mission_contract import mission_contract
from sysmlc.robots.robot_contract import robot_contract
from sysmlc.robots.run_extension import extend_to_all_robots, violated_conjuncts
from sysmlc.robots.schedule import TravelTimes
from sysmlc.robots.study import Study
from sysmlc.robots.system_contract import system_contract
from sysmlc.synthesis.algebra.fair_systems import Universe
from sysmlc.synthesis.algebra.refinement import Entailment, find_refinement_failures
from sysmlc.synthesis.algebra.traces import Trace
from sysmlc.synthesis.bdd.limits import LimitError
from sysmlc.synthesis.bdd.manager import Manager
from sysmlc.synthesis.decision import Options
from sysmlc.synthesis.witnesses import describe_run, manager_factory

ManagerFactory = Callable[[], Manager]
"""A manager for each question, within the limits."""


class Claim(Struct, frozen=True):
    """A claim and what became of it; ``holds`` is None when it was not decided."""

    claim: str
    holds: bool | None
    reason: str = ""
    run: tuple[str, ...] = ()
    """A run that shows why not, a line a step."""


MISSION_CLAIM = "C_S refines C_M"
_NONE: Mapping[str, Claim] = {}
_Procedure = Callable[[str, ManagerFactory], Claim]


def decide_claims(
    study: Study, travel: TravelTimes, options: Options, known: Mapping[str, Claim] = _NONE
) -> Iterator[Claim]:
    """The claims of the thesis for the first robot, which the others are like, from any start.

    What is known of a floor stays; only what is said of its mission is decided anew.
    """
    open_ = tuple(replace(one, start=None) for one in study.robots)
    study = replace(study, robots=open_)
    for claim, decide in _claim_procedures(study, travel).items():
        if claim == MISSION_CLAIM and not study.targets:
            continue
        is_known = claim in known and claim != MISSION_CLAIM
        yield known[claim] if is_known else _decide_within_limits(claim, options, decide)


def _claim_procedures(study: Study, travel: TravelTimes) -> dict[str, _Procedure]:
    """How each claim is decided; nothing is made before it is asked for."""
    robot = study.robots[0]
    literal, once = Sharing.LITERAL, Sharing.ARBITRATED
    return {
        "C_S refines C_R": partial(_decide_refinement, study, lambda: robot_contract(study, robot)),
        "C_S refines C_R among others": partial(
            _decide_refinement, study, lambda: robot_contract(study, robot, is_alone=False)
        ),
        "C_S refines C_E": partial(_decide_refinement, study, lambda: environment_contract(study)),
        MISSION_CLAIM: partial(_decide_refinement, study, lambda: mission_contract(study, travel)),
        "C_E as the thesis has it discharges what C_R assumes of it": partial(
            _decide_discharge, study, literal, True
        ),
        "C_E discharges what C_R assumes of it": partial(_decide_discharge, study, once, True),
        "C_E discharges what C_R among others assumes of it": partial(
            _decide_discharge, study, once, False
        ),
        "C_R, C_E and C_M together keep what C_S promises of each step": partial(
            _decide_steps, study
        ),
        "C_R, C_E and C_M together refine C_S": partial(_decide_whole, study),
        "C_R, C_E and C_M together keep C_S where ways that lead nearer are offered": partial(
            _decide_with_offers, study
        ),
        "C_R and C_E bring robots to their targets in a known time, as C_M assumes": partial(
            _decide_travel_time, study
        ),
    }


def _decide_refinement(
    study: Study, of: Callable[[], Contract], claim: str, new_manager: ManagerFactory
) -> Claim:
    concrete, abstract = system_contract(study), of()
    shared = {one.name for one in concrete.variables} & {one.name for one in abstract.variables}
    if not shared:
        return Claim(claim, False, "they have no variable in common")
    failure = next(find_refinement_failures(concrete, abstract, new_manager()), None)
    if failure is None:
        return Claim(claim, True)
    verb = "assumes more" if failure.is_assumption else "does not promise"
    reason = f"{claim.partition(' ')[0]} {verb}: {failure.conjunct.text}"
    return Claim(claim, False, reason, _describe_trace(failure.trace, failure.conjunct))


def _decide_discharge(
    study: Study, sharing: Sharing, is_alone: bool, claim: str, new_manager: ManagerFactory
) -> Claim:
    """Whether all that the environment decides and the first robot assumes of it follows.

    A run in which it does not is looked for with as few robots as it takes.
    """
    environment = environment_contract(study, sharing)
    kept = (*environment.assumptions, *environment.guarantees)
    found = None
    for few, is_still in _iter_attempts(study):
        found = _find_undischarged(few, sharing, is_alone, new_manager(), is_still)
        if found is None:
            continue
        conjunct, few_run = found
        is_exact = sharing is Sharing.LITERAL
        for run in extend_to_all_robots(study, few.robots, few_run, is_exact):
            if not any(violated_conjuncts(run, kept)) and any(violated_conjuncts(run, (conjunct,))):
                reason = f"C_E does not promise: {conjunct.text}"
                return Claim(claim, False, reason, _describe_trace(run, conjunct))
    if found is None:
        return Claim(claim, True)
    return Claim(claim, None, "what some robots are shown is not so when all are there")


def _iter_attempts(study: Study) -> Iterator[tuple[Study, bool]]:
    """With one robot, two, and so on: first such that stay, which is enough for most runs, and is
    explored at once."""
    for count in range(1, len(study.robots) + 1):
        few = replace(study, robots=study.robots[:count])
        yield from ((few, True), (few, False))


def _find_undischarged(
    study: Study, sharing: Sharing, is_alone: bool, manager: Manager, is_still: bool
) -> tuple[Conjunct, Trace] | None:
    """What the first robot assumes and does not follow; targets are the mission's to give."""
    goals = {words.target(one) for one in study.robots}
    environment = environment_contract(study, sharing)
    robot = robot_contract(study, study.robots[0], is_alone)
    of_targets = [one for one in robot.assumptions if _names_of(one) & goals]
    open_ = [one for one in of_targets if _is_about_offers(one)]
    asked = [one for one in robot.assumptions if one not in of_targets]
    given = [*environment.assumptions, *environment.guarantees]
    given += [one for one in of_targets if one not in open_]
    given += [words.stays(one) for one in study.robots if is_still]
    with manager.guard():
        universe = Universe((environment, robot), manager)
        runs = Entailment(universe, universe.system(given))
        for conjunct in (*asked, *open_):
            trace = runs.find_violation(conjunct)
            if trace is not None:
                return conjunct, trace
    return None


def _decide_steps(study: Study, claim: str, new_manager: ManagerFactory) -> Claim:
    found = JointProof(study, new_manager).stepwise_failure()
    return Claim(claim, True) if found is None else _failed_claim(claim, found)


def _decide_with_offers(study: Study, claim: str, new_manager: ManagerFactory) -> Claim:
    asked = JointProof(study, new_manager)
    found = asked.stepwise_failure() or asked.recurring_failure()
    return Claim(claim, True) if found is None else _failed_claim(claim, found)


def _decide_whole(study: Study, claim: str, new_manager: ManagerFactory) -> Claim:
    asked = JointProof(study, new_manager)
    found = asked.stepwise_failure() or asked.recurring_failure() or asked.offered_failure()
    return Claim(claim, True) if found is None else _failed_claim(claim, found)


def _decide_travel_time(study: Study, claim: str, new_manager: ManagerFactory) -> Claim:
    run = JointProof(study, new_manager).find_endless_travel()
    if run is None:
        return Claim(claim, True)
    reason = f"'{study.robots[0].name}' may go on like that for any time"
    return Claim(claim, False, reason, tuple(describe_run(run)))


def _failed_claim(claim: str, found: Counterexample) -> Claim:
    if found.run is None:
        return Claim(claim, None, f"no run was found that breaks: {found.conjunct.text}")
    reason = f"nothing promises: {found.conjunct.text}"
    return Claim(claim, False, reason, _describe_trace(found.run, found.conjunct))


def _describe_trace(trace: Trace | None, broken: Conjunct) -> tuple[str, ...]:
    return () if trace is None else tuple(describe_run(trace, broken))


def _names_of(conjunct: Conjunct) -> set[str]:
    return {one.name for one in variables(conjunct.formula)}


def _is_about_offers(conjunct: Conjunct) -> bool:
    """Whether it speaks of sensors, too: the environment has its part in it."""
    return any("_sensor_" in name for name in _names_of(conjunct))


def _decide_within_limits(claim: str, options: Options, decide: _Procedure) -> Claim:
    try:
        return decide(claim, manager_factory(options))
    except (LimitError, UndecidedError) as problem:
        return Claim(claim, None, str(problem))
