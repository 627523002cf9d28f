"""Regions of numbers: intervals of the rational line that comparisons with numbers tell apart.

Comparisons with k numbers cut the line at up to 2k places. A variable whose value is the region
makes conditions over reals finite without loss: ``temp < 18`` and ``temp >= 18`` need two regions.
"""

import re
from collections.abc import Iterable, Iterator
from fractions import Fraction
from itertools import pairwise
from math import ceil, floor

from msgspec import Struct
from msgspec.structs import replace

from sysmlc.support.units import express, show_symbol


class Cut(Struct, frozen=True, order=True):
    """A place on the line of numbers: directly below a number, or directly above it."""

    number: Fraction
    is_above: bool = False


class Interval(Struct, frozen=True):
    """The numbers between two cuts; None stands for an open end of the line."""

    low: Cut | None = None
    high: Cut | None = None

    def contains(self, number: Fraction) -> bool:
        """Whether the number lies between the cuts."""
        return (self.low is None or self.low <= Cut(number)) and (
            self.high is None or Cut(number, is_above=True) <= self.high
        )

    def includes(self, interval: "Interval") -> bool:
        """Whether every number of another interval belongs to this one."""
        is_low = self.low is None or (interval.low is not None and self.low <= interval.low)
        is_high = self.high is None or (interval.high is not None and interval.high <= self.high)
        return is_low and is_high

    def move(self, factor: Fraction, offset: Fraction) -> "Interval":
        """Return the interval of ``factor * x + offset`` for the numbers x of this one."""
        ends = [
            None if cut is None else Cut(factor * cut.number + offset, cut.is_above ^ (factor < 0))
            for cut in (self.low, self.high)
        ]
        return Interval(*(ends[::-1] if factor < 0 else ends))

    def round_up(self) -> "Interval":
        """Return the interval with the same Integers and only cuts below Integers."""
        return Interval(
            *(
                None
                if cut is None
                else Cut(Fraction(floor(cut.number) + 1))
                if cut.is_above
                else Cut(Fraction(ceil(cut.number)))
                for cut in (self.low, self.high)
            )
        )

    def intersect(self, interval: "Interval") -> "Interval | None":
        """Return the numbers that belong to both intervals; None if there are none."""
        lows = [cut for cut in (self.low, interval.low) if cut is not None]
        highs = [cut for cut in (self.high, interval.high) if cut is not None]
        low, high = max(lows, default=None), min(highs, default=None)
        return None if low is not None and high is not None and low >= high else Interval(low, high)


LINE = Interval()
Term = tuple[tuple[str, Fraction], ...]
"""Features with their factors in a sum, in the order of their keys; the first factor is 1."""
MIRROR = {"<": ">", "<=": ">=", ">": "<", ">=": "<=", "==": "==", "!=": "!="}
"""The comparison with exchanged operands."""


def select_interval(op: str, number: Fraction, *, is_integral: bool = False) -> Interval:
    """Return the numbers x with ``x op number``; *op* is ``<``, ``<=``, ``>``, ``>=`` or ``==``.

    Of integers only cuts below integers are used, so that ``x > 4`` and ``x >= 5`` are the same.
    """
    below, above = Cut(number), Cut(number, is_above=True)
    if is_integral:
        below, above = Cut(Fraction(ceil(number))), Cut(Fraction(floor(number) + 1))
    match op:
        case "<":
            return Interval(None, below)
        case "<=":
            return Interval(None, above)
        case ">":
            return Interval(above, None)
        case ">=":
            return Interval(below, None)
    return Interval(below, above)


def is_true(left: Fraction, op: str, right: Fraction) -> bool:
    """Return the truth of a comparison of two numbers."""
    if op == "!=":
        return left != right
    return select_interval(op, right).contains(left)


def list_cuts(op: str, number: Fraction, *, is_integral: bool = False) -> tuple[Cut, ...]:
    """Return the cuts that a comparison with a number needs."""
    interval = select_interval("==" if op == "!=" else op, number, is_integral=is_integral)
    return tuple(cut for cut in (interval.low, interval.high) if cut is not None)


def split_line(cuts: Iterable[Cut], limits: Interval = LINE) -> tuple[Interval, ...]:
    """Return the regions between neighbouring cuts inside the limits, the lowest one first."""
    inner = sorted(
        cut
        for cut in set(cuts)
        if (limits.low is None or limits.low < cut) and (limits.high is None or cut < limits.high)
    )
    ends = [limits.low, *inner, limits.high]
    return tuple(Interval(low, high) for low, high in pairwise(ends))


# -- texts -----------------------------------------------------------------------------------------

_SIGNS = re.compile(r"\W+")
_MINUS = re.compile(r"(?<!\w)-(?=\d)")


def print_number(number: Fraction) -> str:
    """Return a number as a decimal if it has one, else as a quotient."""
    digits = 0
    while number * 10**digits % 1 and digits < 12:
        digits += 1
    if number * 10**digits % 1:
        return str(number)
    scaled = abs(int(number * 10**digits))
    text = str(scaled).rjust(digits + 1, "0")
    sign = "-" if number < 0 else ""
    return f"{sign}{text[:-digits]}.{text[-digits:]}" if digits else f"{sign}{text}"


def print_quantity(number: Fraction, symbol: str) -> str:
    """Return a number of the base unit as a quantity in the unit with a symbol."""
    return f"{print_number(express(number, symbol))} {show_symbol(symbol)}".rstrip()


class Regions(Struct, frozen=True):
    """The regions into which comparisons cut the values of a number, the lowest one first."""

    intervals: tuple[Interval, ...]
    unit: str = ""
    """Symbol of the unit of the numbers; empty for plain numbers."""
    is_integral: bool = False
    """Whether the numbers are Integers."""
    labels: tuple[tuple[Fraction, str], ...] = ()
    """The words of the author for numbers at cuts, such as the name of a constant."""
    symbol: str = ""
    """Symbol of the unit in which the author writes the numbers."""

    def find(self, number: Fraction) -> int | None:
        """Return the index of the region that contains a number; None if no region does."""
        indices = (index for index, item in enumerate(self.intervals) if item.contains(number))
        return next(indices, None)

    def list_floors(self) -> Iterator[tuple[Cut | None, int | None]]:
        """Yield the cuts, the highest one first, with the region between this cut and the last.

        A region is given by its index, or None where none is. The last cut is None.
        """
        ceiling: Cut | None = None
        for index, interval in reversed(list(enumerate(self.intervals))):
            if interval.high != ceiling and interval.high is not None:
                yield interval.high, None
            ceiling = interval.low
            yield ceiling, index
        if ceiling is not None:
            yield None, None

    def join_neighbours(self) -> "Regions":
        """Return the regions without the cuts between two of them."""
        joined: list[Interval] = []
        for interval in self.intervals:
            if joined and joined[-1].high == interval.low:
                joined[-1] = Interval(joined[-1].low, interval.high)
            else:
                joined.append(interval)
        return replace(self, intervals=tuple(joined))

    def select(self, op: str, number: Fraction) -> tuple[int, ...] | None:
        """Return the indices of the regions in which a comparison with a number is true.

        None if it is true and false in one region, because no cut separates them.
        """
        wanted = select_interval("==" if op == "!=" else op, number, is_integral=self.is_integral)
        is_empty = wanted.low is not None and wanted.low == wanted.high
        indices: list[int] = []
        for index, interval in enumerate(self.intervals):
            is_inside = not is_empty and wanted.includes(interval)
            if not (is_empty or is_inside or interval.intersect(wanted) is None):
                return None
            if is_inside != (op == "!="):
                indices.append(index)
        return tuple(indices)

    def unite(self, regions: "Regions") -> "Regions":
        """Return the regions that the cuts of both tell apart, without numbers outside of both."""
        parts = (*self.intervals, *regions.intervals)
        cuts = (cut for item in parts for cut in (item.low, item.high) if cut is not None)
        intervals = (
            item for item in split_line(cuts) if any(part.includes(item) for part in parts)
        )
        is_integral = self.is_integral and regions.is_integral
        labels = dict(regions.labels) | dict(self.labels)
        labels_of_both = tuple(labels.items())
        return Regions(tuple(intervals), self.unit, is_integral, labels_of_both, self.symbol)

    def scale(self, factor: Fraction) -> "Regions":
        """Return the regions of the multiple of a number."""
        intervals = [item.move(factor, Fraction(0)) for item in self.intervals]
        is_integral = self.is_integral and abs(factor) == 1
        if is_integral:
            intervals = [item.round_up() for item in intervals]
        labels = tuple((factor * number, label) for number, label in self.labels)
        ordered = tuple(intervals[::-1] if factor < 0 else intervals)
        return Regions(ordered, self.unit, is_integral, labels, self.symbol)

    def list_names(self) -> list[str]:
        """Return a part of an identifier for each region: ``below_low``, ``from_18``, ``at_2_5``.

        The names differ, because the regions do not overlap.
        """
        spelled = (_MINUS.sub("minus_", words) for words in self.words)
        return [_SIGNS.sub("_", words).strip("_") for words in spelled]

    @property
    def words(self) -> list[str]:
        """Each region in words: ``below low``, ``from 18 °C``, ``18 to 22``, ``at 2.5``."""
        return [self._word(interval) for interval in self.intervals]

    def _word(self, interval: Interval) -> str:
        low, high = interval.low, interval.high
        if low is None or high is None:
            if high is not None:
                return f"{'up to' if high.is_above else 'below'} {self._label(high)}"
            if low is not None:
                return f"{'above' if low.is_above else 'from'} {self._label(low)}"
            return "any"
        if self._is_point(low, high):
            return f"at {self._label(low)}"
        return f"{self._label(low)} to {self._label(high)}"

    def is_point(self, index: int) -> bool:
        """Whether the region has a single number."""
        low, high = self.intervals[index].low, self.intervals[index].high
        return low is not None and high is not None and self._is_point(low, high)

    def list_conditions(self, term: str, subtracted: str = "") -> list[str]:
        """Return each region as a condition, as ``describe`` does."""
        indices = range(len(self.intervals))
        return [self.describe(index, term, subtracted) for index in indices]

    def describe(self, index: int, term: str, subtracted: str = "") -> str:
        """Return a region as a condition: ``temp < low``, ``18 <= temp < 22``, ``temp == 5``.

        With *subtracted*, the number is a difference, and the condition is ``a < b + 5``.
        """
        return self._describe(self.intervals[index], term, subtracted)

    def describe_span(self, first: int, last: int, term: str, subtracted: str = "") -> str:
        """Return neighbouring regions as one condition, without bounds that all numbers keep."""
        if first == last and self.is_point(first):
            return self.describe(first, term, subtracted)
        low = self.intervals[first].low if first else None
        high = self.intervals[last].high if last < len(self.intervals) - 1 else None
        return self._describe(Interval(low, high), term, subtracted)

    def _describe(self, interval: Interval, term: str, subtracted: str) -> str:
        low, high = interval.low, interval.high
        bounds = ["" if cut is None else self._write_bound(cut, subtracted) for cut in (low, high)]
        if low is not None and high is not None:
            if self._is_point(low, high):
                return f"{term} == {bounds[0]}"
            signs = "<" if low.is_above else "<=", "<=" if high.is_above else "<"
            return f"{bounds[0]} {signs[0]} {term} {signs[1]} {bounds[1]}"
        if high is not None:
            return f"{term} {'<=' if high.is_above else '<'} {bounds[1]}"
        if low is not None:
            return f"{term} {'>' if low.is_above else '>='} {bounds[0]}"
        return f"any {term}"

    def _write_bound(self, cut: Cut, subtracted: str) -> str:
        if not subtracted:
            return self._label(cut)
        if not cut.number:
            return subtracted
        quantity = print_quantity(cut.number, self.symbol)
        sign = "-" if quantity.startswith("-") else "+"
        return f"{subtracted} {sign} {quantity.removeprefix('-')}"

    def _is_point(self, low: Cut, high: Cut) -> bool:
        return high.number - low.number == 1 if self.is_integral else low.number == high.number

    def _label(self, cut: Cut) -> str:
        return dict(self.labels).get(cut.number) or print_quantity(cut.number, self.symbol)
