"""What a robot's machine answers where one way at most is offered to it."""

from collections.abc import Callable, Mapping
from typing import NamedTuple

from sysmlc.logic.evaluate import compile_evaluation
from sysmlc.logic.formula import Literal
from sysmlc.robots import contract_terms as words
from sysmlc.robots.study import WAYS, Grid, Robot, next_move
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
        self._robot, self._grid = robot, grid
        self._step = _steps(machine)
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
            outputs, state = self._step(memory.state, last, now)
        except LookupError:
            return None
        now |= outputs
        kept = tuple(now[name] for name in self._registers)
        command = str(now[words.command(robot)])
        there = self._grid.after(cell, command)
        after = cell if there is None else there
        return Answer(command, Memory(after, goal, cell == goal, state, kept))


Values = Mapping[str, Literal]
Step = Callable[[int, Values, Values], tuple[Values, int]]
"""The outputs and the next state, for a state, what was known before, and inputs."""


def _steps(machine: Machine | Table) -> Step:
    """How a machine is asked; raises LookupError where it has no move.

    Its conditions, which are long, are walked through once and not for each question.
    """
    if isinstance(machine, Table):
        return machine.step
    names = [one.name for one in machine.outputs]
    rows = [
        [
            (compile_evaluation(move.when), tuple(map(compile_evaluation, move.output)), move.state)
            for move in moves
        ]
        for moves in machine.states
    ]

    def step(state: int, last: Values, now: Values) -> tuple[Values, int]:
        for when, outputs, after in rows[state]:
            if when(last, now):
                values = (output(last, None) for output in outputs)
                return dict(zip(names, values, strict=True)), after
        raise LookupError(state)

    return step


def exceeds_travel_limit(grid: Grid, answers: Answers, cell: int, goal: int, within: int) -> bool:
    """Whether a robot that is given a target has it for more steps than that.

    It is not stopped on its way (``traffic``), so that the steps are those of one that is alone.
    """
    known = Memory(cell, cell)
    for _ in range(within + 1):
        step = next_move(grid, known.cell, goal)
        if step is None:
            return known.cell != goal
        answer = answers.get(known, goal, step[0])
        if answer is None:
            return False
        known = answer.memory
    return True
