"""Runs that have come to the same: from then on one of them stands for all (decision 0037).

After a few steps most robots are on their way between targets, wherever they started. What will
become of a run depends on its state only, so that each state is gone on with once.
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
_BYTE = 8
_WIDTH = 3
"""Bytes for the number of what is known of a robot: sixteen million things."""


class _Known(NamedTuple):
    """What is known of one robot in one run: its body without all the others."""

    memory: Memory | None
    command: str | None
    cell: int | None
    sent: int | None
    aside: int | None


class Batch(Struct, frozen=True):
    """Some states to go on with; a bit of a condition is one of them."""

    runs: RunSpace[int]
    state: State[int]
    origins: Sequence[int]
    """By bit a run that came to this state."""


class States:
    """The states that runs have come to, each once.

    A state is a row of bytes: what is known of each robot, as a number, then which targets have
    been reached.
    """

    def __init__(self, robots: int) -> None:
        """Nothing is known yet."""
        self._numbers: list[dict[_Known, int]] = [{} for _ in range(robots)]
        self._origins: dict[bytes, int] = {}

    def __len__(self) -> int:
        """How many states there are."""
        return len(self._origins)

    def add(self, world: World[int], origins: Sequence[int]) -> None:
        """Note the states of all runs; ``origins`` are where the runs themselves come from."""
        count = world.runs.all.bit_length()
        bits = [bit for robot in range(len(world.bodies)) for bit in self._bits(robot, world)]
        bits += world.done
        columns = [_column(bits[at : at + _BYTE], count) for at in range(0, len(bits), _BYTE)]
        found = dict(zip(_rows(columns, count), reversed(origins), strict=True))
        found.pop(bytes(len(columns)), None)
        self._origins.update(found)

    def _bits(self, robot: int, world: World[int]) -> list[int]:
        """The bits of the number of what is known of a robot; 0 is for runs that are none."""
        numbers = self._numbers[robot]
        found = [0] * (_WIDTH * _BYTE)
        for known, plane in _split(world.bodies[robot], world.runs.all):
            number = numbers.setdefault(known, len(numbers) + 1)
            for place in range(number.bit_length()):
                if number >> place & 1:
                    found[place] |= plane
        return found

    def batches(self, most: int, like: World[int]) -> Iterator[Batch]:
        """All states, so many at once, in a world ``like`` one that was added."""
        rows = list(self._origins)
        for start in range(0, len(rows), most):
            chosen = rows[start : start + most]
            yield self._batch(chosen, like)

    def _batch(self, rows: Sequence[bytes], like: World[int]) -> Batch:
        table, width = b"".join(rows), len(rows[0])
        columns = [table[at::width] for at in range(width)]
        bodies = []
        for robot, (body, numbers) in enumerate(zip(like.bodies, self._numbers, strict=True)):
            known = list(numbers)
            planes = _planes(columns[robot * _WIDTH : (robot + 1) * _WIDTH])
            bodies.append(_body(body, [(known[at - 1], planes[at]) for at in sorted(planes)]))
        reached = columns[len(bodies) * _WIDTH :]
        done = [_bit_plane(column, bit) for column in reached for bit in range(_BYTE)]
        starts = tuple(tuple(body.places) for body in bodies)
        runs = RunSpace((1 << len(rows)) - 1, 0, starts, difference)
        state = State(bodies, done[: len(like.done)])
        return Batch(runs, state, [self._origins[row] for row in reversed(rows)])


def _split(body: Body[int], whole: int) -> Iterator[tuple[_Known, int]]:
    """All that is known of a robot, with the runs in which it is."""
    commands, cells = _some(body.commands.items()), _some(enumerate(body.places))
    sent, aside = _some(enumerate(body.sent)), _some(enumerate(body.aside))
    for memory, known in _told(_some(body.memory.items()), whole):
        # A robot is where its machine will have it, or next to it.
        end = 0 if memory is None else memory.cell
        near = sorted(cells, key=lambda one: abs(one[0] - end))
        for command, ordered in _told(commands, known):
            for cell, here in _told(near, ordered):
                for goal, going in _told(sent, here):
                    for side, plane in _told(aside, going):
                        yield _Known(memory, command, cell, goal, side), plane


def _some(conditions: Iterable[tuple[_T, int]]) -> list[tuple[_T, int]]:
    return [one for one in conditions if one[1]]


def _told(conditions: Sequence[tuple[_T, int]], left: int) -> Iterator[tuple[_T | None, int]]:
    """Some runs, split by which condition holds; None where none does."""
    for name, plane in conditions:
        both = left & plane
        if both:
            yield name, both
            left ^= both
            if not left:
                return
    if left:
        yield None, left


def _body(like: Body[int], known: Iterable[tuple[_Known, int]]) -> Body[int]:
    """A robot made of what is known of it in each run; its lists are as long as another one's."""
    places, sent, aside = ([0] * len(one) for one in (like.places, like.sent, like.aside))
    made: Body[int] = Body(places, sent, aside, {}, {})
    for one, plane in known:
        _add(made.places, one.cell, plane)
        _add(made.sent, one.sent, plane)
        _add(made.aside, one.aside, plane)
        if one.memory is not None:
            made.memory[one.memory] = made.memory.get(one.memory, 0) | plane
        if one.command is not None:
            made.commands[one.command] = made.commands.get(one.command, 0) | plane
    return made


def _add(planes: list[int], at: int | None, plane: int) -> None:
    if at is not None:
        planes[at] |= plane


def _column(bits: Sequence[int], count: int) -> bytes:
    """A byte for each run, the last run first, of eight conditions."""
    zeros = int.from_bytes(b"0" * count, "big") if any(bits) else 0
    total = 0
    for place, plane in enumerate(bits):
        if plane:
            spread = int.from_bytes(f"{plane:0{count}b}".encode(), "big") ^ zeros
            total |= spread << place
    return total.to_bytes(count, "big") if total else b""


def _rows(columns: Sequence[bytes], count: int) -> Iterator[bytes]:
    """The bytes of each run in one row; an empty column is one of zeros."""
    width = len(columns)
    table = bytearray(count * width)
    for at, column in enumerate(columns):
        if column:
            table[at::width] = column
    return map(itemgetter(0), iter_unpack(f"{width}s", table))


_IS = [
    bytes(ord("1") if value == wanted else ord("0") for value in range(256))
    for wanted in range(256)
]
"""By number the digits that say of each byte whether it is that number."""
_HAS = [
    bytes(ord("1") if value >> bit & 1 else ord("0") for value in range(256))
    for bit in range(_BYTE)
]
"""By bit the digits that say of each byte whether it has that bit."""


def _bit_plane(column: bytes, bit: int) -> int:
    return int(column.translate(_HAS[bit]), 2)


def _planes(columns: Sequence[bytes]) -> dict[int, int]:
    """By number the rows in which some bytes, the lowest one first, are that number."""
    found = {0: -1}
    for at, column in enumerate(columns):
        more = {value: int(column.translate(_IS[value]), 2) for value in sorted(set(column))}
        found = {
            low + (value << _BYTE * at): both
            for low, plane in found.items()
            for value, other in more.items()
            if (both := plane & other)
        }
    return found
