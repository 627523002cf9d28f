"""What the runs of a contract show: environments that end, outputs of which nothing is said."""

from collections.abc import Iterator

from sysmlc.logic.contract import Contract, IntegerDomain, Owner, Variable
from sysmlc.logic.domains import size, values
from sysmlc.logic.printing import print_literal
from sysmlc.synthesis.algebra.fair import Runs
from sysmlc.synthesis.algebra.systems import FairSystem
from sysmlc.synthesis.bdd.manager import Manager, Node
from sysmlc.synthesis.games.game import Game, Part, make_game
from sysmlc.synthesis.games.image import Product
from sysmlc.synthesis.lints import rules
from sysmlc.synthesis.lints.words import Remark

_COUNTED = 3
"""Values from which on a whole number is a quantity, which jumps when nothing holds it."""


def of_runs(contract: Contract, manager: Manager) -> Iterator[Remark]:
    """Dead ends of the environment, and outputs without a frame."""
    game = make_game(contract, manager)
    with manager.guard():
        yield from _of_game(contract, game)


def _of_game(contract: Contract, game: Game) -> Iterator[Remark]:
    manager = game.manager
    reachable = Runs(all_steps(game)).reachable
    alive = Product(manager, _nodes(game.assumptions), game.next_inputs)(manager.true)
    dead = reachable & ~alive
    if dead != manager.false:
        yield Remark(rules.DEADLOCK, said=_words(game, dead))
    for variable in contract.variables:
        if variable.owner is Owner.SYSTEM and not _is_determined(game, variable):
            yield from _frame(game, variable, reachable & alive)


def all_steps(game: Game) -> FairSystem:
    """The runs of all steps that both sides may take."""
    init = game.manager.true
    for part in (*game.init_assumptions, *game.init_guarantees):
        init = init & part.node
    parts = (*_nodes(game.assumptions), *_nodes(game.guarantees))
    return FairSystem(game.symbols, init, parts, _nodes(game.fairness))


def _is_determined(game: Game, variable: Variable) -> bool:
    """Whether single guarantees leave no two values: most say what one output becomes."""
    manager = game.manager
    bits = game.symbols.bits(variable.name, primed=True)
    others = [bit for bit in game.next_outputs if bit not in bits]
    left = manager.true
    for node in _nodes(game.guarantees):
        if not manager.support(node).isdisjoint(bits):
            left = left & _any_value(game, variable, manager.exist(others, node))
    return left == manager.false


def _any_value(game: Game, variable: Variable, node: Node) -> Node:
    """Where each value of the next step would do."""
    manager, found = game.manager, game.manager.true
    bits = game.symbols.bits(variable.name, primed=True)
    for value in values(variable.domain):
        code = manager.cube(game.symbols.code(variable.name, value, primed=True))
        found = found & manager.exist(bits, node & code)
    return found


def _frame(game: Game, variable: Variable, states: Node) -> Iterator[Remark]:
    moves = Product(game.manager, _nodes(game.assumptions), game.next_inputs)
    free = _free(game, variable)
    if _is_quantity(variable):
        where = states & moves(free)
        is_free = where != game.manager.false
    else:
        # A choice may be free in some steps; one that always is says nothing.
        where = states
        is_free = states & moves(~free) == game.manager.false
    if is_free:
        when = f"where {_words(game, where)}" if where != states else "in any step"
        yield Remark(rules.NO_FRAME, name=variable.name, said=when)


def _is_quantity(variable: Variable) -> bool:
    domain = variable.domain
    return isinstance(domain, IntegerDomain) and size(domain) >= _COUNTED


def _free(game: Game, variable: Variable) -> Node:
    """Where every value may come next, each with some values of the other outputs."""
    manager = game.manager
    bits = game.symbols.bits(variable.name, primed=True)
    others = [bit for bit in game.next_outputs if bit not in bits]
    join = Product(manager, _nodes(game.guarantees), others)
    found = manager.true
    for value in values(variable.domain):
        code = manager.cube(game.symbols.code(variable.name, value, primed=True))
        found = found & manager.exist(bits, join(code))
    return found


def _words(game: Game, states: Node) -> str:
    """One of the states, by the variables that make the difference."""
    symbols, manager = game.symbols, game.manager
    known = symbols.all_bits(symbols.variables)
    found = symbols.decode(manager.pick(states, known) or {})
    names = symbols.names(states) or tuple(found)
    return ", ".join(f"{name}={print_literal(found[name])}" for name in names)


def _nodes(parts: tuple[Part, ...]) -> tuple[Node, ...]:
    return tuple(part.node for part in parts)
