"""Formulas of comparisons and sums of numbers, by the regions of their variables."""

from collections.abc import Mapping
from fractions import Fraction
from functools import partial

from sysmlc.ir.expressions import (
    Binary,
    Call,
    Expression,
    Literal,
    Member,
    Name,
    describe_unsupported,
    name_of,
    print_expression,
    walk_tree,
)
from sysmlc.logic import formula as f
from sysmlc.logic.contract import EnumerationDomain, IntegerDomain
from sysmlc.logic.expressions.linear import (
    Comparison,
    Linear,
    Number,
    UnitError,
    iter_comparisons,
    print_term,
    read_linear,
)
from sysmlc.logic.expressions.symbols import (
    Case,
    ElaborationError,
    Fault,
    GuardedValue,
    Scope,
    Symbol,
    find_symbol,
    make_value,
    mismatch,
)
from sysmlc.logic.formula import Const, Formula, Op
from sysmlc.logic.regions import Cut, Interval, Regions, Term, is_true, select_interval

CHOICE = "the lower region of "
"""What precedes the text of an assigned sum in the name of the input that decides its region.

The region of ``x + 1`` is not known if x is anywhere below a threshold.
"""
_SEVERAL = 2
"""Regions between which such an input decides."""


def _find_quantity(scope: Scope, name: Name | Member) -> Number | None:
    symbol = find_symbol(name, scope)
    if symbol is None or symbol.quantity is not None:
        return None if symbol is None else symbol.quantity
    value = symbol.formula.value if isinstance(symbol.formula, Const) else None
    if not isinstance(value, int) or isinstance(value, bool):
        return None
    return Number(
        "", (Linear(number=Fraction(value), unit="" if value else None),), is_constant=True
    )


def _list_symbols(expression: Expression, scope: Scope) -> dict[str, Symbol]:
    """Return the symbols of the numeric features in an expression, by their variables."""
    names = (node for node in walk_tree(expression) if isinstance(node, Name | Member))
    symbols = (find_symbol(name, scope) for name in names)
    return {s.quantity.key: s for s in symbols if s is not None and s.quantity is not None}


def list_sums(expression: Binary, scope: Scope) -> list[Term]:
    """Return the terms of several features in a comparison."""
    try:
        comparisons = list(iter_comparisons(expression, partial(_find_quantity, scope)))
    except UnitError:
        return []
    return [comparison.term for _, comparison in comparisons if len(comparison.term) > 1]


def compare_regions(expression: Binary, scope: Scope) -> Formula | None:
    """Return a comparison of numbers by regions; None if all of them are finite, or none is.

    Raises ElaborationError if no regions are known or if the units differ.
    """
    symbols = _list_symbols(expression, scope)
    is_finite = all(isinstance(symbol.domain, IntegerDomain) for symbol in symbols.values())
    if is_finite and not (len(symbols) == 1 and _has_fraction(expression)):
        return None
    text = print_expression(expression)
    try:
        comparisons = list(iter_comparisons(expression, partial(_find_quantity, scope)))
    except UnitError as error:
        raise ElaborationError(Fault.UNSUPPORTED, f"'{text}': {error}", text) from None
    cases = [
        f.both(
            *(_equal_number(text, symbols[key], value) for key, value in values.items()),
            _select_regions(text, comparison, symbols, scope),
        )
        for values, comparison in comparisons
    ]
    return f.either(*cases) if cases else None


def _equal_number(text: str, symbol: Symbol, value: Linear) -> Formula:
    """Return the formula that a feature has one of its values."""
    if symbol.quantity is not None and len(symbol.quantity.values) == 1:
        return f.TRUE
    if isinstance(symbol.domain, IntegerDomain):
        return f.eq(symbol.formula, Const(int(value.number)))
    assert isinstance(symbol.domain, EnumerationDomain)
    point = Interval(Cut(value.number), Cut(value.number, is_above=True))
    return f.eq(symbol.formula, _find_region(text, symbol.domain, point))


def _select_regions(
    text: str, comparison: Comparison, symbols: Mapping[str, Symbol], scope: Scope
) -> Formula:
    """Return the formula that a term is in one of the regions in which a comparison is true."""
    op, number = comparison.op, comparison.number
    if not comparison.term:
        return Const(is_true(Fraction(0), op, number))
    term = print_term(comparison.term)
    symbol = symbols.get(term) or scope(term, "")
    domain = None if symbol is None else symbol.domain
    if symbol is not None and isinstance(domain, IntegerDomain):
        return _compare_integer(symbol.formula, op, number)
    if symbol is None or not isinstance(domain, EnumerationDomain) or domain.regions is None:
        reason = f"'{text}' compares numbers that have no regions"
        raise ElaborationError(Fault.UNSUPPORTED, reason, text)
    _check_unit(text, comparison.unit, domain.regions)
    selected = domain.regions.select(op, number)
    if selected is None:
        reason = f"'{text}' compares with a number between two thresholds"
        raise ElaborationError(Fault.UNSUPPORTED, reason, text)
    return f.either(*(f.eq(symbol.formula, Const(domain.literals[index])) for index in selected))


def _has_fraction(expression: Expression) -> bool:
    """Whether a number in an expression is no Integer."""
    values = (node.value for node in walk_tree(expression) if isinstance(node, Literal))
    return any(isinstance(value, float) for value in values)


def _compare_integer(formula: Formula, op: str, number: Fraction) -> Formula:
    """Return the comparison of a finite Integer with any number."""
    wanted = select_interval("==" if op == "!=" else op, number, is_integral=True)
    bounds = ((Op.GE, wanted.low), (Op.LT, wanted.high))
    inside = f.both(
        *(f.compare(op, formula, Const(int(cut.number))) for op, cut in bounds if cut is not None)
    )
    return f.negate(inside) if op == "!=" else inside


def _check_unit(text: str, unit: str | None, regions: Regions | None) -> None:
    if unit is not None and regions is not None and unit != regions.unit:
        units = " and in ".join(name or "no unit" for name in (unit, regions.unit))
        message = f"'{text}' is compared in {units}"
        raise ElaborationError(Fault.UNSUPPORTED, message, text)


def elaborate_region(
    expression: Expression, scope: Scope, expected: EnumerationDomain
) -> GuardedValue:
    """Return the region of a number: that of a constant, or of a multiple of one feature."""
    text = print_expression(expression)
    try:
        form = read_linear(expression, partial(_find_quantity, scope))
    except UnitError as error:
        raise ElaborationError(Fault.UNSUPPORTED, f"'{text}': {error}", text) from None
    if form is None:
        _check_numbers(expression, scope)
    if form is None or len(form.factors) > 1:
        raise ElaborationError(Fault.UNSUPPORTED, f"'{text}' is no sum with one feature", text)
    _check_unit(text, form.unit, expected.regions)
    if not form.factors:
        point = Interval(Cut(form.number), Cut(form.number, is_above=True))
        return make_value(_find_region(text, expected, point), expected)
    ((name, factor),) = form.factors.items()
    symbol = _list_symbols(expression, scope)[name]
    source = symbol.domain
    if not isinstance(source, EnumerationDomain) or source.regions is None:
        raise ElaborationError(Fault.UNSUPPORTED, f"'{text}' has no regions", text)
    cases: list[Case] = []
    for literal, interval in zip(source.literals, source.regions.intervals, strict=True):
        is_source = f.eq(symbol.formula, Const(literal))
        values = interval.move(factor, form.number)
        targets = _list_regions(expected, values)
        choice = scope(f"{CHOICE}{text}", "") if len(targets) == _SEVERAL else None
        if choice is None:
            cases.append(Case(is_source, _find_region(text, expected, values)))
        else:
            lower, upper = (Const(expected.literals[index]) for index in targets)
            cases.append(Case(f.both(is_source, choice.formula), lower))
            cases.append(Case(f.both(is_source, f.negate(choice.formula)), upper))
    return GuardedValue(tuple(cases), expected)


def _check_numbers(expression: Expression, scope: Scope) -> None:
    """Raise ElaborationError for a call, and if a name is unknown or denotes no number."""
    for node in walk_tree(expression):
        if isinstance(node, Call):
            text = print_expression(node)
            raise ElaborationError(Fault.UNSUPPORTED, describe_unsupported(node), text)
        symbol, name = find_symbol(node, scope), name_of(node)
        if name and symbol is None and isinstance(node, Name):
            raise ElaborationError(Fault.UNKNOWN, f"'{name}' is not known", name, node.element)
        domain = None if symbol is None else symbol.domain
        is_number = isinstance(domain, IntegerDomain) or getattr(domain, "regions", None)
        if isinstance(node, Name) and domain is not None and not is_number:
            raise mismatch(node, "a number", domain)


def _list_regions(domain: EnumerationDomain, values: Interval) -> list[int]:
    """Return the indices of the regions in which *values* can be."""
    intervals = () if domain.regions is None else domain.regions.intervals
    return [index for index, item in enumerate(intervals) if item.intersect(values) is not None]


def _find_region(text: str, domain: EnumerationDomain, values: Interval) -> Formula:
    """Return the literal of the region with all *values*. Raises ElaborationError without one."""
    assert domain.regions is not None
    for literal, interval in zip(domain.literals, domain.regions.intervals, strict=True):
        if interval.includes(values):
            return Const(literal)
    reason = f"'{text}' has values in several regions"
    raise ElaborationError(Fault.UNSUPPORTED, reason, text)
