"""The contracts of a floor as they are joined: what robots, environment and targets promise.

The mission gives a robot a goal; the robot takes it as its target when it is in its last one. So
targets stay until they are reached, whatever the mission does.
"""

from collections.abc import Iterable, Iterator, Sequence
from itertools import combinations

from sysmlc.logic import formula as f
from sysmlc.logic.contract import Class, Conjunct, Contract, EnumerationDomain, Owner, Variable
from sysmlc.logic.formula import Formula
from sysmlc.robots import contract_terms as words
from sysmlc.robots.environment_contract import environment_contract
from sysmlc.robots.mission_contract import NONE
from sysmlc.robots.robot_contract import robot_contract
from sysmlc.robots.study import WAYS, Robot, Study
from sysmlc.robots.system_contract import system_contract, timing


class JointContracts:
    """C_E, C_R of each robot among others, and how targets are given."""

    def __init__(self, study: Study) -> None:
        """The contracts are made, nothing is decided."""
        self.study = study
        self.system = system_contract(study)
        self.environment = environment_contract(study)
        self.robots = [robot_contract(study, one, is_alone=False) for one in study.robots]
        self.wiring = [*(one for robot in study.robots for one in define_targets(study, robot))]
        self.wiring += timing(study)
        self.parts = (self.environment, *self.robots)
        self._owner = {name: one for one in study.robots for name in variable_names(one)}

    @property
    def variables(self) -> dict[str, Variable]:
        """All variables by name."""
        goals = (goal_variable(self.study, one) for one in self.study.robots)
        every = (one for part in (self.system, *self.parts) for one in part.variables)
        return {one.name: one for one in (*every, *goals)}

    def steps(self) -> Iterator[Conjunct]:
        """What is promised of the first step and of each one, and what joins the contracts."""
        yield from safety_conjuncts(one for part in self.parts for one in part.guarantees)
        yield from self.wiring

    def about(self, conjunct: Conjunct) -> tuple[Robot, ...] | None:
        """The robots that a conjunct is about; None when it is about cells, too."""
        names = _names_in(conjunct)
        if not names <= self._owner.keys():
            return None
        found = {self._owner[name].word for name in names}
        return tuple(one for one in self.study.robots if one.word in found)

    def only(self, robots: Sequence[Robot]) -> tuple[Contract, list[Conjunct]]:
        """The variables of some robots, and what is promised of these robots alone."""
        known = {name for one in robots for name in variable_names(one)}
        variables = tuple(one for name, one in self.variables.items() if name in known)
        facts = [one for one in self.steps() if _names_in(one) <= known]
        return Contract("", "", variables, (), ()), facts


def safety_conjuncts(conjuncts: Iterable[Conjunct]) -> Iterator[Conjunct]:
    """What is said of the first step and of each one."""
    return (one for one in conjuncts if one.class_ is not Class.LIVENESS)


def liveness_conjuncts(conjuncts: Iterable[Conjunct]) -> list[Conjunct]:
    """What is said to hold again and again."""
    return [one for one in conjuncts if one.class_ is Class.LIVENESS]


def variable_names(robot: Robot) -> tuple[str, ...]:
    """All variables of a robot."""
    some = (words.position, words.target, words.command, words.steps, words.timer, words.goal)
    return (*(name(robot) for name in some), *(words.sensor(robot, way) for way in WAYS))


def _names_in(conjunct: Conjunct) -> set[str]:
    return {one.name for one in f.variables(conjunct.formula)}


def goal_variable(study: Study, robot: Robot) -> Variable:
    """The cell that the mission sends a robot to, if it does: of any mission on this floor."""
    cells = tuple(f"cell_{cell}" for cell in study.grid.cells)
    return Variable(words.goal(robot), Owner.SYSTEM, EnumerationDomain((NONE, *cells)))


def is_sent_to(robot: Robot, cell: int) -> Formula:
    """That the mission sends a robot to a cell."""
    return words.is_(words.goal(robot), f"cell_{cell}")


def define_targets(study: Study, robot: Robot) -> Iterator[Conjunct]:
    """A robot begins in its target, and takes a goal when it is in its last target.

    No mission sends a robot where no way leads (its target would never be reached), so that such
    a goal is as good as none.
    """
    here, goal = f.var(words.position(robot)), f.var(words.target(robot))
    yield words.first(f.eq(here, goal), robot.origin, "At first a robot is in its target.")
    text = f"'{robot.name}' takes its goal when it is in its target."
    for cell in study.grid.cells:
        reach = words.one_of(words.position(robot), sorted(study.grid.distances(cell)))
        takes = f.both(words.reached(robot), is_sent_to(robot, cell), reach)
        after = f.primed(words.is_(words.target(robot), cell))
        yield words.each(f.implies(takes, after), robot.origin, text)
        stays = f.eq(f.primed(goal), goal)
        lost = f.both(words.reached(robot), is_sent_to(robot, cell), f.negate(reach))
        yield words.each(f.implies(lost, stays), robot.origin, text)
    rests = f.either(words.away(robot), words.is_(words.goal(robot), NONE))
    yield words.each(f.implies(rests, f.eq(f.primed(goal), goal)), robot.origin, text)


def mission_guarantees(study: Study) -> Iterator[Conjunct]:
    """What every mission promises of the goals that it gives (C_M), until robots are late."""
    for robot in study.robots:
        none = words.is_(words.goal(robot), NONE)
        yield words.first(none, robot.origin, f"At first '{robot.name}' has no target.")
        for cell in study.grid.cells:
            yield _keep_goal(robot, cell)
    for one, other in combinations(study.robots, 2):
        for cell in study.grid.cells:
            both = f.both(is_sent_to(one, cell), is_sent_to(other, cell))
            text = f"One robot goes to cell {cell}."
            yield words.each(f.negate(both), other.origin, text)


def never_sent(robot: Robot) -> Conjunct:
    """The mission never sends a robot anywhere."""
    none = words.is_(words.goal(robot), NONE)
    return words.each(none, robot.origin, f"'{robot.name}' has no target.")


def _keep_goal(robot: Robot, cell: int) -> Conjunct:
    there = f.both(words.at(robot, cell), words.is_(words.target(robot), cell))
    under_way = f.both(is_sent_to(robot, cell), f.negate(f.primed(there)))
    text = f"'{robot.name}' keeps a target until it has reached it."
    return words.each(f.implies(under_way, f.primed(is_sent_to(robot, cell))), robot.origin, text)
