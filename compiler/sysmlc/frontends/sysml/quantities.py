"""Units and kinds of values: ``500 [kg]``, and ``=``, ``:=`` or ``default`` before it."""

from collections.abc import Sequence
from fractions import Fraction

from sysmlc.frontends.sysml import expressions, nodes
from sysmlc.frontends.sysml.elements import NodeElements
from sysmlc.frontends.sysml.lowering import Lowering
from sysmlc.frontends.sysml.trees import Trees
from sysmlc.ir import AttrValue, Edge, Element, Graph
from sysmlc.ir.query.classifiers import strip_qualifiers, unit_of
from sysmlc.language.text.lexer import quote_name
from sysmlc.language.tree import Node
from sysmlc.support.units import find_unit

_KINDS = {
    "=": "bound",
    ":=": "initial",
    "default": "default",
    "default =": "default",
    "default :=": "default initial",
}
"""Kinds of values by the words before their expression."""
_MAX_CONVERSIONS = 8
"""Units in a chain of conversions, which a model may close to a cycle."""
_UNIT_OPERATORS = ("*", "/", "**", "^")
_USUAL_KINDS = {"default": "default", "value": "bound"}
"""Kinds of the values of SysML v1, by attribute; they are not stated."""


def set_kind(graph: Graph, element: Element, key: str, expression: Node) -> None:
    """Set ``<key>_kind`` unless the value is of the kind that values of SysML v1 have."""
    kind = _KINDS.get(expression.role, "")
    if kind and kind != _USUAL_KINDS.get(key):
        graph.set(element, **{f"{key}_kind": kind})


def set_unit(lowering: Lowering, element: Element, key: str, expression: Node) -> None:
    """Set ``<key>_unit`` to the unit of a constant, or to the unit of each of several numbers.

    The unit is omitted if it is that of the type. The unit of a value type must be known.
    """
    units = _list_units(expression)
    if not any(units):
        return
    names = tuple(_name_unit(lowering.trees, lowering.elements, unit) for unit in units)
    if len(set(names)) > 1:
        lowering.graph.set(element, **{f"{key}_unit": names})
    elif not _is_unit_of_type(lowering.graph, lowering.elements, element, units[0]):
        lowering.graph.set(element, **{f"{key}_unit": names[0]})


def read_unit(trees: Trees, expression: Node) -> tuple[str, Fraction]:
    """Return the symbol of a usual unit of a quantity, and the factor from its own unit to that.

    The symbol is empty for a number without a unit. A unit without a usual one stays itself.
    """
    unit = next(filter(None, _list_units(expression)), None)
    if unit is None:
        return "", Fraction(1)
    symbol = own_symbol = strip_qualifiers(_write_unit(trees, unit))
    factor = Fraction(1)
    for _ in range(_MAX_CONVERSIONS):
        conversion = None if find_unit(symbol) else _read_conversion(unit)
        if conversion is None:
            break
        factor, unit = factor * conversion[0], conversion[1]
        symbol = strip_qualifiers(_write_unit(trees, unit))
    return (symbol, factor) if find_unit(symbol) else (own_symbol, Fraction(1))


def _read_conversion(unit: Node) -> tuple[Fraction, Node] | None:
    """Return the number of the unit's reference units that it is, and this reference unit."""
    target = _unit_element(unit)
    members = [] if target is None else nodes.body_of(target)
    conversions = (member for member in members if nodes.name_of(member) == "unitConversion")
    facts = {
        nodes.name_of(member): value
        for conversion in conversions
        for member in nodes.body_of(conversion)
        if (value := nodes.value_of(member)) is not None
    }
    if "conversionFactor" not in facts or "referenceUnit" not in facts:
        return None
    factor = _read_factor(facts["conversionFactor"])
    return (factor, facts["referenceUnit"]) if factor else None


def _read_factor(expression: Node) -> Fraction | None:
    """Return a positive number, or a quotient of such numbers; None for other expressions."""
    if expression.attributes.get("operator") == "/":
        dividend, divisor = map(_read_factor, nodes.list_arguments(expression))
        return dividend / divisor if dividend and divisor else None
    value = expression.attributes.get("value")
    is_number = isinstance(value, int | float) and not isinstance(value, bool) and value > 0
    return Fraction(str(value)) if is_number else None


def has_unit(expression: Node) -> bool:
    """Whether a constant contains a quantity."""
    return any(_list_units(expression))


def _list_units(constant: Node) -> Sequence[Node | None]:
    """Return the unit of each number of a constant; None for a number without a unit."""
    if constant.kind != "OperatorExpression":
        return () if constant.kind == "NullExpression" else (None,)
    arguments = nodes.list_arguments(constant)
    match constant.attributes.get("operator"), len(arguments):
        case "-", 1:
            return _list_units(arguments[0])
        case "[", 2:
            return (arguments[1],) * len(_list_units(arguments[0]))
    units: list[Node | None] = []
    while constant.attributes.get("operator") == ",":
        first, constant = nodes.list_arguments(constant)
        units += _list_units(first)
    return [*units, *_list_units(constant)] if units else (None,)


def _name_unit(trees: Trees, elements: NodeElements, unit: Node | None) -> str:
    """Return the id of a unit of the model, else the qualified name or the expression of it."""
    if unit is None:
        return ""
    target = _unit_element(unit)
    element = elements.find(target)
    return _write_unit(trees, unit) if element is None else element.id


def _write_unit(trees: Trees, unit: Node) -> str:
    """Return a unit, or a product or power of units, with qualified names."""
    target, arguments = _unit_element(unit), nodes.list_arguments(unit)
    operator = unit.attributes.get("operator")
    if operator in _UNIT_OPERATORS and len(arguments) == 2:
        left, right = (_write_operand(trees, argument) for argument in arguments)
        return f"{left} {operator} {right}"
    if target is None:
        document = trees.document_of(unit)
        return expressions.write_expression(unit, "" if document is None else document.text)
    name = quote_name(target.short_name or nodes.name_of(target))
    package = "" if target.owner is None else nodes.qualified_name_of(target.owner)
    return f"{package}::{name}" if package else name


def _write_operand(trees: Trees, unit: Node) -> str:
    text = _write_unit(trees, unit)
    return f"({text})" if unit.kind == "OperatorExpression" else text


def _unit_element(unit: Node) -> Node | None:
    is_reference = unit.kind == "FeatureReferenceExpression"
    return nodes.find_target(unit, "Membership") if is_reference else None


def _is_unit_of_type(
    graph: Graph, elements: NodeElements, element: Element, unit: Node | None
) -> bool:
    """Whether the type of the feature already states the unit, as in SysML v1."""
    feature = graph.target(element, Edge.INSTANCE_OF) or element
    unit_of_type = unit_of(graph, feature)
    target = None if unit is None else _unit_element(unit)
    if unit_of_type is None or target is None:
        return False
    if unit_of_type is elements.find(target):
        return True
    symbol: AttrValue = unit_of_type.attrs.get("symbol", "")
    return target.short_name == symbol or unit_of_type.name in (target.name, target.short_name)
