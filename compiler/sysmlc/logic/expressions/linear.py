"""Linear forms of numeric expressions: sums of features with rational factors, and a number."""

from collections.abc import Callable, Iterator, Mapping
from fractions import Fraction
from itertools import product

from msgspec import Struct

from sysmlc.ir import Element, Graph
from sysmlc.ir.expressions import (
    Binary,
    Expression,
    Index,
    Literal,
    Member,
    Name,
    ParsedText,
    Unary,
    print_expression,
    walk_tree,
)
from sysmlc.ir.query.classifiers import name_value_unit
from sysmlc.logic.regions import MIRROR, Term
from sysmlc.support.units import measure

COMPARISONS = frozenset(MIRROR)
"""The operators that compare numbers."""


class UnitError(ValueError):
    """An expression adds or compares numbers of different units."""


class Linear(Struct, frozen=True):
    """``sum(factor * feature) + number``, in the unit ``unit``.

    The unit is empty for plain numbers, and None if no number states one. ``symbol`` is the unit in
    which the author writes such a number.
    """

    factors: Mapping[str, Fraction] = {}
    number: Fraction = Fraction(0)
    unit: str | None = None
    symbol: str = ""

    def add(self, form: "Linear", sign: int = 1) -> "Linear":
        """Return the sum, or with *sign* -1 the difference. Raises UnitError."""
        unit = self.unit if form.unit is None else form.unit
        if self.unit not in (None, unit):
            left, right = (text or "no unit" for text in (self.unit, form.unit))
            raise UnitError(f"it combines numbers in {left} and in {right}")
        factors = dict(self.factors)
        for name, factor in form.factors.items():
            factors[name] = factors.get(name, Fraction(0)) + sign * factor
        factors = {name: factor for name, factor in factors.items() if factor}
        number = self.number + sign * form.number
        return Linear(factors, number, unit, self.symbol or form.symbol)

    def scale(self, factor: Fraction, unit: str | None = None, symbol: str = "") -> "Linear":
        """Return the multiple of the form."""
        factors = {name: factor * value for name, value in self.factors.items() if factor}
        return Linear(factors, factor * self.number, self.unit or unit, self.symbol or symbol)


class Number(Struct, frozen=True):
    """A numeric feature or constant in expressions.

    ``values`` are all numbers that it can have; they are empty for a feature without such limits.
    ``is_constant`` states that it has the only value, ``is_frozen`` that it never changes.
    """

    key: str
    values: tuple[Linear, ...] = ()
    is_constant: bool = False
    is_frozen: bool = False


class Comparison(Struct, frozen=True):
    """``term op number``; the term is empty if no feature occurs."""

    term: Term
    op: str
    number: Fraction
    unit: str | None
    symbol: str = ""
    """The unit in which the author writes the number."""


Lookup = Callable[[Name | Member], Number | None]
"""Returns what a name stands for; None if it is no number."""


def read_linear(  # noqa: PLR0911 - by kind of expression
    expression: Expression, find: Lookup, values: Mapping[str, Linear] = {}
) -> Linear | None:
    """Return the linear form of an expression; None if it has none. Raises UnitError.

    Constants are replaced by their values, and so are the features with the keys of *values*.
    """
    match expression:
        case Literal(value):
            return _read_number(value)
        case Index(base, unit):
            number = read_linear(base, find, values)
            is_number = number is not None and not number.factors and not number.unit
            return _measure(number.number, unit) if number is not None and is_number else None
        case Unary("-", Index(base, unit)):
            # The sign belongs to the number: -5 [°C_abs] is 268.15 K.
            return read_linear(Index(Unary("-", base), unit), find, values)
        case Unary("-" | "+" as op, operand):
            form = read_linear(operand, find, values)
            return None if form is None else form.scale(Fraction(-1 if op == "-" else 1))
        case Binary("+" | "-" | "*" | "/" as op, left, right):
            first, second = (read_linear(operand, find, values) for operand in (left, right))
            return None if first is None or second is None else _combine(op, first, second)
        case Name() | Member():
            named = find(expression)
            if named is None:
                return None
            if named.is_constant:
                return named.values[0]
            return values.get(named.key) or Linear({named.key: Fraction(1)})
    return None


def _read_number(value: bool | float | str) -> Linear | None:
    if isinstance(value, bool | str):
        return None
    # Zero is the same in every unit.
    return Linear(number=Fraction(str(value)), unit="" if value else None)


def _measure(number: Fraction, unit: Expression) -> Linear:
    symbol = print_expression(unit).rpartition("::")[2].strip("'")
    number, base = measure(number, symbol)
    return Linear(number=number, unit=base, symbol=symbol)


def _combine(op: str, left: Linear, right: Linear) -> Linear | None:
    if op in "+-":
        return left.add(right, 1 if op == "+" else -1)
    if op == "*" and left.factors:
        left, right = right, left
    if op == "*":
        return None if left.factors else right.scale(left.number, left.unit, left.symbol)
    if right.factors or not right.number or right.unit:
        return None
    return left.scale(1 / right.number)


def iter_comparisons(
    expression: Binary, find: Lookup
) -> Iterator[tuple[Mapping[str, Linear], Comparison]]:
    """Yield a comparison of numbers in canonical form, if it is one. Raises UnitError.

    Features with few values are replaced by each of them beside a feature without such limits:
    the threshold in ``temp < low``, but not the feature in ``battery < 20``. The first results
    state for which values the comparisons hold.
    """
    if expression.op not in COMPARISONS:
        return
    names = (node for node in walk_tree(expression) if isinstance(node, Name | Member))
    numbers = {number.key: number for number in map(find, names) if number is not None}
    form = read_linear(Binary("-", expression.left, expression.right), find)
    if form is None:
        return
    limited = [key for key in sorted(form.factors) if numbers[key].values]
    if len(limited) == len(form.factors):
        limited = limited[1:]
    for choice in product(*(numbers[key].values for key in limited)):
        values = dict(zip(limited, choice, strict=True))
        form = read_linear(Binary("-", expression.left, expression.right), find, values)
        if form is not None:
            yield values, _normalise(expression.op, form)


def list_comparisons(expression: Binary, find: Lookup) -> list[Comparison]:
    """Return a comparison of numbers in canonical form; none if the units differ."""
    try:
        return [comparison for _, comparison in iter_comparisons(expression, find)]
    except UnitError:
        return []


def read_form(expression: Expression, find: Lookup) -> Linear | None:
    """Return the linear form of an expression; None without one or if its units differ."""
    try:
        return read_linear(expression, find)
    except UnitError:
        return None


def _normalise(op: str, form: Linear) -> Comparison:
    """Return the comparison of a form with zero."""
    names = sorted(form.factors)
    scale = form.factors[names[0]] if names else Fraction(1)
    term = tuple((name, form.factors[name] / scale) for name in names)
    op = MIRROR[op] if scale < 0 else op
    return Comparison(term, op, -form.number / scale, form.unit, form.symbol)


def print_term(term: Term) -> str:
    """Return a term as text: ``temp``, ``a - b``, ``a + 1/2*b``."""
    text = ""
    for name, factor in term:
        sign = ("-" if factor < 0 else "") if not text else (" - " if factor < 0 else " + ")
        size = abs(factor)
        text += f"{sign}{name}" if size == 1 else f"{sign}{size}*{name}"
    return text


def read_quantity(
    graph: Graph, element: Element, key: str, find: Lookup = lambda _: None
) -> Linear | None:
    """Return the number in an attribute of an element (``default``, ``value``) with its unit.

    *find* returns the constants that the value may name.
    """
    value = element.attrs.get(key)
    if isinstance(value, ParsedText):
        form = read_form(value.tree, find)
        return None if form is None or form.factors else form
    if isinstance(value, bool) or not isinstance(value, int | float):
        return None
    unit = name_value_unit(graph, element, key)
    number, base = measure(Fraction(str(value)), unit) if unit else (Fraction(str(value)), "")
    return Linear(number=number, unit=base if value or unit else None, symbol=unit)


def is_antisymmetric(term: Term) -> bool:
    """Whether a term is the difference of one feature in two objects."""
    (first, _), (second, factor) = term if len(term) == 2 else (("", 1), (" ", 1))
    return first == second and factor == -1
