"""Dead ends of the environment: inputs after which no run satisfies the safety assumptions.

An assumption may be violated before it is evaluated. ``G !(X a | b)`` is evaluated when the next
input is known, but b alone violates it; ``G (a -> X !a)``, written with a history bit, is evaluated
a step late. Without the inputs that lead to dead ends, the verdict does not depend on how an
assumption is written.
"""

from collections.abc import Iterable, Sequence
from itertools import count

from msgspec import Struct

from sysmlc.logic.contract import Owner
from sysmlc.synthesis.bdd.manager import Manager, Node
from sysmlc.synthesis.bdd.symbols import Symbols, conjoin
from sysmlc.synthesis.games.relational_product import Product


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
    viable, shrunk = manager.false, conjoin(manager, map(symbols.domain, symbols.variables))
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


def _quantify(manager: Manager, parts: Iterable[Node], bits: Sequence[str]) -> list[Node]:
    """Return conjuncts of ``exist bits: part & part ...``, without those that are true.

    Bits in the fewest parts go first (bucket elimination): an input that a definition determines
    vanishes with its definition, before anything is conjoined with it.
    """
    nodes = dict(enumerate(parts))
    parts_of_bit: dict[str, set[int]] = {bit: set() for bit in bits}
    for number, node in nodes.items():
        for bit in manager.support(node).intersection(parts_of_bit):
            parts_of_bit[bit].add(number)
    new_numbers = count(len(nodes))
    while parts_of_bit:
        bit = min(parts_of_bit, key=lambda bit: len(parts_of_bit[bit]))
        touching = parts_of_bit[bit]
        own_bits = [bit for bit, numbers in parts_of_bit.items() if numbers <= touching]
        conjunction = conjoin(manager, [nodes.pop(number) for number in sorted(touching)])
        for own_bit in own_bits:
            del parts_of_bit[own_bit]
        number = next(new_numbers)
        nodes[number] = manager.exist(own_bits, conjunction)
        support = manager.support(nodes[number])
        for other_bit, numbers in parts_of_bit.items():
            numbers -= touching
            if other_bit in support:
                numbers.add(number)
    return [node for node in nodes.values() if node != manager.true]


def _holds_in_ranges(symbols: Symbols, node: Node) -> bool:
    """Whether all values of the variables satisfy the condition."""
    ranges = conjoin(
        symbols.manager,
        (
            symbols.domain(name, primed)
            for primed in (False, True)
            for name in symbols.names(node, primed)
        ),
    )
    return ranges <= node
