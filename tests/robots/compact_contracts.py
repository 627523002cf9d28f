"""Contracts of the corpus in other forms than those of the compiler.

Two encodings of C_S are decided faster than that of the thesis (``system_contract``).

``commands`` omits sensors and free cells, which follow from the positions. In ``moves`` a robot
chooses its next position directly instead of giving a command.
"""

from itertools import combinations, permutations

from msgspec.structs import replace

from sysmlc.logic import formula as f
from sysmlc.logic.contract import Owner
from sysmlc.logic.formula import Op
from sysmlc.robots import contract_terms as terms
from sysmlc.robots.contract_terms import forbid_obstacle_cells
from sysmlc.robots.environment_contract import environment_contract
from sysmlc.robots.robot_contract import count_steps
from sysmlc.robots.study import STAY, WAYS
from sysmlc.robots.system_contract import count_timers, promise_targets, system_contract


def compact_contract(study, encoding):
    """Return C_S in an encoding: ``commands`` or ``moves``."""
    contract = system_contract(study)
    chosen = [("_position",), ("_target",), ("_timer",), ("_steps",)]
    chosen += [("_command",)] if encoding == "commands" else []
    variables = [v for v in contract.variables if any(v.name.endswith(end) for end in chosen)]
    if encoding == "moves":
        variables = [
            replace(v, owner=Owner.SYSTEM) if v.name.endswith("_position") else v for v in variables
        ]
    assume, guarantee = _PARTS[encoding]
    return replace(
        contract,
        variables=tuple(variables),
        assumptions=(*assume(study), *count_timers(study)),
        guarantees=(*guarantee(study), *promise_targets(study)),
    )


def _command_assumptions(study):
    yield from terms.define_starts(study.robots)
    yield from _forbid_meeting(study, terms.initial_conjunct)
    places = (rule for robot in study.robots for rule in terms.place_on_floor(study, robot))
    yield from terms.repeat_in_every_step(places)
    for robot in study.robots:
        yield from terms.define_motion(study, robot, is_total=True)
        yield _hold_target(robot)


def _move_assumptions(study):
    for robot in study.robots:
        yield from terms.repeat_in_every_step(terms.require_reachable_targets(study, robot))
        yield _hold_target(robot)


def _command_guarantees(study):
    for robot in study.robots:
        text = f"At first '{robot.name}' stays."
        yield terms.initial_conjunct(terms.equals(terms.command(robot), STAY), robot.origin, text)
    yield from _forbid_meeting(study, terms.safety_conjunct)
    for robot in study.robots:
        yield from _forbid_blocked_commands(study, robot)
        yield from count_steps(study, robot)


def _move_guarantees(study):
    yield from terms.define_starts(study.robots)
    yield from forbid_obstacle_cells(study)
    yield from _forbid_meeting(study, terms.initial_conjunct)
    for robot in study.robots:
        yield from _move_to_neighbours(study, robot)
        yield from count_steps(study, robot)
    yield from _forbid_following(study)
    for conjunct in _forbid_meeting(study, terms.safety_conjunct):
        yield terms.safety_conjunct(f.prime(conjunct.formula), conjunct.origin, conjunct.text)


def _forbid_meeting(study, make_conjunct):
    """State for each pair of robots that they are in different cells."""
    for first, second in combinations(study.robots, 2):
        text = f"'{first.name}' and '{second.name}' are never in one cell."
        yield make_conjunct(_are_in_different_cells(second, first), second.origin, text)


def _are_in_different_cells(first, second, is_primed=False):
    """Return the predicate that two robots are in different cells.

    With ``is_primed`` it compares the next cell of the first robot with the cell of the second.
    """
    first_position, second_position = f.var(terms.position(first)), f.var(terms.position(second))
    return f.compare(
        Op.NE, f.prime(first_position) if is_primed else first_position, second_position
    )


def _forbid_blocked_commands(study, robot):
    """Forbid commands into a wall, an obstacle or another robot."""
    text = f"'{robot.name}' goes only where nothing is."
    other_robots = [other for other in study.robots if other != robot]
    for way in WAYS:
        for cell in study.grid.cells:
            moves = f.both(terms.equals(terms.command(robot), way), terms.is_in_cell(robot, cell))
            neighbour = study.grid.cell_after(cell, way)
            blocked = (
                [f.TRUE]
                if neighbour is None
                else [terms.is_in_cell(other_robot, neighbour) for other_robot in other_robots]
            )
            for condition in blocked:
                yield terms.safety_conjunct(
                    f.prime(f.negate(f.both(moves, condition))), robot.origin, text
                )


def _move_to_neighbours(study, robot):
    """State that a robot moves to a neighbour cell or stays."""
    for cell in study.grid.cells:
        reachable = (cell, *(neighbour for _, neighbour in study.grid.neighbours(cell)))
        moves = f.prime(terms.is_in_any(terms.position(robot), reachable))
        text = f"From cell {cell} '{robot.name}' goes to a neighbour, or stays."
        yield terms.safety_conjunct(
            f.implies(terms.is_in_cell(robot, cell), moves), robot.origin, text
        )


def _forbid_following(study):
    """State that no robot enters a cell that another robot is just leaving."""
    for robot, other_robot in permutations(study.robots, 2):
        text = f"'{robot.name}' does not go where '{other_robot.name}' is."
        yield terms.safety_conjunct(
            _are_in_different_cells(robot, other_robot, is_primed=True), robot.origin, text
        )


def _hold_target(robot):
    """State that a target stays until it is reached, with a comparison of positions."""
    text = f"The target of '{robot.name}' stays until it is reached."
    target = f.var(terms.target(robot))
    stays = f.eq(f.prime(target), target)
    formula = f.implies(terms.is_away_from_target(robot), stays)
    return terms.safety_conjunct(formula, robot.origin, text)


_PARTS = {
    "commands": (_command_assumptions, _command_guarantees),
    "moves": (_move_assumptions, _move_guarantees),
}


def assume_no_meeting(study):
    """Return C_E of the thesis with the assumption that no two robots move to one cell."""
    contract = environment_contract(study, is_literal=True)
    assumptions = []
    for first, second in combinations(study.robots, 2):
        for cell in study.grid.cells:
            meet = f.both(_moves_to(study, second, cell), _moves_to(study, first, cell))
            assumptions.append(terms.safety_conjunct(f.negate(meet), second.origin, "no meeting"))
    return replace(contract, assumptions=(*contract.assumptions, *assumptions))


def _moves_to(study, robot, cell):
    """Return the predicate that a robot will be in a cell after its command."""
    entries = [
        (neighbour, way)
        for neighbour in study.grid.cells
        for way in WAYS
        if study.grid.cell_after(neighbour, way) == cell
    ]
    return f.either(
        *(
            f.both(terms.is_in_cell(robot, start), terms.equals(terms.command(robot), way))
            for start, way in ((cell, STAY), *entries)
        )
    )
