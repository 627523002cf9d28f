"""Merging of runs that reached the same state, of which one then represents all (decision 26).

After a few steps most robots are on their way between targets, wherever they started. The future of
a run depends only on its state, so each state is simulated once.
"""

from collections.abc import Iterable, Iterator, Sequence
from operator import itemgetter
from struct import iter_unpack
from typing import NamedTuple, TypeVar

from msgspec import Struct

from sysmlc.robots.answers import Memory
from sysmlc.robots.run_sets import RunSpace, difference
from sysmlc.robots.world import Body, State, World

_T = TypeVar("_T")
_BITS_PER_BYTE = 8
_STATE_BYTES = 3
"""Bytes for the number of a robot's state, enough for sixteen million states."""


class _RobotState(NamedTuple):
    """The state of one robot in one run."""

    memory: Memory | None
    command: str | None
    cell: int | None
    assigned: int | None
    evasion: int | None


class Batch(Struct, frozen=True):
    """States to continue with; a bit of a run set is one state."""

    runs: RunSpace[int]
    state: State[int]
    origins: Sequence[int]
    """By bit, a run that reached this state."""


class StateSet:
    """The distinct states that runs have reached.

    A state is a row of bytes: the state of each robot as a number, then the reached targets.
    """

    def __init__(self, robots: int) -> None:
        """Create an empty set."""
        self._numbers: list[dict[_RobotState, int]] = [{} for _ in range(robots)]
        self._origins: dict[bytes, int] = {}

    def __len__(self) -> int:
        """Return the number of states."""
        return len(self._origins)

    def add(self, world: World[int], origins: Sequence[int]) -> None:
        """Add the states of all runs; *origins* are the runs from which they originate."""
        count = world.runs.all.bit_length()
        bits = [
            bit for robot in range(len(world.bodies)) for bit in self._encode_robot(robot, world)
        ]
        bits += world.done
        columns = [
            _byte_column(bits[index : index + _BITS_PER_BYTE], count)
            for index in range(0, len(bits), _BITS_PER_BYTE)
        ]
        origins_by_state = dict(zip(_transpose(columns, count), reversed(origins), strict=True))
        # A row of zeros belongs to a bit that is no run.
        origins_by_state.pop(bytes(len(columns)), None)
        self._origins.update(origins_by_state)

    def _encode_robot(self, robot: int, world: World[int]) -> list[int]:
        """Return the bits of the number of a robot's state; 0 marks bits that are no run."""
        numbers = self._numbers[robot]
        bits = [0] * (_STATE_BYTES * _BITS_PER_BYTE)
        for robot_state, run_set in _split_by_robot_state(world.bodies[robot], world.runs.all):
            number = numbers.setdefault(robot_state, len(numbers) + 1)
            for place in range(number.bit_length()):
                if number >> place & 1:
                    bits[place] |= run_set
        return bits

    def batches(self, max_states: int, model: World[int]) -> Iterator[Batch]:
        """Yield all states in batches, for worlds like *model*, one of the added worlds."""
        rows = list(self._origins)
        for start in range(0, len(rows), max_states):
            batch_rows = rows[start : start + max_states]
            yield self._build_batch(batch_rows, model)

    def _build_batch(self, rows: Sequence[bytes], model: World[int]) -> Batch:
        table, width = b"".join(rows), len(rows[0])
        columns = [table[index::width] for index in range(width)]
        bodies = []
        for robot, (body, numbers) in enumerate(zip(model.bodies, self._numbers, strict=True)):
            robot_states = list(numbers)
            runs_by_number = _runs_by_number(
                columns[robot * _STATE_BYTES : (robot + 1) * _STATE_BYTES]
            )
            bodies.append(
                _build_body(
                    body,
                    [
                        (robot_states[index - 1], runs_by_number[index])
                        for index in sorted(runs_by_number)
                    ],
                )
            )
        done_columns = columns[len(bodies) * _STATE_BYTES :]
        reached_sets = [
            _runs_with_bit(column, bit) for column in done_columns for bit in range(_BITS_PER_BYTE)
        ]
        starts = tuple(tuple(body.places) for body in bodies)
        runs = RunSpace((1 << len(rows)) - 1, 0, starts, difference)
        state = State(bodies, reached_sets[: len(model.done)])
        return Batch(runs, state, [self._origins[row] for row in reversed(rows)])


def _split_by_robot_state(body: Body[int], every_run: int) -> Iterator[tuple[_RobotState, int]]:
    """Yield the states of a robot, with the runs in which it has them."""
    commands, cells = _non_empty(body.commands.items()), _non_empty(enumerate(body.places))
    sent, aside = _non_empty(enumerate(body.assigned)), _non_empty(enumerate(body.evasions))
    for memory, memory_runs in _split_by_condition(_non_empty(body.memory.items()), every_run):
        # A robot is in the cell that its controller expects, or in a neighbour of that cell.
        expected_cell = 0 if memory is None else memory.cell
        nearby_cells = sorted(cells, key=lambda pair: abs(pair[0] - expected_cell))
        for command, command_runs in _split_by_condition(commands, memory_runs):
            for cell, cell_runs in _split_by_condition(nearby_cells, command_runs):
                for goal, target_runs in _split_by_condition(sent, cell_runs):
                    for evasion, run_set in _split_by_condition(aside, target_runs):
                        yield _RobotState(memory, command, cell, goal, evasion), run_set


def _non_empty(conditions: Iterable[tuple[_T, int]]) -> list[tuple[_T, int]]:
    return [pair for pair in conditions if pair[1]]


def _split_by_condition(
    conditions: Sequence[tuple[_T, int]], remaining: int
) -> Iterator[tuple[_T | None, int]]:
    """Split runs by the condition that holds; None where none does."""
    for value, run_set in conditions:
        overlap = remaining & run_set
        if overlap:
            yield value, overlap
            remaining ^= overlap
            if not remaining:
                return
    if remaining:
        yield None, remaining


def _build_body(model: Body[int], robot_states: Iterable[tuple[_RobotState, int]]) -> Body[int]:
    """Build a robot from its states; the lists have the lengths of those of *model*."""
    places, sent, aside = (
        [0] * len(robot_state) for robot_state in (model.places, model.assigned, model.evasions)
    )
    body: Body[int] = Body(places, sent, aside, {}, {})
    for robot_state, run_set in robot_states:
        _add_runs(body.places, robot_state.cell, run_set)
        _add_runs(body.assigned, robot_state.assigned, run_set)
        _add_runs(body.evasions, robot_state.evasion, run_set)
        if robot_state.memory is not None:
            body.memory[robot_state.memory] = body.memory.get(robot_state.memory, 0) | run_set
        if robot_state.command is not None:
            body.commands[robot_state.command] = body.commands.get(robot_state.command, 0) | run_set
    return body


def _add_runs(run_sets: list[int], index: int | None, run_set: int) -> None:
    if index is not None:
        run_sets[index] |= run_set


def _byte_column(bits: Sequence[int], count: int) -> bytes:
    """Pack eight conditions into a byte for each run, the last run first."""
    zeros = int.from_bytes(b"0" * count, "big") if any(bits) else 0
    total = 0
    for bit_number, run_set in enumerate(bits):
        if run_set:
            spread = int.from_bytes(f"{run_set:0{count}b}".encode(), "big") ^ zeros
            total |= spread << bit_number
    return total.to_bytes(count, "big") if total else b""


def _transpose(columns: Sequence[bytes], count: int) -> Iterator[bytes]:
    """Yield the bytes of each run as one row; an empty column consists of zeros."""
    width = len(columns)
    table = bytearray(count * width)
    for index, column in enumerate(columns):
        if column:
            table[index::width] = column
    return map(itemgetter(0), iter_unpack(f"{width}s", table))


_DIGITS_BY_VALUE = [
    bytes(ord("1") if value == wanted else ord("0") for value in range(256))
    for wanted in range(256)
]
"""By value, a translation of bytes to the digit whether they have that value."""
_DIGITS_BY_BIT = [
    bytes(ord("1") if value >> bit & 1 else ord("0") for value in range(256))
    for bit in range(_BITS_PER_BYTE)
]
"""By bit, a translation of bytes to the digit whether they have that bit."""


def _runs_with_bit(column: bytes, bit: int) -> int:
    return int(column.translate(_DIGITS_BY_BIT[bit]), 2)


def _runs_by_number(columns: Sequence[bytes]) -> dict[int, int]:
    """Return the rows by the number that some bytes, lowest first, encode."""
    runs = {0: -1}
    for index, column in enumerate(columns):
        runs_by_byte = {
            value: int(column.translate(_DIGITS_BY_VALUE[value]), 2)
            for value in sorted(set(column))
        }
        runs = {
            low + (value << _BITS_PER_BYTE * index): overlap
            for low, run_set in runs.items()
            for value, byte_runs in runs_by_byte.items()
            if (overlap := run_set & byte_runs)
        }
    return runs
