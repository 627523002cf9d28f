"""Elaboration of expressions to formulas: resolve names, check types, split values into cases."""

import operator
from collections.abc import Callable, Mapping
from enum import StrEnum
from fractions import Fraction
from functools import partial

from msgspec import Struct

from sysmlc.ir.expressions import (
    Binary,
    Conditional,
    Expression,
    Literal,
    Member,
    Name,
    Statement,
    Unary,
    describe_unsupported,
    dotted_name,
    element_of,
    last_name,
    name_of,
    print_expression,
    walk_tree,
)
from sysmlc.logic import domains
from sysmlc.logic import formula as f
from sysmlc.logic.contract import BooleanDomain, Domain, EnumerationDomain, IntegerDomain
from sysmlc.logic.expressions.linear import (
    Comparison,
    Linear,
    Number,
    UnitError,
    iter_comparisons,
    print_term,
    read_linear,
)
from sysmlc.logic.formula import Const, Formula, Op
from sysmlc.logic.regions import Cut, Interval, Regions, Term, is_true, select_interval


class Fault(StrEnum):
    """Why an expression has no formula."""

    UNKNOWN = "unknown name"
    TYPE = "type mismatch"
    OUTSIDE = "out of domain"
    UNSUPPORTED = "not supported"


class ElaborationError(ValueError):
    """An expression has no formula; ``name`` is the name or value at fault, with its element."""

    def __init__(self, fault: Fault, message: str, name: str, element: str = "") -> None:
        super().__init__(message)
        self.fault = fault
        self.name = name
        self.element = element


class Case(Struct, frozen=True):
    """A value, and the condition under which an expression has it."""

    condition: Formula
    value: Formula


class GuardedValue(Struct, frozen=True):
    """The value of an expression as cases; exactly one of their conditions holds in each step."""

    cases: tuple[Case, ...]
    domain: Domain

    def as_formula(self) -> Formula:
        """Return the formula of a Boolean value."""
        if len(self.cases) == 1:
            return self.cases[0].value
        return f.either(*(f.both(case.condition, case.value) for case in self.cases))


class Symbol(Struct, frozen=True):
    """The formula and the domain of a name; ``number`` if an enumeration literal stands for one."""

    formula: Formula
    domain: Domain | None
    number: int | None = None
    has_several_values: bool = False
    quantity: Number | None = None
    """The number that the name stands for in sums and comparisons, if any."""
    term: Term = ()
    """The sum of variables whose region the name stands for, if any."""


Scope = Callable[[str, str], Symbol | None]
"""Looks up a name and the id of its element, which may be empty; None if they are unknown."""
FINITE_ADVICE = "compare Booleans, enumerations and sums of numbers for a contract"
CHOICE = "the lower region of "
"""What precedes the text of an assigned sum in the name of the input that decides its region.

The region of ``x + 1`` is not known if x is anywhere below a threshold.
"""
_SEVERAL = 2
"""Regions between which such an input decides."""
EMPTY_ADVICE = "write the condition as its text, or delete it if there is none"
"""Advice on a condition without text."""
ELSEWHERE_ADVICE = (
    "give it to the owner of the behaviour, or pass the value by a signal, for a contract about it"
)
_ORDER = {"<": Op.LT, "<=": Op.LE, ">": Op.GT, ">=": Op.GE}
_EQUALITY = {"==": Op.EQ, "!=": Op.NE}
_ARITHMETIC = {"+": Op.ADD, "-": Op.SUB, "*": Op.MUL, "/": Op.DIV, "%": Op.MOD}
_FOLDED: dict[Op, Callable[[int, int], int]] = {
    Op.ADD: operator.add,
    Op.SUB: operator.sub,
    Op.MUL: operator.mul,
}
"""Operators whose value for two numbers is computed at once."""
_CONNECTIVE: dict[str, Callable[[Formula, Formula], Formula]] = {
    "and": f.both,
    "or": f.either,
    "implies": f.implies,
    "xor": lambda left, right: f.negate(f.fold_iff(left, right)),
}


def elaborate_condition(expression: Expression, scope: Scope) -> Formula:
    """Return the formula of a Boolean expression. Raises ElaborationError."""
    value = elaborate_value(expression, scope)
    if not isinstance(value.domain, BooleanDomain):
        raise _mismatch(expression, "a condition", value.domain)
    return value.as_formula()


def elaborate_value(
    expression: Expression, scope: Scope, expected: Domain | None = None
) -> GuardedValue:
    """Return the value of an expression. Raises ElaborationError.

    *expected* is the domain that the surrounding expression needs; it resolves the plain names of
    enumeration literals and decides whether a literal stands for its number.
    """
    if isinstance(expected, EnumerationDomain) and expected.regions is not None:
        return _elaborate_region(expression, scope, expected)
    match expression:
        case Literal(value):
            return _elaborate_literal(expression, value, expected)
        case Name() | Member():
            return _elaborate_name(expression, scope, expected)
        case Unary(op, operand):
            return _elaborate_unary(op, operand, scope)
        case Binary():
            return _elaborate_binary(expression, scope)
        case Conditional():
            return _elaborate_conditional(expression, scope, expected)
        case _:
            text = print_expression(expression)
            raise ElaborationError(Fault.UNSUPPORTED, describe_unsupported(expression), text)


def _make_value(formula: Formula, domain: Domain) -> GuardedValue:
    return GuardedValue((Case(f.TRUE, formula),), domain)


def find_symbol(expression: Expression | Statement, scope: Scope) -> Symbol | None:
    """Return the symbol of a name or of a chain of features; None for any other expression."""
    name = name_of(expression)
    return scope(name, element_of(expression)) if name else None


def list_read(expression: Expression, scope: Scope) -> list[tuple[str, Symbol | None]]:
    """Return the names in an expression, and the texts of the sums it compares, with symbols."""
    read: list[tuple[str, Symbol | None]] = []
    for node in walk_tree(expression):
        name = name_of(node)
        read += [(name, find_symbol(node, scope))] if name else []
        if isinstance(node, Binary):
            read += [(sum_, scope(sum_, "")) for sum_ in map(print_term, _list_sums(node, scope))]
    return read


# -- operands ------------------------------------------------------------------------------------


def _elaborate_literal(
    expression: Literal, value: bool | float | str, expected: Domain | None
) -> GuardedValue:
    if isinstance(value, bool):
        return _make_value(Const(value), BooleanDomain())
    if isinstance(value, int):
        return _make_value(Const(value), IntegerDomain(value, value))
    if isinstance(value, str) and isinstance(expected, EnumerationDomain):
        return _elaborate_string(expression, value, expected)
    text = print_expression(expression)
    raise ElaborationError(Fault.UNSUPPORTED, f"{text} is not an Integer", text)


def _elaborate_string(
    expression: Expression, value: str, expected: EnumerationDomain
) -> GuardedValue:
    """Return the literal of a text, or the enumeration literal that the text names."""
    if value in expected.texts:
        return _make_value(Const(expected.literals[expected.texts.index(value)]), expected)
    if expected.texts or value not in expected.literals:
        message = f"'{value}' is none of {domains.describe(expected)}"
        raise ElaborationError(Fault.OUTSIDE, message, value)
    return _make_value(Const(value), expected)


def _elaborate_name(
    expression: Name | Member, scope: Scope, expected: Domain | None
) -> GuardedValue:
    name = name_of(expression) or print_expression(expression)
    symbol = find_symbol(expression, scope)
    last = last_name(name)
    if isinstance(expected, EnumerationDomain) and last in expected.literals and not expected.texts:
        # A property, or a constant of the same type, hides a literal of the same name. A qualified
        # name may denote a literal of another enumeration.
        is_hidden = symbol is not None and (
            not isinstance(symbol.formula, Const)
            or symbol.domain == expected
            or (name != last and isinstance(symbol.domain, EnumerationDomain))
        )
        if not is_hidden:
            return _make_value(Const(last), expected)
    if symbol is None:
        fault = Fault.UNKNOWN if dotted_name(expression) else Fault.UNSUPPORTED
        raise ElaborationError(fault, f"'{name}' is not known", name, expression.element)
    if isinstance(expected, IntegerDomain) and symbol.number is not None:
        return _make_value(Const(symbol.number), IntegerDomain(symbol.number, symbol.number))
    if symbol.domain is None:
        if isinstance(symbol.formula, Const) and symbol.quantity is None:
            message = f"'{name}' is a literal of several enumerations"
        else:
            obstacle = "several values" if symbol.has_several_values else "no finite type"
            message = f"'{name}' has {obstacle}"
        raise ElaborationError(Fault.UNSUPPORTED, message, name)
    return _make_value(symbol.formula, symbol.domain)


# -- operators -----------------------------------------------------------------------------------


def _elaborate_unary(op: str, operand: Expression, scope: Scope) -> GuardedValue:
    if op == "not":
        return _make_value(f.negate(elaborate_condition(operand, scope)), BooleanDomain())
    number = _elaborate_number(operand, scope)
    if op == "+":
        return number
    return _combine(Op.SUB, _make_value(Const(0), IntegerDomain(0, 0)), number)


_ANY_NUMBER = IntegerDomain(0, 0)
"""An expected domain that asks for a number; its bounds are not checked."""


def _elaborate_number(expression: Expression, scope: Scope) -> GuardedValue:
    value = elaborate_value(expression, scope, _ANY_NUMBER)
    if not isinstance(value.domain, IntegerDomain):
        raise _mismatch(expression, "a number", value.domain)
    return value


def _elaborate_binary(expression: Binary, scope: Scope) -> GuardedValue:
    op = expression.op
    if op in _CONNECTIVE:
        operands = (
            elaborate_condition(expression.left, scope),
            elaborate_condition(expression.right, scope),
        )
        return _make_value(_CONNECTIVE[op](*operands), BooleanDomain())
    if op in _ARITHMETIC:
        left = _elaborate_number(expression.left, scope)
        right = _elaborate_number(expression.right, scope)
        return _combine(_ARITHMETIC[op], left, right)
    if (truth := compare_regions(expression, scope)) is not None:
        return _make_value(truth, BooleanDomain())
    left, right = _elaborate_operands(expression, scope)
    comparisons = [
        f.both(a.condition, b.condition, _compare(op, a.value, b.value, left.domain))
        for a in left.cases
        for b in right.cases
    ]
    return _make_value(f.either(*comparisons), BooleanDomain())


def _compare(op: str, left: Formula, right: Formula, domain: Domain) -> Formula:
    if not isinstance(domain, BooleanDomain):
        return f.compare(_EQUALITY.get(op) or _ORDER[op], left, right)
    is_same = f.fold_iff(left, right)
    return is_same if op == "==" else f.negate(is_same)


def _elaborate_operands(expression: Binary, scope: Scope) -> tuple[GuardedValue, GuardedValue]:
    """Return both values of a comparison, after a check that they can be compared."""
    left, right = _infer_operands(expression.left, expression.right, scope)
    if type(left.domain) is not type(right.domain):
        raise _mismatch(expression.right, _describe_kind(left.domain), right.domain)
    if expression.op in _ORDER and not isinstance(left.domain, IntegerDomain):
        raise _mismatch(expression.left, "a number", left.domain)
    check_enumeration(expression.right, right.domain, left.domain)
    _check_range(expression, left, right)
    _check_texts(expression, left, right)
    return left, right


def _infer_operands(
    left: Expression, right: Expression, scope: Scope
) -> tuple[GuardedValue, GuardedValue]:
    """Return both values; the domain of one resolves the literals of the other.

    A plain literal, such as ``auto`` in ``auto == mode``, has no value before the domain of the
    other side is known, so the right side is elaborated first if the left one fails.
    """
    try:
        left_value = elaborate_value(left, scope)
    except ElaborationError:
        right_value = elaborate_value(right, scope)
        return elaborate_value(left, scope, right_value.domain), right_value
    right_value = elaborate_value(right, scope, left_value.domain)
    if isinstance(left_value.domain, EnumerationDomain) and isinstance(
        right_value.domain, IntegerDomain
    ):
        left_value = elaborate_value(left, scope, right_value.domain)
    return left_value, right_value


def _check_range(expression: Binary, left: GuardedValue, right: GuardedValue) -> None:
    """Raise ElaborationError if a number is outside the range of the other operand.

    ``<``, ``<=``, ``>`` and ``>=`` may also use the number next to the range (``x < 8`` for 0..7).
    An operand that reads nothing has no range: ``3 < 1`` is false.
    """
    for operand, value, other in (
        (expression.right, right, left),
        (expression.left, left, right),
    ):
        if not isinstance(operand, Literal | Unary) or not _is_constant(value):
            continue
        domain, other_domain = value.domain, other.domain
        if not isinstance(domain, IntegerDomain) or _is_constant(other):
            continue
        slack = 0 if expression.op in _EQUALITY else 1
        if isinstance(other_domain, IntegerDomain) and not (
            other_domain.low - slack <= domain.low <= other_domain.high + slack
        ):
            text = print_expression(operand)
            message = f"{text} is outside {domains.describe(other_domain)}"
            raise ElaborationError(Fault.OUTSIDE, message, text)


def _is_constant(value: GuardedValue) -> bool:
    return all(isinstance(case.value, Const) for case in value.cases)


def _check_texts(expression: Binary, left: GuardedValue, right: GuardedValue) -> None:
    """Raise ElaborationError if two String features are compared with each other.

    The last literal of a String stands for all other texts, so that equal literals may be
    different texts.
    """
    is_text = isinstance(left.domain, EnumerationDomain) and bool(left.domain.texts)
    has_constant = any(
        isinstance(case.value, Const) for side in (left, right) for case in side.cases
    )
    if is_text and not has_constant:
        text = print_expression(expression)
        message = f"'{text}' compares texts of which neither is known"
        raise ElaborationError(Fault.UNSUPPORTED, message, text)


def _combine(op: Op, left: GuardedValue, right: GuardedValue) -> GuardedValue:
    """Apply an arithmetic operator to all pairs of cases."""
    cases = tuple(
        Case(f.both(a.condition, b.condition), _fold(op, a.value, b.value))
        for a in left.cases
        for b in right.cases
    )
    return GuardedValue(cases, _bound_result(op, left.domain, right.domain))


def _fold(op: Op, left: Formula, right: Formula) -> Formula:
    fold = _FOLDED.get(op)
    if fold is not None and isinstance(left, Const) and isinstance(right, Const):
        return Const(fold(int(left.value), int(right.value)))
    return f.compare(op, left, right)


def _bound_result(op: Op, left: Domain, right: Domain) -> Domain:
    """Return bounds of the results of an arithmetic operator (interval arithmetic)."""
    assert isinstance(left, IntegerDomain)
    assert isinstance(right, IntegerDomain)
    match op:
        case Op.ADD:
            return IntegerDomain(left.low + right.low, left.high + right.high)
        case Op.SUB:
            return IntegerDomain(left.low - right.high, left.high - right.low)
        case Op.MUL:
            products = [a * b for a in (left.low, left.high) for b in (right.low, right.high)]
            return IntegerDomain(min(products), max(products))
    # The absolute values of quotient and remainder are at most that of the dividend.
    greatest = max(abs(left.low), abs(left.high))
    return IntegerDomain(-greatest, greatest)


def _elaborate_conditional(
    expression: Conditional, scope: Scope, expected: Domain | None
) -> GuardedValue:
    test = elaborate_condition(expression.condition, scope)
    then = elaborate_value(expression.then, scope, expected)
    otherwise = elaborate_value(expression.otherwise, scope, expected or then.domain)
    if type(then.domain) is not type(otherwise.domain):
        raise _mismatch(expression.otherwise, _describe_kind(then.domain), otherwise.domain)
    check_enumeration(expression.otherwise, otherwise.domain, then.domain)
    cases = [Case(f.both(test, case.condition), case.value) for case in then.cases]
    negated = f.negate(test)
    cases += [Case(f.both(negated, case.condition), case.value) for case in otherwise.cases]
    return GuardedValue(tuple(cases), _join_domains(then.domain, otherwise.domain))


def _join_domains(left: Domain, right: Domain) -> Domain:
    """Return the domain of both branches: the smallest range that contains the two ranges."""
    if isinstance(left, IntegerDomain) and isinstance(right, IntegerDomain):
        return IntegerDomain(min(left.low, right.low), max(left.high, right.high))
    return left


# -- regions of numbers --------------------------------------------------------------------------


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


def _list_sums(expression: Binary, scope: Scope) -> list[Term]:
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


def _elaborate_region(
    expression: Expression, scope: Scope, expected: EnumerationDomain
) -> GuardedValue:
    """Return the region of a number: that of a constant, or of a multiple of one feature."""
    if isinstance(expression, Conditional):
        return _elaborate_conditional(expression, scope, expected)
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
        return _make_value(_find_region(text, expected, point), expected)
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
    """Raise ElaborationError if a name is unknown or denotes no number."""
    for node in walk_tree(expression):
        symbol, name = find_symbol(node, scope), name_of(node)
        if name and symbol is None and isinstance(node, Name):
            raise ElaborationError(Fault.UNKNOWN, f"'{name}' is not known", name, node.element)
        domain = None if symbol is None else symbol.domain
        is_number = isinstance(domain, IntegerDomain) or getattr(domain, "regions", None)
        if isinstance(node, Name) and domain is not None and not is_number:
            raise _mismatch(node, "a number", domain)


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


# -- errors --------------------------------------------------------------------------------------


def _describe_kind(domain: Domain) -> str:
    match domain:
        case BooleanDomain():
            return "a condition"
        case IntegerDomain():
            return "a number"
        case EnumerationDomain():
            return f"one of {domains.describe(domain)}"


def check_enumeration(expression: Expression, actual: Domain, expected: Domain) -> None:
    """Raise ElaborationError if the domain of an expression is another enumeration."""
    if not isinstance(actual, EnumerationDomain) or not isinstance(expected, EnumerationDomain):
        return
    if not actual.is_comparable(expected):
        text = print_expression(expression)
        difference = domains.describe_difference(actual, expected)
        raise ElaborationError(Fault.TYPE, f"'{text}' is {difference}", text)


def _mismatch(expression: Expression, expected: str, actual: Domain) -> ElaborationError:
    text = print_expression(expression)
    if isinstance(actual, EnumerationDomain) and actual.regions is not None:
        reason = f"'{text}' is a number, and only comparisons of sums of numbers have a formula"
        return ElaborationError(Fault.UNSUPPORTED, reason, text)
    message = f"'{text}' is {_describe_kind(actual)}, not {expected}"
    return ElaborationError(Fault.TYPE, message, text)
