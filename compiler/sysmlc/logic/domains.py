"""Finite domains: their values, sizes and textual form."""

from collections.abc import Iterable, Iterator, Mapping, Sequence
from itertools import product

from sysmlc.logic.contract import BooleanDomain, Domain, EnumerationDomain, IntegerDomain
from sysmlc.logic.formula import Literal
from sysmlc.logic.identifiers import make_unique
from sysmlc.logic.regions import Regions


def make_region_domain(regions: Regions) -> EnumerationDomain:
    """Return an enumeration whose literals stand for regions of numbers."""
    return EnumerationDomain(make_unique(regions.list_names(), "region"), regions=regions)


def regions_of(domain: Domain) -> Regions | None:
    """Return the regions for which the literals of a domain stand; None if they stand for none."""
    return domain.regions if isinstance(domain, EnumerationDomain) else None


def values(domain: Domain) -> Sequence[Literal]:
    """Return all values in order, the least or first declared one first; a range stays a range."""
    match domain:
        case BooleanDomain():
            return (False, True)
        case IntegerDomain(low, high):
            return range(low, high + 1)
        case EnumerationDomain(literals):
            return literals


def size(domain: Domain) -> int:
    """Return the number of values."""
    match domain:
        case BooleanDomain():
            return 2
        case IntegerDomain(low, high):
            return high - low + 1
        case EnumerationDomain(literals):
            return len(literals)


def contains(domain: Domain, value: Literal) -> bool:
    """Whether the value belongs to the domain; ``True`` is no integer."""
    match domain:
        case BooleanDomain():
            return isinstance(value, bool)
        case IntegerDomain(low, high):
            return isinstance(value, int) and not isinstance(value, bool) and low <= value <= high
        case EnumerationDomain(literals):
            return isinstance(value, str) and value in literals


def describe(domain: Domain) -> str:
    """Return the domain as text: ``Boolean``, ``0..7`` or ``open, closed``."""
    match domain:
        case BooleanDomain():
            return "Boolean"
        case IntegerDomain(low, high):
            return f"{low}..{high}"
        case EnumerationDomain(literals):
            return ", ".join(literals)


def describe_kind(domain: Domain) -> str:
    """Return what the values of a domain are; regions are numbers in their unit."""
    regions = regions_of(domain)
    if regions is None:
        return describe(domain)
    return f"numbers in {regions.unit}" if regions.unit else "numbers without a unit"


def describe_difference(actual: EnumerationDomain, expected: EnumerationDomain) -> str:
    """Return what a value is and should be, by the literals or, if they are the same, the types."""
    if sorted(actual.literals) == sorted(expected.literals):
        return f"a value of '{actual.type_name}', not of '{expected.type_name}'"
    return f"one of {describe(actual)}, not of {describe(expected)}"


def valuations(domains: Mapping[str, Domain]) -> Iterator[dict[str, Literal]]:
    """Yield every assignment of values to the variables."""
    names: Sequence[str] = tuple(domains)
    for row in product(*(values(domains[name]) for name in names)):
        yield dict(zip(names, row, strict=True))


def count(domains: Mapping[str, Domain]) -> int:
    """Return the number of assignments of values to the variables."""
    total = 1
    for domain in domains.values():
        total *= size(domain)
    return total


def width(domain: Domain) -> int:
    """Return the number of bits of a variable with these values.

    A variable with a single value has a bit too, so that the support of diagrams can show it.
    """
    return max(1, (size(domain) - 1).bit_length())


def encode(domain: Domain, value: Literal) -> tuple[bool, ...]:
    """Return the bits of the index of a value, the most significant one first."""
    index = values(domain).index(value)
    return tuple(bool(index >> position & 1) for position in reversed(range(width(domain))))


def decode(domain: Domain, bits: Iterable[bool]) -> Literal:
    """Return the value with these bits. Raises IndexError if they encode none."""
    index = 0
    for bit in bits:
        index = index << 1 | bit
    if index >= size(domain):
        raise IndexError(f"no value with the code {index}")
    return values(domain)[index]
