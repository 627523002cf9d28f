"""Finite domains: their values, bounds and how they are shown."""

from collections.abc import Iterator, Mapping, Sequence
from itertools import product

from sysmlc.logic.contract import BooleanDomain, Domain, EnumerationDomain, IntegerDomain
from sysmlc.logic.formula import Literal


def values(domain: Domain) -> Sequence[Literal]:
    """All values, the least or first declared one first; those of a range are not listed."""
    match domain:
        case BooleanDomain():
            return (False, True)
        case IntegerDomain(low, high):
            return range(low, high + 1)
        case EnumerationDomain(literals):
            return literals


def size(domain: Domain) -> int:
    """Number of values."""
    match domain:
        case BooleanDomain():
            return 2
        case IntegerDomain(low, high):
            return high - low + 1
        case EnumerationDomain(literals):
            return len(literals)


def contains(domain: Domain, value: Literal) -> bool:
    """Whether the value is one of the domain's, of the right type too."""
    match domain:
        case BooleanDomain():
            return isinstance(value, bool)
        case IntegerDomain(low, high):
            return isinstance(value, int) and not isinstance(value, bool) and low <= value <= high
        case EnumerationDomain(literals):
            return isinstance(value, str) and value in literals


def describe(domain: Domain) -> str:
    """The domain in words: ``Boolean``, ``0..7``, ``open, closed``."""
    match domain:
        case BooleanDomain():
            return "Boolean"
        case IntegerDomain(low, high):
            return f"{low}..{high}"
        case EnumerationDomain(literals):
            return ", ".join(literals)


def valuations(domains: Mapping[str, Domain]) -> Iterator[dict[str, Literal]]:
    """Every assignment of values to the variables."""
    names: Sequence[str] = tuple(domains)
    for row in product(*(values(domains[name]) for name in names)):
        yield dict(zip(names, row, strict=True))


def count(domains: Mapping[str, Domain]) -> int:
    """Number of assignments of values to the variables."""
    number = 1
    for domain in domains.values():
        number *= size(domain)
    return number
