"""What games about a contract show: winning by waiting, by force, and for want of fairness."""

from collections.abc import Callable, Iterable, Iterator

from msgspec.structs import replace

from sysmlc.logic import formula as f
from sysmlc.logic.contract import (
    BooleanDomain,
    Class,
    Conjunct,
    Contract,
    IntegerDomain,
    Owner,
    Variable,
)
from sysmlc.logic.domains import size, values
from sysmlc.logic.formula import Formula, Var
from sysmlc.logic.printing import print_formula, print_literal
from sysmlc.synthesis.algebra.fair_systems import FairSystem, Runs
from sysmlc.synthesis.bdd.manager import Manager, Node
from sysmlc.synthesis.games.game import Constraint, Game, make_game
from sysmlc.synthesis.games.relational_product import Product
from sysmlc.synthesis.games.solver import solve
from sysmlc.synthesis.lints import rules
from sysmlc.synthesis.lints.text_checks import LintFinding, state_assumptions_of_next_step

ManagerFactory = Callable[[], Manager]
_MAX_TRIED = 40
"""Assumptions that are tried one by one to say which is to blame."""


def check_games(contract: Contract, new: ManagerFactory) -> Iterator[LintFinding]:
    """Remarks about how a contract is won or lost; every game has a manager of its own."""
    if not is_won(contract, new):
        yield from _suggest_fairness(contract, new)
    elif _has_liveness((*contract.assumptions, *contract.guarantees)) and is_won(
        _with_idle_outputs(contract), new
    ):
        yield LintFinding(rules.IDLE)
    elif _has_liveness(contract.assumptions) and _has_liveness(contract.guarantees):
        yield from _check_needless_fairness(contract, new)
    if is_forced(contract, new):
        yield LintFinding(rules.NOT_SEPARATED, said=_culprits(contract, new))


def is_won(contract: Contract, new: ManagerFactory) -> bool:
    """Whether some component keeps the contract."""
    return solve(make_game(contract, new()), is_complete=False).is_realizable


def _check_needless_fairness(contract: Contract, new: ManagerFactory) -> Iterator[LintFinding]:
    """That what recurs is brought about although nothing that is assumed recurs."""
    left = tuple(one for one in contract.assumptions if one.class_ is not Class.LIVENESS)
    if is_won(replace(contract, assumptions=left), new):
        yield LintFinding(rules.NEEDLESS)


def _has_liveness(conjuncts: Iterable[Conjunct]) -> bool:
    return any(one.class_ is Class.LIVENESS for one in conjuncts)


def _with_idle_outputs(contract: Contract) -> Contract:
    """The same, with all outputs as they are."""
    outputs = [one.name for one in contract.variables if one.owner is Owner.SYSTEM]
    frames = (f.eq(Var(name, primed=True), Var(name)) for name in outputs)
    same = tuple(Conjunct(one, Class.SAFETY, contract.origin) for one in frames)
    return replace(contract, guarantees=(*contract.guarantees, *same))


# -- fairness ----------------------------------------------------------------------------------


def _suggest_fairness(contract: Contract, new: ManagerFactory) -> Iterator[LintFinding]:
    """An assumption that would make a lost contract one that is kept."""
    safe = tuple(one for one in contract.guarantees if one.class_ is not Class.LIVENESS)
    if len(safe) == len(contract.guarantees) or not is_won(replace(contract, guarantees=safe), new):
        return
    for wanted in _input_predicates(contract):
        more = Conjunct(wanted, Class.LIVENESS, contract.origin)
        helped = replace(contract, assumptions=(*contract.assumptions, more))
        if is_won(helped, new) and not is_forced(helped, new):
            text = f", for instance if '{print_formula(wanted)}' recurred"
            yield LintFinding(rules.NO_FAIRNESS, said=text)
            return


def _input_predicates(contract: Contract) -> Iterator[Formula]:
    for variable in contract.variables:
        if variable.owner is Owner.ENVIRONMENT:
            yield from _value_predicates(variable)


def _value_predicates(variable: Variable) -> Iterator[Formula]:
    match variable.domain:
        case BooleanDomain():
            yield f.var(variable.name)
            yield f.negate(f.var(variable.name))
        case IntegerDomain():
            return
        case domain:
            for value in values(domain):
                yield f.eq(f.var(variable.name), f.const(value))


# -- separation --------------------------------------------------------------------------------


def is_forced(contract: Contract, new: ManagerFactory) -> bool:
    """Whether the component, keeping its safety, can make the assumptions fail from somewhere.

    Klein and Pnueli (2010), Maoz and Ringert (2016): it wins although what it owes is impossible.
    They let it break its own safety too, which a component that wins may not.
    """
    never = Conjunct(f.FALSE, Class.LIVENESS, contract.origin)
    safe = tuple(one for one in contract.guarantees if one.class_ is not Class.LIVENESS)
    game = make_game(
        state_assumptions_of_next_step(replace(contract, guarantees=(*safe, never))), new()
    )
    reachable = Runs(system_of_game(game)).reachable
    return reachable & solve(game).winning != game.manager.false


def _culprits(contract: Contract, new: ManagerFactory) -> str:
    """Assumptions without which the others cannot be broken by force, in words."""
    if len(contract.assumptions) > _MAX_TRIED:
        return ""
    found = [one for one in contract.assumptions if not is_forced(_without(contract, one), new)]
    texts = ", ".join(f"'{print_formula(one.formula)}'" for one in found)
    return f"; not without {texts}" if texts else ""


def _without(contract: Contract, conjunct: Conjunct) -> Contract:
    left = tuple(one for one in contract.assumptions if one is not conjunct)
    return replace(contract, assumptions=left)


_MIN_QUANTITY_VALUES = 3
"""Values from which on a whole number is a quantity, which jumps when nothing holds it."""


def check_runs(contract: Contract, manager: Manager) -> Iterator[LintFinding]:
    """Dead ends of the environment, and outputs without a frame."""
    game = make_game(contract, manager)
    with manager.guard():
        yield from _check_game(contract, game)


def _check_game(contract: Contract, game: Game) -> Iterator[LintFinding]:
    manager = game.manager
    reachable = Runs(system_of_game(game)).reachable
    alive = Product(manager, _nodes_of(game.assumptions), game.next_inputs)(manager.true)
    dead = reachable & ~alive
    if dead != manager.false:
        yield LintFinding(rules.DEADLOCK, said=_describe_state(game, dead))
    for variable in contract.variables:
        if variable.owner is Owner.SYSTEM and not _has_unique_value(game, variable):
            yield from _check_frame(game, variable, reachable & alive)


def system_of_game(game: Game) -> FairSystem:
    """The runs of all steps that both sides may take."""
    init = game.manager.true
    for part in (*game.init_assumptions, *game.init_guarantees):
        init = init & part.node
    parts = (*_nodes_of(game.assumptions), *_nodes_of(game.guarantees))
    return FairSystem(game.symbols, init, parts, _nodes_of(game.fairness))


def _has_unique_value(game: Game, variable: Variable) -> bool:
    """Whether single guarantees leave no two values: most say what one output becomes."""
    manager = game.manager
    bits = game.symbols.bits(variable.name, primed=True)
    others = [bit for bit in game.next_outputs if bit not in bits]
    left = manager.true
    for node in _nodes_of(game.guarantees):
        if not manager.support(node).isdisjoint(bits):
            left = left & _states_allowing_any_value(game, variable, manager.exist(others, node))
    return left == manager.false


def _states_allowing_any_value(game: Game, variable: Variable, node: Node) -> Node:
    """Where each value of the next step would do."""
    manager, found = game.manager, game.manager.true
    bits = game.symbols.bits(variable.name, primed=True)
    for value in values(variable.domain):
        code = manager.cube(game.symbols.code(variable.name, value, primed=True))
        found = found & manager.exist(bits, node & code)
    return found


def _check_frame(game: Game, variable: Variable, states: Node) -> Iterator[LintFinding]:
    moves = Product(game.manager, _nodes_of(game.assumptions), game.next_inputs)
    free = _states_without_frame(game, variable)
    if _is_quantity(variable):
        where = states & moves(free)
        is_free = where != game.manager.false
    else:
        # A choice may be free in some steps; one that always is says nothing.
        where = states
        is_free = states & moves(~free) == game.manager.false
    if is_free:
        when = f"where {_describe_state(game, where)}" if where != states else "in any step"
        yield LintFinding(rules.NO_FRAME, name=variable.name, said=when)


def _is_quantity(variable: Variable) -> bool:
    domain = variable.domain
    return isinstance(domain, IntegerDomain) and size(domain) >= _MIN_QUANTITY_VALUES


def _states_without_frame(game: Game, variable: Variable) -> Node:
    """Where every value may come next, each with some values of the other outputs."""
    manager = game.manager
    bits = game.symbols.bits(variable.name, primed=True)
    others = [bit for bit in game.next_outputs if bit not in bits]
    join = Product(manager, _nodes_of(game.guarantees), others)
    found = manager.true
    for value in values(variable.domain):
        code = manager.cube(game.symbols.code(variable.name, value, primed=True))
        found = found & manager.exist(bits, join(code))
    return found


def _describe_state(game: Game, states: Node) -> str:
    """One of the states, by the variables that make the difference."""
    symbols, manager = game.symbols, game.manager
    known = symbols.all_bits(symbols.variables)
    found = symbols.decode(manager.pick(states, known) or {})
    names = symbols.names(states) or tuple(found)
    return ", ".join(f"{name}={print_literal(found[name])}" for name in names)


def _nodes_of(parts: tuple[Constraint, ...]) -> tuple[Node, ...]:
    return tuple(part.node for part in parts)
