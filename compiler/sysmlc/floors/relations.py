"""What the thesis says of its four contracts, decided (MOOD4I thesis, 4.3.2 to 4.3.4)."""

from collections.abc import Callable, Iterator, Mapping
from functools import partial

from sysmlc.floors import words
from sysmlc.floors.environment import Sharing, environment_contract
from sysmlc.floors.mission import mission_contract
from sysmlc.floors.robot import robot_contract
from sysmlc.floors.study import Study
from sysmlc.floors.system import system_contract
from sysmlc.floors.travel import Travel
from sysmlc.logic.contract import Conjunct, Contract
from sysmlc.logic.formula import variables
from sysmlc.synthesis.algebra.entail import Entailment
from sysmlc.synthesis.algebra.relations import refinement_failures
from sysmlc.synthesis.algebra.systems import Universe
from sysmlc.synthesis.algebra.traces import Trace
from sysmlc.synthesis.bdd.manager import LimitError, Manager
from sysmlc.synthesis.decide import Options
from sysmlc.synthesis.witness import lines
from sysmlc.values import dataclass, replace


@dataclass(frozen=True, slots=True)
class Relation:
    """A claim and what became of it; ``holds`` is None when it was not decided."""

    claim: str
    holds: bool | None
    reason: str = ""
    run: tuple[str, ...] = ()
    """A run that shows why not, a line a step."""


_ENVIRONMENTS = (Sharing.LITERAL, Sharing.ARBITRATED)
OF_MISSION = "C_S refines C_M"
_NONE: Mapping[str, Relation] = {}


def relations(
    study: Study, travel: Travel, options: Options, known: Mapping[str, Relation] = _NONE
) -> Iterator[Relation]:
    """The claims of the thesis for the first robot, which the others are like, from any start.

    What is known of a floor stays; only what is said of its mission is decided anew.
    """
    open_ = tuple(replace(one, start=None) for one in study.robots)
    study = replace(study, robots=open_)
    robot = study.robots[0]
    system = system_contract(study)
    alone, shared = (robot_contract(study, robot, one) for one in (True, False))
    literal, environment = (environment_contract(study, one) for one in _ENVIRONMENTS)
    asked = {
        "C_S refines C_R": partial(_refines, system, alone),
        "C_S refines C_R among others": partial(_refines, system, shared),
        "C_S refines C_E": partial(_refines, system, environment),
        OF_MISSION: partial(_refines, system, mission_contract(study, travel)),
        "C_E as the thesis has it discharges what C_R assumes of it": partial(
            _discharges, study, literal, alone
        ),
        "C_E discharges what C_R assumes of it": partial(_discharges, study, environment, alone),
        "C_E discharges what C_R among others assumes of it": partial(
            _discharges, study, environment, shared
        ),
    }
    for claim, decide in asked.items():
        if claim == OF_MISSION and not study.targets:
            continue
        is_known = claim in known and claim != OF_MISSION
        yield known[claim] if is_known else _limited(claim, options, decide)


def _refines(concrete: Contract, abstract: Contract, claim: str, manager: Manager) -> Relation:
    shared = {one.name for one in concrete.variables} & {one.name for one in abstract.variables}
    if not shared:
        return Relation(claim, False, "they have no variable in common")
    failure = next(refinement_failures(concrete, abstract, manager), None)
    if failure is None:
        return Relation(claim, True)
    verb = "assumes more" if failure.is_assumption else "does not promise"
    reason = f"{claim.partition(' ')[0]} {verb}: {failure.conjunct.text}"
    return Relation(claim, False, reason, _told(failure.trace, failure.conjunct))


def _discharges(
    study: Study, environment: Contract, robot: Contract, claim: str, manager: Manager
) -> Relation:
    """Whether all that the environment decides and the robot assumes of it follows.

    What is assumed of targets is the mission's to keep.
    """
    goals = {words.target(one) for one in study.robots}
    asked = [one for one in robot.assumptions if not (_names(one) & goals)]
    open_ = [one for one in robot.assumptions if _is_offered(one, goals)]

    universe = Universe((environment, robot), manager)
    given = (*environment.assumptions, *environment.guarantees)
    runs = Entailment(universe, universe.system(given))
    for conjunct in (*asked, *open_):
        trace = runs.violation(conjunct)
        if trace is not None:
            reason = f"C_E does not promise: {conjunct.text}"
            return Relation(claim, False, reason, _told(trace, conjunct))
    return Relation(claim, True)


def _told(trace: Trace | None, broken: Conjunct) -> tuple[str, ...]:
    return () if trace is None else tuple(lines(trace, broken))


def _names(conjunct: Conjunct) -> set[str]:
    return {one.name for one in variables(conjunct.formula)}


def _is_offered(conjunct: Conjunct, goals: set[str]) -> bool:
    """Whether it speaks of targets and of sensors: the environment has its part in it."""
    names = _names(conjunct)
    return bool(names & goals) and any("_sensor_" in name for name in names)


def _limited(claim: str, options: Options, decide: Callable[[str, Manager], Relation]) -> Relation:
    try:
        manager = Manager(options.engine, options.limits, options.progress)
        with manager.guard():
            return decide(claim, manager)
    except LimitError as problem:
        return Relation(claim, None, str(problem))
