"""Dead ends of the environment: inputs after which no run satisfies the safety assumptions.

An assumption may be violated before it is evaluated. ``G !(X a | b)`` is evaluated when the next
input is known, but b alone violates it; ``G (a -> X !a)``, written with a history bit, is evaluated
a step late. Without the inputs that lead to dead ends, the verdict does not depend on how an
assumption is written.
"""

from collections.abc import Iterable

from msgspec import Struct

from sysmlc.logic.contract import Owner
from sysmlc.synthesis.bdd.manager import Node
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
    manager, history = symbols.manager, tuple(history)
    states = conjoin(manager, map(symbols.domain, symbols.variables))
    predecessors = Product(
        manager, (*assumptions, *history), symbols.all_bits(symbols.variables, primed=True)
    )
    viable, shrunk = manager.false, states
    while shrunk != viable:
        manager.check("searching for dead ends of the environment")
        viable, shrunk = shrunk, predecessors(symbols.prime(shrunk)) & shrunk
    if viable == states:
        return None
    choose_first = Product(manager, first, symbols.bits_of_owner(Owner.SYSTEM))
    choose_next = Product(manager, history, symbols.bits_of_owner(Owner.SYSTEM, primed=True))
    result = ViableInputs(choose_first(viable), choose_next(symbols.prime(viable)))
    inputs = manager.exist(symbols.bits_of_owner(Owner.SYSTEM), states)
    is_unrestricted = inputs <= result.first and symbols.prime(inputs) <= result.later
    return None if is_unrestricted else result
