"""Sets of runs, to simulate many runs at once: a condition is the set of runs in which it holds.

A set is an integer with a bit for each run, or a decision diagram over the starts of the robots.
Both have ``&`` and ``|``. Instead of complements there is ``RunSpace.without``: the complement of
an integer is negative, and Python computes with negative numbers five times as slowly.
"""

from collections.abc import Callable, Sequence
from itertools import accumulate
from math import prod
from operator import mul
from typing import Generic, Protocol, TypeVar

from msgspec import Struct


class RunSet(Protocol):
    """A set of runs, comparable for equality."""

    def __and__(self: "P", other: "P", /) -> "P": ...
    def __or__(self: "P", other: "P", /) -> "P": ...


P = TypeVar("P", bound=RunSet)


class RunSpace(Struct, Generic[P], frozen=True):
    """All runs of a simulation, and the sets of runs in which a robot starts in a cell."""

    all: P
    none: P
    starts: tuple[tuple[P, ...], ...]
    """For each robot and cell, the runs in which the robot starts in the cell."""
    without: Callable[[P, P], P]
    """Returns the runs of the first set that are not in the second one."""


def difference(minuend: int, subtrahend: int) -> int:
    """Return the difference of two sets of runs that are integers (``RunSpace.without``)."""
    return minuend ^ (minuend & subtrahend)


def digit_patterns(choices: Sequence[int]) -> list[list[int]]:
    """Return for each digit and each of its values the set of numbers with this value of the digit.

    Numbers have one digit for each of *choices*, which is its base; the first digit is the least
    significant. Bit n of a set represents the number n.
    """
    total = prod(choices)
    strides = accumulate(choices, mul, initial=1)
    return [
        _digit_pattern(stride, choice, total)
        for stride, choice in zip(strides, choices, strict=False)
    ]


def _digit_pattern(stride: int, choices: int, total: int) -> list[int]:
    # The bits of a value repeat with the period of the digit; doubling fills the integer in few
    # operations.
    patterns = []
    for value in range(choices):
        bits, length = ((1 << stride) - 1) << (value * stride), stride * choices
        while length < total:
            bits |= bits << length
            length *= 2
        patterns.append(bits & ((1 << total) - 1))
    return patterns


def starts_without_collision(starts: Sequence[Sequence[int]], every_run: int) -> int:
    """Return the runs in which all robots start in different cells."""
    colliding = 0
    for cell in range(len(starts[0])):
        occupied = 0
        for robot in starts:
            colliding |= occupied & robot[cell]
            occupied |= robot[cell]
    return difference(every_run, colliding)


def union(run_sets: Sequence[P], none: P) -> P:
    """Return the runs that are in at least one of the sets."""
    result = none
    # The union with an empty set would copy a long integer.
    for run_set in run_sets:
        if run_set != none:
            result = result | run_set
    return result
