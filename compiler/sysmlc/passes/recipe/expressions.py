"""Expressions of recipes, from the texts of the model."""

from collections.abc import Iterator

from sysmlc.ir import Element
from sysmlc.logic.expressions import expression as source
from sysmlc.logic.machines.triggers import parse_milliseconds
from sysmlc.passes.recipe.context import Context
from sysmlc.passes.recipe.features import feature_at, literal_value, value_type
from sysmlc.recipe.expression import Apply, Call, Expr, Index, Lit, Opaque, Var
from sysmlc.recipe.model import EnumType

_OPERATORS = {"%": "mod", "xor": "!="}


def read(text: str) -> Expr:
    """The expression of a text, or Opaque when it is none."""
    try:
        return translate(source.parse_expression(text))
    except source.ExpressionError:
        return Opaque(text)


def read_time(text: str) -> Expr:
    """A duration in milliseconds: a number with a unit, or an expression that is one already."""
    found = parse_milliseconds(text)
    return read(text) if found is None else Lit(found)


def optional(text: str) -> Expr | None:
    """The expression of a text, None for no text."""
    return read(text) if text else None


def translate(expression: source.Expression) -> Expr:  # noqa: PLR0911 - one a kind
    """A parsed expression as a recipe's tree."""
    name = source.dotted(expression)
    if name is not None:
        return Var(name)
    match expression:
        case source.Literal(value):
            return Lit(value)
        case source.Unary("+", operand):
            return translate(operand)
        case source.Unary(op, operand):
            return Apply(op, (translate(operand),))
        case source.Binary("implies", left, right):
            return Apply("or", (Apply("not", (translate(left),)), translate(right)))
        case source.Binary(op, left, right):
            return Apply(_OPERATORS.get(op, op), (translate(left), translate(right)))
        case source.Index(base, index):
            return Index(translate(base), translate(index))
        case source.Call(function, args):
            called = source.dotted(function) or source.print_expression(function)
            return Call(called, tuple(map(translate, args)))
        case source.Conditional(condition, then, otherwise):
            return Call("if", tuple(map(translate, (condition, then, otherwise))))
        case _:
            return Opaque(source.print_expression(expression))


def assignments(text: str) -> list[tuple[str, Expr]] | None:
    """Variables and values of an effect that only assigns; None for any other."""
    try:
        statements = source.parse_effect(text)
    except source.ExpressionError:
        return None
    found: list[tuple[str, Expr]] = []
    for statement in statements:
        if not isinstance(statement, source.Assignment):
            return None
        target = source.dotted(statement.target)
        if target is None:
            return None
        found.append((target, translate(statement.value)))
    return found


def with_values(context: Context, activity: Element, expression: Expr) -> Expr:
    """The expression with the values of enumeration literals (SysML 2.0, 8.3.8).

    A literal beside something of its enumeration stays a name.
    """
    match expression:
        case Var(name) if "::" in name:
            literal = context.literal(name)
            return expression if literal is None else Lit(literal_value(literal))
        case Apply(op, args):
            kept = list(_of_enumerations(context, activity, args))
            return Apply(op, tuple(_inner(context, activity, one, kept) for one in args))
        case Index(base, index):
            return Index(base, with_values(context, activity, index))
        case Call(function, args):
            return Call(function, tuple(with_values(context, activity, one) for one in args))
        case _:
            return expression


def _inner(context: Context, activity: Element, one: Expr, kept: list[str]) -> Expr:
    literal = context.literal(one.name) if isinstance(one, Var) and "::" in one.name else None
    owner = None if literal is None else context.graph.owner(literal)
    is_kept = owner is not None and context.name(owner) in kept
    return one if is_kept else with_values(context, activity, one)


def _of_enumerations(context: Context, activity: Element, args: tuple[Expr, ...]) -> Iterator[str]:
    """Names of the enumerations that type what stands in an expression."""
    for one in args:
        found = feature_at(context, activity, one.name) if isinstance(one, Var) else None
        type_ = None if found is None else value_type(context, found)
        if isinstance(type_, EnumType):
            yield type_.name
