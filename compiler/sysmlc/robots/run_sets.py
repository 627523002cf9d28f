"""Many runs at once: a condition is one value that says in which of them it holds.

A plane is an integer with a bit for each run, or a decision diagram over what tells runs apart.
Both have ``&`` and ``|``; a negation is only ever used behind ``&``, as ``Runs.but``: an integer
would become negative by it, and Python computes with those five times as slowly.
"""

from collections.abc import Callable, Sequence
from itertools import accumulate
from math import prod
from operator import mul
from typing import Generic, Protocol, TypeVar

from msgspec import Struct


class RunSet(Protocol):
    """What conditions are made of; it must tell equal ones."""

    def __and__(self: "P", other: "P", /) -> "P": ...
    def __or__(self: "P", other: "P", /) -> "P": ...


P = TypeVar("P", bound=RunSet)


class RunSpace(Struct, Generic[P], frozen=True):
    """Some runs: all of them, none of them, and in which a robot starts in a cell."""

    all: P
    none: P
    starts: tuple[tuple[P, ...], ...]
    """By robot and cell."""
    but: Callable[[P, P], P]
    """The runs of the first condition in which the second one does not hold."""


def difference(one: int, other: int) -> int:
    """``Runs.but`` for integers."""
    return one ^ (one & other)


def digit_patterns(choices: Sequence[int]) -> list[list[int]]:
    """For each of some digits with so many values the numbers of which it has a value, as bits.

    The bit at place n belongs to the number n, written with the digits, the first one lowest.
    """
    whole = prod(choices)
    strides = accumulate(choices, mul, initial=1)
    return [
        _digit_pattern(stride, one, whole) for stride, one in zip(strides, choices, strict=False)
    ]


def _digit_pattern(stride: int, choices: int, whole: int) -> list[int]:
    found = []
    for value in range(choices):
        bits, length = ((1 << stride) - 1) << (value * stride), stride * choices
        while length < whole:
            bits |= bits << length
            length *= 2
        found.append(bits & ((1 << whole) - 1))
    return found


def starts_without_collision(starts: Sequence[Sequence[int]], whole: int) -> int:
    """The runs in which no two robots start in one cell."""
    together = 0
    for cell in range(len(starts[0])):
        taken = 0
        for robot in starts:
            together |= taken & robot[cell]
            taken |= robot[cell]
    return difference(whole, together)


def runs_with_several(planes: Sequence[P], none: P) -> P:
    """In which runs two or more of the conditions hold."""
    seen, found = none, none
    for one in planes:
        found = found | (seen & one)
        seen = seen | one
    return found


def union(planes: Sequence[P], none: P) -> P:
    """In which runs one of the conditions holds."""
    found = none
    for one in planes:
        if one != none:
            found = found | one
    return found
