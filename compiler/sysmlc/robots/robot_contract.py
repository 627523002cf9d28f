"""The contract of one robot, C_R (MOOD4I thesis, 4.3.2), alone on the floor or among others."""

from collections.abc import Iterator

from sysmlc.logic import formula as f
from sysmlc.logic.contract import Conjunct, Contract, IntegerDomain, Owner, Variable
from sysmlc.logic.formula import Formula
from sysmlc.robots import contract_terms as terms
from sysmlc.robots.study import STAY, WAYS, Robot, Study

_ENVIRONMENT, _SYSTEM = Owner.ENVIRONMENT, Owner.SYSTEM


def robot_contract(study: Study, robot: Robot, is_alone: bool = True) -> Contract:
    """Return C_R: a robot moves only in free directions, and reaches its targets.

    With ``is_alone``, as in the thesis, it assumes that all directions are free except those into
    walls and obstacles. Otherwise other robots may be in the way, and it assumes that a direction
    nearer to the target is offered infinitely often.
    """
    sensor_conjuncts = _barred_ways(study, robot) if not is_alone else _all_ways(study, robot)
    assumptions = [
        *terms.define_starts((robot,)),
        *terms.repeat_in_every_step((*terms.place_on_floor(study, robot), *sensor_conjuncts)),
        *terms.define_motion(study, robot, is_total=False),
        *terms.hold_target_by_cell(study, robot),
    ]
    if not is_alone:
        text = f"Again and again '{robot.name}' is in its target, or may go nearer."
        is_nearer = f.either(terms.is_at_target(robot), _nearer_offered(study, robot))
        assumptions.append(terms.liveness_conjunct(is_nearer, robot.origin, text))
    variables = (
        terms.declare_cell(terms.position(robot), _ENVIRONMENT, study.grid, robot.origin),
        terms.declare_cell(terms.target(robot), _ENVIRONMENT, study.grid, robot.origin),
        *tuple(terms.declare_position_and_sensors(study, robot, _ENVIRONMENT))[1:],
        terms.declare_command(robot, _SYSTEM),
        *declare_counter(study, robot),
    )
    name = f"{study.component}.{robot.word}"
    return Contract(
        f"{name}.shared" if not is_alone else name,
        robot.origin,
        variables,
        tuple(assumptions),
        tuple(_list_guarantees(study, robot)),
    )


def _list_guarantees(study: Study, robot: Robot) -> Iterator[Conjunct]:
    yield terms.initial_conjunct(
        terms.equals(terms.command(robot), STAY), robot.origin, "At first it stays."
    )
    yield from terms.require_sensor_obedience(robot)
    stays_next = f.prime(terms.equals(terms.command(robot), STAY))
    # The step in which the robot can get its next target.
    text = f"In its target '{robot.name}' stays for a step."
    yield terms.safety_conjunct(
        f.implies(terms.is_at_target(robot), stays_next), robot.origin, text
    )
    yield from count_steps(study, robot)
    text = f"'{robot.name}' reaches its targets."
    yield terms.liveness_conjunct(terms.is_at_target(robot), robot.origin, text)


def _barred_ways(study: Study, robot: Robot) -> Iterator[Conjunct]:
    """State that sensors never offer directions into walls and obstacles."""
    for way in WAYS:
        for cell in study.grid.cells:
            if study.grid.cell_after(cell, way) is None:
                yield _state_sensor(robot, cell, way, is_free=False)


def _all_ways(study: Study, robot: Robot) -> Iterator[Conjunct]:
    """State the value of each sensor in each cell, if no other robot is on the floor."""
    for way in WAYS:
        for cell in study.grid.cells:
            yield _state_sensor(robot, cell, way, study.grid.cell_after(cell, way) is not None)


def _state_sensor(robot: Robot, cell: int, way: str, is_free: bool) -> Conjunct:
    sensor_value: Formula = f.var(terms.sensor(robot, way))
    text = f"From cell {cell} the way {way} is {'free' if is_free else 'barred'}."
    value = sensor_value if is_free else f.negate(sensor_value)
    return terms.initial_conjunct(
        f.implies(terms.is_in_cell(robot, cell), value), robot.origin, text
    )


def _nearer_offered(study: Study, robot: Robot) -> Formula:
    """Return the predicate that a sensor offers a direction nearer to the target."""
    ways: list[Formula] = []
    for cell in study.grid.cells:
        for way in WAYS:
            goals = [
                goal for goal in study.grid.cells if way in study.grid.commands_nearer(cell, goal)
            ]
            if goals:
                is_target = terms.is_in_any(terms.target(robot), goals)
                sensor_value = f.var(terms.sensor(robot, way))
                ways.append(f.both(terms.is_in_cell(robot, cell), sensor_value, is_target))
    return f.either(*ways)


def declare_counter(study: Study, robot: Robot) -> Iterator[Variable]:
    """Declare the step counter of a robot, if the floor has step counters."""
    if study.counter_size:
        domain = IntegerDomain(0, study.counter_size - 1)
        yield Variable(terms.steps(robot), _SYSTEM, domain, robot.origin)


def count_steps(study: Study, robot: Robot) -> Iterator[Conjunct]:
    """State that the counter counts changes of position and wraps around (thesis 4.3.1)."""
    if not study.counter_size:
        return
    position, count = f.var(terms.position(robot)), f.var(terms.steps(robot))
    is_moved = f.negate(f.eq(f.prime(position), position))
    text = f"'{robot.name}' counts its steps."
    yield terms.initial_conjunct(terms.equals(terms.steps(robot), 0), robot.origin, text)
    unchanged = f.implies(f.negate(is_moved), f.eq(f.prime(count), count))
    yield terms.safety_conjunct(unchanged, robot.origin, text)
    for number in range(study.counter_size):
        before = f.both(is_moved, terms.equals(terms.steps(robot), number))
        after = f.prime(terms.equals(terms.steps(robot), (number + 1) % study.counter_size))
        yield terms.safety_conjunct(f.implies(before, after), robot.origin, text)
