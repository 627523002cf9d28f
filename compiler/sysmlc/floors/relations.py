"""What the thesis says of its four contracts, decided (MOOD4I thesis, 4.3.2 to 4.3.4)."""

from collections.abc import Callable, Iterator

from sysmlc.floors import words
from sysmlc.floors.environment import environment_contract
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
from sysmlc.values import dataclass, replace


@dataclass(frozen=True, slots=True)
class Relation:
    """A claim and what became of it; ``holds`` is None when it was not decided."""

    claim: str
    holds: bool | None
    reason: str = ""
    broken: Conjunct | None = None
    trace: Trace | None = None


def relations(study: Study, travel: Travel, options: Options) -> Iterator[Relation]:
    """The claims of the thesis for the first robot, which the others are like, from any start."""
    open_ = tuple(replace(one, start=None) for one in study.robots)
    study = replace(study, robots=open_)
    robot = study.robots[0]
    system = system_contract(study)
    alone, shared = (robot_contract(study, robot, one) for one in (True, False))
    environment = environment_contract(study)
    yield _refines("C_S refines C_R", system, alone, options)
    yield _refines("C_S refines C_R among others", system, shared, options)
    yield _refines("C_S refines C_E", system, environment, options)
    if study.targets:
        mission = mission_contract(study, travel)
        yield _refines("C_S refines C_M", system, mission, options)
    for words_, contract in (("C_R", alone), ("C_R among others", shared)):
        claim = f"C_E discharges what {words_} assumes of it"
        yield _discharges(claim, study, environment, contract, options)


def _refines(claim: str, concrete: Contract, abstract: Contract, options: Options) -> Relation:
    shared = {one.name for one in concrete.variables} & {one.name for one in abstract.variables}
    if not shared:
        return Relation(claim, False, "they have no variable in common")

    def found() -> Relation:
        failure = next(refinement_failures(concrete, abstract, _manager(options)), None)
        if failure is None:
            return Relation(claim, True)
        verb = "assumes more" if failure.is_assumption else "does not promise"
        reason = f"{claim.partition(' ')[0]} {verb}: {failure.conjunct.text}"
        return Relation(claim, False, reason, failure.conjunct, failure.trace)

    return _limited(claim, found)


def _discharges(
    claim: str, study: Study, environment: Contract, robot: Contract, options: Options
) -> Relation:
    """Whether all that the environment decides and the robot assumes of it follows.

    What is assumed of targets is the mission's to keep.
    """
    goals = {words.target(one) for one in study.robots}
    asked = [one for one in robot.assumptions if not (_names(one) & goals)]
    open_ = [one for one in robot.assumptions if _is_offered(one, goals)]

    def found() -> Relation:
        manager = _manager(options)
        with manager.guard():
            universe = Universe((environment, robot), manager)
            given = (*environment.assumptions, *environment.guarantees)
            runs = Entailment(universe, universe.system(given))
            for conjunct in (*asked, *open_):
                trace = runs.violation(conjunct)
                if trace is not None:
                    reason = f"C_E does not promise: {conjunct.text}"
                    return Relation(claim, False, reason, conjunct, trace)
        return Relation(claim, True)

    return _limited(claim, found)


def _names(conjunct: Conjunct) -> set[str]:
    return {one.name for one in variables(conjunct.formula)}


def _is_offered(conjunct: Conjunct, goals: set[str]) -> bool:
    """Whether it speaks of targets and of sensors: the environment has its part in it."""
    names = _names(conjunct)
    return bool(names & goals) and any("_sensor_" in name for name in names)


def _limited(claim: str, found: Callable[[], Relation]) -> Relation:
    try:
        return found()
    except LimitError as problem:
        return Relation(claim, None, str(problem))


def _manager(options: Options) -> Manager:
    return Manager(options.engine, options.limits, options.progress)
