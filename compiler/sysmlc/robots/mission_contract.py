"""The contract of the mission, C_M (MOOD4I thesis, 4.3.4): targets, their order, and deadlines.

The environment is robots that reach each target within the time that they travel; the system is
whoever gives them targets. That the contract can be kept says that the mission can be done.
"""

from collections.abc import Iterator
from itertools import combinations

from sysmlc.logic import formula as f
from sysmlc.logic.contract import (
    BooleanDomain,
    Conjunct,
    Contract,
    EnumerationDomain,
    IntegerDomain,
    Owner,
    Variable,
)
from sysmlc.logic.formula import Formula, Op
from sysmlc.robots import contract_terms as words
from sysmlc.robots.schedule import START, TravelTimes
from sysmlc.robots.study import Robot, Study, Target

NONE, START_WORD = "none", "start"
TIMER = "timer"


def mission_contract(study: Study, travel: TravelTimes) -> Contract:
    """Every robot travels no longer than it is known to; all targets are reached in order, in time.

    Without a deadline all targets are reached at some time.
    """
    return Contract(
        f"{study.component}.mission",
        study.origin,
        tuple(_variables(study, travel)),
        tuple(_assumed(study, travel)),
        tuple(_promised(study, travel)),
    )


def _variables(study: Study, travel: TravelTimes) -> Iterator[Variable]:
    names = tuple(target.word for target in study.targets)
    if last := _last(study):
        domain = IntegerDomain(0, last + 1)
        yield Variable(TIMER, Owner.ENVIRONMENT, domain, study.origin)
    for robot in study.robots:
        places = EnumerationDomain((START_WORD, *names))
        yield Variable(words.place(robot), Owner.ENVIRONMENT, places, robot.origin)
        longest = IntegerDomain(0, travel.longest)
        yield Variable(words.clock(robot), Owner.ENVIRONMENT, longest, robot.origin)
        goals = EnumerationDomain((NONE, *names))
        yield Variable(words.goal(robot), Owner.SYSTEM, goals, robot.origin)
    for target in study.targets:
        yield Variable(words.done(target), Owner.SYSTEM, BooleanDomain(), target.origin)


def _last(study: Study) -> int:
    """The last deadline; 0 when there is none."""
    known = (study.deadline, *(target.deadline for target in study.targets))
    return max((one for one in known if one is not None), default=0)


# -- assumptions -------------------------------------------------------------------------------


def _assumed(study: Study, travel: TravelTimes) -> Iterator[Conjunct]:
    if last := _last(study):
        text = "The timer counts the steps of the mission."
        yield words.first(words.is_(TIMER, 0), study.origin, text)
        for number in range(last + 2):
            after = f.primed(words.is_(TIMER, min(number + 1, last + 1)))
            yield words.each(f.implies(words.is_(TIMER, number), after), study.origin, text)
    for number, robot in enumerate(study.robots):
        text = f"'{robot.name}' starts where it is."
        at_start = f.both(
            words.is_(words.place(robot), START_WORD), words.is_(words.clock(robot), 0)
        )
        yield words.first(at_start, robot.origin, text)
        yield _idle(robot)
        for from_ in (START, *range(len(study.targets))):
            for to in range(len(study.targets)):
                yield _travelling(study, travel, number, from_, to)


def _idle(robot: Robot) -> Conjunct:
    text = f"Without a target '{robot.name}' stays where it is."
    here = f.var(words.place(robot))
    rests = f.both(f.eq(f.primed(here), here), f.primed(words.is_(words.clock(robot), 0)))
    return words.each(f.implies(words.is_(words.goal(robot), NONE), rests), robot.origin, text)


def _travelling(study: Study, travel: TravelTimes, number: int, from_: int, to: int) -> Conjunct:
    """A robot on its way arrives in time, or goes on and counts."""
    robot, name = study.robots[number], study.targets[to].word
    most = travel.get(number, from_, to)
    origin = START_WORD if from_ == START else study.targets[from_].word
    under_way = f.both(words.is_(words.place(robot), origin), words.is_(words.goal(robot), name))
    arrives = f.primed(
        f.both(words.is_(words.place(robot), name), words.is_(words.clock(robot), 0))
    )
    count = f.var(words.clock(robot))
    if from_ == to:
        text = f"'{robot.name}' is in '{name}' already."
        return words.each(f.implies(under_way, arrives), robot.origin, text)
    stays = f.primed(words.is_(words.place(robot), origin))
    if most is None:
        text = f"'{robot.name}' cannot get from '{origin}' to '{name}'."
        never = f.both(stays, f.primed(words.is_(words.clock(robot), 0)))
        return words.each(f.implies(under_way, never), robot.origin, text)
    goes_on = f.both(
        f.compare(Op.LT, count, f.const(most - 1)),
        stays,
        f.eq(f.primed(count), f.Apply(Op.ADD, (count, f.const(1)))),
    )
    text = f"'{robot.name}' gets from '{origin}' to '{name}' in {most} steps at most."
    return words.each(f.implies(under_way, f.either(arrives, goes_on)), robot.origin, text)


# -- guarantees --------------------------------------------------------------------------------


def _promised(study: Study, travel: TravelTimes) -> Iterator[Conjunct]:
    for target in study.targets:
        text = f"At first '{target.name}' has not been reached."
        yield words.first(f.negate(f.var(words.done(target))), target.origin, text)
    for robot in study.robots:
        text = f"At first '{robot.name}' has no target."
        yield words.first(words.is_(words.goal(robot), NONE), robot.origin, text)
    for number in range(len(study.targets)):
        yield from _of_target(study, number)
    yield from _orders(study)
    yield from _deadlines(study)


def _of_target(study: Study, number: int) -> Iterator[Conjunct]:
    target = study.targets[number]
    is_done = f.var(words.done(target))
    arrivals = [_arrival(robot, target) for robot in study.robots]
    text = f"'{target.name}' has been reached when a robot has."
    becomes = f.iff(f.primed(is_done), f.either(is_done, *arrivals))
    yield words.each(becomes, target.origin, text)
    for robot in study.robots:
        goes = words.is_(words.goal(robot), target.word)
        arrives = f.primed(words.is_(words.place(robot), target.word))
        text = f"'{robot.name}' keeps a target until it has reached it."
        keeps = f.implies(f.both(goes, f.negate(arrives)), f.primed(goes))
        yield words.each(keeps, robot.origin, text)
        text = f"'{target.name}' is reached once."
        once = f.primed(f.implies(is_done, f.negate(goes)))
        yield words.each(once, target.origin, text)
    for one, other in combinations(study.robots, 2):
        text = f"One robot goes to '{target.name}'."
        both = f.both(*(words.is_(words.goal(robot), target.word) for robot in (one, other)))
        yield words.each(f.primed(f.negate(both)), target.origin, text)


def _arrival(robot: Robot, target: Target) -> Formula:
    goes = words.is_(words.goal(robot), target.word)
    return f.both(goes, f.primed(words.is_(words.place(robot), target.word)))


def _orders(study: Study) -> Iterator[Conjunct]:
    for order in study.orders:
        earlier, later = study.targets[order.earlier], study.targets[order.later]
        for robot in study.robots:
            goes = words.is_(words.goal(robot), later.word)
            text = f"'{later.name}' comes after '{earlier.name}'."
            waits = f.primed(f.implies(goes, f.var(words.done(earlier))))
            yield words.each(waits, order.origin, text)
            if order.is_carried:
                yield from _carrying(robot, earlier, later, order.origin)


def _carrying(robot: Robot, earlier: Target, later: Target, origin: str) -> Iterator[Conjunct]:
    text = f"Who was in '{earlier.name}' goes on to '{later.name}', nobody else does."
    goes = f.primed(words.is_(words.goal(robot), later.word))
    is_there = f.primed(words.is_(words.place(robot), earlier.word))
    yield words.each(f.implies(goes, is_there), origin, text)
    is_open = f.negate(f.primed(f.var(words.done(later))))
    waits = f.primed(words.is_(words.goal(robot), NONE))
    going_on = f.implies(f.both(is_there, is_open), f.either(goes, waits))
    yield words.each(going_on, origin, text)


def _deadlines(study: Study) -> Iterator[Conjunct]:
    for target in study.targets:
        limit = study.limit(target)
        is_done = f.var(words.done(target))
        if limit is None:
            text = f"'{target.name}' is reached."
            yield words.again(is_done, target.origin, text)
            continue
        text = f"'{target.name}' is reached within {limit} steps."
        is_late = f.compare(Op.GE, f.var(TIMER), f.const(limit))
        yield words.each(f.implies(is_late, is_done), target.origin, text)
