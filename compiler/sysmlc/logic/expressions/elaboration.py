"""Elaboration of expressions to formulas: resolve names, check types, split values into cases."""

import operator
from collections.abc import Callable

from sysmlc.ir.expressions import (
    Binary,
    Conditional,
    Expression,
    Literal,
    Member,
    Name,
    Unary,
    describe_unsupported,
    dotted_name,
    last_name,
    name_of,
    print_expression,
    walk_tree,
)
from sysmlc.logic import domains
from sysmlc.logic import formula as f
from sysmlc.logic.contract import BooleanDomain, Domain, EnumerationDomain, IntegerDomain
from sysmlc.logic.expressions.linear import print_term
from sysmlc.logic.expressions.number_formulas import compare_regions, elaborate_region, list_sums
from sysmlc.logic.expressions.symbols import (
    Case,
    ElaborationError,
    Fault,
    GuardedValue,
    Scope,
    Symbol,
    describe_kind,
    find_symbol,
    make_value,
    mismatch,
)
from sysmlc.logic.formula import Const, Formula, Op

FINITE_ADVICE = "compare Booleans, enumerations and sums of numbers for a contract"
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
        raise mismatch(expression, "a condition", value.domain)
    return value.as_formula()


def elaborate_value(
    expression: Expression, scope: Scope, expected: Domain | None = None
) -> GuardedValue:
    """Return the value of an expression. Raises ElaborationError.

    *expected* is the domain that the surrounding expression needs; it resolves the plain names of
    enumeration literals and decides whether a literal stands for its number.
    """
    is_whole = not isinstance(expression, Conditional)
    if isinstance(expected, EnumerationDomain) and expected.regions is not None and is_whole:
        return elaborate_region(expression, scope, expected)
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


def list_read(expression: Expression, scope: Scope) -> list[tuple[str, Symbol | None]]:
    """Return the names in an expression, and the texts of the sums it compares, with symbols."""
    read: list[tuple[str, Symbol | None]] = []
    for node in walk_tree(expression):
        name = name_of(node)
        read += [(name, find_symbol(node, scope))] if name else []
        if isinstance(node, Binary):
            read += [(sum_, scope(sum_, "")) for sum_ in map(print_term, list_sums(node, scope))]
    return read


# -- operands ------------------------------------------------------------------------------------


def _elaborate_literal(
    expression: Literal, value: bool | float | str, expected: Domain | None
) -> GuardedValue:
    if isinstance(value, bool):
        return make_value(Const(value), BooleanDomain())
    if isinstance(value, int):
        return make_value(Const(value), IntegerDomain(value, value))
    if isinstance(value, str) and isinstance(expected, EnumerationDomain):
        return _elaborate_string(expression, value, expected)
    text = print_expression(expression)
    raise ElaborationError(Fault.UNSUPPORTED, f"{text} is not an Integer", text)


def _elaborate_string(
    expression: Expression, value: str, expected: EnumerationDomain
) -> GuardedValue:
    """Return the literal of a text, or the enumeration literal that the text names."""
    if value in expected.texts:
        return make_value(Const(expected.literals[expected.texts.index(value)]), expected)
    if expected.texts or value not in expected.literals:
        message = f"'{value}' is none of {domains.describe(expected)}"
        raise ElaborationError(Fault.OUTSIDE, message, value)
    return make_value(Const(value), expected)


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
            return make_value(Const(last), expected)
    if symbol is None:
        fault = Fault.UNKNOWN if dotted_name(expression) else Fault.UNSUPPORTED
        raise ElaborationError(fault, f"'{name}' is not known", name, expression.element)
    if isinstance(expected, IntegerDomain) and symbol.number is not None:
        return make_value(Const(symbol.number), IntegerDomain(symbol.number, symbol.number))
    if symbol.domain is None:
        if isinstance(symbol.formula, Const) and symbol.quantity is None:
            message = f"'{name}' is a literal of several enumerations"
        else:
            obstacle = "several values" if symbol.has_several_values else "no finite type"
            message = f"'{name}' has {obstacle}"
        raise ElaborationError(Fault.UNSUPPORTED, message, name)
    return make_value(symbol.formula, symbol.domain)


# -- operators -----------------------------------------------------------------------------------


def _elaborate_unary(op: str, operand: Expression, scope: Scope) -> GuardedValue:
    if op == "not":
        return make_value(f.negate(elaborate_condition(operand, scope)), BooleanDomain())
    number = _elaborate_number(operand, scope)
    if op == "+":
        return number
    return _combine(Op.SUB, make_value(Const(0), IntegerDomain(0, 0)), number)


_ANY_NUMBER = IntegerDomain(0, 0)
"""An expected domain that asks for a number; its bounds are not checked."""


def _elaborate_number(expression: Expression, scope: Scope) -> GuardedValue:
    value = elaborate_value(expression, scope, _ANY_NUMBER)
    if not isinstance(value.domain, IntegerDomain):
        raise mismatch(expression, "a number", value.domain)
    return value


def _elaborate_binary(expression: Binary, scope: Scope) -> GuardedValue:
    op = expression.op
    if op in _CONNECTIVE:
        operands = (
            elaborate_condition(expression.left, scope),
            elaborate_condition(expression.right, scope),
        )
        return make_value(_CONNECTIVE[op](*operands), BooleanDomain())
    if op in _ARITHMETIC:
        left = _elaborate_number(expression.left, scope)
        right = _elaborate_number(expression.right, scope)
        return _combine(_ARITHMETIC[op], left, right)
    if (truth := compare_regions(expression, scope)) is not None:
        return make_value(truth, BooleanDomain())
    left, right = _elaborate_operands(expression, scope)
    comparisons = [
        f.both(a.condition, b.condition, _compare(op, a.value, b.value, left.domain))
        for a in left.cases
        for b in right.cases
    ]
    return make_value(f.either(*comparisons), BooleanDomain())


def _compare(op: str, left: Formula, right: Formula, domain: Domain) -> Formula:
    if not isinstance(domain, BooleanDomain):
        return f.compare(_EQUALITY.get(op) or _ORDER[op], left, right)
    is_same = f.fold_iff(left, right)
    return is_same if op == "==" else f.negate(is_same)


def _elaborate_operands(expression: Binary, scope: Scope) -> tuple[GuardedValue, GuardedValue]:
    """Return both values of a comparison, after a check that they can be compared."""
    left, right = _infer_operands(expression.left, expression.right, scope)
    if type(left.domain) is not type(right.domain):
        raise mismatch(expression.right, describe_kind(left.domain), right.domain)
    if expression.op in _ORDER and not isinstance(left.domain, IntegerDomain):
        raise mismatch(expression.left, "a number", left.domain)
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
        raise mismatch(expression.otherwise, describe_kind(then.domain), otherwise.domain)
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


# -- errors --------------------------------------------------------------------------------------


def check_enumeration(expression: Expression, actual: Domain, expected: Domain) -> None:
    """Raise ElaborationError if the domain of an expression is another enumeration."""
    if not isinstance(actual, EnumerationDomain) or not isinstance(expected, EnumerationDomain):
        return
    if not actual.is_comparable(expected):
        text = print_expression(expression)
        difference = domains.describe_difference(actual, expected)
        raise ElaborationError(Fault.TYPE, f"'{text}' is {difference}", text)
