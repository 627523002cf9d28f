"""Systems of linear inequalities over the rationals, solved exactly (Fourier-Motzkin elimination).

Comparisons of real features are such inequalities: ``2*a - b < 7`` and, as two of them,
``a = 18``. A solution is a witness that some combination of comparisons is possible.
"""

from collections.abc import Iterable, Mapping, Sequence
from fractions import Fraction
from math import gcd, lcm
from typing import NamedTuple


class Inequality(NamedTuple):
    """The condition ``sum(coefficient * variable) <= bound``, or ``<`` if it is strict.

    No coefficient is zero.
    """

    coefficients: Mapping[str, Fraction]
    bound: Fraction
    is_strict: bool


_Row = tuple[int, ...]
"""The left-hand side: a coefficient for each variable, without a common divisor."""
_Bound = tuple[Fraction, bool]
"""The right-hand side, and whether it is included; the lesser of two is the tighter one."""
_System = dict[_Row, _Bound]


def find_solution(inequalities: Iterable[Inequality]) -> dict[str, Fraction] | None:
    """Return values of all variables that satisfy the inequalities, or None if there are none.

    The values are short decimals where the inequalities permit it.
    """
    inequalities = tuple(inequalities)
    variables = sorted({name for inequality in inequalities for name in inequality.coefficients})
    system = _read_system(inequalities, variables)
    # What bounds each variable, in the order of elimination
    eliminated: list[tuple[int, _System]] = []
    while any(map(any, system)):
        index = _choose_variable(system)
        eliminated.append((index, {row: bound for row, bound in system.items() if row[index]}))
        system = _eliminate(system, index)
    # The only row that can remain is 0 <= bound.
    if any(bound < (Fraction(0), True) for bound in system.values()):
        return None
    values = [Fraction(0)] * len(variables)
    for index, bounds in reversed(eliminated):
        values[index] = _choose_value(index, bounds, values)
    return dict(zip(variables, values, strict=True))


def _read_system(inequalities: Iterable[Inequality], variables: Sequence[str]) -> _System:
    indices = {name: index for index, name in enumerate(variables)}
    system: _System = {}
    for coefficients, bound, is_strict in inequalities:
        factor = lcm(*(coefficient.denominator for coefficient in coefficients.values()))
        row = [0] * len(variables)
        for name, coefficient in coefficients.items():
            row[indices[name]] = coefficient.numerator * (factor // coefficient.denominator)
        _add_row(system, row, bound * factor, not is_strict)
    return system


def _add_row(system: _System, coefficients: list[int], bound: Fraction, is_included: bool) -> None:
    """Add an inequality to the system unless one with the same left-hand side is as tight."""
    divisor = gcd(*coefficients) or 1
    row = tuple(coefficients)
    if divisor != 1:
        row = tuple(coefficient // divisor for coefficient in coefficients)
        bound /= divisor
    right_side = (bound, is_included)
    if row not in system or right_side < system[row]:
        system[row] = right_side


def _choose_variable(system: _System) -> int:
    """Return the variable whose elimination adds the fewest rows."""
    costs = {}
    for index, column in enumerate(zip(*system, strict=True)):
        lower = sum(coefficient < 0 for coefficient in column)
        upper = sum(coefficient > 0 for coefficient in column)
        if lower or upper:
            costs[index] = lower * upper - lower - upper
    return min(costs, key=lambda index: costs[index])


def _eliminate(system: _System, index: int) -> _System:
    """Return the inequalities about the other variables that the system implies."""
    rest = {row: bound for row, bound in system.items() if not row[index]}
    lower = [(row, bound) for row, bound in system.items() if row[index] < 0]
    upper = [(row, bound) for row, bound in system.items() if row[index] > 0]
    for low, (low_bound, is_low_included) in lower:
        for high, (high_bound, is_high_included) in upper:
            by, times = -low[index], high[index]
            row = [a * times + b * by for a, b in zip(low, high, strict=True)]
            bound = low_bound * times + high_bound * by
            _add_row(rest, row, bound, is_low_included and is_high_included)
    return rest


def _choose_value(index: int, bounds: _System, values: Sequence[Fraction]) -> Fraction:
    """Return a value of a variable within its bounds, given the values of other variables."""
    lower: list[_Bound] = []
    upper: list[_Bound] = []
    for row, (bound, is_included) in bounds.items():
        others = sum(c * value for c, value in zip(row, values, strict=True) if c)
        limits = upper if row[index] > 0 else lower
        limits.append(((bound - others) / row[index], is_included))
    low, is_low_included = max(
        lower, key=lambda limit: (limit[0], not limit[1]), default=(None, True)
    )
    high, is_high_included = min(upper, default=(None, True))
    return choose_number(low, not is_low_included, high, not is_high_included)


def choose_number(
    low: Fraction | None, low_is_open: bool, high: Fraction | None, high_is_open: bool
) -> Fraction:
    """Return the number between *low* and *high* that has the fewest digits before final zeros.

    This is 0 if possible, else an integer if possible; among several the one next to 0. None is
    no bound. Raises ValueError if there is no number between the bounds.
    """
    if low is not None and high is not None:
        if low > high or (low == high and (low_is_open or high_is_open)):
            raise ValueError(f"no number between {low} and {high}")
        if low == high:
            return low
    if high is not None and (high < 0 or (high == 0 and high_is_open)):
        bound = -low if low is not None else None
        return -choose_number(-high, high_is_open, bound, low_is_open)
    if low is None or low < 0 or (low == 0 and not low_is_open):
        return Fraction(0)
    step = Fraction(1)
    while step * 10 <= low:
        step *= 10
    while True:  # The interval is not a point, so that a multiple of a small step lies in it.
        quotient = low // step
        number = quotient * step
        if number < low or low_is_open:
            number += step
        if high is None or number < high or (number == high and not high_is_open):
            return number
        step /= 10
