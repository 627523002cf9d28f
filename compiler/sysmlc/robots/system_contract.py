"""The contract of all robots together, C_S (MOOD4I thesis, 4.3.1).

Positions, sensors and free cells are its inputs.
"""

from collections.abc import Iterator

from sysmlc.logic import formula as f
from sysmlc.logic.contract import Conjunct, Contract, IntegerDomain, Owner, Variable
from sysmlc.logic.formula import Op
from sysmlc.robots import contract_terms as terms
from sysmlc.robots.contract_terms import (
    define_free_cells,
    define_sensors,
    forbid_shared_cells,
)
from sysmlc.robots.robot_contract import count_steps, declare_counter
from sysmlc.robots.study import STAY, Robot, Study
from sysmlc.support.counts import count

_ENVIRONMENT, _SYSTEM = Owner.ENVIRONMENT, Owner.SYSTEM


def system_contract(study: Study) -> Contract:
    """Return the contract of the whole system: all robots reach their targets and never meet.

    With ``study.within`` each target is reached within this number of steps after its assignment.
    The timer of the thesis, taken literally, never restarts: the contract would be unrealizable or
    leave the environment without a next step. Here the timer restarts with each target.
    """
    return Contract(
        study.component,
        study.origin,
        tuple(_declare_variables(study)),
        (*_list_assumptions(study), *count_timers(study)),
        tuple(_list_guarantees(study)),
    )


def _declare_variables(study: Study) -> Iterator[Variable]:
    for robot in study.robots:
        place, *sensors = terms.declare_position_and_sensors(study, robot, _ENVIRONMENT)
        yield place
        yield terms.declare_cell(terms.target(robot), _ENVIRONMENT, study.grid, robot.origin)
        if study.within is not None:
            domain = IntegerDomain(0, study.within + 1)
            yield Variable(terms.timer(robot), _ENVIRONMENT, domain, robot.origin)
        yield from sensors
        yield terms.declare_command(robot, _SYSTEM)
        yield from declare_counter(study, robot)
    yield from terms.declare_free_cells(study, _ENVIRONMENT)


# -- assumptions -------------------------------------------------------------------------------


def _list_assumptions(study: Study) -> Iterator[Conjunct]:
    yield from terms.define_starts(study.robots)
    yield from forbid_shared_cells(study)
    places = (rule for robot in study.robots for rule in terms.place_on_floor(study, robot))
    sensors = (rule for robot in study.robots for rule in define_sensors(study, robot))
    yield from terms.repeat_in_every_step((*places, *define_free_cells(study), *sensors))
    for robot in study.robots:
        yield from terms.define_motion(study, robot, is_total=True)
        yield from terms.hold_target_by_cell(study, robot)


def count_timers(study: Study) -> Iterator[Conjunct]:
    """State that timers count the steps since the assignment of a target, if there is a limit."""
    if study.within is None:
        return
    for robot in study.robots:
        yield from _count_timer(robot, (study.within or 0) + 1)


def _count_timer(robot: Robot, max_count: int) -> Iterator[Conjunct]:
    """State that a timer counts up to *max_count*, and restarts when the robot is in its target."""
    text = f"The timer of '{robot.name}' counts the steps since it has its target."
    count = terms.timer(robot)
    yield terms.initial_conjunct(terms.equals(count, 0), robot.origin, text)
    reset = f.implies(terms.is_at_target(robot), f.prime(terms.equals(count, 0)))
    yield terms.safety_conjunct(reset, robot.origin, text)
    for number in range(max_count + 1):
        before = f.both(terms.is_away_from_target(robot), terms.equals(count, number))
        after = f.prime(terms.equals(count, min(number + 1, max_count)))
        yield terms.safety_conjunct(f.implies(before, after), robot.origin, text)


# -- guarantees --------------------------------------------------------------------------------


def _list_guarantees(study: Study) -> Iterator[Conjunct]:
    for robot in study.robots:
        text = f"At first '{robot.name}' stays."
        yield terms.initial_conjunct(terms.equals(terms.command(robot), STAY), robot.origin, text)
    for conjunct in forbid_shared_cells(study):
        yield terms.safety_conjunct(conjunct.formula, conjunct.origin, conjunct.text)
    for robot in study.robots:
        yield from terms.require_sensor_obedience(robot)
        yield from count_steps(study, robot)
    yield from promise_targets(study)


def promise_targets(study: Study) -> Iterator[Conjunct]:
    """State that each robot reaches its targets, within the limit if there is one."""
    for robot in study.robots if study.within is not None else ():
        text = f"'{robot.name}' reaches a target within {count(study.within or 0, 'step')}."
        limit = f.compare(Op.LE, f.var(terms.timer(robot)), f.const(study.within or 0))
        yield terms.safety_conjunct(limit, robot.origin, text)
    for robot in study.robots:
        text = f"'{robot.name}' reaches its targets."
        yield terms.liveness_conjunct(terms.is_at_target(robot), robot.origin, text)
