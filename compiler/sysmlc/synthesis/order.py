"""The order in which variables and their bits enter the diagrams.

Numbers with one range are positions, targets, angles of alike things: what is said compares them,
so their bits are interleaved, the most significant ones first. Relations between three and more
of them are then a fifth of what they are with one variable after the other. Other variables stay
where they are declared.
"""

from collections.abc import Iterable, Mapping

from sysmlc.logic import domains
from sysmlc.logic.contract import Domain, IntegerDomain, Variable

MANY = 5
"""Fewer variables with one range stay apart: their relations are small in any order."""


def ordered(variables: Iterable[Variable], bits: Mapping[str, tuple[str, ...]]) -> tuple[str, ...]:
    """All bits, those of variables with the same range interleaved."""
    groups: dict[Domain | str, list[str]] = {}
    for variable in variables:
        is_number = isinstance(variable.domain, IntegerDomain) and domains.size(variable.domain) > 2
        groups.setdefault(variable.domain if is_number else variable.name, []).append(variable.name)
    return tuple(bit for names in groups.values() for bit in _laid([bits[one] for one in names]))


def _laid(rows: list[tuple[str, ...]]) -> Iterable[str]:
    if len(rows) < MANY:
        return (bit for row in rows for bit in row)
    return (bit for column in zip(*rows, strict=True) for bit in column)
