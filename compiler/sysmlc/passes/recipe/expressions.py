"""Expressions of recipes, read from the texts of a model."""

from collections.abc import Iterator

from sysmlc.ir import Element
from sysmlc.logic.expressions import expression as source
from sysmlc.logic.expressions.parsing import parse_effect, parse_expression
from sysmlc.logic.machines.triggers import parse_milliseconds
from sysmlc.passes.recipe.context import Context
from sysmlc.passes.recipe.features import find_feature, literal_value, value_type
from sysmlc.recipe.expression import (
    make_opaque,
    make_variable,
    map_operands,
    operands,
    variable_name,
)
from sysmlc.recipe.model import EnumType

_OPERATORS = {"%": "mod", "xor": "!="}


def read_expression(text: str) -> source.Expression:
    """Return the expression of a text, or Opaque if it is none."""
    try:
        return translate_expression(parse_expression(text))
    except source.ExpressionError:
        return make_opaque(text)


def read_time(text: str) -> source.Expression:
    """Return a duration in milliseconds, from a number with a unit or an expression."""
    duration = parse_milliseconds(text)
    return read_expression(text) if duration is None else source.Literal(duration)


def read_optional(text: str) -> source.Expression | None:
    """Return the expression of a text, or None for the empty text."""
    return read_expression(text) if text else None


def translate_expression(  # noqa: PLR0911 - one for each kind
    expression: source.Expression,
) -> source.Expression:
    """Return a parsed expression in the normal form of recipes."""
    name = source.dotted_name(expression)
    if name is not None:
        return make_variable(name)
    match expression:
        case source.Literal():
            return expression
        case source.Unary("+", operand):
            return translate_expression(operand)
        case source.Binary("implies", left, right):
            negated = source.Unary("not", translate_expression(left))
            return source.Binary("or", negated, translate_expression(right))
        case source.Binary(op, left, right):
            operator = _OPERATORS.get(op, op)
            return source.Binary(operator, translate_expression(left), translate_expression(right))
        case source.Call(function, args):
            function_name = source.dotted_name(function) or source.print_expression(function)
            return _make_call(function_name, *args)
        case source.Conditional(condition, then, otherwise):
            return _make_call("if", condition, then, otherwise)
        case source.Unary() | source.Index():
            return map_operands(expression, translate_expression)
        case _:
            return make_opaque(source.print_expression(expression))


def _make_call(function: str, *args: source.Expression) -> source.Expression:
    return source.Call(make_variable(function), tuple(map(translate_expression, args)))


def read_assignments(text: str) -> list[tuple[str, source.Expression]] | None:
    """Return the variables and values of an effect that only assigns; None for any other effect."""
    try:
        statements = parse_effect(text)
    except source.ExpressionError:
        return None
    pairs: list[tuple[str, source.Expression]] = []
    for statement in statements:
        if not isinstance(statement, source.Assignment):
            return None
        target = source.dotted_name(statement.target)
        if target is None:
            return None
        pairs.append((target, translate_expression(statement.value)))
    return pairs


def resolve_literals(
    context: Context, activity: Element, expression: source.Expression
) -> source.Expression:
    """Replace enumeration literals by their values (SysML 2.0, 8.3.8).

    A literal that is compared with something of its own enumeration stays a name.
    """
    name = variable_name(expression)
    if name is not None:
        literal = context.find_literal(name) if "::" in name else None
        return expression if literal is None else source.Literal(literal_value(literal))
    match expression:
        case source.Unary() | source.Binary():
            enumerations = list(_find_enumerations(context, activity, operands(expression)))
            return map_operands(
                expression,
                lambda operand: _resolve_operand(context, activity, operand, enumerations),
            )
        case source.Index(base, index):
            return source.Index(base, resolve_literals(context, activity, index))
        case source.Call():
            return map_operands(
                expression, lambda argument: resolve_literals(context, activity, argument)
            )
        case _:
            return expression


def _resolve_operand(
    context: Context, activity: Element, operand: source.Expression, enumerations: list[str]
) -> source.Expression:
    name = variable_name(operand)
    literal = context.find_literal(name) if name is not None and "::" in name else None
    owner = None if literal is None else context.graph.owner(literal)
    is_kept = owner is not None and context.name(owner) in enumerations
    return operand if is_kept else resolve_literals(context, activity, operand)


def _find_enumerations(
    context: Context, activity: Element, args: tuple[source.Expression, ...]
) -> Iterator[str]:
    """Yield the names of the enumerations that type the operands of an expression."""
    for operand in args:
        name = variable_name(operand)
        feature = None if name is None else find_feature(context, activity, name)
        type_ = None if feature is None else value_type(context, feature)
        if isinstance(type_, EnumType):
            yield type_.name
