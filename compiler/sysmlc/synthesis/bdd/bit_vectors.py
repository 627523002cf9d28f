"""Integers as vectors of diagrams: two's complement, the least bit first, the last is the sign.

Operations never overflow: their results have as many bits as they need. Division is the one of
``logic.evaluate``: towards zero, x / 0 is 0 and x mod 0 is x.
"""

from collections.abc import Sequence

from sysmlc.synthesis.bdd.manager import Manager, Node

Vector = tuple[Node, ...]


def constant(manager: Manager, value: int) -> Vector:
    """A number."""
    width = (value if value >= 0 else ~value).bit_length() + 1
    return tuple(_bit(manager, value >> place & 1) for place in range(width))


def unsigned(manager: Manager, bits: Sequence[Node]) -> Vector:
    """A number that is never negative, of the bits as they are."""
    return (*bits, manager.false)


def add(manager: Manager, left: Vector, right: Vector) -> Vector:
    """Sum."""
    return _add(manager, left, right, manager.false)


def subtract(manager: Manager, left: Vector, right: Vector) -> Vector:
    """Difference."""
    return _add(manager, left, tuple(~bit for bit in right), manager.true)


def _add(manager: Manager, left: Vector, right: Vector, carry: Node) -> Vector:
    width = max(len(left), len(right)) + 1
    total: list[Node] = []
    for one, other in zip(_wide(left, width), _wide(right, width), strict=True):
        half = ~one.equiv(other)
        total.append(~half.equiv(carry))
        carry = (one & other) | (half & carry)
    return _trimmed(tuple(total))


def multiply(manager: Manager, left: Vector, right: Vector) -> Vector:
    """Product."""
    total = constant(manager, 0)
    for place, bit in enumerate(right):
        part = (*(manager.false,) * place, *(one & bit for one in left))
        is_sign = place == len(right) - 1
        total = (subtract if is_sign else add)(manager, total, part)
    return total


def divide(manager: Manager, left: Vector, right: Vector) -> Vector:
    """Quotient, towards zero."""
    quotient, _ = _divided(manager, left, right)
    is_negative = ~left[-1].equiv(right[-1])
    signed = _choose(manager, is_negative, _negated(manager, quotient), quotient)
    return tuple(bit & ~equal(manager, right, constant(manager, 0)) for bit in signed)


def modulo(manager: Manager, left: Vector, right: Vector) -> Vector:
    """Remainder, with the sign of the left operand."""
    _, rest = _divided(manager, left, right)
    signed = _choose(manager, left[-1], _negated(manager, rest), rest)
    return _choose(manager, equal(manager, right, constant(manager, 0)), left, signed)


def _divided(manager: Manager, left: Vector, right: Vector) -> tuple[Vector, Vector]:
    """Quotient and remainder of the absolute values, bit by bit from the top."""
    dividend, divisor = _absolute(manager, left), _absolute(manager, right)
    rest = constant(manager, 0)
    quotient: list[Node] = []
    for bit in reversed(dividend):
        rest = _trimmed((bit, *rest))
        fits = ~less(manager, rest, divisor)
        rest = _choose(manager, fits, subtract(manager, rest, divisor), rest)
        quotient.append(fits)
    return unsigned(manager, quotient[::-1]), rest


def equal(manager: Manager, left: Vector, right: Vector) -> Node:
    """Where both are the same number."""
    width = max(len(left), len(right))
    found = manager.true
    for one, other in zip(_wide(left, width), _wide(right, width), strict=True):
        found = found & one.equiv(other)
    return found


def less(manager: Manager, left: Vector, right: Vector) -> Node:
    """Where the left one is smaller."""
    width = max(len(left), len(right))
    found = manager.false
    # The signs count the other way round.
    pairs = list(zip(_wide(left, width), _wide(right, width), strict=True))
    pairs[-1] = pairs[-1][1], pairs[-1][0]
    for one, other in pairs:
        found = manager.ite(one.equiv(other), found, other)
    return found


def _absolute(manager: Manager, vector: Vector) -> Vector:
    return _choose(manager, vector[-1], _negated(manager, vector), vector)


def _negated(manager: Manager, vector: Vector) -> Vector:
    return subtract(manager, constant(manager, 0), vector)


def _choose(manager: Manager, test: Node, then: Vector, otherwise: Vector) -> Vector:
    width = max(len(then), len(otherwise))
    rows = zip(_wide(then, width), _wide(otherwise, width), strict=True)
    return _trimmed(tuple(manager.ite(test, one, other) for one, other in rows))


def _wide(vector: Vector, width: int) -> Vector:
    return (*vector, *(vector[-1],) * (width - len(vector)))


def _trimmed(vector: Vector) -> Vector:
    """Without bits that only repeat the sign."""
    while len(vector) > 1 and vector[-1] == vector[-2]:
        vector = vector[:-1]
    return vector


def _bit(manager: Manager, value: int) -> Node:
    return manager.true if value else manager.false
