"""All contracts of a floor, and their conjunction with the assignment of targets (thesis, 4.3).

The mission assigns a goal to a robot. The robot adopts the goal as its target only when it is in
its previous target. So targets stay until they are reached, whatever the mission does.
"""

from collections.abc import Iterable, Iterator, Sequence
from itertools import combinations

from sysmlc.logic import formula as f
from sysmlc.logic.contract import Class, Conjunct, Contract, EnumerationDomain, Owner, Variable
from sysmlc.logic.formula import Formula
from sysmlc.robots import contract_terms as terms
from sysmlc.robots.environment_contract import environment_contract
from sysmlc.robots.mission_contract import NONE, mission_contract
from sysmlc.robots.robot_contract import robot_contract
from sysmlc.robots.schedule import shortest_travel_times
from sysmlc.robots.study import WAYS, Robot, Study
from sysmlc.robots.system_contract import count_timers, system_contract


class JointContracts:
    """The contracts of a floor together: C_S, C_E, C_R of each robot, and the wiring of targets."""

    def __init__(self, study: Study) -> None:
        """Build the contracts of a study."""
        self.study = study
        self.system = system_contract(study)
        self.environment = environment_contract(study)
        self.robots = [robot_contract(study, robot, is_alone=False) for robot in study.robots]
        self.wiring = [rule for robot in study.robots for rule in _define_targets(study, robot)]
        self.wiring += count_timers(study)
        self.parts = (self.environment, *self.robots)
        self._owner = {name: robot for robot in study.robots for name in variable_names(robot)}

    @property
    def variables(self) -> dict[str, Variable]:
        """All variables by name."""
        goal_variables = (_goal_variable(self.study, robot) for robot in self.study.robots)
        all_variables = (
            variable for part in (self.system, *self.parts) for variable in part.variables
        )
        return {variable.name: variable for variable in (*all_variables, *goal_variables)}

    def steps(self) -> Iterator[Conjunct]:
        """Yield the initial and safety guarantees of C_E and C_R, and the wiring."""
        yield from safety_conjuncts(conjunct for part in self.parts for conjunct in part.guarantees)
        yield from self.wiring

    def robots_of(self, conjunct: Conjunct) -> tuple[Robot, ...] | None:
        """Return the robots whose variables a conjunct reads; None if it reads other variables."""
        names = _names_in(conjunct)
        if not names <= self._owner.keys():
            return None
        words = {self._owner[name].word for name in names}
        return tuple(robot for robot in self.study.robots if robot.word in words)

    def restrict_to(self, robots: Sequence[Robot]) -> tuple[Contract, list[Conjunct]]:
        """Return a contract with the variables of *robots*, and the conjuncts about only these."""
        names = {name for robot in robots for name in variable_names(robot)}
        variables = tuple(variable for name, variable in self.variables.items() if name in names)
        facts = [conjunct for conjunct in self.steps() if _names_in(conjunct) <= names]
        return Contract("", "", variables, (), ()), facts


def safety_conjuncts(conjuncts: Iterable[Conjunct]) -> Iterator[Conjunct]:
    """Yield the initial and safety conjuncts."""
    return (conjunct for conjunct in conjuncts if conjunct.class_ is not Class.LIVENESS)


def liveness_conjuncts(conjuncts: Iterable[Conjunct]) -> list[Conjunct]:
    """Return the liveness conjuncts."""
    return [conjunct for conjunct in conjuncts if conjunct.class_ is Class.LIVENESS]


def variable_names(robot: Robot) -> tuple[str, ...]:
    """Return the names of all variables of a robot."""
    namers = (terms.position, terms.target, terms.command, terms.steps, terms.timer, terms.goal)
    return (*(namer(robot) for namer in namers), *(terms.sensor(robot, way) for way in WAYS))


def _names_in(conjunct: Conjunct) -> set[str]:
    return f.variable_names(conjunct.formula)


def _goal_variable(study: Study, robot: Robot) -> Variable:
    """Declare the goal of a robot in an arbitrary mission on this floor: a cell or none."""
    cells = tuple(f"cell_{cell}" for cell in study.grid.cells)
    return Variable(terms.goal(robot), Owner.SYSTEM, EnumerationDomain((NONE, *cells)))


def _is_sent_to(robot: Robot, cell: int) -> Formula:
    """Return the predicate that the mission sends a robot to a cell."""
    return terms.equals(terms.goal(robot), f"cell_{cell}")


def _define_targets(study: Study, robot: Robot) -> Iterator[Conjunct]:
    """State that a robot starts in its target, and adopts a goal when it is in its target.

    An unreachable goal is ignored: no mission needs one, because its target is never reached.
    """
    position, target_value = f.var(terms.position(robot)), f.var(terms.target(robot))
    yield terms.initial_conjunct(
        f.eq(position, target_value), robot.origin, "At first a robot is in its target."
    )
    text = f"'{robot.name}' takes its goal when it is in its target."
    for cell in study.grid.cells:
        reach = terms.is_in_any(terms.position(robot), sorted(study.grid.distances(cell)))
        receives_goal = f.both(terms.is_at_target(robot), _is_sent_to(robot, cell), reach)
        next_target = f.prime(terms.equals(terms.target(robot), cell))
        yield terms.safety_conjunct(f.implies(receives_goal, next_target), robot.origin, text)
        keeps_target = f.eq(f.prime(target_value), target_value)
        has_unreachable_goal = f.both(
            terms.is_at_target(robot), _is_sent_to(robot, cell), f.negate(reach)
        )
        yield terms.safety_conjunct(
            f.implies(has_unreachable_goal, keeps_target), robot.origin, text
        )
    keeps_old_target = f.either(
        terms.is_away_from_target(robot), terms.equals(terms.goal(robot), NONE)
    )
    yield terms.safety_conjunct(
        f.implies(keeps_old_target, f.eq(f.prime(target_value), target_value)), robot.origin, text
    )


def mission_guarantees(study: Study) -> Iterator[Conjunct]:
    """State what every mission guarantees about goals (C_M) as long as its assumptions hold."""
    for robot in study.robots:
        has_no_goal = terms.equals(terms.goal(robot), NONE)
        yield terms.initial_conjunct(
            has_no_goal, robot.origin, f"At first '{robot.name}' has no target."
        )
        for cell in study.grid.cells:
            yield _keep_goal(robot, cell)
    for first, second in combinations(study.robots, 2):
        for cell in study.grid.cells:
            share_goal = f.both(_is_sent_to(first, cell), _is_sent_to(second, cell))
            text = f"One robot goes to cell {cell}."
            yield terms.safety_conjunct(f.negate(share_goal), second.origin, text)


def never_sent(robot: Robot) -> Conjunct:
    """State that the mission never sends the robot anywhere."""
    has_no_goal = terms.equals(terms.goal(robot), NONE)
    return terms.safety_conjunct(has_no_goal, robot.origin, f"'{robot.name}' has no target.")


def _keep_goal(robot: Robot, cell: int) -> Conjunct:
    """State that a goal stays until the robot has reached it as its target."""
    has_arrived = f.both(terms.is_in_cell(robot, cell), terms.equals(terms.target(robot), cell))
    is_under_way = f.both(_is_sent_to(robot, cell), f.negate(f.prime(has_arrived)))
    text = f"'{robot.name}' keeps a target until it has reached it."
    return terms.safety_conjunct(
        f.implies(is_under_way, f.prime(_is_sent_to(robot, cell))), robot.origin, text
    )


# -- contracts as files ------------------------------------------------------------------------


def study_contracts(study: Study) -> Iterator[Contract]:
    """Yield all contracts of a floor: C_S, C_E, C_R of each robot in two versions, and C_M.

    C_R is yielded for a robot alone on the floor and for one among others. C_M needs targets;
    it assumes the travel times of shortest paths.
    """
    yield system_contract(study)
    yield environment_contract(study)
    for robot in study.robots:
        yield robot_contract(study, robot)
        yield robot_contract(study, robot, is_alone=False)
    if study.targets:
        yield mission_contract(study, shortest_travel_times(study))
