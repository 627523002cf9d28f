"""The contract of the mission, C_M (MOOD4I thesis, 4.3.4): targets, their order, and deadlines.

The environment consists of robots that reach each target within their travel time. The system
assigns the targets to them. If the contract is realizable, the mission can be accomplished.
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
from sysmlc.robots import contract_terms as terms
from sysmlc.robots.schedule import START, TravelTimes
from sysmlc.robots.study import Robot, Study, Target
from sysmlc.support.counts import count as count_nouns

NONE, START_WORD = "none", "start"
TIMER = "timer"


def mission_contract(study: Study, travel: TravelTimes) -> Contract:
    """Return C_M: it assumes travel times, and guarantees that targets are reached in time.

    The order of the targets is respected. A target without a deadline is reached eventually.
    """
    return Contract(
        f"{study.component}.mission",
        study.origin,
        tuple(_declare_variables(study, travel)),
        tuple(_list_assumptions(study, travel)),
        tuple(_list_guarantees(study, travel)),
    )


def _declare_variables(study: Study, travel: TravelTimes) -> Iterator[Variable]:
    names = tuple(target.word for target in study.targets)
    if last_deadline := _last_deadline(study):
        domain = IntegerDomain(0, last_deadline + 1)
        yield Variable(TIMER, Owner.ENVIRONMENT, domain, study.origin)
    for robot in study.robots:
        places = EnumerationDomain((START_WORD, *names))
        yield Variable(terms.place(robot), Owner.ENVIRONMENT, places, robot.origin)
        longest = IntegerDomain(0, travel.longest)
        yield Variable(terms.clock(robot), Owner.ENVIRONMENT, longest, robot.origin)
        goals = EnumerationDomain((NONE, *names))
        yield Variable(terms.goal(robot), Owner.SYSTEM, goals, robot.origin)
    for target in study.targets:
        yield Variable(terms.completion(target), Owner.SYSTEM, BooleanDomain(), target.origin)


def _last_deadline(study: Study) -> int:
    """Return the latest deadline, or 0 if there is none."""
    deadlines = (study.deadline, *(target.deadline for target in study.targets))
    return max((deadline for deadline in deadlines if deadline is not None), default=0)


# -- assumptions -------------------------------------------------------------------------------


def _list_assumptions(study: Study, travel: TravelTimes) -> Iterator[Conjunct]:
    if last_deadline := _last_deadline(study):
        text = "The timer counts the steps of the mission."
        yield terms.initial_conjunct(terms.equals(TIMER, 0), study.origin, text)
        for number in range(last_deadline + 2):
            after = f.prime(terms.equals(TIMER, min(number + 1, last_deadline + 1)))
            yield terms.safety_conjunct(
                f.implies(terms.equals(TIMER, number), after), study.origin, text
            )
    for number, robot in enumerate(study.robots):
        text = f"'{robot.name}' starts where it is."
        at_start = f.both(
            terms.equals(terms.place(robot), START_WORD), terms.equals(terms.clock(robot), 0)
        )
        yield terms.initial_conjunct(at_start, robot.origin, text)
        yield _rest_without_target(robot)
        for start_place in (START, *range(len(study.targets))):
            for target_number in range(len(study.targets)):
                yield _limit_travel_time(study, travel, number, start_place, target_number)


def _rest_without_target(robot: Robot) -> Conjunct:
    """State that a robot without a target stays in its place."""
    text = f"Without a target '{robot.name}' stays where it is."
    place = f.var(terms.place(robot))
    stays = f.both(f.eq(f.prime(place), place), f.prime(terms.equals(terms.clock(robot), 0)))
    return terms.safety_conjunct(
        f.implies(terms.equals(terms.goal(robot), NONE), stays), robot.origin, text
    )


def _limit_travel_time(
    study: Study, travel: TravelTimes, number: int, start_place: int, target_number: int
) -> Conjunct:
    """State that a robot arrives at a target before its clock reaches the travel time."""
    robot, name = study.robots[number], study.targets[target_number].word
    max_steps = travel.get(number, start_place, target_number)
    origin = START_WORD if start_place == START else study.targets[start_place].word
    under_way = f.both(
        terms.equals(terms.place(robot), origin), terms.equals(terms.goal(robot), name)
    )
    arrives = f.prime(
        f.both(terms.equals(terms.place(robot), name), terms.equals(terms.clock(robot), 0))
    )
    count = f.var(terms.clock(robot))
    if start_place == target_number:
        text = f"'{robot.name}' is in '{name}' already."
        return terms.safety_conjunct(f.implies(under_way, arrives), robot.origin, text)
    stays_at_origin = f.prime(terms.equals(terms.place(robot), origin))
    if max_steps is None:
        text = f"'{robot.name}' cannot get from '{origin}' to '{name}'."
        never = f.both(stays_at_origin, f.prime(terms.equals(terms.clock(robot), 0)))
        return terms.safety_conjunct(f.implies(under_way, never), robot.origin, text)
    continues = f.both(
        f.compare(Op.LT, count, f.const(max_steps - 1)),
        stays_at_origin,
        f.eq(f.prime(count), f.Apply(Op.ADD, (count, f.const(1)))),
    )
    steps = count_nouns(max_steps, "step")
    text = f"'{robot.name}' gets from '{origin}' to '{name}' in {steps} at most."
    return terms.safety_conjunct(
        f.implies(under_way, f.either(arrives, continues)), robot.origin, text
    )


# -- guarantees --------------------------------------------------------------------------------


def _list_guarantees(study: Study, travel: TravelTimes) -> Iterator[Conjunct]:
    for target in study.targets:
        text = f"At first '{target.name}' has not been reached."
        yield terms.initial_conjunct(f.negate(f.var(terms.completion(target))), target.origin, text)
    for robot in study.robots:
        text = f"At first '{robot.name}' has no target."
        yield terms.initial_conjunct(terms.equals(terms.goal(robot), NONE), robot.origin, text)
    for number in range(len(study.targets)):
        yield from _target_guarantees(study, number)
    yield from _respect_orders(study)
    yield from _meet_deadlines(study)


def _target_guarantees(study: Study, number: int) -> Iterator[Conjunct]:
    """State that a target is reached once, by one robot, which keeps it until then."""
    target = study.targets[number]
    is_done = f.var(terms.completion(target))
    arrivals = [_arrives_at(robot, target) for robot in study.robots]
    text = f"'{target.name}' has been reached when a robot has."
    definition = f.iff(f.prime(is_done), f.either(is_done, *arrivals))
    yield terms.safety_conjunct(definition, target.origin, text)
    for robot in study.robots:
        is_sent = terms.equals(terms.goal(robot), target.word)
        arrives = f.prime(terms.equals(terms.place(robot), target.word))
        text = f"'{robot.name}' keeps a target until it has reached it."
        keeps_target = f.implies(f.both(is_sent, f.negate(arrives)), f.prime(is_sent))
        yield terms.safety_conjunct(keeps_target, robot.origin, text)
        text = f"'{target.name}' is reached once."
        is_reached_once = f.prime(f.implies(is_done, f.negate(is_sent)))
        yield terms.safety_conjunct(is_reached_once, target.origin, text)
    for first, second in combinations(study.robots, 2):
        text = f"One robot goes to '{target.name}'."
        both_are_sent = f.both(
            *(terms.equals(terms.goal(robot), target.word) for robot in (first, second))
        )
        yield terms.safety_conjunct(f.prime(f.negate(both_are_sent)), target.origin, text)


def _arrives_at(robot: Robot, target: Target) -> Formula:
    """Return the predicate that a robot that is sent to a target reaches it in the next step."""
    is_sent = terms.equals(terms.goal(robot), target.word)
    return f.both(is_sent, f.prime(terms.equals(terms.place(robot), target.word)))


def _respect_orders(study: Study) -> Iterator[Conjunct]:
    """State that a robot is sent to a target only after the targets before it were reached."""
    for order in study.orders:
        earlier, later = study.targets[order.earlier], study.targets[order.later]
        for robot in study.robots:
            is_sent = terms.equals(terms.goal(robot), later.word)
            text = f"'{later.name}' comes after '{earlier.name}'."
            waits_for_earlier = f.prime(f.implies(is_sent, f.var(terms.completion(earlier))))
            yield terms.safety_conjunct(waits_for_earlier, order.origin, text)
            if order.is_carried:
                yield from _carry(robot, earlier, later, order.origin)


def _carry(robot: Robot, earlier: Target, later: Target, origin: str) -> Iterator[Conjunct]:
    """State that the robot that has reached the earlier target continues to the later one."""
    text = f"Who was in '{earlier.name}' goes on to '{later.name}', nobody else does."
    is_sent = f.prime(terms.equals(terms.goal(robot), later.word))
    has_arrived = f.prime(terms.equals(terms.place(robot), earlier.word))
    yield terms.safety_conjunct(f.implies(is_sent, has_arrived), origin, text)
    # The robot may have no target for a while, but no other one than the later target.
    is_not_done = f.negate(f.prime(f.var(terms.completion(later))))
    has_no_target = f.prime(terms.equals(terms.goal(robot), NONE))
    continues = f.implies(f.both(has_arrived, is_not_done), f.either(is_sent, has_no_target))
    yield terms.safety_conjunct(continues, origin, text)


def _meet_deadlines(study: Study) -> Iterator[Conjunct]:
    for target in study.targets:
        limit = study.limit(target)
        is_done = f.var(terms.completion(target))
        if limit is None:
            text = f"'{target.name}' is reached."
            yield terms.liveness_conjunct(is_done, target.origin, text)
            continue
        text = f"'{target.name}' is reached within {count_nouns(limit, 'step')}."
        is_late = f.compare(Op.GE, f.var(TIMER), f.const(limit))
        yield terms.safety_conjunct(f.implies(is_late, is_done), target.origin, text)
