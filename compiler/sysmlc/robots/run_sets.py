"""Sets of runs: many runs are simulated at once, and a condition is the set of runs in which it
holds.

A set is an integer with a bit for each run, or a decision diagram over the starts of the robots.
Both have ``&`` and ``|``. Complements occur only after ``&``, as ``RunSpace.without``, because the
complement of an integer is negative, and Python computes with negative numbers five times as
slowly.
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
    """The sets by robot and cell."""
    without: Callable[[P, P], P]
    """Returns the runs of the first set that are not in the second one."""


def difference(minuend: int, subtrahend: int) -> int:
    """``RunSpace.without`` for integers."""
    return minuend ^ (minuend & subtrahend)


def digit_patterns(choices: Sequence[int]) -> list[list[int]]:
    """Return for each digit and each of its values the set of numbers whose digit has this value.

    Bit n of a set represents the number n, written with the digits, the first one least
    significant.
    """
    total = prod(choices)
    strides = accumulate(choices, mul, initial=1)
    return [
        _digit_pattern(stride, choice, total)
        for stride, choice in zip(strides, choices, strict=False)
    ]


def _digit_pattern(stride: int, choices: int, total: int) -> list[int]:
    patterns = []
    for value in range(choices):
        bits, length = ((1 << stride) - 1) << (value * stride), stride * choices
        while length < total:
            bits |= bits << length
            length *= 2
        patterns.append(bits & ((1 << total) - 1))
    return patterns


def starts_without_collision(starts: Sequence[Sequence[int]], every_run: int) -> int:
    """Return the runs in which no two robots start in one cell."""
    colliding = 0
    for cell in range(len(starts[0])):
        occupied = 0
        for robot in starts:
            colliding |= occupied & robot[cell]
            occupied |= robot[cell]
    return difference(every_run, colliding)


def runs_with_several(run_sets: Sequence[P], none: P) -> P:
    """Return the runs in which two or more of the conditions hold."""
    any_seen, several = none, none
    for run_set in run_sets:
        several = several | (any_seen & run_set)
        any_seen = any_seen | run_set
    return several


def union(run_sets: Sequence[P], none: P) -> P:
    """Return the runs in which some condition holds."""
    result = none
    for run_set in run_sets:
        if run_set != none:
            result = result | run_set
    return result
