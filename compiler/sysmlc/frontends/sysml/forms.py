"""How the literals of an expression become the value of an attribute, without the expression."""

from collections.abc import Callable, Iterator

from sysmlc.frontends.sysml.nodes import arguments
from sysmlc.ir import AttrValue
from sysmlc.language.tree import Node

_NEGATED, _SEQUENCE = "-", ","


def form(node: Node) -> AttrValue:
    """Where in the text the literals are, and what becomes of them.

    A number is the character at which a literal starts, ``("-", form)`` its negation,
    ``(",", form, ...)`` a sequence; None is no literal. It follows ``values.constant``.
    """
    if node.kind.startswith("Literal") and "value" in node.facts:
        return node.start
    if node.kind == "NullExpression":
        return (_SEQUENCE,)
    operator, args = node.facts.get("operator"), arguments(node)
    if operator == "-" and len(args) == 1:
        return (_NEGATED, form(args[0]))
    if operator == "[" and len(args) == 2:
        return form(args[0])
    if operator == "," and len(args) == 2:
        return (_SEQUENCE, *map(form, _members(args)))
    return None


def _members(args: list[Node]) -> Iterator[Node]:
    """What stands between the commas, which nest to the right as deep as the row is long."""
    while len(args) == 2:
        left, right = args
        yield left
        args = arguments(right) if right.facts.get("operator") == "," else [right]
    yield from args


def places(found: AttrValue) -> Iterator[int]:
    """Where the literals of a form start."""
    if isinstance(found, int):
        yield found
    elif isinstance(found, tuple):
        for one in found[1:]:
            yield from places(one)


def value(found: AttrValue, literal: Callable[[int], AttrValue]) -> AttrValue:
    """The value of an attribute whose literals are these, by their places; None without one."""
    if isinstance(found, int):
        return literal(found)
    if not isinstance(found, tuple):
        return None
    values = [value(one, literal) for one in found[1:]]
    if found[0] == _SEQUENCE:
        return _sequence(values)
    number = values[0]
    is_number = isinstance(number, int | float) and not isinstance(number, bool)
    return -number if is_number and isinstance(number, int | float) else None


def _sequence(values: list[AttrValue]) -> AttrValue:
    if None in values:
        return None
    return tuple(one for each in values for one in (each if isinstance(each, tuple) else (each,)))
