"""Lints of the text of a contract, and lints that explore runs or solve games.

The text shows conjuncts on the wrong side of the contract. Games show vacuous wins, missing or
needless fairness, and assumptions that the component can force the environment to violate. Runs
show dead ends of the environment, and outputs without a frame condition.
"""

from collections.abc import Iterable, Iterator

from msgspec import Struct
from msgspec.structs import replace

from sysmlc.diagnostics import Rule
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
from sysmlc.logic.formula import Formula, Var, variable_names, variables
from sysmlc.logic.printing import print_formula, print_literal
from sysmlc.synthesis import rules
from sysmlc.synthesis.algebra.fair_systems import FairSystem, Runs
from sysmlc.synthesis.bdd.manager import Manager, ManagerFactory, Node
from sysmlc.synthesis.games.arena import nodes_of
from sysmlc.synthesis.games.game import Game, make_game
from sysmlc.synthesis.games.relational_product import Product
from sysmlc.synthesis.games.solver import solve


class LintFinding(Struct, frozen=True):
    """A finding about a conjunct, or about the whole contract if there is no conjunct."""

    rule: Rule
    conjunct: Conjunct | None = None
    name: str = ""
    """Value of the placeholder ``name`` in the message of the rule."""
    detail: str = ""
    """Value of the placeholder ``detail`` in the message of the rule."""


def check_ownership(contract: Contract) -> Iterator[LintFinding]:
    """Yield findings about conjuncts that the wrong side decides, and about misplaced primes."""
    owners = {variable.name: variable.owner for variable in contract.variables}
    for conjunct in contract.assumptions:
        if _sole_owner(conjunct, owners) is Owner.SYSTEM:
            yield _find_wrong_owner(conjunct, "assumes", "the component")
    for conjunct in contract.guarantees:
        if _sole_owner(conjunct, owners) is Owner.ENVIRONMENT:
            yield _find_wrong_owner(conjunct, "promises", "the environment")
        elif conjunct.class_ is Class.INIT and Owner.ENVIRONMENT in _owners_of(conjunct, owners):
            yield LintFinding(rules.INITIAL_INPUT, conjunct)
    for conjunct in (*contract.assumptions, *contract.guarantees):
        if conjunct.class_ is Class.LIVENESS and _primed_names(conjunct.formula):
            yield LintFinding(rules.NEXT_IN_LIVENESS, conjunct)


def _find_wrong_owner(conjunct: Conjunct, verb: str, side: str) -> LintFinding:
    """Return the finding; in a conjunct about two steps, *side* decides the next values only."""
    relation = "whose next values" if _primed_names(conjunct.formula) else "which"
    return LintFinding(rules.WRONG_OWNER, conjunct, verb, f"{relation} {side}")


def _sole_owner(conjunct: Conjunct, owners: dict[str, Owner]) -> Owner | None:
    """Return the owner that alone decides whether the conjunct holds, or None.

    A conjunct about two steps is decided by the owner of the next values. A liveness conjunct has
    no sole owner, because the other side may bring it about through its assumptions and guarantees.
    """
    names = _primed_names(conjunct.formula) or variable_names(conjunct.formula)
    found_owners = {owners[name] for name in names if name in owners}
    is_immediate = conjunct.class_ in (Class.INIT, Class.SAFETY)
    return next(iter(found_owners)) if len(found_owners) == 1 and is_immediate else None


def _owners_of(conjunct: Conjunct, owners: dict[str, Owner]) -> set[Owner]:
    return {owners[name] for name in variable_names(conjunct.formula) if name in owners}


def _primed_names(formula: Formula) -> set[str]:
    return {variable.name for variable in variables(formula) if variable.primed}


# -- games and runs ----------------------------------------------------------------------------

_MAX_REMOVED_ASSUMPTIONS = 40
"""Assumptions up to which each of them is removed in turn to find the culprits."""


def check_games(contract: Contract, create_manager: ManagerFactory) -> Iterator[LintFinding]:
    """Yield findings about the games of a contract and of variants of it."""
    if not is_won(contract, create_manager):
        yield from _suggest_fairness(contract, create_manager)
    elif _has_liveness((*contract.assumptions, *contract.guarantees)) and is_won(
        _with_idle_outputs(contract), create_manager
    ):
        yield LintFinding(rules.IDLE)
    elif _has_liveness(contract.assumptions) and _has_liveness(contract.guarantees):
        yield from _check_needless_fairness(contract, create_manager)
    if is_forced(contract, create_manager):
        yield LintFinding(rules.NOT_SEPARATED, detail=_describe_culprits(contract, create_manager))


def is_won(contract: Contract, create_manager: ManagerFactory) -> bool:
    """Whether the contract is realizable."""
    return solve(make_game(contract, create_manager()), is_complete=False).is_realizable


def _check_needless_fairness(
    contract: Contract, create_manager: ManagerFactory
) -> Iterator[LintFinding]:
    """Yield a finding if the contract is realizable without its liveness assumptions, too."""
    safety_assumptions = tuple(
        assumption for assumption in contract.assumptions if assumption.class_ is not Class.LIVENESS
    )
    if is_won(replace(contract, assumptions=safety_assumptions), create_manager):
        yield LintFinding(rules.NEEDLESS)


def _has_liveness(conjuncts: Iterable[Conjunct]) -> bool:
    return any(conjunct.class_ is Class.LIVENESS for conjunct in conjuncts)


def _with_idle_outputs(contract: Contract) -> Contract:
    """Return the contract with the additional guarantee that all outputs stay constant."""
    outputs = [
        variable.name
        for variable in contract.variables
        if variable.owner is Owner.SYSTEM and not variable.is_auxiliary
    ]
    frames = (f.eq(Var(name, primed=True), Var(name)) for name in outputs)
    frame_conjuncts = tuple(Conjunct(frame, Class.SAFETY, contract.origin) for frame in frames)
    return replace(contract, guarantees=(*contract.guarantees, *frame_conjuncts))


def describe_vacuity(contract: Contract, create_manager: ManagerFactory) -> str:
    """Return why a realizable contract demands nothing of the component, or an empty text."""
    has_outputs = any(variable.owner is Owner.SYSTEM for variable in contract.variables)
    if not has_outputs or not contract.guarantees:
        return ""
    if is_won(_with_impossible_goal(contract), create_manager):
        return "the controller can make the environment violate its assumptions"
    if is_won(_with_idle_outputs(contract), create_manager):
        return "the controller needs to do nothing, since its outputs may stay as they are"
    return ""


# -- fairness ----------------------------------------------------------------------------------


def _suggest_fairness(contract: Contract, create_manager: ManagerFactory) -> Iterator[LintFinding]:
    """Yield a finding with a liveness assumption that makes an unrealizable contract realizable."""
    # Fairness helps only if the safety guarantees alone are realizable.
    safety_guarantees = tuple(
        guarantee for guarantee in contract.guarantees if guarantee.class_ is not Class.LIVENESS
    )
    if len(safety_guarantees) == len(contract.guarantees) or not is_won(
        replace(contract, guarantees=safety_guarantees), create_manager
    ):
        return
    for condition in _input_predicates(contract):
        assumption = Conjunct(condition, Class.LIVENESS, contract.origin)
        extended_contract = replace(contract, assumptions=(*contract.assumptions, assumption))
        if is_won(extended_contract, create_manager) and not is_forced(
            extended_contract, create_manager
        ):
            text = f", for instance if '{print_formula(condition)}' recurred"
            yield LintFinding(rules.NO_FAIRNESS, detail=text)
            return


def _input_predicates(contract: Contract) -> Iterator[Formula]:
    for variable in contract.variables:
        if variable.owner is Owner.ENVIRONMENT:
            yield from _value_predicates(variable)


def _value_predicates(variable: Variable) -> Iterator[Formula]:
    """Yield the predicates that a Boolean or an enumeration has one of its values."""
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


def is_forced(contract: Contract, create_manager: ManagerFactory) -> bool:
    """Whether the component can force the environment to violate its assumptions.

    That is: from some reachable state it can do so while it satisfies its own safety guarantees
    (well-separation: Klein and Pnueli 2010, Maoz and Ringert 2016).
    """
    game = make_game(_with_impossible_goal(contract), create_manager())
    reachable = Runs(_system_of_game(game)).reachable
    return reachable & solve(game).winning != game.manager.false


def _with_impossible_goal(contract: Contract) -> Contract:
    """Return a contract that is won only if the environment violates an assumption.

    In the literature the component may violate its safety guarantees, too. Here it may not, since a
    component that wins its contract may not either.
    """
    impossible_goal = Conjunct(f.FALSE, Class.LIVENESS, contract.origin)
    safety_guarantees = tuple(
        guarantee for guarantee in contract.guarantees if guarantee.class_ is not Class.LIVENESS
    )
    return replace(contract, guarantees=(*safety_guarantees, impossible_goal))


def _describe_culprits(contract: Contract, create_manager: ManagerFactory) -> str:
    """Return a text with the assumptions whose removal makes the contract well-separated."""
    if len(contract.assumptions) > _MAX_REMOVED_ASSUMPTIONS:
        return ""
    culprits = [
        assumption
        for assumption in contract.assumptions
        if not is_forced(_without_assumption(contract, assumption), create_manager)
    ]
    texts = ", ".join(f"'{print_formula(assumption.formula)}'" for assumption in culprits)
    return f"; not without {texts}" if texts else ""


def _without_assumption(contract: Contract, conjunct: Conjunct) -> Contract:
    remaining = tuple(
        assumption for assumption in contract.assumptions if assumption is not conjunct
    )
    return replace(contract, assumptions=remaining)


_MIN_QUANTITY_VALUES = 3
"""Least number of values of an integer that counts as a quantity; quantities should not jump."""


def check_runs(contract: Contract, manager: Manager) -> Iterator[LintFinding]:
    """Yield findings about dead ends of the environment and outputs without a frame condition."""
    game = make_game(contract, manager)
    with manager.guard():
        yield from _check_game(contract, game)


def _check_game(contract: Contract, game: Game) -> Iterator[LintFinding]:
    manager = game.manager
    reachable = Runs(_system_of_game(game)).reachable
    can_continue = Product(manager, nodes_of(game.assumptions), game.next_inputs)(manager.true)
    dead_ends = reachable & ~can_continue
    if dead_ends != manager.false:
        yield LintFinding(rules.DEADLOCK, detail=_describe_state(game, dead_ends))
    for variable in contract.variables:
        if variable.owner is Owner.SYSTEM and not _is_always_restricted(game, variable):
            yield from _check_frame(game, variable, reachable & can_continue)


def _system_of_game(game: Game) -> FairSystem:
    """Return the fair system of all steps that assumptions and guarantees allow."""
    initial = game.manager.true
    for part in (*game.init_assumptions, *game.init_guarantees):
        initial = initial & part.node
    parts = (*nodes_of(game.assumptions), *nodes_of(game.guarantees))
    return FairSystem(game.symbols, initial, parts, nodes_of(game.fairness))


def _is_always_restricted(game: Game, variable: Variable) -> bool:
    """Whether some guarantee always restricts the output, examining one guarantee at a time.

    A cheap test that often succeeds, because most guarantees are about a single output.
    """
    manager = game.manager
    bits = game.symbols.bits(variable.name, primed=True)
    other_bits = [bit for bit in game.next_outputs if bit not in bits]
    # The states and next inputs in which every guarantee examined so far allows all values.
    unrestricted = manager.true
    for node in nodes_of(game.guarantees):
        if not manager.support(node).isdisjoint(bits):
            unrestricted = unrestricted & _states_allowing_any_value(
                game, variable, manager.exist(other_bits, node)
            )
    return unrestricted == manager.false


def _states_allowing_any_value(game: Game, variable: Variable, node: Node) -> Node:
    """Return the states and next inputs for which *node* allows all next values of the output."""
    manager, states = game.manager, game.manager.true
    bits = game.symbols.bits(variable.name, primed=True)
    for value in values(variable.domain):
        code = manager.cube(game.symbols.code(variable.name, value, primed=True))
        states = states & manager.exist(bits, node & code)
    return states


def _check_frame(game: Game, variable: Variable, states: Node) -> Iterator[LintFinding]:
    """Yield a finding if the output has no frame condition in *states*."""
    if size(variable.domain) == 1:
        return  # such as the state of a machine with one state
    product = Product(game.manager, nodes_of(game.assumptions), game.next_inputs)
    unconstrained = _states_without_frame(game, variable)
    if _is_quantity(variable):
        condition = states & product(unconstrained)
        is_free = condition != game.manager.false
    else:
        # A Boolean or enumeration may be free in some steps; report only outputs free in all.
        condition = states
        is_free = states & product(~unconstrained) == game.manager.false
    if is_free:
        condition_text = (
            f"where {_describe_state(game, condition)}" if condition != states else "in any step"
        )
        yield LintFinding(rules.NO_FRAME, name=variable.name, detail=condition_text)


def _is_quantity(variable: Variable) -> bool:
    domain = variable.domain
    return isinstance(domain, IntegerDomain) and size(domain) >= _MIN_QUANTITY_VALUES


def _states_without_frame(game: Game, variable: Variable) -> Node:
    """Return the states and next inputs for which the guarantees allow all next values.

    Each value may need other values of the other outputs.
    """
    manager = game.manager
    bits = game.symbols.bits(variable.name, primed=True)
    other_bits = [bit for bit in game.next_outputs if bit not in bits]
    join = Product(manager, nodes_of(game.guarantees), other_bits)
    states = manager.true
    for value in values(variable.domain):
        code = manager.cube(game.symbols.code(variable.name, value, primed=True))
        states = states & manager.exist(bits, join(code))
    return states


def _describe_state(game: Game, states: Node) -> str:
    """Return one of the states as text, without variables on which *states* do not depend.

    Auxiliary variables are omitted unless the states depend only on them.
    """
    symbols, manager = game.symbols, game.manager
    all_bits = symbols.all_bits(symbols.variables)
    values = symbols.decode(manager.pick(states, all_bits) or {})
    names = symbols.names(states) or tuple(values)
    shown = [name for name in names if not symbols.variables[name].is_auxiliary] or names
    return ", ".join(f"{name}={print_literal(values[name])}" for name in shown)
