"""Merging of runs that have reached the same state (decision 26).

The future of a run depends only on its state, so one run per state is continued. After a few steps
most robots are on their way between targets, wherever they started, so there are far fewer states
than runs.
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
    """The state of one robot in one run, by the fields of ``Body``."""

    memory: Memory | None
    command: str | None
    cell: int | None
    assigned: int | None
    evasion: int | None


class Batch(Struct, frozen=True):
    """Distinct states to continue with; each bit of a run set stands for one state."""

    runs: RunSpace[int]
    state: State[int]
    origins: Sequence[int]
    """For each bit, the number of a run that has reached the state."""


class StateSet:
    """The distinct states that runs have reached.

    A state is encoded as bytes: for each robot the number of its state, then a bit for each target.
    """

    def __init__(self, robots: int) -> None:
        """Create an empty set."""
        self._numbers: list[dict[_RobotState, int]] = [{} for _ in range(robots)]
        self._origins: dict[bytes, int] = {}

    def __len__(self) -> int:
        """Return the number of states."""
        return len(self._origins)

    def add(self, world: World[int], origins: Sequence[int]) -> None:
        """Add the states of all runs of *world*; *origins* contains a number for each run."""
        # A table with a row for each run and a column for each byte: bit-parallel operations fill
        # whole columns, and the rows become the keys of the dictionary that finds equal states.
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
        """Return for each bit of the number of the robot's state the runs in which it is set.

        Numbers begin with 1; bits of a run set that are no run have the number 0.
        """
        numbers = self._numbers[robot]
        bits = [0] * (_STATE_BYTES * _BITS_PER_BYTE)
        for robot_state, run_set in _split_by_robot_state(world.bodies[robot], world.runs.all):
            number = numbers.setdefault(robot_state, len(numbers) + 1)
            for position in range(number.bit_length()):
                if number >> position & 1:
                    bits[position] |= run_set
        return bits

    def batches(self, max_states: int, model: World[int]) -> Iterator[Batch]:
        """Yield all states in batches of limited size; *model* is one of the added worlds."""
        rows = list(self._origins)
        for start in range(0, len(rows), max_states):
            batch_rows = rows[start : start + max_states]
            yield self._build_batch(batch_rows, model)

    def _build_batch(self, rows: Sequence[bytes], model: World[int]) -> Batch:
        """Return the batch of some encoded states; the inverse of ``add``."""
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
    """Yield the states of a robot, each with the runs in which the robot has it."""
    commands, cells = _non_empty(body.commands.items()), _non_empty(enumerate(body.places))
    targets, evasions = _non_empty(enumerate(body.assigned)), _non_empty(enumerate(body.evasions))
    for memory, memory_runs in _split_by_condition(_non_empty(body.memory.items()), every_run):
        # A robot is in the cell that its controller expects, or in a neighbour of that cell. Trying
        # these first ends the search early.
        expected_cell = 0 if memory is None else memory.cell
        nearby_cells = sorted(cells, key=lambda pair: abs(pair[0] - expected_cell))
        for command, command_runs in _split_by_condition(commands, memory_runs):
            for cell, cell_runs in _split_by_condition(nearby_cells, command_runs):
                for goal, target_runs in _split_by_condition(targets, cell_runs):
                    for evasion, run_set in _split_by_condition(evasions, target_runs):
                        yield _RobotState(memory, command, cell, goal, evasion), run_set


def _non_empty(conditions: Iterable[tuple[_T, int]]) -> list[tuple[_T, int]]:
    return [pair for pair in conditions if pair[1]]


def _split_by_condition(
    conditions: Sequence[tuple[_T, int]], remaining: int
) -> Iterator[tuple[_T | None, int]]:
    """Yield the values with the part of *remaining* in which their condition holds.

    At most one condition holds in a run. The runs in which none holds are yielded with None.
    """
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
    """Return the body of a robot with these states; its lists are as long as those of *model*."""
    places, assigned, evasions = (
        [0] * len(robot_state) for robot_state in (model.places, model.assigned, model.evasions)
    )
    body: Body[int] = Body(places, assigned, evasions, {}, {})
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
    """Return a byte for each run, the last run first, with the bits of up to eight run sets."""
    # Printing an integer in binary spreads its bits over bytes without a loop in Python.
    zeros = int.from_bytes(b"0" * count, "big") if any(bits) else 0
    total = 0
    for bit_number, run_set in enumerate(bits):
        if run_set:
            spread = int.from_bytes(f"{run_set:0{count}b}".encode(), "big") ^ zeros
            total |= spread << bit_number
    return total.to_bytes(count, "big") if total else b""


def _transpose(columns: Sequence[bytes], count: int) -> Iterator[bytes]:
    """Yield for each run its bytes in all columns; an empty column stands for zeros."""
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
"""For each value of a byte, the translation table that maps this value to "1", others to "0"."""
_DIGITS_BY_BIT = [
    bytes(ord("1") if value >> bit & 1 else ord("0") for value in range(256))
    for bit in range(_BITS_PER_BYTE)
]
"""For each bit, the translation table that maps bytes with this bit to "1", others to "0"."""


def _runs_with_bit(column: bytes, bit: int) -> int:
    """Return the set of rows whose byte has a bit; the inverse of ``_byte_column``."""
    return int(column.translate(_DIGITS_BY_BIT[bit]), 2)


def _runs_by_number(columns: Sequence[bytes]) -> dict[int, int]:
    """Return the set of rows for each number that *columns*, lowest byte first, encode."""
    # Minus one has all bits set: every row has the number 0 before the first byte is read.
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
