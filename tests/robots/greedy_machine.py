"""A hand-written machine of a robot: it takes an offered way that leads nearer, or stays."""

from sysmlc.controllers.machine import Machine, Move
from sysmlc.logic import formula as f
from sysmlc.logic.contract import Owner
from sysmlc.robots import contract_terms as terms
from sysmlc.robots.answers import Answers
from sysmlc.robots.robot_controller import ANY, controller_contract
from sysmlc.robots.study import STAY, WAYS


def greedy_machine(study):
    """Return the machine. In state 1 the robot was not in its target in the previous step."""
    contract = controller_contract(study)
    sides = [
        tuple(variable for variable in contract.variables if variable.owner is owner)
        for owner in Owner
    ]
    position, goal = (f.prime(f.var(name(ANY))) for name in (terms.position, terms.target))
    is_home = f.eq(position, goal)
    moves = [_move(is_home, STAY, 0), *_iter_travel_moves(study), _move(f.TRUE, STAY, 1)]
    resting = (_move(is_home, STAY, 0), _move(f.TRUE, STAY, 1))
    return Machine(*sides, (), (resting, tuple(moves)))


def _move(when, command, state):
    return Move(when, (f.const(command),), state)


def _iter_travel_moves(study):
    grid = study.grid
    for way in WAYS:
        for goal in grid.cells:
            cells = [cell for cell in grid.cells if way in grid.commands_nearer(cell, goal)]
            if cells:
                is_there = terms.is_in_any(terms.position(ANY), cells)
                sees = f.var(terms.sensor(ANY, way))
                when = f.both(is_there, sees, terms.equals(terms.target(ANY), goal))
                yield _move(f.prime(when), way, 1)


def greedy_answers(study):
    """Return the answers of the greedy machine for all robots of a floor."""
    machine = greedy_machine(study)
    return (Answers(machine, ANY, study.grid),) * len(study.robots)
