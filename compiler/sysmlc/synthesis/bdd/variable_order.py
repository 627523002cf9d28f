"""The order in which variables and their bits enter the diagrams.

Numbers with one range are positions, targets, angles of alike things: what is said compares them,
so their bits are interleaved, the most significant ones first. Relations between three and more
of them are then a fifth of what they are with one variable after the other. Wide numbers are laid
so whatever their ranges: two that are compared, one behind the other, need as many nodes as they
have values. Other variables stay where they are declared. Of many variables (tokens of an activity,
what runs, what is done) those that conjuncts speak of together come close together: FORCE (Aloul,
Markov, Sakallah 2003).
"""

from collections.abc import Collection, Iterable, Mapping, Sequence
from itertools import zip_longest

from sysmlc.logic import domains
from sysmlc.logic.contract import Domain, IntegerDomain, Variable

MANY = 5
"""Fewer variables with one range stay apart: their relations are small in any order."""
BROAD = 7
"""Bits of a number from which on it is interleaved with all that have as many or more."""
CROWD = 40
"""Variables from which on they are laid by what speaks of them."""
LONG = 300
"""Times that a crowd is laid anew at most."""
WIDE = 20
"""A conjunct about more variables says nothing of which are close."""


def ordered(
    variables: Iterable[Variable],
    bits: Mapping[str, tuple[str, ...]],
    together: Iterable[Collection[str]] = (),
) -> tuple[str, ...]:
    """All bits, those of variables with the same range interleaved; ``together`` are names of
    variables that something is said of."""
    groups: dict[Domain | str | int, list[str]] = {}
    for variable in variables:
        is_number = isinstance(variable.domain, IntegerDomain) and domains.size(variable.domain) > 2
        is_broad = is_number and len(bits[variable.name]) >= BROAD
        key = BROAD if is_broad else variable.domain if is_number else variable.name
        groups.setdefault(key, []).append(variable.name)
    if len(bits) >= CROWD and all(len(names) < MANY for names in groups.values()):
        return tuple(bit for name in laid(tuple(bits), tuple(together)) for bit in bits[name])
    return tuple(bit for names in groups.values() for bit in _laid([bits[one] for one in names]))


def _laid(rows: list[tuple[str, ...]]) -> Iterable[str]:
    if len(rows) < MANY and len(rows[0]) < BROAD:
        return (bit for row in rows for bit in row)
    columns = list(zip_longest(*(reversed(row) for row in rows), fillvalue=""))
    return (bit for column in reversed(columns) for bit in column if bit)


def laid(names: Sequence[str], together: Sequence[Collection[str]]) -> tuple[str, ...]:
    """The names in an order in which those that belong together are close."""
    edges = [tuple(edge) for edge in together if 1 < len(edge) <= WIDE]
    best = order = tuple(names)
    least = _span(order, edges)
    for _ in range(LONG):
        order = _drawn(order, edges)
        span = _span(order, edges)
        if span >= least:
            break
        best, least = order, span
    return best


def _drawn(order: Sequence[str], edges: Iterable[Sequence[str]]) -> tuple[str, ...]:
    """Each name as near as can be to the middles of what speaks of it."""
    place = {name: at for at, name in enumerate(order)}
    pull: dict[str, list[float]] = {name: [] for name in order}
    for edge in edges:
        middle = sum(place[name] for name in edge) / len(edge)
        for name in edge:
            pull[name].append(middle)
    return tuple(
        sorted(
            order, key=lambda name: sum(pull[name]) / len(pull[name]) if pull[name] else place[name]
        )
    )


def _span(order: Sequence[str], edges: Iterable[Sequence[str]]) -> int:
    place = {name: at for at, name in enumerate(order)}
    return sum(max(at) - min(at) for edge in edges for at in [[place[name] for name in edge]])
