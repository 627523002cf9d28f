"""What the thesis says of its four contracts, decided (MOOD4I thesis, 4.3.2 to 4.3.4)."""

from collections.abc import Callable, Iterator, Mapping
from functools import partial

from msgspec import Struct
from msgspec.structs import replace

from sysmlc.logic.contract import Conjunct, Contract
from sysmlc.logic.formula import variables
from sysmlc.robots import words
from sysmlc.robots.among import among_all, breaks
from sysmlc.robots.environment import Sharing, environment_contract
from sysmlc.robots.mission import mission_contract
from sysmlc.robots.robot import robot_contract
from sysmlc.robots.study import Study
from sysmlc.robots.system import system_contract
from sysmlc.robots.together import Finding, Together, UndecidedError
from sysmlc.robots.travel import Travel
from sysmlc.synthesis.algebra.entail import Entailment
from sysmlc.synthesis.algebra.relations import refinement_failures
from sysmlc.synthesis.algebra.systems import Universe
from sysmlc.synthesis.algebra.traces import Trace
from sysmlc.synthesis.bdd.limits import LimitError
from sysmlc.synthesis.bdd.manager import Manager
from sysmlc.synthesis.decide import Options
from sysmlc.synthesis.told import new_manager
from sysmlc.synthesis.witness import lines

NewManager = Callable[[], Manager]
"""A manager for each question, within the limits."""


class Relation(Struct, frozen=True):
    """A claim and what became of it; ``holds`` is None when it was not decided."""

    claim: str
    holds: bool | None
    reason: str = ""
    run: tuple[str, ...] = ()
    """A run that shows why not, a line a step."""


OF_MISSION = "C_S refines C_M"
_NONE: Mapping[str, Relation] = {}
_Decided = Callable[[str, NewManager], Relation]


def relations(
    study: Study, travel: Travel, options: Options, known: Mapping[str, Relation] = _NONE
) -> Iterator[Relation]:
    """The claims of the thesis for the first robot, which the others are like, from any start.

    What is known of a floor stays; only what is said of its mission is decided anew.
    """
    open_ = tuple(replace(one, start=None) for one in study.robots)
    study = replace(study, robots=open_)
    for claim, decide in _asked(study, travel).items():
        if claim == OF_MISSION and not study.targets:
            continue
        is_known = claim in known and claim != OF_MISSION
        yield known[claim] if is_known else _limited(claim, options, decide)


def _asked(study: Study, travel: Travel) -> dict[str, _Decided]:
    """How each claim is decided; nothing is made before it is asked for."""
    robot = study.robots[0]
    literal, once = Sharing.LITERAL, Sharing.ARBITRATED
    return {
        "C_S refines C_R": partial(_refines, study, lambda: robot_contract(study, robot)),
        "C_S refines C_R among others": partial(
            _refines, study, lambda: robot_contract(study, robot, is_alone=False)
        ),
        "C_S refines C_E": partial(_refines, study, lambda: environment_contract(study)),
        OF_MISSION: partial(_refines, study, lambda: mission_contract(study, travel)),
        "C_E as the thesis has it discharges what C_R assumes of it": partial(
            _discharges, study, literal, True
        ),
        "C_E discharges what C_R assumes of it": partial(_discharges, study, once, True),
        "C_E discharges what C_R among others assumes of it": partial(
            _discharges, study, once, False
        ),
        "C_R, C_E and C_M together keep what C_S promises of each step": partial(_steps, study),
        "C_R, C_E and C_M together refine C_S": partial(_whole, study),
        "C_R, C_E and C_M together keep C_S where ways that lead nearer are offered": partial(
            _offered, study
        ),
        "C_R and C_E bring robots to their targets in a known time, as C_M assumes": partial(
            _in_time, study
        ),
    }


def _refines(
    study: Study, of: Callable[[], Contract], claim: str, new_manager: NewManager
) -> Relation:
    concrete, abstract = system_contract(study), of()
    shared = {one.name for one in concrete.variables} & {one.name for one in abstract.variables}
    if not shared:
        return Relation(claim, False, "they have no variable in common")
    failure = next(refinement_failures(concrete, abstract, new_manager()), None)
    if failure is None:
        return Relation(claim, True)
    verb = "assumes more" if failure.is_assumption else "does not promise"
    reason = f"{claim.partition(' ')[0]} {verb}: {failure.conjunct.text}"
    return Relation(claim, False, reason, _told(failure.trace, failure.conjunct))


def _discharges(
    study: Study, sharing: Sharing, is_alone: bool, claim: str, new_manager: NewManager
) -> Relation:
    """Whether all that the environment decides and the first robot assumes of it follows.

    A run in which it does not is looked for with as few robots as it takes.
    """
    environment = environment_contract(study, sharing)
    kept = (*environment.assumptions, *environment.guarantees)
    found = None
    for few, is_still in _attempts(study):
        found = _undischarged(few, sharing, is_alone, new_manager(), is_still)
        if found is None:
            continue
        conjunct, few_run = found
        is_exact = sharing is Sharing.LITERAL
        for run in among_all(study, few.robots, few_run, is_exact):
            if not any(breaks(run, kept)) and any(breaks(run, (conjunct,))):
                reason = f"C_E does not promise: {conjunct.text}"
                return Relation(claim, False, reason, _told(run, conjunct))
    if found is None:
        return Relation(claim, True)
    return Relation(claim, None, "what some robots are shown is not so when all are there")


def _attempts(study: Study) -> Iterator[tuple[Study, bool]]:
    """With one robot, two, and so on: first such that stay, which is enough for most runs, and is
    explored at once."""
    for count in range(1, len(study.robots) + 1):
        few = replace(study, robots=study.robots[:count])
        yield from ((few, True), (few, False))


def _undischarged(
    study: Study, sharing: Sharing, is_alone: bool, manager: Manager, is_still: bool
) -> tuple[Conjunct, Trace] | None:
    """What the first robot assumes and does not follow; targets are the mission's to give."""
    goals = {words.target(one) for one in study.robots}
    environment = environment_contract(study, sharing)
    robot = robot_contract(study, study.robots[0], is_alone)
    of_targets = [one for one in robot.assumptions if _names(one) & goals]
    open_ = [one for one in of_targets if _is_offered(one)]
    asked = [one for one in robot.assumptions if one not in of_targets]
    given = [*environment.assumptions, *environment.guarantees]
    given += [one for one in of_targets if one not in open_]
    given += [words.stays(one) for one in study.robots if is_still]
    with manager.guard():
        universe = Universe((environment, robot), manager)
        runs = Entailment(universe, universe.system(given))
        for conjunct in (*asked, *open_):
            trace = runs.violation(conjunct)
            if trace is not None:
                return conjunct, trace
    return None


def _steps(study: Study, claim: str, new_manager: NewManager) -> Relation:
    found = Together(study, new_manager).stepwise_failure()
    return Relation(claim, True) if found is None else _failed(claim, found)


def _offered(study: Study, claim: str, new_manager: NewManager) -> Relation:
    asked = Together(study, new_manager)
    found = asked.stepwise_failure() or asked.recurring_failure()
    return Relation(claim, True) if found is None else _failed(claim, found)


def _whole(study: Study, claim: str, new_manager: NewManager) -> Relation:
    asked = Together(study, new_manager)
    found = asked.stepwise_failure() or asked.recurring_failure() or asked.offered_failure()
    return Relation(claim, True) if found is None else _failed(claim, found)


def _in_time(study: Study, claim: str, new_manager: NewManager) -> Relation:
    run = Together(study, new_manager).endless()
    if run is None:
        return Relation(claim, True)
    reason = f"'{study.robots[0].name}' may go on like that for any time"
    return Relation(claim, False, reason, tuple(lines(run)))


def _failed(claim: str, found: Finding) -> Relation:
    if found.run is None:
        return Relation(claim, None, f"no run was found that breaks: {found.conjunct.text}")
    reason = f"nothing promises: {found.conjunct.text}"
    return Relation(claim, False, reason, _told(found.run, found.conjunct))


def _told(trace: Trace | None, broken: Conjunct) -> tuple[str, ...]:
    return () if trace is None else tuple(lines(trace, broken))


def _names(conjunct: Conjunct) -> set[str]:
    return {one.name for one in variables(conjunct.formula)}


def _is_offered(conjunct: Conjunct) -> bool:
    """Whether it speaks of sensors, too: the environment has its part in it."""
    return any("_sensor_" in name for name in _names(conjunct))


def _limited(claim: str, options: Options, decide: _Decided) -> Relation:
    try:
        return decide(claim, new_manager(options))
    except (LimitError, UndecidedError) as problem:
        return Relation(claim, None, str(problem))
