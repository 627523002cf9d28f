"""How the literals of an expression become the value of an attribute, without the expression."""

import re
from collections.abc import Callable, Iterator

from sysmlc.frontends.sysml.nodes import arguments
from sysmlc.ir import AttrValue
from sysmlc.ir.kept import PREFIX
from sysmlc.language.tree import Node

KINDS = frozenset({"LiteralBoolean", "LiteralString", "LiteralInteger", "LiteralRational"})
"""Metaclasses of literals that have a value."""
BODIES = frozenset({"Comment", "Documentation"})
"""Metaclasses of what has a text for its readers."""
_NEGATED, _SEQUENCE, _TAG, _TEXT, _BODY = "-", ",", "tag", "text", "body"
_GAP = re.compile('"\ue000(\\d+)\ue001"')


def has_literal(node: Node) -> bool:
    """Whether an expression has literals in it."""
    left = [node]
    while left:
        one = left.pop()
        if one.kind in KINDS:
            return True
        left += one.members
    return False


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


def tag(node: Node) -> AttrValue:
    """The same for a tagged value, which is a text: ``("tag", form)``."""
    return (_TAG, form(node))


def text(node: Node, printed: Callable[[Node], str]) -> AttrValue:
    """The same for the text of an expression: ``("text", piece, place, piece, ...)``."""
    literals = [one for one in node.walk() if one.kind in KINDS]
    facts = [one.facts for one in literals]
    for one in literals:
        one.facts = {"value": f"\ue000{one.start}\ue001"}
    try:
        pieces = _GAP.split(printed(node))
    finally:
        for one, own in zip(literals, facts, strict=True):
            one.facts = own
    if len(pieces) != 2 * len(literals) + 1:
        return None
    return (_TEXT, *(int(one) if at % 2 else one for at, one in enumerate(pieces)))


def body(place: int) -> AttrValue:
    """The same for the body of a comment, by where that starts: ``("body", place)``."""
    return (_BODY, place)


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
    if found[0] == _TEXT:
        return _filled(found[1:], literal)
    values = [value(one, literal) for one in found[1:]]
    if found[0] == _SEQUENCE:
        return _sequence(values)
    if found[0] in (_TAG, _BODY):
        return _tagged(values[0]) if found[0] == _TAG else _said(str(values[0]).strip())
    number = values[0]
    is_number = isinstance(number, int | float) and not isinstance(number, bool)
    return -number if is_number and isinstance(number, int | float) else None


def _sequence(values: list[AttrValue]) -> AttrValue:
    if None in values:
        return None
    return tuple(one for each in values for one in (each if isinstance(each, tuple) else (each,)))


def _filled(pieces: tuple[AttrValue, ...], literal: Callable[[int], AttrValue]) -> str | None:
    from sysmlc.logic.expressions.expression import print_literal

    said = []
    for one in pieces:
        found = literal(one) if isinstance(one, int) else None
        if isinstance(found, str | int | float):
            said.append(print_literal(found))
        elif isinstance(one, str):
            said.append(one)
        else:
            return None
    return "".join(said)


def _said(text: str) -> str | None:
    """The body of a comment; without one there is no attribute, and what is kept is read."""
    return None if not text or text.startswith(PREFIX) else text


def _tagged(found: AttrValue) -> AttrValue:
    """As ``annotations`` has it; what may be a qualified name may mean an element."""
    if isinstance(found, tuple):
        each = tuple(map(_tagged, found))
        return None if None in each else each
    if found is None or "::" in str(found):
        return None
    return str(found).lower() if isinstance(found, bool) else str(found)
