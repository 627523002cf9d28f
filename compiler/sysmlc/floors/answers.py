"""What a robot's machine answers where one way at most is offered to it."""

from collections.abc import Mapping
from typing import NamedTuple

from sysmlc.floors import words
from sysmlc.floors.study import WAYS, Grid, Robot
from sysmlc.logic.evaluate import value_of
from sysmlc.logic.formula import Literal
from sysmlc.synthesis.controllers.mealy import Machine
from sysmlc.synthesis.controllers.table import Table


class Memory(NamedTuple):
    """What is known of a robot between two steps."""

    cell: int
    """Where its command brings it."""
    goal: int
    """Its target, which stays unless the robot was in it."""
    is_home: bool = True
    """Whether it was in its target."""
    state: int = 0
    """Of its machine."""
    registers: tuple[Literal, ...] = ()
    """Of its machine, in their order."""


class Answer(NamedTuple):
    """The command, and what is known then."""

    command: str
    memory: Memory


class Answers:
    """The machine of a robot, each answer looked up once."""

    def __init__(self, machine: Machine | Table, robot: Robot, grid: Grid) -> None:
        """Nothing is asked yet. The machine is one of the robot's contract without counters."""
        self._machine, self._robot, self._grid = machine, robot, grid
        known = (*machine.inputs, *machine.outputs)
        kept = machine.registers if isinstance(machine, Machine) else known
        self._registers = tuple(one.name for one in kept)
        self._known: dict[tuple[Memory, int, str], Answer | None] = {}

    def get(self, memory: Memory, goal: int, way: str = "") -> Answer | None:
        """The answer to a target and the way that is offered, if one is.

        None when the machine has none: the assumptions of its contract exclude that.
        """
        key = memory, goal, way
        if key not in self._known:
            self._known[key] = self._asked(memory, goal, (way,) if way else ())
        return self._known[key]

    def _asked(self, memory: Memory, goal: int, ways: tuple[str, ...]) -> Answer | None:
        robot, cell = self._robot, memory.cell
        last: Mapping[str, Literal] = dict(zip(self._registers, memory.registers, strict=False))
        now: dict[str, Literal] = {words.position(robot): cell, words.target(robot): goal}
        now |= {words.sensor(robot, way): way in ways for way in WAYS}
        try:
            outputs, state = _stepped(self._machine, memory.state, last, now)
        except LookupError:
            return None
        now |= outputs
        kept = tuple(now[name] for name in self._registers)
        command = str(now[words.command(robot)])
        there = self._grid.after(cell, command)
        after = cell if there is None else there
        return Answer(command, Memory(after, goal, cell == goal, state, kept))


def _stepped(
    machine: Machine | Table, state: int, last: Mapping[str, Literal], now: Mapping[str, Literal]
) -> tuple[Mapping[str, Literal], int]:
    """The outputs and the next state. Raises LookupError where the machine has no move."""
    if isinstance(machine, Table):
        return machine.step(state, last, now)
    move = machine.taken(state, last, now)
    names = (one.name for one in machine.outputs)
    values = (value_of(one, last) for one in move.output)
    return dict(zip(names, values, strict=True)), move.state
