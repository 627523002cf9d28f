"""Integers as vectors of diagrams: two's complement, least significant bit first, sign last.

Operations never overflow: a result has as many bits as it needs. Division follows
``logic.evaluate``: it truncates towards zero, x / 0 is 0 and x mod 0 is x.
"""

from collections.abc import Sequence

from sysmlc.synthesis.bdd.manager import Manager, Node

Vector = tuple[Node, ...]


def constant(manager: Manager, value: int) -> Vector:
    """Return the vector of a number."""
    width = (value if value >= 0 else ~value).bit_length() + 1
    bits = (manager.false, manager.true)
    return tuple(bits[value >> place & 1] for place in range(width))


def from_unsigned(manager: Manager, bits: Sequence[Node]) -> Vector:
    """Return the vector of an unsigned binary number: its bits, and a sign bit that is false."""
    return (*bits, manager.false)


def add(manager: Manager, left: Vector, right: Vector) -> Vector:
    """Return the sum."""
    return _add(manager, left, right, manager.false)


def subtract(manager: Manager, left: Vector, right: Vector) -> Vector:
    """Return the difference."""
    return _add(manager, left, tuple(~bit for bit in right), manager.true)


def _add(manager: Manager, left: Vector, right: Vector, carry: Node) -> Vector:
    width = max(len(left), len(right)) + 1
    total: list[Node] = []
    for left_bit, right_bit in zip(
        _sign_extend(left, width), _sign_extend(right, width), strict=True
    ):
        half = ~left_bit.equiv(right_bit)
        total.append(~half.equiv(carry))
        carry = (left_bit & right_bit) | (half & carry)
    return _trim_sign(tuple(total))


def multiply(manager: Manager, left: Vector, right: Vector) -> Vector:
    """Return the product."""
    total = constant(manager, 0)
    for position, bit in enumerate(right):
        partial_product = (*(manager.false,) * position, *(left_bit & bit for left_bit in left))
        # In two's complement the sign bit has a negative weight.
        is_sign = position == len(right) - 1
        total = (subtract if is_sign else add)(manager, total, partial_product)
    return total


def divide(manager: Manager, left: Vector, right: Vector) -> Vector:
    """Return the quotient, truncated towards zero."""
    quotient, _ = _divide_absolute(manager, left, right)
    is_negative = ~left[-1].equiv(right[-1])
    signed = _select(manager, is_negative, _negate(manager, quotient), quotient)
    return tuple(bit & ~equal(manager, right, constant(manager, 0)) for bit in signed)


def modulo(manager: Manager, left: Vector, right: Vector) -> Vector:
    """Return the remainder, which has the sign of *left*."""
    _, remainder = _divide_absolute(manager, left, right)
    signed = _select(manager, left[-1], _negate(manager, remainder), remainder)
    return _select(manager, equal(manager, right, constant(manager, 0)), left, signed)


def _divide_absolute(manager: Manager, left: Vector, right: Vector) -> tuple[Vector, Vector]:
    """Return quotient and remainder of the absolute values by long division."""
    dividend, divisor = _absolute_value(manager, left), _absolute_value(manager, right)
    remainder = constant(manager, 0)
    quotient: list[Node] = []
    for bit in reversed(dividend):
        remainder = _trim_sign((bit, *remainder))
        fits = ~less(manager, remainder, divisor)
        remainder = _select(manager, fits, subtract(manager, remainder, divisor), remainder)
        quotient.append(fits)
    return from_unsigned(manager, quotient[::-1]), remainder


def equal(manager: Manager, left: Vector, right: Vector) -> Node:
    """Return the condition under which both vectors are the same number."""
    width = max(len(left), len(right))
    pairs = zip(_sign_extend(left, width), _sign_extend(right, width), strict=True)
    return manager.conjoin(left_bit.equiv(right_bit) for left_bit, right_bit in pairs)


def less(manager: Manager, left: Vector, right: Vector) -> Node:
    """Return the condition under which *left* is smaller than *right*."""
    width = max(len(left), len(right))
    result = manager.false
    # A set sign bit makes a number smaller, so the operands are swapped for the sign.
    pairs = list(zip(_sign_extend(left, width), _sign_extend(right, width), strict=True))
    pairs[-1] = pairs[-1][1], pairs[-1][0]
    for left_bit, right_bit in pairs:
        result = manager.ite(left_bit.equiv(right_bit), result, right_bit)
    return result


def _absolute_value(manager: Manager, vector: Vector) -> Vector:
    return _select(manager, vector[-1], _negate(manager, vector), vector)


def _negate(manager: Manager, vector: Vector) -> Vector:
    return subtract(manager, constant(manager, 0), vector)


def _select(manager: Manager, test: Node, then: Vector, otherwise: Vector) -> Vector:
    width = max(len(then), len(otherwise))
    pairs = zip(_sign_extend(then, width), _sign_extend(otherwise, width), strict=True)
    return _trim_sign(tuple(manager.ite(test, then_bit, else_bit) for then_bit, else_bit in pairs))


def _sign_extend(vector: Vector, width: int) -> Vector:
    return (*vector, *(vector[-1],) * (width - len(vector)))


def _trim_sign(vector: Vector) -> Vector:
    """Drop the bits that only repeat the sign."""
    while len(vector) > 1 and vector[-1] == vector[-2]:
        vector = vector[:-1]
    return vector
