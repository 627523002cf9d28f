"""Features as variables: the domain that the model declares, and the initial value."""

import re
from collections.abc import Callable, Iterator, Mapping
from operator import add, mul, sub
from typing import NamedTuple

from msgspec import Struct
from msgspec.structs import replace

from sysmlc.ir import AttrValue, Edge, Element, Graph, Kind, query
from sysmlc.logic.contract import BooleanDomain, Domain, EnumerationDomain, IntegerDomain
from sysmlc.logic.domains import contains
from sysmlc.logic.expressions.expression import (
    Binary,
    Expression,
    ExpressionError,
    Member,
    Name,
    Unary,
    dotted_name,
    last_name,
    name_of,
)
from sysmlc.logic.expressions.expression import Literal as LiteralExpression
from sysmlc.logic.expressions.named_elements import literals_of
from sysmlc.logic.expressions.parsing import parse_expression
from sysmlc.logic.formula import Literal

_BOOLEAN = frozenset(["boolean", "bool", "eboolean"])
_INTEGER = frozenset(
    ["integer", "int", "natural", "positive", "unlimitednatural", "eint", "short", "long", "byte"]
)
_UNSIGNED = frozenset(["natural", "positive", "unlimitednatural"])
_STRING = frozenset(["string", "estring", "java.lang.string"])
_RANGE = re.compile(r"^\s*\[?\s*(-?\d+)\s*(?:\.\.|,|:)\s*(-?\d+)\s*\]?\s*$")
_BOUND_TAGS = (("min", "max"), ("lower", "upper"), ("minimum", "maximum"))
_MOMENTARY = frozenset(["precondition", "postcondition", "body"])
"""Kinds of constraints that do not hold at all times."""
_ARITHMETIC: dict[str, Callable[..., int]] = {"+": add, "-": sub, "*": mul}
_MIRROR = {"<": ">", "<=": ">=", ">": "<", ">=": "<="}


class Feature(Struct, frozen=True):
    """A feature as a variable; ``domain`` is None if its values are not finite."""

    element: Element
    variable: str
    domain: Domain | None
    default: Literal | None = None
    is_constant: bool = False
    is_assumed: bool = False
    """Whether the range is assumed; ``report_range`` reports this when the feature is used."""
    invalid_default: str = ""
    """A default value that is not in the domain."""
    direction: str = ""
    """``in``, ``out`` or ``inout`` as the owner sees it; empty if the feature has none."""
    has_several_values: bool = False
    """Whether the multiplicity allows other than one value; such a feature has no domain."""


class Access(NamedTuple):
    """A classifier, and the dotted name by which its expressions reach a feature."""

    classifier: Element
    name: str


def make_feature(
    graph: Graph,
    element: Element,
    variable: str,
    assumed_range: tuple[int, int],
    constants: Mapping[str, int],
    access: Access | None = None,
) -> Feature:
    """Return the feature of an element.

    An Integer without a range gets *assumed_range*. *constants* are the Integers that never change,
    by name; the bounds of ranges may name them. *access* is given if the name is dotted.
    """
    bounds = query.bounds(element.attrs.get("multiplicity"))
    if bounds is not None and bounds[1] != 1:
        # One variable cannot stand for several values.
        return Feature(element, variable, None, has_several_values=True)
    type_ = query.type_of(graph, element)
    family = [] if type_ is None else [type_, *query.generals(graph, type_)]
    type_names = _list_type_names(family)
    is_integer = bool(type_names & _INTEGER) or _has_untyped_default(element, type_, int)
    domain = _find_domain(graph, element, family, type_names, is_integer, constants, access)
    is_assumed = domain is None and is_integer
    value = _evaluate_default(element, constants)
    if is_assumed:
        domain = _assume_domain(value, type_names, assumed_range)
    default = _find_default(graph, value, type_, domain)
    is_constant = element.attrs.get("readonly") is True and default is not None
    is_range = ".." in str(value)
    is_unknown = value is None or (isinstance(value, str) and _is_computed(graph, element))
    # The unlimited natural number is the greatest; an assumed range has it as little as others.
    is_unchecked = is_range or is_unknown or (is_assumed and value == "*")
    invalid_default = "" if default is not None or is_unchecked else str(element.attrs["default"])
    return Feature(element, variable, domain, default, is_constant, is_assumed, invalid_default)


def _find_domain(
    graph: Graph,
    element: Element,
    family: list[Element],
    type_names: set[str],
    is_integer: bool,
    constants: Mapping[str, int],
    access: Access | None,
) -> Domain | None:
    type_ = family[0] if family else None
    if type_ is not None and type_.kind is Kind.ENUMERATION:
        literals = tuple(literals_of(graph, type_).values())
        return EnumerationDomain(literals) if literals else None
    if type_names & _BOOLEAN or _has_untyped_default(element, type_, bool):
        return BooleanDomain()
    return _find_range(graph, element, family, constants, access) if is_integer else None


def _list_type_names(family: list[Element]) -> set[str]:
    """Return the names of types in lower case, and the names in their libraries (``href``)."""
    hrefs = (str(type_.attrs.get("href", "")).rpartition("#")[2] for type_ in family)
    return {type_.name.lower() for type_ in family} | {href.lower() for href in hrefs}


def _has_untyped_default(element: Element, type_: Element | None, kind: type) -> bool:
    return type_ is None and type(element.attrs.get("default")) is kind


def _assume_domain(
    default: AttrValue, type_names: set[str], assumed_range: tuple[int, int]
) -> Domain:
    """Return the assumed range of a number.

    It has no negative numbers for unsigned types, and contains the default value.
    """
    low, high = assumed_range
    low = max(low, 0) if type_names & _UNSIGNED else low
    if isinstance(default, int) and not isinstance(default, bool):
        low, high = min(low, default), max(high, default)
    return IntegerDomain(low, high)


# -- strings -----------------------------------------------------------------------------------


def is_string(graph: Graph, feature: Feature) -> bool:
    """Whether the feature is a String whose values are not declared."""
    type_ = query.type_of(graph, feature.element)
    family = [] if type_ is None else [type_, *query.generals(graph, type_)]
    is_undeclared = feature.domain is None and not feature.has_several_values
    return is_undeclared and bool(_list_type_names(family) & _STRING)


def restrict_string(feature: Feature, domain: EnumerationDomain) -> Feature:
    """Return a String feature with the texts of *domain* as its values."""
    text = default_text(feature.element)
    default = None if text is None else domain.literals[domain.texts.index(text)]
    is_constant = feature.element.attrs.get("readonly") is True and default is not None
    return replace(
        feature, domain=domain, default=default, is_constant=is_constant, invalid_default=""
    )


def default_text(element: Element) -> str | None:
    """Return the initial value of a String; None if it is computed or absent."""
    text = element.attrs.get("default")
    return text if isinstance(text, str) and "default_language" not in element.attrs else None


# -- default values ----------------------------------------------------------------------------


def read_constant(element: Element) -> int | None:
    """Return the value of a read-only Integer, or None for any other element."""
    return _parse_integer(element.attrs.get("default")) if element.attrs.get("readonly") else None


def _evaluate_default(element: Element, constants: Mapping[str, int]) -> AttrValue:
    """Return the default value of an element; the number if it is a constant expression."""
    default = element.attrs.get("default")
    expression = _parse_default(element)
    number = None if expression is None else _evaluate(expression, constants)
    return default if number is None else number


def _parse_default(element: Element) -> Expression | None:
    """Return the expression that computes the default value; None if there is none."""
    text = element.attrs.get("default")
    if not isinstance(text, str) or "default_language" not in element.attrs:
        return None
    try:
        return parse_expression(text)
    except ExpressionError:
        return None


def _is_computed(graph: Graph, element: Element) -> bool:
    """Whether an expression computes the default value, such as the name of another feature.

    An expression outside the supported grammar, such as ``(1, 2)#(1)``, computes one too.
    """
    expression = _parse_default(element)
    if expression is None:
        return "default_language" in element.attrs
    if not isinstance(expression, Name):
        return expression is not None and not isinstance(expression, LiteralExpression)
    owner = graph.owner(element)
    features = [] if owner is None else query.features(graph, owner)
    return name_of(expression) in [feature.name for feature in features]


def _find_default(
    graph: Graph, default: AttrValue, type_: Element | None, domain: Domain | None
) -> Literal | None:
    if domain is None or default is None:
        return None
    value = _parse_value(graph, str(default), type_, domain)
    return value if value is not None and contains(domain, value) else None


def _parse_value(graph: Graph, text: str, type_: Element | None, domain: Domain) -> Literal | None:
    match domain:
        case BooleanDomain():
            return {"true": True, "false": False}.get(text.lower())
        case IntegerDomain():
            return _parse_integer(text)
        case EnumerationDomain():
            return None if type_ is None else _find_identifier(graph, text, type_)


def _find_identifier(graph: Graph, text: str, enumeration: Element) -> Literal | None:
    """Return the identifier of a literal that is given by id, name or qualified name."""
    literal = graph.get(text)
    name = last_name(text) if literal is None else literal.name
    return literals_of(graph, enumeration).get(name)


def _parse_integer(value: AttrValue) -> int | None:
    text = str(value)
    return int(text) if re.fullmatch(r"-?\d+", text) else None


# -- ranges of Integers --------------------------------------------------------------------------


def _find_range(
    graph: Graph,
    element: Element,
    types: list[Element],
    constants: Mapping[str, int],
    access: Access | None,
) -> Domain | None:
    """Return the range given by tagged values, a bounded default, or constraints, in this order."""
    for tagged_element in (element, *types):
        domain = _find_tagged_range(graph, tagged_element)
        if domain is not None:
            return domain
    bounds = _RANGE.match(str(element.attrs.get("default", "")))
    if bounds and ".." in bounds[0]:
        return _make_range(int(bounds[1]), int(bounds[2]))
    return _find_constrained_range(graph, element, types, constants, access)


def _make_range(low: int, high: int) -> Domain | None:
    return IntegerDomain(low, high) if low <= high else None


def _find_tagged_range(graph: Graph, element: Element) -> Domain | None:
    if not query.applications(graph, element):
        return None
    bounds = _RANGE.match(str(query.tag(graph, element, "range") or ""))
    if bounds:
        return _make_range(int(bounds[1]), int(bounds[2]))
    for low_tag, high_tag in _BOUND_TAGS:
        low = _parse_integer(query.tag(graph, element, low_tag))
        high = _parse_integer(query.tag(graph, element, high_tag))
        if low is not None and high is not None:
            return _make_range(low, high)
    return None


def _find_constrained_range(
    graph: Graph,
    element: Element,
    types: list[Element],
    constants: Mapping[str, int],
    access: Access | None,
) -> Domain | None:
    """Return the intersection of the bounds that constraints set; None if one side is open.

    Zero is a lower bound of every unsigned type.
    """
    low: int | None = 0 if _list_type_names(types) & _UNSIGNED else None
    high: int | None = None
    for names, body in _iter_constraints(graph, element, types, access):
        for op, bound in _iter_bounds(body, names, constants):
            lower_bound = {">": bound + 1, ">=": bound, "==": bound}.get(op)
            upper_bound = {"<": bound - 1, "<=": bound, "==": bound}.get(op)
            if lower_bound is not None:
                low = lower_bound if low is None else max(low, lower_bound)
            if upper_bound is not None:
                high = upper_bound if high is None else min(high, upper_bound)
    return None if low is None or high is None else _make_range(low, high)


def _iter_constraints(
    graph: Graph, element: Element, types: list[Element], access: Access | None
) -> Iterator[tuple[frozenset[str], Expression]]:
    """Yield the constraints that may bound an element, each with the element's names in it.

    They belong to the owner, to the classifier that reaches the element by a dotted name, to the
    element itself, or to its types.
    """
    # A feature that redefines another one keeps the range of that feature.
    for feature in (element, *query.redefined_features(graph, element)):
        owner = graph.owner(feature)
        if owner is not None:
            names = frozenset([feature.name, f"self.{feature.name}"])
            yield from _iter_bodies(graph, owner, names, feature.name)
    if access is not None:
        names = frozenset([access.name, f"self.{access.name}"])
        yield from _iter_bodies(graph, access.classifier, names, element.name)
    yield from _iter_bodies(graph, element, frozenset([element.name, "self", "value"]))
    for type_ in types:
        names = frozenset(["self", "value", "self.value", type_.name])
        yield from _iter_bodies(graph, type_, names)


def _iter_bodies(
    graph: Graph, owner: Element, names: frozenset[str], word: str = ""
) -> Iterator[tuple[frozenset[str], Expression]]:
    """Yield *names* and the expression of each constraint of an owner that always holds.

    Constraints that cannot contain *word* are skipped before they are parsed.
    """
    constraints = {
        element.id: element for element in graph.owned(owner) if element.kind is Kind.CONSTRAINT
    }
    for element in graph.sources(owner, Edge.REFERENCES):
        if element.kind is Kind.CONSTRAINT:
            constraints[element.id] = element
    is_plain = word.isidentifier()
    for constraint in constraints.values():
        if constraint.subkind in _MOMENTARY:
            continue
        body = str(constraint.attrs.get("body", ""))
        # A quoted name may spell the word with escapes.
        if is_plain and word not in body and "'" not in body:
            continue
        try:
            yield names, parse_expression(body)
        except ExpressionError:
            continue


def _iter_bounds(
    body: Expression, names: frozenset[str], constants: Mapping[str, int]
) -> Iterator[tuple[str, int]]:
    """Yield the bounds that a conjunction sets: ``x >= 0``, ``7 > x``, ``0 <= x <= limit``."""
    match body:
        case Binary("and", left, right):
            yield from _iter_bounds(left, names, constants)
            yield from _iter_bounds(right, names, constants)
        case Binary(op, Binary(first, low, middle), high) if op in _MIRROR and first in _MIRROR:
            yield from _match_bound(first, low, middle, names, constants)
            yield from _match_bound(op, middle, high, names, constants)
        case Binary(op, left, right):
            yield from _match_bound(op, left, right, names, constants)


def _match_bound(
    op: str,
    left: Expression,
    right: Expression,
    names: frozenset[str],
    constants: Mapping[str, int],
) -> Iterator[tuple[str, int]]:
    """Yield the comparison as a bound of the named feature, which may stand on either side."""
    if dotted_name(left) in names and (value := _evaluate(right, constants)) is not None:
        yield op, value
    elif dotted_name(right) in names and (value := _evaluate(left, constants)) is not None:
        yield _MIRROR.get(op, op), value


def _evaluate(expression: Expression, constants: Mapping[str, int]) -> int | None:
    """Return the value of an expression over numbers and constants, else None."""
    match expression:
        case LiteralExpression(value) if isinstance(value, int) and not isinstance(value, bool):
            return value
        case Name() | Member():
            return constants.get(name_of(expression) or "")
        case Unary("-", operand):
            number = _evaluate(operand, constants)
            return None if number is None else -number
        case Binary(op, left, right) if op in _ARITHMETIC:
            operands = _evaluate(left, constants), _evaluate(right, constants)
            return None if None in operands else _ARITHMETIC[op](*operands)
        case _:
            return None
