"""Dead ends of the environment: inputs after which no run satisfies the safety assumptions.

An assumption may be violated before it is evaluated. ``G !(X a | b)`` is evaluated when the next
input is known, but b alone violates it; ``G (a -> X !a)``, written with a history bit, is evaluated
a step late. Without the inputs that lead to dead ends, the verdict does not depend on how an
assumption is written.
"""

from collections.abc import Iterable, Iterator, Sequence

from msgspec import Struct

from sysmlc.logic.contract import Owner
from sysmlc.support.disjoint_sets import group_related
from sysmlc.synthesis.bdd.manager import Manager, Node
from sysmlc.synthesis.bdd.symbols import Symbols
from sysmlc.synthesis.games.relational_product import Product

MAX_DEFINITION_NODES = 1_000
"""Nodes of a conjunction above which it is not tried as the definition of an input."""


class ViableInputs(Struct, frozen=True):
    """The inputs after which some run satisfies all safety assumptions for ever."""

    first: Node
    """Inputs of the first step."""
    later: Node
    """States with next inputs."""


def find_viable_inputs(
    symbols: Symbols, assumptions: Iterable[Node], first: Iterable[Node], history: Iterable[Node]
) -> ViableInputs | None:
    """Return the viable inputs, or None if all inputs that the assumptions allow are viable.

    *first* are conditions on outputs in the first step, *history* on outputs in each next step: the
    values of history bits, and ranges. Otherwise outputs are free: the environment does not violate
    an assumption as long as some outputs avoid the dead end.
    """
    assumptions, first, history = tuple(assumptions), tuple(first), tuple(history)
    if not _can_choose_dead_end(symbols, assumptions, first, history):
        return None
    manager = symbols.manager
    predecessors = Product(
        manager, (*assumptions, *history), symbols.all_bits(symbols.variables, primed=True)
    )
    viable, shrunk = manager.false, manager.conjoin(map(symbols.domain, symbols.variables))
    while shrunk != viable:
        manager.check("searching for dead ends of the environment")
        viable, shrunk = shrunk, predecessors(symbols.prime(shrunk)) & shrunk
    choose_first = Product(manager, first, symbols.bits_of_owner(Owner.SYSTEM))
    choose_next = Product(manager, history, symbols.bits_of_owner(Owner.SYSTEM, primed=True))
    return ViableInputs(choose_first(viable), choose_next(symbols.prime(viable)))


def _can_choose_dead_end(
    symbols: Symbols, assumptions: Sequence[Node], first: Sequence[Node], history: Sequence[Node]
) -> bool:
    """Whether some inputs leave no outputs with which the environment has a next input."""
    # Parts without common variables stay apart: the conjunction of the ranges of many interleaved
    # numbers alone takes most of the nodes of a grid of robots.
    manager = symbols.manager
    conditions = [
        node
        for node in _quantify(manager, assumptions, symbols.bits_of_owner(Owner.ENVIRONMENT, True))
        if not _holds_in_ranges(symbols, node)
    ]
    next_conditions = map(symbols.prime, conditions)
    outputs = symbols.bits_of_owner(Owner.SYSTEM)
    next_outputs = symbols.bits_of_owner(Owner.SYSTEM, primed=True)
    answers = (
        *_quantify(manager, (*conditions, *first), outputs),
        *_quantify(manager, (*next_conditions, *history), next_outputs),
    )
    return bool(conditions) and not all(_holds_in_ranges(symbols, node) for node in answers)


def _quantify(manager: Manager, parts: Iterable[Node], bits: Sequence[str]) -> Iterator[Node]:
    """Yield conjuncts of ``exist bits: part & part ...``, one for all parts that share bits."""
    remaining = _drop_definitions(manager, parts, bits)
    quantified = frozenset(bits)
    supports = [(part, manager.support(part) & quantified) for part in remaining]
    groups = group_related(bits, [support for _, support in supports])
    group_of = {bit: index for index, group in enumerate(groups) for bit in group}
    members: dict[int, list[Node]] = {}
    for part, support in supports:
        if support:
            members.setdefault(group_of[min(support)], []).append(part)
        else:
            yield part
    for index, nodes in members.items():
        yield Product(manager, nodes, groups[index])(manager.true)


def _drop_definitions(manager: Manager, parts: Iterable[Node], bits: Sequence[str]) -> list[Node]:
    """Return the parts without those that some value of a bit always satisfies.

    Sensors that definitions determine would otherwise be replaced by the definitions in all parts,
    which for a grid of robots takes most of the nodes.
    """
    remaining = dict.fromkeys(parts)
    by_bit = {bit: [part for part in remaining if bit in manager.support(part)] for bit in bits}
    is_changed = True
    while is_changed:
        is_changed = False
        for bit in bits:
            touching = [part for part in by_bit[bit] if part in remaining]
            conjunction = (
                manager.conjoin_small(touching, MAX_DEFINITION_NODES) if touching else None
            )
            if conjunction is not None and manager.exist([bit], conjunction) == manager.true:
                is_changed = True
                for part in touching:
                    del remaining[part]
    return list(remaining)


def _holds_in_ranges(symbols: Symbols, node: Node) -> bool:
    """Whether all values of the variables satisfy the condition."""
    ranges = symbols.manager.conjoin(
        symbols.domain(name, primed)
        for primed in (False, True)
        for name in symbols.names(node, primed)
    )
    return ranges <= node
