"""From expressions to formulas: names resolved, types checked, values as guarded cases."""

from collections.abc import Callable
from enum import StrEnum

from msgspec import Struct

from sysmlc.logic import domains
from sysmlc.logic import formula as f
from sysmlc.logic.contract import BooleanDomain, Domain, EnumerationDomain, IntegerDomain
from sysmlc.logic.expressions.context import Context
from sysmlc.logic.expressions.expression import (
    Binary,
    Conditional,
    Expression,
    Member,
    Name,
    Unary,
    dotted,
    name_of,
    print_expression,
)
from sysmlc.logic.expressions.expression import Literal as Written
from sysmlc.logic.formula import Const, Formula, Op


class Fault(StrEnum):
    """Why an expression has no meaning as a formula."""

    UNKNOWN = "unknown name"
    TYPE = "type mismatch"
    OUTSIDE = "out of domain"
    UNSUPPORTED = "not supported"


class ElaborationError(ValueError):
    """An expression without meaning; ``name`` is the name or value that is at fault."""

    def __init__(self, fault: Fault, message: str, name: str, offset: int) -> None:
        super().__init__(message)
        self.fault = fault
        self.name = name
        self.offset = offset


class Term(Struct, frozen=True):
    """A value under a condition, with the domain that it is taken from."""

    condition: Formula
    value: Formula


class Meaning(Struct, frozen=True):
    """What an expression means: terms whose conditions exclude one another and cover all."""

    terms: tuple[Term, ...]
    domain: Domain

    @property
    def truth(self) -> Formula:
        """The formula of a Boolean meaning."""
        only = self.terms[0]
        if len(self.terms) == 1:
            return only.value
        return f.either(*(f.both(term.condition, term.value) for term in self.terms))


class Symbol(Struct, frozen=True):
    """What a name stands for: a formula and its domain; ``number`` where a literal is one."""

    formula: Formula
    domain: Domain | None
    number: int | None = None


Scope = Callable[[str], Symbol | None]
_ORDER = {"<": Op.LT, "<=": Op.LE, ">": Op.GT, ">=": Op.GE}
_EQUALITY = {"==": Op.EQ, "!=": Op.NE}
_ARITHMETIC = {"+": Op.ADD, "-": Op.SUB, "*": Op.MUL, "/": Op.DIV, "%": Op.MOD}
_CONNECTIVE: dict[str, Callable[[Formula, Formula], Formula]] = {
    "and": f.both,
    "or": f.either,
    "implies": f.implies,
    "xor": lambda left, right: f.negate(f.iff(left, right)),
}


def literal_of(context: Context, name: str) -> Symbol | None:
    """An enumeration literal that is named together with its enumeration: ``Mode::auto``."""
    found = context.literals.get(name)
    if found is None or ("::" not in name and "." not in name):
        return None
    enumeration, literal = found
    domain = context.enumerations.domains[enumeration]
    return Symbol(f.const(literal), domain, context.number(name))


def condition(expression: Expression, scope: Scope) -> Formula:
    """The formula of a Boolean expression. Raises ElaborationError."""
    found = meaning(expression, scope)
    if not isinstance(found.domain, BooleanDomain):
        raise _mismatch(expression, "a condition", found.domain)
    return found.truth


def meaning(expression: Expression, scope: Scope, expected: Domain | None = None) -> Meaning:
    """What an expression means; ``expected`` helps to find the literals of an enumeration.

    Raises ElaborationError.
    """
    match expression:
        case Written(value):
            return _literal(expression, value, expected)
        case Name() | Member():
            return _named(expression, scope, expected)
        case Unary(op, operand):
            return _unary(op, operand, scope)
        case Binary():
            return _binary(expression, scope)
        case Conditional():
            return _conditional(expression, scope, expected)
        case _:
            text = print_expression(expression)
            raise ElaborationError(
                Fault.UNSUPPORTED, f"'{text}' is not a finite value", text, expression.offset
            )


def _single(value: Formula, domain: Domain) -> Meaning:
    return Meaning((Term(f.TRUE, value),), domain)


def _literal(expression: Written, value: bool | float | str, expected: Domain | None) -> Meaning:
    if isinstance(value, bool):
        return _single(Const(value), BooleanDomain())
    if isinstance(value, int):
        return _single(Const(value), IntegerDomain(value, value))
    if isinstance(value, str) and isinstance(expected, EnumerationDomain):
        return _enumerated(expression, value, expected)
    text = print_expression(expression)
    raise ElaborationError(
        Fault.UNSUPPORTED, f"{text} is not a finite value", text, expression.offset
    )


def _enumerated(expression: Expression, value: str, expected: EnumerationDomain) -> Meaning:
    if value in expected.texts:
        return _single(Const(expected.literals[expected.texts.index(value)]), expected)
    if expected.texts or value not in expected.literals:
        message = f"'{value}' is none of {domains.describe(expected)}"
        raise ElaborationError(Fault.OUTSIDE, message, value, expression.offset)
    return _single(Const(value), expected)


def _named(expression: Name | Member, scope: Scope, expected: Domain | None) -> Meaning:
    name = name_of(expression) or print_expression(expression)
    symbol = scope(name)
    last = name.replace(".", "::").rpartition("::")[2]
    if isinstance(expected, EnumerationDomain) and last in expected.literals and not expected.texts:
        is_property = symbol is not None and not isinstance(symbol.formula, Const)
        if not is_property:
            return _single(Const(last), expected)
    if symbol is None:
        kind = Fault.UNKNOWN if dotted(expression) else Fault.UNSUPPORTED
        raise ElaborationError(kind, f"'{name}' is not known", name, expression.offset)
    if isinstance(expected, IntegerDomain) and symbol.number is not None:
        return _single(Const(symbol.number), IntegerDomain(symbol.number, symbol.number))
    if symbol.domain is None:
        message = f"'{name}' has no finite type"
        raise ElaborationError(Fault.UNSUPPORTED, message, name, expression.offset)
    return _single(symbol.formula, symbol.domain)


def _unary(op: str, operand: Expression, scope: Scope) -> Meaning:
    if op == "not":
        return _single(f.negate(condition(operand, scope)), BooleanDomain())
    inner = _number(operand, scope)
    if op == "+":
        return inner
    return _combine(Op.SUB, _single(Const(0), IntegerDomain(0, 0)), inner)


_NUMBER = IntegerDomain(0, 0)
"""That a number is expected, whichever."""


def _number(expression: Expression, scope: Scope) -> Meaning:
    found = meaning(expression, scope, _NUMBER)
    if not isinstance(found.domain, IntegerDomain):
        raise _mismatch(expression, "a number", found.domain)
    return found


def _binary(expression: Binary, scope: Scope) -> Meaning:
    op = expression.op
    if op in _CONNECTIVE:
        sides = condition(expression.left, scope), condition(expression.right, scope)
        return _single(_CONNECTIVE[op](*sides), BooleanDomain())
    if op in _ARITHMETIC:
        left, right = _number(expression.left, scope), _number(expression.right, scope)
        return _combine(_ARITHMETIC[op], left, right)
    left, right = _sides(expression, scope)
    made = [
        f.both(a.condition, b.condition, _comparison(op, a.value, b.value, left.domain))
        for a in left.terms
        for b in right.terms
    ]
    return _single(f.either(*made), BooleanDomain())


def _comparison(op: str, left: Formula, right: Formula, domain: Domain) -> Formula:
    if not isinstance(domain, BooleanDomain):
        return f.compare(_EQUALITY.get(op) or _ORDER[op], left, right)
    same = f.iff(left, right)
    return same if op == "==" else f.negate(same)


def _sides(expression: Binary, scope: Scope) -> tuple[Meaning, Meaning]:
    left, right = _paired(expression.left, expression.right, scope)
    if type(left.domain) is not type(right.domain):
        raise _mismatch(expression.right, _noun(left.domain), right.domain)
    if expression.op in _ORDER and not isinstance(left.domain, IntegerDomain):
        raise _mismatch(expression.left, "a number", left.domain)
    if isinstance(left.domain, EnumerationDomain) and left.domain != right.domain:
        raise _mismatch(expression.right, f"one of {domains.describe(left.domain)}", right.domain)
    _check_range(expression, left, right)
    _check_texts(expression, left, right)
    return left, right


def _check_texts(expression: Binary, left: Meaning, right: Meaning) -> None:
    """Two texts that may be any other are not known to be the same."""
    is_text = isinstance(left.domain, EnumerationDomain) and bool(left.domain.texts)
    known = (isinstance(t.value, Const) for side in (left, right) for t in side.terms)
    if is_text and not any(known):
        text = print_expression(expression)
        message = f"'{text}' compares texts of which neither is known"
        raise ElaborationError(Fault.UNSUPPORTED, message, text, expression.offset)


def _paired(left: Expression, right: Expression, scope: Scope) -> tuple[Meaning, Meaning]:
    """Both meanings; the side that is known tells the enumeration of the other."""
    try:
        first = meaning(left, scope)
    except ElaborationError:
        second = meaning(right, scope)
        return meaning(left, scope, second.domain), second
    second = meaning(right, scope, first.domain)
    if isinstance(first.domain, EnumerationDomain) and isinstance(second.domain, IntegerDomain):
        first = meaning(left, scope, second.domain)
    return first, second


def _check_range(expression: Binary, left: Meaning, right: Meaning) -> None:
    for side, mine, other in (
        (expression.right, right.domain, left.domain),
        (expression.left, left.domain, right.domain),
    ):
        if not isinstance(side, Written | Unary) or not isinstance(mine, IntegerDomain):
            continue
        slack = 0 if expression.op in _EQUALITY else 1
        if isinstance(other, IntegerDomain) and not (
            other.low - slack <= mine.low <= other.high + slack
        ):
            text = print_expression(side)
            message = f"{text} is outside {domains.describe(other)}"
            raise ElaborationError(Fault.OUTSIDE, message, text, side.offset)


def _combine(op: Op, left: Meaning, right: Meaning) -> Meaning:
    terms = tuple(
        Term(f.both(a.condition, b.condition), _fold(op, a.value, b.value))
        for a in left.terms
        for b in right.terms
    )
    return Meaning(terms, _spread(op, left.domain, right.domain))


def _fold(op: Op, left: Formula, right: Formula) -> Formula:
    if isinstance(left, Const) and isinstance(right, Const) and op in (Op.ADD, Op.SUB, Op.MUL):
        a, b = int(left.value), int(right.value)
        return Const({Op.ADD: a + b, Op.SUB: a - b, Op.MUL: a * b}[op])
    return f.compare(op, left, right)


def _spread(op: Op, left: Domain, right: Domain) -> Domain:
    """Bounds of an operation's results."""
    assert isinstance(left, IntegerDomain)
    assert isinstance(right, IntegerDomain)
    a, b = (left.low, left.high), (right.low, right.high)
    if op is Op.ADD:
        return IntegerDomain(a[0] + b[0], a[1] + b[1])
    if op is Op.SUB:
        return IntegerDomain(a[0] - b[1], a[1] - b[0])
    if op is Op.MUL:
        products = [x * y for x in a for y in b]
        return IntegerDomain(min(products), max(products))
    most = max(map(abs, a))
    return IntegerDomain(-most, most)


def _conditional(expression: Conditional, scope: Scope, expected: Domain | None) -> Meaning:
    test = condition(expression.condition, scope)
    then = meaning(expression.then, scope, expected)
    otherwise = meaning(expression.otherwise, scope, expected or then.domain)
    if type(then.domain) is not type(otherwise.domain):
        raise _mismatch(expression.otherwise, _noun(then.domain), otherwise.domain)
    terms = [Term(f.both(test, one.condition), one.value) for one in then.terms]
    unless = f.negate(test)
    terms += [Term(f.both(unless, one.condition), one.value) for one in otherwise.terms]
    return Meaning(tuple(terms), _hull(then.domain, otherwise.domain))


def _hull(left: Domain, right: Domain) -> Domain:
    if isinstance(left, IntegerDomain) and isinstance(right, IntegerDomain):
        return IntegerDomain(min(left.low, right.low), max(left.high, right.high))
    return left


def _noun(domain: Domain) -> str:
    match domain:
        case BooleanDomain():
            return "a condition"
        case IntegerDomain():
            return "a number"
        case EnumerationDomain():
            return f"one of {domains.describe(domain)}"


def _mismatch(expression: Expression, wanted: str, found: Domain) -> ElaborationError:
    text = print_expression(expression)
    message = f"'{text}' is {_noun(found)}, not {wanted}"
    return ElaborationError(Fault.TYPE, message, text, expression.offset)
