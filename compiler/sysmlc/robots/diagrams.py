"""Conditions on where robots start, as decision diagrams: for more starts than can be listed."""

from sysmlc.robots.planes import Runs
from sysmlc.robots.study import Study
from sysmlc.synthesis import Limits, Manager, Node

MEMORY = 4 << 30
"""Bytes that the diagrams may take."""


def started(study: Study, limits: Limits | None = None) -> tuple[Runs[Node], int]:
    """All admissible starts, and how many there are."""
    manager = Manager(limits=limits or Limits(memory=MEMORY))
    size = study.grid.size
    width = max(1, (size - 1).bit_length())
    names = [[f"s{robot}_{bit}" for bit in range(width)] for robot in range(len(study.robots))]
    manager.declare([bit for own in names for bit in own])
    starts = [
        [_in_cell(manager, study, robot, cell, bits) for cell in range(size)]
        for robot, bits in enumerate(names)
    ]
    valid = manager.true
    for robot in starts:
        placed = manager.false
        for one in robot:
            placed = placed | one
        valid = valid & placed
    for cell in range(size):
        taken = manager.false
        for robot in starts:
            valid = valid & ~(taken & robot[cell])
            taken = taken | robot[cell]
    known = tuple(tuple(one & valid for one in own) for own in starts)
    runs = Runs(valid, manager.false, known, _but)
    return runs, manager.count(valid, [bit for own in names for bit in own])


def _but(one: Node, other: Node) -> Node:
    return one & ~other


def _in_cell(manager: Manager, study: Study, robot: int, cell: int, bits: list[str]) -> Node:
    """That a robot starts in a cell; where it cannot, never."""
    start = study.robots[robot].start
    if cell in study.grid.blocked or start not in (None, cell):
        return manager.false
    return manager.cube({bit: bool(cell >> at & 1) for at, bit in enumerate(bits)})
