"""The order in which variables and their bits enter the decision diagrams.

Integers with the same range usually are quantities of one kind: positions and targets, or angles.
Formulas compare them, so their bits are interleaved, the most significant ones first. Relations
between three or more of them then need a fifth of the nodes. Wide integers are interleaved whatever
their ranges: without that, the comparison of two integers needs as many nodes as they have values.

No order suits all contracts. ``VariableOrder`` names those that are tried in turn.
"""

from collections.abc import Collection, Iterable, Mapping, Sequence
from enum import StrEnum
from itertools import zip_longest

from sysmlc.logic import domains
from sysmlc.logic import formula as f
from sysmlc.logic.contract import Conjunct, Domain, IntegerDomain, Variable

MIN_INTERLEAVED_VARIABLES = 5
"""Least number of variables of one range to interleave: relations between fewer variables are small
in any order."""
MIN_INTERLEAVED_BITS = 7
"""Least width of integers that are interleaved with one another although their ranges differ."""
MIN_FORCE_VARIABLES = 40
"""From so many variables on, the order of FORCE is always used."""
_MIN_HUB_NEIGHBOURS = 4
_HUB_SHARE = 1 / 3
"""A hub occurs in conjuncts with at least this share of the variables."""
_MAX_HUBS_SHARE = 1 / 5
"""Among more variables than this share, none is a hub: an arbiter relates all grants."""
_MIN_SPAN_SHARE = 0.7
"""FORCE must reduce the distances in conjuncts to this share of those in the declared order."""
MAX_FORCE_ROUNDS = 300
"""Rounds after which FORCE ends even if the order still improves."""
MAX_EDGE_VARIABLES = 20
"""Conjuncts with more variables are ignored by FORCE: they relate nearly everything."""


class VariableOrder(StrEnum):
    """A way to order the variables of a contract."""

    CONJUNCTS = "by conjuncts"
    """First *hubs*: few variables that conjuncts relate to many others, such as the floor of an
    elevator with a call for each floor. They select which of the others count; below the others, a
    diagram has a node for each combination of these. Then variables of the same conjuncts close
    together, by the heuristic FORCE (Aloul, Markov, Sakallah 2003), or as they are declared if that
    is nearly as close: authors keep together what belongs together."""
    DECLARED = "declared"
    """As they are declared."""


def list_related(conjuncts: Iterable[Conjunct]) -> list[tuple[str, ...]]:
    """Return the names of the variables of each conjunct."""
    return [
        tuple(dict.fromkeys(variable.name for variable in f.variables(conjunct.formula)))
        for conjunct in conjuncts
    ]


def order_bits(
    variables: Iterable[Variable],
    bits: Mapping[str, tuple[str, ...]],
    edges: Iterable[Collection[str]] = (),
    order: VariableOrder = VariableOrder.CONJUNCTS,
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
    units = _list_units(groups.values(), bits)
    names = tuple(units)
    if order is VariableOrder.CONJUNCTS:
        names = _order_by_conjuncts(names, _join_names(units, edges))
    return tuple(bit for name in names for bit in _interleave([bits[n] for n in units[name]]))


def _list_units(
    groups: Iterable[list[str]], bits: Mapping[str, tuple[str, ...]]
) -> dict[str, list[str]]:
    """Return the variables that are ordered as one, by the name of the first of them."""
    units: dict[str, list[str]] = {}
    for names in groups:
        are_interleaved = len(names) >= MIN_INTERLEAVED_VARIABLES
        are_interleaved |= len(bits[names[0]]) >= MIN_INTERLEAVED_BITS
        units |= {names[0]: names} if are_interleaved else {name: [name] for name in names}
    return units


def _join_names(
    units: Mapping[str, list[str]], edges: Iterable[Collection[str]]
) -> list[tuple[str, ...]]:
    """Return the edges between units, without those that relate nearly everything."""
    unit_of = {name: unit for unit, names in units.items() for name in names}
    joined = (tuple(dict.fromkeys(unit_of[name] for name in edge)) for edge in edges)
    return [edge for edge in joined if 1 < len(edge) <= MAX_EDGE_VARIABLES]


def _order_by_conjuncts(names: tuple[str, ...], edges: Sequence[Sequence[str]]) -> tuple[str, ...]:
    hubs = _find_hubs(names, edges)
    others = tuple(name for name in names if name not in hubs)
    inner_edges = [tuple(name for name in edge if name not in hubs) for edge in edges]
    ordered = order_by_force(others, inner_edges)
    allowed_span = _MIN_SPAN_SHARE * _total_span(others, inner_edges)
    is_closer = _total_span(ordered, inner_edges) < allowed_span
    return (*hubs, *(ordered if is_closer or len(names) >= MIN_FORCE_VARIABLES else others))


def _find_hubs(names: Sequence[str], edges: Iterable[Sequence[str]]) -> tuple[str, ...]:
    """Return the hubs, the one with the most neighbours first."""
    neighbours: dict[str, set[str]] = {name: set() for name in names}
    # A conjunct about many variables ("there is no call") would make hubs of all of them.
    least = max(_MIN_HUB_NEIGHBOURS, _HUB_SHARE * len(names))
    for edge in edges:
        for name in edge if len(edge) <= least else ():
            neighbours[name].update(edge)
    # A name counts as its own neighbour.
    hubs = [name for name in names if len(neighbours[name]) > least]
    if len(hubs) > _MAX_HUBS_SHARE * len(names):
        return ()
    return tuple(sorted(hubs, key=lambda name: -len(neighbours[name])))


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
        if edge
        for edge_positions in [[positions[name] for name in edge]]
    )
