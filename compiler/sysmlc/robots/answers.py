"""Answers of a robot's controller, memoised, if at most one direction is offered to the robot."""

from collections.abc import Callable, Mapping
from typing import NamedTuple

from sysmlc.controllers.machine import Machine
from sysmlc.controllers.table import Table
from sysmlc.logic.evaluate import compile_evaluation
from sysmlc.logic.formula import Literal
from sysmlc.robots import contract_terms as terms
from sysmlc.robots.study import WAYS, Grid, Robot, next_move


class Memory(NamedTuple):
    """The state of a robot between two steps."""

    cell: int
    """The cell in which the robot is after its last command."""
    goal: int
    """The cell of the target. A new target may be assigned only if ``was_at_target``."""
    was_at_target: bool = True
    """Whether the robot was in its target."""
    state: int = 0
    """The state of the machine."""
    registers: tuple[Literal, ...] = ()
    """The values of the machine's registers, in their order."""


class Answer(NamedTuple):
    """The command of a controller, and the memory after the command."""

    command: str
    memory: Memory


class Answers:
    """The controller of a robot with memoised answers."""

    def __init__(self, machine: Machine | Table, robot: Robot, grid: Grid) -> None:
        """Compile a controller of *robot*, synthesised from its contract without step counters."""
        self._robot, self._grid = robot, grid
        self._step = _compile_step(machine)
        variables = (*machine.inputs, *machine.outputs)
        register_variables = machine.registers if isinstance(machine, Machine) else variables
        self._registers = tuple(variable.name for variable in register_variables)
        self._cache: dict[tuple[Memory, int, str], Answer | None] = {}

    def get(self, memory: Memory, goal: int, way: str = "") -> Answer | None:
        """Return the answer to the target *goal* and the offered direction *way*.

        *way* is empty if no direction is offered. Return None if the controller has no answer,
        which happens only for inputs that the assumptions of its contract exclude.
        """
        key = memory, goal, way
        if key not in self._cache:
            self._cache[key] = self._ask_machine(memory, goal, (way,) if way else ())
        return self._cache[key]

    def _ask_machine(self, memory: Memory, goal: int, ways: tuple[str, ...]) -> Answer | None:
        robot, cell = self._robot, memory.cell
        registers: Mapping[str, Literal] = dict(
            zip(self._registers, memory.registers, strict=False)
        )
        values: dict[str, Literal] = {terms.position(robot): cell, terms.target(robot): goal}
        values |= {terms.sensor(robot, way): way in ways for way in WAYS}
        try:
            outputs, state = self._step(memory.state, registers, values)
        except LookupError:
            return None
        values |= outputs
        register_values = tuple(values[name] for name in self._registers)
        command = str(values[terms.command(robot)])
        next_cell = self._grid.cell_after(cell, command)
        reached_cell = cell if next_cell is None else next_cell
        return Answer(command, Memory(reached_cell, goal, cell == goal, state, register_values))


Values = Mapping[str, Literal]
Step = Callable[[int, Values, Values], tuple[Values, int]]
"""Returns outputs and next state for a state, the previous values, and inputs."""


def _compile_step(machine: Machine | Table) -> Step:
    """Return the step function of a controller, which raises LookupError if there is no answer.

    The conditions of a machine are long, so they are compiled once for all steps.
    """
    if isinstance(machine, Table):
        return machine.step
    names = [variable.name for variable in machine.outputs]
    compiled_states = [
        [
            (compile_evaluation(move.when), tuple(map(compile_evaluation, move.output)), move.state)
            for move in moves
        ]
        for moves in machine.states
    ]

    def step(state: int, last: Values, now: Values) -> tuple[Values, int]:
        for when, outputs, next_state in compiled_states[state]:
            if when(last, now):
                values = (output(last, None) for output in outputs)
                return dict(zip(names, values, strict=True)), next_state
        raise LookupError(state)

    return step


def exceeds_travel_limit(grid: Grid, answers: Answers, cell: int, goal: int, within: int) -> bool:
    """Return whether a robot needs more than *within* steps from *cell* to its target *goal*.

    A robot that has departed is never stopped (``traffic``), so other robots need not be simulated.
    """
    memory = Memory(cell, cell)
    for _ in range(within + 1):
        step = next_move(grid, memory.cell, goal)
        if step is None:
            return memory.cell != goal
        answer = answers.get(memory, goal, step[0])
        if answer is None:
            return False
        memory = answer.memory
    return True
