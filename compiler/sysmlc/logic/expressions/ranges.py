"""Ranges of Integers: tagged values, bounded defaults, and constraints that set bounds."""

import re
from collections.abc import Callable, Iterator, Mapping
from operator import add, mul, sub
from typing import NamedTuple

from sysmlc.ir import AttrValue, Edge, Element, Graph, Kind, query
from sysmlc.ir.expressions import (
    Binary,
    Expression,
    ExpressionError,
    Member,
    Name,
    Unary,
    dotted_name,
    name_of,
)
from sysmlc.ir.expressions import Literal as LiteralExpression
from sysmlc.logic.expressions.parsing import tree_of

UNSIGNED = frozenset(["natural", "positive", "unlimitednatural"])
"""Types of Integers without negative values, in lower case."""
_RANGE = re.compile(r"^\s*\[?\s*(-?\d+)\s*(?:\.\.|,|:)\s*(-?\d+)\s*\]?\s*$")
_BOUND_TAGS = (("min", "max"), ("lower", "upper"), ("minimum", "maximum"))
_MOMENTARY = frozenset(["precondition", "postcondition", "body"])
"""Kinds of constraints that do not hold at all times."""
_ARITHMETIC: dict[str, Callable[..., int]] = {"+": add, "-": sub, "*": mul}
MIRROR = {"<": ">", "<=": ">=", ">": "<", ">=": "<="}
"""The comparison with exchanged operands."""


class Access(NamedTuple):
    """A classifier, and the dotted name by which its expressions reach a feature."""

    classifier: Element
    name: str


Bounds = tuple[int | None, int | None]
"""The least and the greatest value, each None if it is open."""


def find_bounds(
    graph: Graph,
    element: Element,
    types: list[Element],
    constants: Mapping[str, int],
    access: Access | None,
) -> Bounds:
    """Return the bounds given by tagged values, a bounded default, or constraints, in this order.

    *types* are the type of the element and the generals of the type. The bounds of constraints may
    name *constants*. *access* is given if expressions reach the element by a dotted name.
    """
    for tagged_element in (element, *types):
        tagged_range = _find_tagged_range(graph, tagged_element)
        if tagged_range is not None:
            return tagged_range
    bounds = _RANGE.match(str(element.attrs.get("default", "")))
    if bounds and ".." in bounds[0]:
        return _make_range(int(bounds[1]), int(bounds[2])) or (None, None)
    return _find_constrained_bounds(graph, element, types, constants, access)


def _make_range(low: int, high: int) -> tuple[int, int] | None:
    return (low, high) if low <= high else None


def _find_tagged_range(graph: Graph, element: Element) -> tuple[int, int] | None:
    if not query.applications(graph, element):
        return None
    bounds = _RANGE.match(str(query.tag(graph, element, "range") or ""))
    if bounds:
        return _make_range(int(bounds[1]), int(bounds[2]))
    for low_tag, high_tag in _BOUND_TAGS:
        low = parse_integer(query.tag(graph, element, low_tag))
        high = parse_integer(query.tag(graph, element, high_tag))
        if low is not None and high is not None:
            return _make_range(low, high)
    return None


def _find_constrained_bounds(
    graph: Graph,
    element: Element,
    types: list[Element],
    constants: Mapping[str, int],
    access: Access | None,
) -> Bounds:
    """Return the intersection of the bounds that constraints set; none if it is empty.

    Zero is a lower bound of every unsigned type.
    """
    low: int | None = 0 if list_type_names(types) & UNSIGNED else None
    high: int | None = None
    for names, body in _iter_constraints(graph, element, types, access):
        for op, bound in _iter_bounds(body, names, constants):
            lower_bound = {">": bound + 1, ">=": bound, "==": bound}.get(op)
            upper_bound = {"<": bound - 1, "<=": bound, "==": bound}.get(op)
            if lower_bound is not None:
                low = lower_bound if low is None else max(low, lower_bound)
            if upper_bound is not None:
                high = upper_bound if high is None else min(high, upper_bound)
    is_empty = low is not None and high is not None and low > high
    return (None, None) if is_empty else (low, high)


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
            yield names, tree_of(body)
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
        case Binary(op, Binary(first, low, middle), high) if op in MIRROR and first in MIRROR:
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
    if dotted_name(left) in names and (value := evaluate_integer(right, constants)) is not None:
        yield op, value
    elif dotted_name(right) in names and (value := evaluate_integer(left, constants)) is not None:
        yield MIRROR.get(op, op), value


def evaluate_integer(expression: Expression, constants: Mapping[str, int]) -> int | None:
    """Return the value of an expression over numbers and constants, else None.

    The keys of *constants* are names, or ids of elements.
    """
    match expression:
        case LiteralExpression(value) if isinstance(value, int) and not isinstance(value, bool):
            return value
        case Name(element=element) | Member(element=element) if element in constants:
            return constants[element]
        case Name() | Member():
            return constants.get(name_of(expression) or "")
        case Unary("-", operand):
            number = evaluate_integer(operand, constants)
            return None if number is None else -number
        case Binary(op, left, right) if op in _ARITHMETIC:
            operands = evaluate_integer(left, constants), evaluate_integer(right, constants)
            return None if None in operands else _ARITHMETIC[op](*operands)
        case _:
            return None


def parse_integer(value: AttrValue) -> int | None:
    """Return the Integer that a value is, or None if its text has other characters than digits."""
    text = str(value)
    return int(text) if re.fullmatch(r"-?\d+", text) else None


def list_type_names(family: list[Element]) -> set[str]:
    """Return the names of types in lower case, and the names in their libraries (``href``)."""
    hrefs = (str(type_.attrs.get("href", "")).rpartition("#")[2] for type_ in family)
    return {type_.name.lower() for type_ in family} | {href.lower() for href in hrefs}
