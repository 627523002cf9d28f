"""Ranges of Integers, as tagged values, default values and constraints declare them."""

import re
from collections.abc import Callable, Iterator, Mapping
from operator import add, mul, sub

from sysmlc.ir import AttrValue, Edge, Element, Graph, Kind, query
from sysmlc.logic.contract import Domain, IntegerDomain
from sysmlc.logic.expressions.expression import (
    Binary,
    Expression,
    ExpressionError,
    Member,
    Name,
    Unary,
    dotted,
    name_of,
)
from sysmlc.logic.expressions.expression import Literal as Constant
from sysmlc.logic.expressions.parsing import parse_expression

_RANGE = re.compile(r"^\s*\[?\s*(-?\d+)\s*(?:\.\.|,|:)\s*(-?\d+)\s*\]?\s*$")
_BOUNDS = (("min", "max"), ("lower", "upper"), ("minimum", "maximum"))
_TAGS = frozenset(f"tag.{name}" for pair in (("range",), *_BOUNDS) for name in pair)
_MOMENTARY = frozenset(["precondition", "postcondition", "body"])
"""Kinds of constraints that do not hold at all times."""
_ARITHMETIC: dict[str, Callable[..., int]] = {"+": add, "-": sub, "*": mul}
_MIRROR = {"<": ">", "<=": ">=", ">": "<", ">=": "<="}


Seen = tuple[Element, str]
"""A classifier and the dotted name that a feature has in it."""


def declared_range(
    graph: Graph,
    element: Element,
    types: list[Element],
    fixed: Mapping[str, int],
    seen: Seen | None = None,
) -> Domain | None:
    """Range from tagged values, a bounded default, or constraints, in this order.

    Constraints of the element's owner count, of its types, and of who has it by a dotted name.
    """
    for one in (element, *types):
        found = _tagged_range(graph, one)
        if found is not None:
            return found
    bounded = _RANGE.match(str(element.attrs.get("default", "")))
    if bounded and ".." in bounded[0]:
        return _range(int(bounded[1]), int(bounded[2]))
    return _constrained_range(graph, element, types, fixed, seen)


def _range(low: int, high: int) -> Domain | None:
    return IntegerDomain(low, high) if low <= high else None


def _tagged_range(graph: Graph, element: Element) -> Domain | None:
    applied = query.applications(graph, element)
    if not any(key.lower() in _TAGS for one in (*applied, element) for key in one.attrs):
        return None
    if not applied:
        return None
    found = _RANGE.match(str(query.tag(graph, element, "range") or ""))
    if found:
        return _range(int(found[1]), int(found[2]))
    for least, greatest in _BOUNDS:
        low = integer(query.tag(graph, element, least))
        high = integer(query.tag(graph, element, greatest))
        if low is not None and high is not None:
            return _range(low, high)
    return None


def integer(value: AttrValue) -> int | None:
    """The Integer that a value is written as."""
    text = str(value)
    return int(text) if re.fullmatch(r"-?\d+", text) else None


def _constrained_range(
    graph: Graph,
    element: Element,
    types: list[Element],
    fixed: Mapping[str, int],
    seen: Seen | None,
) -> Domain | None:
    low: int | None = None
    high: int | None = None
    for names, body in _constraints(graph, element, types, seen):
        for op, bound in _bounds(body, names, fixed):
            least = {">": bound + 1, ">=": bound, "==": bound}.get(op)
            most = {"<": bound - 1, "<=": bound, "==": bound}.get(op)
            low = least if low is None else max(low, low if least is None else least)
            high = most if high is None else min(high, high if most is None else most)
    return None if low is None or high is None else _range(low, high)


def _constraints(
    graph: Graph, element: Element, types: list[Element], seen: Seen | None
) -> Iterator[tuple[frozenset[str], Expression]]:
    owner = graph.owner(element)
    if owner is not None:
        names = frozenset([element.name, f"self.{element.name}"])
        yield from _bodies(graph, owner, names, element.name)
    if seen is not None:
        names = frozenset([seen[1], f"self.{seen[1]}"])
        yield from _bodies(graph, seen[0], names, element.name)
    yield from _bodies(graph, element, frozenset([element.name, "self", "value"]))
    for type_ in types:
        yield from _bodies(graph, type_, frozenset(["self", "value", "self.value", type_.name]))


def _bodies(
    graph: Graph, owner: Element, names: frozenset[str], word: str = ""
) -> Iterator[tuple[frozenset[str], Expression]]:
    """What constrains the owner; all that can hold one of the names, which all have the word."""
    constraints = {one.id: one for one in graph.owned(owner) if one.kind is Kind.CONSTRAINT}
    for one in graph.sources(owner, Edge.REFERENCES):
        if one.kind is Kind.CONSTRAINT:
            constraints[one.id] = one
    is_plain = word.isidentifier()
    for constraint in constraints.values():
        if constraint.subkind in _MOMENTARY:
            continue
        body = str(constraint.attrs.get("body", ""))
        if is_plain and word not in body and "'" not in body:
            continue
        try:
            yield names, parse_expression(body)
        except ExpressionError:
            continue


def _bounds(
    body: Expression, names: frozenset[str], fixed: Mapping[str, int]
) -> Iterator[tuple[str, int]]:
    """Bounds that a conjunction sets: ``x >= 0``, ``7 > x``, ``0 <= x <= limit``."""
    match body:
        case Binary("and", left, right):
            yield from _bounds(left, names, fixed)
            yield from _bounds(right, names, fixed)
        case Binary(op, Binary(first, low, middle), high) if op in _MIRROR and first in _MIRROR:
            yield from _bound(first, low, middle, names, fixed)
            yield from _bound(op, middle, high, names, fixed)
        case Binary(op, left, right):
            yield from _bound(op, left, right, names, fixed)


def _bound(
    op: str,
    left: Expression,
    right: Expression,
    names: frozenset[str],
    fixed: Mapping[str, int],
) -> Iterator[tuple[str, int]]:
    if dotted(left) in names and (value := _constant(right, fixed)) is not None:
        yield op, value
    elif dotted(right) in names and (value := _constant(left, fixed)) is not None:
        yield _MIRROR.get(op, op), value


def _constant(expression: Expression, fixed: Mapping[str, int]) -> int | None:
    """The number that an expression of numbers and constants is."""
    match expression:
        case Constant(value) if isinstance(value, int) and not isinstance(value, bool):
            return value
        case Name() | Member():
            return fixed.get(name_of(expression) or "")
        case Unary("-", operand):
            found = _constant(operand, fixed)
            return None if found is None else -found
        case Binary(op, left, right) if op in _ARITHMETIC:
            sides = _constant(left, fixed), _constant(right, fixed)
            return None if None in sides else _ARITHMETIC[op](*sides)
        case _:
            return None
