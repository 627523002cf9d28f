"""Expressions of recipes, read from the texts of a model."""

from collections.abc import Iterator

from sysmlc.ir import Element
from sysmlc.logic.expressions import expression as source
from sysmlc.logic.machines.triggers import parse_milliseconds
from sysmlc.passes.recipe.context import Context
from sysmlc.passes.recipe.features import find_feature, literal_value, value_type
from sysmlc.recipe.expression import Apply, Call, Expr, Index, Lit, Opaque, Var
from sysmlc.recipe.model import EnumType

_OPERATORS = {"%": "mod", "xor": "!="}


def read_expression(text: str) -> Expr:
    """Return the expression of a text, or Opaque if it is none."""
    try:
        return translate_expression(source.parse_expression(text))
    except source.ExpressionError:
        return Opaque(text)


def read_time(text: str) -> Expr:
    """Return a duration in milliseconds: a number with a unit, or an expression that already is
    one.
    """
    duration = parse_milliseconds(text)
    return read_expression(text) if duration is None else Lit(duration)


def read_optional(text: str) -> Expr | None:
    """Return the expression of a text, or None for the empty text."""
    return read_expression(text) if text else None


def translate_expression(expression: source.Expression) -> Expr:  # noqa: PLR0911 - one a kind
    """Return a parsed expression as an expression of a recipe."""
    name = source.dotted(expression)
    if name is not None:
        return Var(name)
    match expression:
        case source.Literal(value):
            return Lit(value)
        case source.Unary("+", operand):
            return translate_expression(operand)
        case source.Unary(op, operand):
            return Apply(op, (translate_expression(operand),))
        case source.Binary("implies", left, right):
            return Apply(
                "or", (Apply("not", (translate_expression(left),)), translate_expression(right))
            )
        case source.Binary(op, left, right):
            return Apply(
                _OPERATORS.get(op, op), (translate_expression(left), translate_expression(right))
            )
        case source.Index(base, index):
            return Index(translate_expression(base), translate_expression(index))
        case source.Call(function, args):
            function_name = source.dotted(function) or source.print_expression(function)
            return Call(function_name, tuple(map(translate_expression, args)))
        case source.Conditional(condition, then, otherwise):
            return Call("if", tuple(map(translate_expression, (condition, then, otherwise))))
        case _:
            return Opaque(source.print_expression(expression))


def read_assignments(text: str) -> list[tuple[str, Expr]] | None:
    """Return the variables and values of an effect that only assigns; None for any other effect."""
    try:
        statements = source.parse_effect(text)
    except source.ExpressionError:
        return None
    pairs: list[tuple[str, Expr]] = []
    for statement in statements:
        if not isinstance(statement, source.Assignment):
            return None
        target = source.dotted(statement.target)
        if target is None:
            return None
        pairs.append((target, translate_expression(statement.value)))
    return pairs


def resolve_literals(context: Context, activity: Element, expression: Expr) -> Expr:
    """Replace enumeration literals by their values (SysML 2.0, 8.3.8).

    A literal that is compared with something of its own enumeration stays a name.
    """
    match expression:
        case Var(name) if "::" in name:
            literal = context.find_literal(name)
            return expression if literal is None else Lit(literal_value(literal))
        case Apply(op, args):
            enumerations = list(_find_enumerations(context, activity, args))
            return Apply(
                op,
                tuple(
                    _resolve_operand(context, activity, argument, enumerations) for argument in args
                ),
            )
        case Index(base, index):
            return Index(base, resolve_literals(context, activity, index))
        case Call(function, args):
            return Call(
                function, tuple(resolve_literals(context, activity, argument) for argument in args)
            )
        case _:
            return expression


def _resolve_operand(
    context: Context, activity: Element, operand: Expr, enumerations: list[str]
) -> Expr:
    literal = (
        context.find_literal(operand.name)
        if isinstance(operand, Var) and "::" in operand.name
        else None
    )
    owner = None if literal is None else context.graph.owner(literal)
    is_kept = owner is not None and context.name(owner) in enumerations
    return operand if is_kept else resolve_literals(context, activity, operand)


def _find_enumerations(
    context: Context, activity: Element, args: tuple[Expr, ...]
) -> Iterator[str]:
    """Yield the names of the enumerations that type the operands of an expression."""
    for operand in args:
        feature = (
            find_feature(context, activity, operand.name) if isinstance(operand, Var) else None
        )
        type_ = None if feature is None else value_type(context, feature)
        if isinstance(type_, EnumType):
            yield type_.name
