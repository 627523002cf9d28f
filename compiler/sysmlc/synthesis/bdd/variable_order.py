"""The order in which variables and their bits enter the decision diagrams.

Integers with the same range usually are quantities of one kind: positions and targets, or angles.
Formulas compare them, so their bits are interleaved, the most significant ones first. Relations
between three or more of them then need a fifth of the nodes. Wide integers are interleaved whatever
their ranges: without that, the comparison of two integers needs as many nodes as they have values.
Other variables keep the order of their declaration. If there are many variables (tokens of an
activity), the heuristic FORCE (Aloul, Markov, Sakallah 2003) places variables close together that
occur in the same conjuncts.
"""

from collections.abc import Collection, Iterable, Mapping, Sequence
from itertools import zip_longest

from sysmlc.logic import domains
from sysmlc.logic.contract import Domain, IntegerDomain, Variable

MIN_INTERLEAVED_VARIABLES = 5
"""Least number of variables of one range to interleave: relations between fewer variables are small
in any order."""
MIN_INTERLEAVED_BITS = 7
"""Least width of integers that are interleaved with one another although their ranges differ."""
MIN_FORCE_VARIABLES = 40
"""Least number of variables to order with FORCE."""
MAX_FORCE_ROUNDS = 300
"""Rounds after which FORCE ends even if the order still improves."""
MAX_EDGE_VARIABLES = 20
"""Conjuncts with more variables are ignored by FORCE: they relate nearly everything."""


def order_bits(
    variables: Iterable[Variable],
    bits: Mapping[str, tuple[str, ...]],
    edges: Iterable[Collection[str]] = (),
) -> tuple[str, ...]:
    """Return all bits in the order in which they shall be declared.

    Each of *edges* contains the names of the variables of one conjunct.
    """
    groups: dict[Domain | str | int, list[str]] = {}
    for variable in variables:
        is_number = isinstance(variable.domain, IntegerDomain) and domains.size(variable.domain) > 2
        is_broad = is_number and len(bits[variable.name]) >= MIN_INTERLEAVED_BITS
        key = MIN_INTERLEAVED_BITS if is_broad else variable.domain if is_number else variable.name
        groups.setdefault(key, []).append(variable.name)
    if len(bits) >= MIN_FORCE_VARIABLES and all(
        len(names) < MIN_INTERLEAVED_VARIABLES for names in groups.values()
    ):
        return tuple(
            bit for name in order_by_force(tuple(bits), tuple(edges)) for bit in bits[name]
        )
    return tuple(
        bit for names in groups.values() for bit in _interleave([bits[member] for member in names])
    )


def _interleave(bit_lists: list[tuple[str, ...]]) -> Iterable[str]:
    if len(bit_lists) < MIN_INTERLEAVED_VARIABLES and len(bit_lists[0]) < MIN_INTERLEAVED_BITS:
        return (bit for bits in bit_lists for bit in bits)
    # Align the least significant bits, because equal weights are compared with each other.
    columns = list(zip_longest(*(reversed(bits) for bits in bit_lists), fillvalue=""))
    return (bit for column in reversed(columns) for bit in column if bit)


def order_by_force(names: Sequence[str], relations: Sequence[Collection[str]]) -> tuple[str, ...]:
    """Return *names* in an order in which the names of each relation are close together."""
    edges = [tuple(edge) for edge in relations if 1 < len(edge) <= MAX_EDGE_VARIABLES]
    best = order = tuple(names)
    best_span = _total_span(order, edges)
    # The span may oscillate, so the search ends with the first order that is no improvement.
    for _ in range(MAX_FORCE_ROUNDS):
        order = _move_to_centers(order, edges)
        span = _total_span(order, edges)
        if span >= best_span:
            break
        best, best_span = order, span
    return best


def _move_to_centers(order: Sequence[str], edges: Iterable[Sequence[str]]) -> tuple[str, ...]:
    """Sort the names by the mean center of the edges that contain them."""
    position = {name: index for index, name in enumerate(order)}
    centers: dict[str, list[float]] = {name: [] for name in order}
    for edge in edges:
        center = sum(position[name] for name in edge) / len(edge)
        for name in edge:
            centers[name].append(center)
    return tuple(
        sorted(
            order,
            key=lambda name: (
                sum(centers[name]) / len(centers[name]) if centers[name] else position[name]
            ),
        )
    )


def _total_span(order: Sequence[str], edges: Iterable[Sequence[str]]) -> int:
    """Return the sum of the distances between the first and the last name of each edge."""
    positions = {name: index for index, name in enumerate(order)}
    return sum(
        max(edge_positions) - min(edge_positions)
        for edge in edges
        for edge_positions in [[positions[name] for name in edge]]
    )
