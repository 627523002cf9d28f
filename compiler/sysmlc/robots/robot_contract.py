"""The contract of one robot, C_R (MOOD4I thesis, 4.3.2), alone on the floor or among others."""

from collections.abc import Iterator

from sysmlc.logic import formula as f
from sysmlc.logic.contract import Conjunct, Contract, IntegerDomain, Owner, Variable
from sysmlc.logic.formula import Formula
from sysmlc.robots import contract_terms as words
from sysmlc.robots.study import STAY, WAYS, Robot, Study

_ENVIRONMENT, _SYSTEM = Owner.ENVIRONMENT, Owner.SYSTEM


def robot_contract(study: Study, robot: Robot, is_alone: bool = True) -> Contract:
    """What a robot promises: to go on free ways only, and to reach its targets.

    ``is_alone`` is the thesis's: all ways but those into walls and obstacles are always free.
    Otherwise other robots may be in the way, and it is assumed that again and again a way that
    brings the robot nearer is offered to it.
    """
    seen = _walls(study, robot) if not is_alone else _free_ways(study, robot)
    assumed = [
        *words.starts((robot,)),
        *words.in_all((*words.on_floor(study, robot), *seen)),
        *words.motion(study, robot, is_total=False),
        *words.stable_target(study, robot),
    ]
    if not is_alone:
        text = f"Again and again '{robot.name}' is in its target, or may go nearer."
        is_nearer = f.either(words.reached(robot), nearer_offered(study, robot))
        assumed.append(words.again(is_nearer, robot.origin, text))
    variables = (
        words.cells(words.position(robot), _ENVIRONMENT, study.grid, robot.origin),
        words.cells(words.target(robot), _ENVIRONMENT, study.grid, robot.origin),
        *tuple(words.places(study, robot, _ENVIRONMENT))[1:],
        words.commands(robot, _SYSTEM),
        *counters(study, robot),
    )
    name = f"{study.component}.{robot.word}"
    return Contract(
        f"{name}.shared" if not is_alone else name,
        robot.origin,
        variables,
        tuple(assumed),
        tuple(_promised(study, robot)),
    )


def _promised(study: Study, robot: Robot) -> Iterator[Conjunct]:
    yield words.first(words.is_(words.command(robot), STAY), robot.origin, "At first it stays.")
    yield from words.obedience(robot)
    rests = f.primed(words.is_(words.command(robot), STAY))
    text = f"In its target '{robot.name}' stays for a step."
    yield words.each(f.implies(words.reached(robot), rests), robot.origin, text)
    yield from counting(study, robot)
    text = f"'{robot.name}' reaches its targets."
    yield words.again(words.reached(robot), robot.origin, text)


def _walls(study: Study, robot: Robot) -> Iterator[Conjunct]:
    for way in WAYS:
        for cell in study.grid.cells:
            if study.grid.after(cell, way) is None:
                yield _seen(robot, cell, way, is_free=False)


def _free_ways(study: Study, robot: Robot) -> Iterator[Conjunct]:
    for way in WAYS:
        for cell in study.grid.cells:
            yield _seen(robot, cell, way, study.grid.after(cell, way) is not None)


def _seen(robot: Robot, cell: int, way: str, is_free: bool) -> Conjunct:
    seen: Formula = f.var(words.sensor(robot, way))
    text = f"From cell {cell} the way {way} is {'free' if is_free else 'barred'}."
    value = seen if is_free else f.negate(seen)
    return words.first(f.implies(words.at(robot, cell), value), robot.origin, text)


def nearer_offered(study: Study, robot: Robot) -> Formula:
    """That a sensor shows a way which brings the robot nearer to its target."""
    found: list[Formula] = []
    for cell in study.grid.cells:
        for way in WAYS:
            goals = [goal for goal in study.grid.cells if way in study.grid.nearer(cell, goal)]
            if goals:
                there = words.one_of(words.target(robot), goals)
                seen = f.var(words.sensor(robot, way))
                found.append(f.both(words.at(robot, cell), seen, there))
    return f.either(*found)


def counters(study: Study, robot: Robot) -> Iterator[Variable]:
    """The step counter of a robot, if the floor has any."""
    if study.counted:
        domain = IntegerDomain(0, study.counted - 1)
        yield Variable(words.steps(robot), _SYSTEM, domain, robot.origin)


def counting(study: Study, robot: Robot) -> Iterator[Conjunct]:
    """A step counter counts changes of position (thesis 4.3.1), and begins again at its end."""
    if not study.counted:
        return
    here, count = f.var(words.position(robot)), f.var(words.steps(robot))
    is_moved = f.negate(f.eq(f.primed(here), here))
    text = f"'{robot.name}' counts its steps."
    yield words.first(words.is_(words.steps(robot), 0), robot.origin, text)
    stays = f.implies(f.negate(is_moved), f.eq(f.primed(count), count))
    yield words.each(stays, robot.origin, text)
    for number in range(study.counted):
        before = f.both(is_moved, words.is_(words.steps(robot), number))
        after = f.primed(words.is_(words.steps(robot), (number + 1) % study.counted))
        yield words.each(f.implies(before, after), robot.origin, text)
