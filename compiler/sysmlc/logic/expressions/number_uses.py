"""How a model uses a number: constants and steps that it assigns, and uses beside comparisons."""

from collections.abc import Iterable
from fractions import Fraction
from functools import reduce
from math import ceil, floor, gcd

from msgspec import Struct

from sysmlc.ir.expressions import Assignment, Binary, Member, Name, list_children
from sysmlc.logic.expressions.linear import Linear, Lookup, list_comparisons, read_form
from sysmlc.logic.regions import Cut

MAX_VALUES = 64
"""Most values of a feature that are told apart, be they assigned or those of its range."""


class Updates(Struct, frozen=True):
    """How the behaviours of a model change a feature: they assign numbers, or add numbers to it.

    The initial value is one of the numbers.
    """

    values: tuple[Linear, ...]
    steps: tuple[Fraction, ...] = ()

    def list_points(self, cuts: Iterable[Cut]) -> tuple[Fraction, ...]:
        """Return the values that are told apart; all between the outer cuts.

        None are if nothing changes the feature, or if there are too many.
        """
        numbers = sorted({value.number for value in self.values})
        if not self.steps:
            return tuple(numbers) if len(numbers) > 1 else ()
        differences = (number - numbers[0] for number in numbers[1:])
        width = reduce(_find_common_measure, (*self.steps, *differences), Fraction(0))
        if not width:
            return ()
        ends = [*numbers, *(cut.number for cut in cuts)]
        first = numbers[0] + width * floor((min(ends) - numbers[0]) / width)
        last = numbers[0] + width * ceil((max(ends) - numbers[0]) / width)
        count = int((last - first) / width) + 1
        return tuple(first + width * i for i in range(count)) if count <= MAX_VALUES else ()


def _find_common_measure(left: Fraction, right: Fraction) -> Fraction:
    """Return the greatest number of which both are multiples."""
    scale = left.denominator * right.denominator
    return Fraction(gcd(int(left * scale), int(right * scale)), scale)


def find_other_uses(node: object, find: Lookup) -> set[str]:
    """Return the keys of the numbers in a tree that regions do not describe.

    Regions describe comparisons of sums, and the assignment of a constant or of a step.
    """
    if isinstance(node, Assignment):
        target = node.target if isinstance(node.target, Name | Member) else None
        number = None if target is None else find(target)
        form = read_form(node.value, find)
        if number is not None and form is not None and form.factors in ({}, {number.key: 1}):
            return set()
    if isinstance(node, Binary) and list_comparisons(node, find):
        return set()
    number = find(node) if isinstance(node, Name | Member) else None
    used = {number.key} if number is not None else set()
    return used.union(*(find_other_uses(child, find) for child in list_children(node)))
