"""What follows from another unit, and is told as that alone: another type, another quantity."""

from collections.abc import Callable

from sysmlc.ir.compare.pairs import Pairs, Token
from sysmlc.ir.compare.side import Side
from sysmlc.ir.element import Element
from sysmlc.ir.kinds import Edge, Kind

UNIT = frozenset({"unit"})
"""Names of the attribute that tells the unit."""
MEASURES = frozenset({Kind.UNIT.value, Kind.QUANTITY_KIND.value})
"""Names of what a type says of its unit in details."""


def is_same_but_for_unit(pairs: Pairs, old: Element, new: Element) -> bool:
    """Whether the types of two values differ in nothing but the unit."""
    return _types(pairs.old, old, pairs.old_token) == _types(pairs.new, new, pairs.new_token)


def _types(side: Side, element: Element, to_token: Callable[[Element], Token]) -> list[Token]:
    found = side.out.get(element.id, {}).get(Edge.TYPED_BY, ())
    return [to_token(_without_unit(side, one)) for one in found]


def _without_unit(side: Side, type_: Element) -> Element:
    """The type behind one that only ties it to a unit (docs/automationml.md)."""
    is_made = type_.kind is Kind.DATA_TYPE and type_.attrs.get("library") and not type_.source
    if not (is_made and type_.name.endswith("]")):
        return type_
    return next(iter(side.out.get(type_.id, {}).get(Edge.SPECIALIZES, ())), type_)
