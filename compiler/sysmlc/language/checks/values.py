"""Values and types of expressions, as far as the model itself says them."""

import operator as op
from collections.abc import Callable

from sysmlc.language.metaclasses import FEATURES, kinds_of
from sysmlc.language.names import Model
from sysmlc.language.names.expression_results import find_named_element, find_result_parameter
from sysmlc.language.tree import Node

Value = bool | int | float | str
EXPRESSIONS = kinds_of("Expression") - kinds_of("Usage")

_DEEP = 24
"""Values that name features with values that name features: so many are followed."""
_LITERALS = {
    "LiteralBoolean": "ScalarValues::Boolean",
    "LiteralString": "ScalarValues::String",
    "LiteralInteger": "ScalarValues::Integer",
    "LiteralRational": "ScalarValues::Rational",
    "LiteralInfinity": "ScalarValues::Positive",
}
_CONDITIONS = frozenset(
    {"==", "!=", "===", "!==", "<", ">", "<=", ">=", "and", "or", "xor", "implies", "not"}
    | {"&", "|", "istype", "hastype", "@", "@@"}
)
"""Operators of which the result is true or false (KerML 1.0, 9.4)."""
_NAMING = frozenset(
    {
        "ConstructorExpression",
        "FeatureChainExpression",
        "FeatureReferenceExpression",
        "InvocationExpression",
    }
)
_ARITHMETIC: dict[str, Callable[[float, float], Value]] = {
    "+": op.add,
    "-": op.sub,
    "*": op.mul,
    "<": op.lt,
    ">": op.gt,
    "<=": op.le,
    ">=": op.ge,
    "==": op.eq,
    "!=": op.ne,
}


def arguments(expression: Node) -> list[Node]:
    """The operands or arguments by position."""
    return [one for one in expression.members if one.membership == "ParameterMembership"]


def given(feature: Node) -> Node | None:
    """The expression that a feature is bound to."""
    return next((one for one in feature.members if one.membership == "FeatureValue"), None)


def value(model: Model, expression: Node, depth: int = 0) -> Value | None:
    """The constant that an expression comes to, through features that are bound; else None."""
    if "value" in expression.attributes:
        return expression.attributes["value"]
    if depth > _DEEP:
        return None
    if expression.kind == "FeatureReferenceExpression":
        feature = find_named_element(expression, model.lookup)
        bound = given(feature) if feature is not None else None
        return value(model, bound, depth + 1) if bound is not None else None
    operands = arguments(expression)
    if expression.kind != "OperatorExpression" or not 1 <= len(operands) <= 2:
        return None
    found = [value(model, one, depth + 1) for one in operands]
    return _operated(str(expression.attributes.get("operator")), found)


def _operated(operator: str, operands: list[Value | None]) -> Value | None:
    numbers = [one for one in operands if isinstance(one, int | float)]
    if len(numbers) < len(operands) or operator not in _ARITHMETIC:
        return None
    if len(numbers) == 1:
        return {"-": -numbers[0], "+": numbers[0]}.get(operator)
    return _ARITHMETIC[operator](numbers[0], numbers[1])


def types(model: Model, expression: Node, depth: int = 0) -> list[Node]:
    """The types of what an expression gives; empty where they are not known."""
    name = _LITERALS.get(expression.kind)
    if (
        expression.kind == "OperatorExpression"
        and expression.attributes.get("operator") in _CONDITIONS
    ):
        name = "ScalarValues::Boolean"
    if name is not None:
        found = model.find(name)
        return [found] if found is not None else []
    if depth > _DEEP:
        return []
    source = _source(model, expression)
    if source is None or source.kind not in FEATURES:
        return [source] if source is not None else []
    bound = given(source) if not model.lookup.generals(source) else None
    return model.types(source) if bound is None else types(model, bound, depth + 1)


def _source(model: Model, expression: Node) -> Node | None:
    """The feature or type that gives the values of an expression."""
    if expression.kind not in _NAMING:
        return None
    found = find_named_element(expression, model.lookup)
    is_called = expression.kind == "InvocationExpression"
    return (
        find_result_parameter(found, model.lookup, set())
        if found is not None and is_called
        else found
    )


def cannot_be(model: Model, expression: Node, wanted: str) -> bool:
    """Whether nothing that an expression gives is of a library type, by all that is known."""
    target = model.find(wanted)
    found = types(model, expression)
    if target is None or not found:
        return False
    return not any(model.specializes(t, target) or model.specializes(target, t) for t in found)
