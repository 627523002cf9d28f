"""Expressions of recipes, read from texts of the model, and the features that they refer to.

A dotted name refers to a feature, which has a type, a unit and a default value.
"""

from collections.abc import Iterator

from sysmlc.analyses.recipe.context import Context
from sysmlc.analyses.recipe.profile import convert_value
from sysmlc.ir import Element, Kind, query
from sysmlc.ir import expressions as source
from sysmlc.ir.query.classifiers import name_value_unit, unit_of
from sysmlc.logic.expressions.parsing import statements_of, tree_of
from sysmlc.recipe.expression import (
    make_opaque,
    make_variable,
    map_operands,
    operands,
)
from sysmlc.recipe.model import EnumType, ListType, Parameter, ReferenceType, Scalar, ValueType
from sysmlc.support.units import Time

# Recipe expressions have no xor; on Booleans it equals !=.
_OPERATORS = {"%": "mod", "xor": "!="}


def read_expression(text: str) -> source.Expression:
    """Return the expression of a text, or an opaque one if the text has no valid syntax."""
    try:
        return _translate_expression(tree_of(text))
    except source.ExpressionError:
        return make_opaque(text)


def read_delay(time: Time) -> source.Expression:
    """Return a time to wait in milliseconds, or its expression if it is not constant.

    An absolute time, and one that is not a whole number of milliseconds, is opaque.
    """
    if time.duration is None:
        return read_expression(time.text) if time.is_relative else make_opaque(str(time))
    milliseconds = time.duration.milliseconds
    if milliseconds is None or milliseconds.denominator != 1:
        return make_opaque(time.text)
    return source.Literal(int(milliseconds))


def read_optional(text: str) -> source.Expression | None:
    """Return the expression of a text, or None for the empty text."""
    return read_expression(text) if text else None


def _translate_expression(  # noqa: PLR0911 - one for each kind
    expression: source.Expression,
) -> source.Expression:
    """Return a parsed expression in the normal form of recipes."""
    name = source.dotted_name(expression)
    if name is not None:
        return source.Name((name,), source.element_of(expression))
    match expression:
        case source.Literal():
            return expression
        case source.Unary("+", operand):
            return _translate_expression(operand)
        case source.Binary("implies", left, right):
            negated = source.Unary("not", _translate_expression(left))
            return source.Binary("or", negated, _translate_expression(right))
        case source.Binary(op, left, right):
            operator = _OPERATORS.get(op, op)
            return source.Binary(
                operator, _translate_expression(left), _translate_expression(right)
            )
        case source.Call(function, args):
            function_name = source.dotted_name(function) or source.print_expression(function)
            return _make_call(function_name, *args)
        case source.Conditional(condition, then, otherwise):
            return _make_call("if", condition, then, otherwise)
        case source.Index(source.Literal(), _):
            # A quantity: executors have no units.
            return make_opaque(source.print_expression(expression))
        case source.Unary() | source.Index():
            return map_operands(expression, _translate_expression)
        case _:
            return make_opaque(source.print_expression(expression))


def _make_call(function: str, *args: source.Expression) -> source.Expression:
    return source.Call(make_variable(function), tuple(map(_translate_expression, args)))


def read_assignments(text: str) -> list[tuple[str, source.Expression]] | None:
    """Return the variables and values of an effect; None unless it consists of assignments."""
    try:
        statements = statements_of(text)
    except source.ExpressionError:
        return None
    pairs: list[tuple[str, source.Expression]] = []
    for statement in statements:
        if not isinstance(statement, source.Assignment):
            return None
        target = source.dotted_name(statement.target)
        if target is None:
            return None
        pairs.append((target, _translate_expression(statement.value)))
    return pairs


def resolve_literals(context: Context, expression: source.Expression) -> source.Expression:
    """Replace enumeration literals by their values (SysML 2.0, 8.3.8).

    A literal that is compared with an operand of its own enumeration stays a name.
    """
    literal = _find_literal(context, expression)
    if literal is not None:
        return source.Literal(_literal_value(literal))
    match expression:
        case source.Unary() | source.Binary():
            enumerations = list(_find_enumerations(context, operands(expression)))
            return map_operands(
                expression, lambda operand: _resolve_operand(context, operand, enumerations)
            )
        case source.Index(base, index):
            return source.Index(base, resolve_literals(context, index))
        case source.Call():
            return map_operands(expression, lambda argument: resolve_literals(context, argument))
        case _:
            return expression


def _find_literal(context: Context, expression: source.Expression) -> Element | None:
    """Return the enumeration literal that a name denotes, or None."""
    element = context.graph.get(source.element_of(expression))
    is_literal = element is not None and element.kind is Kind.ENUMERATION_LITERAL
    return element if is_literal else None


def _resolve_operand(
    context: Context, operand: source.Expression, enumerations: list[str]
) -> source.Expression:
    literal = _find_literal(context, operand)
    owner = None if literal is None else context.graph.owner(literal)
    is_compared = owner is not None and context.name(owner) in enumerations
    return operand if is_compared else resolve_literals(context, operand)


def _find_enumerations(context: Context, args: tuple[source.Expression, ...]) -> Iterator[str]:
    """Yield the names of the enumerations that type the operands of an expression."""
    for operand in args:
        feature = find_feature(context, operand)
        type_ = None if feature is None else value_type(context, feature)
        if isinstance(type_, EnumType):
            yield type_.name


# -- features ----------------------------------------------------------------------------------

_PRIMITIVES: dict[str, ValueType] = {
    "Boolean": "boolean",
    "Integer": "integer",
    "UnlimitedNatural": "integer",
    "Natural": "integer",
    "Real": "real",
    "String": "string",
}
_FEATURE_KINDS = (Kind.PARAMETER, Kind.PROPERTY)


def find_feature(context: Context, expression: source.Expression) -> Element | None:
    """Return the parameter or attribute that a name or a chain of features denotes, or None."""
    element = context.graph.get(source.element_of(expression))
    return element if element is not None and element.kind in _FEATURE_KINDS else None


def find_member(context: Context, type_: Element, name: str) -> Element | None:
    """Return the feature with this name of a type or of one of its generals."""
    by_name = context.members.get(type_.id)
    if by_name is None:
        # In reverse, so that the first of several features with one name remains.
        features = reversed(query.features(context.graph, type_))
        by_name = context.members[type_.id] = {feature.name: feature for feature in features}
    return by_name.get(name)


def build_parameter(context: Context, element: Element) -> Parameter:
    """Return the recipe parameter for a parameter, pin or property."""
    unit, value = read_default(context, element)
    return Parameter(context.label(element), value_type(context, element), unit, value)


def read_default(
    context: Context, element: Element
) -> tuple[str, Scalar | tuple[Scalar, ...] | None]:
    """Return the unit of an element, and its default value in this unit.

    The unit is that of the value type; without one, times are in milliseconds. A value in a unit
    that cannot be converted keeps its own.
    """
    unit, value = unit_name(context, element), default_value(element)
    own_unit = name_value_unit(context.graph, element, "default")
    if not own_unit or own_unit == unit:
        return unit, value
    converted = convert_value(value, own_unit, unit or "ms")
    return (own_unit, value) if converted is None else (unit or "ms", converted)


def is_data(context: Context, element: Element) -> bool:
    """Whether the type of the element is neither a machine nor a material."""
    return context.level(query.type_of(context.graph, element)) not in ("machine", "material")


def is_input(context: Context, element: Element) -> bool:
    """Whether the element holds a value or a required machine (lower bound above 0)."""
    if is_data(context, element):
        return True
    limits = query.bounds(element.attrs.get("multiplicity"))
    is_machine = context.level(query.type_of(context.graph, element)) == "machine"
    return is_machine and (limits is None or limits[0] > 0)


def value_type(context: Context, element: Element) -> ValueType | None:
    """Return the recipe type of an element, or None if it is untyped.

    The type is a list if the multiplicity allows several values.
    """
    type_ = query.type_of(context.graph, element)
    if type_ is None:
        return None
    single = _build_type(context, type_)
    limits = query.bounds(element.attrs.get("multiplicity"))
    many = limits is not None and (limits[1] is None or limits[1] > 1)
    return ListType(single) if many else single


def _build_type(context: Context, type_: Element) -> ValueType:
    family = [type_, *query.generals(context.graph, type_)]
    for candidate in family:
        if candidate.kind is Kind.ENUMERATION:
            return _build_enumeration(context, candidate)
        name = candidate.name or str(candidate.attrs.get("href", ""))
        primitive = _PRIMITIVES.get(name.replace("::", "#").rpartition("#")[2])
        if primitive is not None:
            return primitive
    if type_.attrs.get("property_specific"):
        type_ = next(iter(query.generals(context.graph, type_)), type_)
    level = context.level(type_)
    if level == "machine":
        return ReferenceType("machine", context.name(type_))
    return ReferenceType("material" if level == "material" else "element", context.name(type_))


def _build_enumeration(context: Context, enumeration: Element) -> EnumType:
    owned = context.graph.owned(enumeration)
    literals = [literal for literal in owned if literal.kind is Kind.ENUMERATION_LITERAL]
    values = [literal.attrs.get("value") for literal in literals]
    plain = tuple(value for value in values if isinstance(value, bool | int | float | str))
    is_whole = len(plain) == len(literals)
    names = tuple(literal.name for literal in literals)
    return EnumType(context.name(enumeration), names, plain if is_whole else ())


def unit_name(context: Context, element: Element) -> str:
    """Return the name of the unit of the element's value type, or the empty string."""
    type_ = query.type_of(context.graph, element)
    tagged = None if type_ is None else query.tag(context.graph, type_, "unit")
    unit_element = context.graph.get(tagged) if isinstance(tagged, str) else None
    if unit_element is None and not tagged:
        unit_element = unit_of(context.graph, element)
    return unit_element.name if unit_element is not None else str(tagged or "")


def literal_default(context: Context, element: Element) -> Scalar | None:
    """Return the default value as ``read_default`` does if it is a single literal, or else None."""
    _, default = read_default(context, element)
    return default if isinstance(default, bool | int | float | str) else None


def default_value(element: Element) -> Scalar | tuple[Scalar, ...] | None:
    """Return the default value if it is a literal or a list of literals, or else None."""
    default = element.attrs.get("default")
    # The values of a list with several units have no common unit.
    if "default_language" in element.attrs or isinstance(element.attrs.get("default_unit"), tuple):
        return None
    if isinstance(default, tuple):
        items = tuple(item for item in default if isinstance(item, bool | int | float | str))
        return items if len(items) == len(default) else None
    return default if isinstance(default, bool | int | float | str) else None


def _literal_value(literal: Element) -> Scalar:
    """Return the value of an enumeration literal, or its name if it has no value."""
    value = literal.attrs.get("value")
    return value if isinstance(value, bool | int | float | str) else literal.name
